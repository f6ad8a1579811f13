#!/usr/bin/env bats
# refer-say. Options that every tool has are in common.bats.

setup_file() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	"$BATS_TEST_DIRNAME/examples-setup.sh" "$BATS_FILE_TMPDIR" "$BIN"
}

setup() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	load ../format/files
	cd "$BATS_TEST_TMPDIR"
	export OMP_WAIT_POLICY=passive
	made=$BATS_FILE_TMPDIR
	cp -r "$made/kitchen" .
}

say() { "$BIN/refer-say" --encoder "$made/encoder" --each 4 "$@"; }

@test "training sentences of the model's things, as many of each, none twice, the same for any number of threads" {
	for n in 1 2 3; do say --threads $n -o $n kitchen; done
	cmp 1 2
	cmp 1 3
	say kitchen >printed
	cmp 1 printed
	jq -se 'all(.[]; .split == "train" and (.text | startswith("the "))) and (map(.ref) | unique | length) == length
		and (map(.text) | unique | length) == length and (group_by(.object) | all(.[]; length == 4)) and length == 12' 1
	"$BIN/gs-check" 1
	say --seed 2 -o other kitchen
	! cmp -s 1 other
}

@test "what is kept is what the lifted model answers, as surely as is asked" {
	say -o said --min-probability 0.8 kitchen
	jq -r '"", .text' said >questions
	"$BIN/refer-ask" -q --json --encoder "$made/encoder" kitchen <questions >replies
	jq -sce --slurpfile said said '[range(length) as $i | .[$i] | .answered and (.things | length == 1) and
		.things[0].name == $said[$i].object and .things[0].probability > 0.799] | all' replies
}

@test "--absent: sentences that the lifted model refuses, of no object, are taught" {
	say -o said --absent 6 kitchen
	"$BIN/gs-check" said
	jq -se 'map(select(.objects == [] and (has("object") | not))) | length == 6' said
	jq -r 'select(.objects) | "", .text' said >questions
	"$BIN/refer-ask" -q --min-probability 0.4 --json --encoder "$made/encoder" kitchen <questions >replies || true
	jq -sce 'length == 6 and all(.[]; .answered | not)' replies
	cat "$made/sentences.jsonl" said | "$BIN/text-encode" -q --model "$made/encoder" -o taught
	"$BIN/refer-lift" -q --scene kitchen/scene --weights "$made/weights" --text taught --masks "$made/masks.jsonl" -o lifted
	"$BIN/gs-check" lifted
	"$BIN/refer-train" -q --scene kitchen/scene --weights "$made/weights" --text taught --masks "$made/masks.jsonl" --query parses \
		--init kitchen/lifted/model.safetensors --init-iterations 4 --iterations 6 -o m
	"$BIN/gs-check" m
}

@test "it is encoded with the sentences that it came from, and taught" {
	say -o said kitchen
	cat "$made/sentences.jsonl" said | "$BIN/text-encode" -q --model "$made/encoder" -o taught
	"$BIN/refer-train" -q --scene kitchen/scene --weights "$made/weights" --text taught --masks "$made/masks.jsonl" --query parses \
		--init kitchen/lifted/model.safetensors --init-iterations 4 --iterations 6 -o m
	"$BIN/gs-check" m
}

@test "a model of another kind, and one of one thing" {
	says 3 "refer-say: $made/model.safetensors: is a trained model; questions need one of refer-lift" \
		"$BIN/refer-say" --encoder "$made/encoder" --model "$made/model.safetensors" -o out kitchen
	[ ! -e out ]
	jq -c 'select(.object == "brown box")' "$made/masks.jsonl" >one.jsonl
	"$BIN/refer-lift" -q --scene kitchen/scene --weights "$made/weights" --text "$made/text.safetensors" --masks one.jsonl -o one
	# One thing has no relations to others.
	"$BIN/refer-say" -q --encoder "$made/encoder" --model one --each 1 -o out kitchen
	[ "$(jq -r .object out)" = "brown box" ]
}
