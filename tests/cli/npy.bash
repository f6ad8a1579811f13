# Helpers of the tests of weights and features: a small weighed scene, .npy files and numbers in safetensors.

# weighed_scene: in the current folder, a synthetic scene with weights, encoded sentences and masks of its training views.
weighed_scene() {
	cp -r "$BATS_TEST_DIRNAME/../golden/bert" encoder
	"$BIN/gs-synth" -q --objects 3 --views 5 --size 64x48 --gaussians 2000 -o .
	"$BIN/gs-import" -q --images images --test-views "$(cat test-views)" -o scene point_cloud.ply
	"$BIN/gs-weigh" -q -o weights scene
	"$BIN/text-encode" -q --model encoder -o text.safetensors sentences.jsonl
	jq -c --arg test "$(cat test-views)" 'select(.view as $v | $test | split(",") | index($v) | not)' truth.jsonl >masks.jsonl
}

# npy FILE DESCR SHAPE HEX: an array as numpy.save writes it, but for the padding.
npy() {
	local header="{'descr': '$2', 'fortran_order': False, 'shape': ($3), }"
	{
		printf '\x93NUMPY\x01\x00\x76\x00%-117s\n' "$header"
		printf '%s' "$4" | xxd -r -p
	} >"$1"
}

# number BYTES N...: each number in so many bytes, the lowest first.
number() {
	local n k bytes=$1
	shift
	for n; do
		for ((k = 0; k < bytes; k++)); do printf "\\x$(printf %02x $((n >> 8 * k & 255)))"; done
	done
}

# npz FILE MEMBER...: a zip of files as they are, under their last names, as numpy.savez writes it.
npz() {
	local out=$1 list=$1.list file name crc size begin
	shift
	: >"$out"
	: >"$list"
	for file; do
		name=${file##*/}
		crc=$(gzip -c "$file" | tail -c 8 | head -c 4 | od -An -t u4 | tr -d ' ')
		size=$(wc -c <"$file")
		begin=$(wc -c <"$out")
		{
			number 4 0x04034b50
			number 2 20 0 0 0 33
			number 4 "$crc" "$size" "$size"
			number 2 ${#name} 0
			printf '%s' "$name"
			cat "$file"
		} >>"$out"
		{
			number 4 0x02014b50
			number 2 20 20 0 0 0 33
			number 4 "$crc" "$size" "$size"
			number 2 ${#name} 0 0 0 0
			number 4 0 "$begin"
			printf '%s' "$name"
		} >>"$list"
	done
	begin=$(wc -c <"$out")
	cat "$list" >>"$out"
	{
		number 4 0x06054b50
		number 2 0 0 $# $#
		number 4 "$(wc -c <"$list")" "$begin"
		number 2 0
	} >>"$out"
	rm "$list"
}

# times N TEXT: the text so often.
times() {
	local k
	for ((k = 0; k < $1; k++)); do printf '%s' "$2"; done
}

# tensor FILE NAME TYPE: a tensor's numbers on one line; TYPE as od has it (d4, d8, f4, u2).
tensor() {
	local length begin end
	length=$(od -An -t d8 -N 8 "$1" | tr -d ' ')
	read -r begin end < <(head -c $((8 + length)) "$1" | tail -c +9 | jq -r ".[\"$2\"].data_offsets | @tsv")
	tail -c +$((9 + length + begin)) "$1" | head -c $((end - begin)) | od -An -v -t "$3" | tr -s ' \n' ' ' | sed 's/^ //; s/ $//'
}

# meta FILE KEY
meta() {
	head -c $((8 + $(od -An -t d8 -N 8 "$1"))) "$1" | tail -c +9 | jq -r ".__metadata__[\"$2\"]"
}
