# Both files are there, and not the same.
differ() {
	[ -s "$1" ] && [ -s "$2" ] || return 1
	if cmp -s "$1" "$2"; then
		echo "$1 and $2 are the same"
		return 1
	fi
}
