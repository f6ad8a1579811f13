# pasted PAGE FROM TO: what a reader copies of a manual page from one heading to another: the lines that are set in, as a terminal of 80
# columns shows them.
pasted() {
	mandoc -T utf8 -O width=78 "$1" | col -bx | sed -n "/^$2/,/^$3/s/^ \\{11\\}//p"
}
