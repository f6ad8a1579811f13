#!/usr/bin/env bats
# formats/scene/checkpoint.md: what goes on with a training. Rules of every safetensors file are in safetensors.bats; that
# resuming gives the same bytes, and which options are another training's, in cli/refer-train.bats.

setup_file() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	export OMP_WAIT_POLICY=passive
	"$BATS_TEST_DIRNAME/../cli/examples-setup.sh" "$BATS_FILE_TMPDIR" "$BIN"
	cd "$BATS_FILE_TMPDIR"
	head -n 1 sentences.jsonl | "$BIN/text-encode" --model encoder -o text.safetensors
	# Step 100 cannot be logged, so that the checkpoint of step 50 stays.
	train --checkpoint 50 --iterations 150 --log /dev/full -o m 2>err || grep -q 'No space left' err
	cp m.checkpoint good
	# Its header without the closing brackets, and the checksums, which would be found first.
	length=$(od -An -t d8 -N 8 good | tr -d ' ')
	head -c $((8 + length)) good | tail -c +9 | jq -c 'del(.__metadata__[] | select(test("^[0-9a-f]{8}$")))' >header
	tail -c +$((9 + length)) good >data
}

setup() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	load files
	cd "$BATS_FILE_TMPDIR"
	export OMP_WAIT_POLICY=passive
	rm -f m m.checkpoint
}

train() {
	"$BIN/refer-train" --scene scene --weights weights --text text.safetensors --masks masks.jsonl --interaction none "$@"
}

# checkpoint [FILTER]: m.checkpoint, its header changed by a jq filter.
checkpoint() {
	local header
	header=$(jq -c "${1:-.}" header)
	while (((8 + ${#header}) % 64)); do header+=' '; done
	st m.checkpoint "$header"
	cat data >>m.checkpoint
}

# bad REASON [FILTER]: that checkpoint is refused and kept, and nothing is written.
bad() {
	checkpoint "${2:-.}"
	says 3 "refer-train: m.checkpoint: $1" train --resume --iterations 60 -o m
	[ ! -e m ]
	[ -e m.checkpoint ]
}

# patched TENSOR BYTES REASON: a checkpoint whose tensor begins with other bytes is refused.
patched() {
	local at
	at=$(jq ".[\"$1\"].data_offsets[0]" header)
	cp data kept
	printf '%s' "$2" | xxd -r -p | dd of=data bs=1 seek="$at" conv=notrunc status=none
	bad "$3"
	mv kept data
}

@test "what is written: the state of step 50, to the table of the page" {
	"$BIN/gs-check" good
	jq -e '.__metadata__ | .format == "refer.checkpoint" and .version == "1" and .tool == "refer-train" and .iteration == "50"' header
	jq -re '.__metadata__.identity' header | grep -qxE -e '--interaction none --similarity dot --query words --contrast cosine --feature-width 16 --temperature 0\.1 --lambda 0\.02 --feature-rate 0\.0025 --mlp-rate 0\.0001 --batch 1 --negatives 12 --tolerance 0 --share 0\.04 --init-iterations 0 --seed 1, inputs [0-9a-f]{8}'
	jq -e '.losses.shape == [3] and .losses.dtype == "F64" and .values.shape == .first_moment.shape and .values.shape == .second_moment.shape' header
	jq -e '.values.dtype == "F32" and .values.shape[0] % 16 == 0' header
}

@test "it is gone on from" {
	checkpoint
	train --resume --iterations 60 -o m
	cp m first
	rm m
	train --iterations 60 -o m
	cmp first m
}

@test "metadata" {
	bad "format is 'refer.model', expected 'refer.checkpoint'" '.__metadata__.format = "refer.model"'
	bad "refer.checkpoint version 2 is newer than this program reads (1)" '.__metadata__.version = "2"'
	other="is of another training (its options or inputs differ); remove it or train without --resume"
	bad "$other" 'del(.__metadata__.identity)'
	bad "$other" '.__metadata__.identity += "0"'
	bad "metadata 'iteration' is '', not a whole number from 1 to 9223372036854775807" 'del(.__metadata__.iteration)'
	bad "metadata 'iteration' is '0', not a whole number from 1 to 9223372036854775807" '.__metadata__.iteration = "0"'
	bad "metadata 'iteration' is '-5', not a whole number from 1 to 9223372036854775807" '.__metadata__.iteration = "-5"'
	bad "metadata 'iteration' is '5 ', not a whole number from 1 to 9223372036854775807" '.__metadata__.iteration = "5 "'
	bad "has 61 steps, more than the 60 asked for" '.__metadata__.iteration = "61"'
}

@test "tensors that are missing or of another type or shape" {
	count=$(jq .values.shape[0] header)
	for name in values first_moment second_moment losses; do
		bad "tensor '$name' is missing" ".other = .$name | del(.$name)"
	done
	bad "tensor 'values': is I32[$count], expected F32[$count]" '.values.dtype = "I32"'
	bad "tensor 'first_moment': is F32[1,$count], expected F32[$count]" '.first_moment.shape = [1, .first_moment.shape[0]]'
	bad "tensor 'losses': is I64[3], expected F64[3]" '.losses.dtype = "I64"'
}

@test "numbers that are not finite, or a negative second moment" {
	patched values 0000c07f "tensor 'values': item 0 is not finite"
	patched first_moment 0000807f "tensor 'first_moment': item 0 is not finite"
	patched second_moment 000080ff "tensor 'second_moment': item 0 is not finite"
	patched second_moment 000080bf "tensor 'second_moment': item 0 is negative"
	patched losses 000000000000f07f "tensor 'losses': item 0 is not finite"
}

@test "a file cut short anywhere is refused" {
	size=$(wc -c <good)
	for length in $((size - 1)) $((size / 2)) 1000 100 8 1 0; do
		head -c $length good >m.checkpoint
		run train --resume --iterations 60 -o m
		[ "$status" = 3 ] || { echo "length $length: $output"; return 1; }
		[[ $output == "refer-train: m.checkpoint: "* ]]
	done
}

@test "a changed bit is found by the checksum" {
	cp good m.checkpoint
	printf '\x3e' | dd of=m.checkpoint bs=1 seek=$(($(wc -c <good) - 2)) conv=notrunc status=none
	run train --resume --iterations 60 -o m
	[ "$status" = 3 ]
	[[ $output == "refer-train: m.checkpoint: tensor 'second_moment': crc32 is "*", the header says "* ]]
}
