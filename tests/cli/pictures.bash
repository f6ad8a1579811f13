# Pictures of a few pixels, for the tests of tools that read them.

# number N: four bytes, the highest first, in hexadecimal.
number() { printf '%08x' "$1"; }

# chunk TYPE HEX: a chunk of a PNG, in hexadecimal.
chunk() {
	local body
	body=$(printf %s "$1" | xxd -p)$2
	printf '%s%s%s' "$(number $((${#2} / 2)))" "$body" "$(printf %s "$body" | xxd -r -p | gzip -c | tail -c 8 | head -c 4 | xxd -p | fold -w2 | tac | tr -d '\n')"
}

# picture FILE ROW...: a colour PNG; a row is its pixels, rrggbb. The data are one stored block of deflate. Other kinds by
# kind=BBCC, bits and colour type: 0800 and 1000 are greys of 8 and 16 bits, 0806 rrggbbaa, 1002 colours of 16 bits.
picture() {
	local file=$1 row data='' sum_a=1 sum_b=0 byte n kind=${kind:-0802}
	local -A digits=([0802]=6 [0806]=8 [1000]=4 [0800]=2 [1002]=12)
	shift
	for row; do data+=00${row// /}; done
	for byte in $(fold -w2 <<<"$data"); do
		sum_a=$(((sum_a + 16#$byte) % 65521)) sum_b=$(((sum_b + sum_a) % 65521))
	done
	n=$(printf '%04x' $((${#data} / 2)))
	{
		printf 89504e470d0a1a0a
		row=${1// /}
		chunk IHDR "$(number $((${#row} / ${digits[$kind]})))$(number $#)${kind}000000"
		chunk IDAT "780101${n:2}${n:0:2}$(printf '%04x' $((16#${n:2}${n:0:2} ^ 65535)))$data$(printf '%04x%04x' $sum_b $sum_a)"
		chunk IEND ''
	} | xxd -r -p >"$file"
}

# says_like STATUS BEGINNING COMMAND...
says_like() {
	local status=$1 beginning=$2
	shift 2
	run "$@"
	[ "$status" = 3 ] && [[ $output == "$beginning"* ]]
}

# labelme SHAPE...: a LabelMe file of 6 by 4 pixels on stdout.
labelme() {
	local IFS=,
	printf '{"version":"5.5.0","flags":{},"shapes":[%s],"imagePath":"..\\\\photos\\\\view_1.jpg","imageData":null,"imageHeight":4,"imageWidth":6}\n' "$*"
}
