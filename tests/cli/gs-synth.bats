#!/usr/bin/env bats
# gs-synth: the folder it makes, and that the suite's readers agree with it. What holds for every tool is in common.bats.

setup() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	cd "$BATS_TEST_TMPDIR"
}

# A scene small enough to be made in a moment.
small() {
	"$BIN/gs-synth" --views 5 --size 80x60 --gaussians 3000 "$@"
}

# One hash of every name and byte in a folder.
hash_of() {
	(cd "$1" && find . -type f | LC_ALL=C sort | xargs sha256sum) | sha256sum
}

# Both files are there, and not the same.
differ() {
	[ -s "$1" ] && [ -s "$2" ] || return 1
	if cmp -s "$1" "$2"; then
		echo "$1 and $2 are the same"
		return 1
	fi
}

@test "without -o: exit 2" {
	run "$BIN/gs-synth" --seed 1
	[ "$status" = 2 ]
	[ "${lines[0]}" = "gs-synth: -o DIR is required" ]
	[ "${lines[1]}" = "Try 'gs-synth --help'." ]
}

@test "standard output cannot hold a folder" {
	run "$BIN/gs-synth" -o -
	[ "$status" = 2 ]
	[ "${lines[0]}" = "gs-synth: -o must name a folder" ]
}

@test "numbers out of range: exit 2, and nothing is made" {
	run small --objects 1 -o out
	[ "$status" = 2 ]
	[ "${lines[0]}" = "gs-synth: --objects: '1' is not a whole number from 2 to 24" ]
	run small --views 1001 -o out
	[ "${lines[0]}" = "gs-synth: --views: '1001' is not a whole number from 2 to 1000" ]
	run small --gaussians 999 -o out
	[ "${lines[0]}" = "gs-synth: --gaussians: '999' is not a whole number from 1000 to 10000000" ]
	run small --size 8x60 -o out
	[ "${lines[0]}" = "gs-synth: --size: '8x60' is not WIDTHxHEIGHT with both from 16 to 4096" ]
	run small operand -o out
	[ "$status" = 2 ]
	[ "${lines[0]}" = "gs-synth: unexpected operand 'operand'" ]
	[ ! -e out ]
}

@test "a folder that cannot be made: exit 4 and its name" {
	: >file
	run small -o file/out
	[ "$status" = 4 ]
	[ "$output" = "gs-synth: file/out/images: file: Not a directory" ]
	[ "$(ls -A)" = file ]
}

@test "an output that cannot be written leaves no temporary file" {
	mkdir -p out/truth.jsonl
	run small -o out
	[ "$status" = 4 ]
	[[ $output = "gs-synth: out/truth.jsonl: "* ]]
	[ -z "$(find . -name '*.tmp.*')" ]
}

# interrupted SIGNAL [OPTION OF env]...: sends the signal when two outputs are half written; sets status.
interrupted() {
	local signal=$1 pid i
	shift
	rm -rf out
	env "$@" "$BIN/gs-synth" --views 25 --size 400x300 --gaussians 1000 --objects 2 -o out >printed 2>&1 &
	pid=$!
	for ((i = 0; i < 1000; i++)); do
		[ "$(find . -name '*.jsonl.tmp.*' | wc -l)" = 2 ] && break
		sleep 0.01
	done
	[ $i -lt 1000 ]
	kill "-$signal" $pid
	status=0
	wait $pid || status=$?
	[ -z "$(find . -name '*.tmp.*')" ]
}

@test "a signal leaves no temporary file, and its own exit status" {
	for signal in HUP INT TERM; do
		interrupted $signal --default-signal
		[ $status = $((128 + $(kill -l $signal))) ]
		[ ! -e out/truth.jsonl ]
	done
}

@test "a signal that is ignored from the start stays so" {
	interrupted HUP --ignore-signal=HUP
	[ $status = 0 ]
	[ -e out/truth.jsonl ]
}

@test "the folder holds what formats/synth.md says" {
	small -o out
	[ "$(cd out && find . -type f | LC_ALL=C sort | tr '\n' ' ')" = "./candidates.jsonl ./images/view_000.png \
./images/view_001.png ./images/view_002.png ./images/view_003.png ./images/view_004.png ./point_cloud.ply \
./sentences.jsonl ./sparse/0/cameras.txt ./sparse/0/images.txt ./sparse/0/points3D.txt ./test-views ./truth.jsonl " ]
	[ "$(cat out/test-views)" = view_004 ]
	[ "$(wc -l <out/sentences.jsonl)" = 40 ]
	[ "$(jq -r .split out/sentences.jsonl | sort | uniq -c | xargs)" = "8 test 32 train" ]
	[ "$(wc -l <out/truth.jsonl)" = 40 ]
	[ "$(jq -c .segmentation.size out/truth.jsonl out/candidates.jsonl | sort -u)" = "[60,80]" ]
}

@test "truth is of objects in every view, candidates of training sentences in training views" {
	small -o out
	jq -e 'has("ref") or has("score") | not' out/truth.jsonl >/dev/null
	[ "$(jq -r .view out/truth.jsonl | sort | uniq -c | sort -u | awk '{print $1}' | sort -u)" = 8 ]
	[ "$(jq -r .object out/truth.jsonl | sort -u)" = "$(jq -r .object out/sentences.jsonl | sort -u)" ]
	[ "$(jq -r .view out/candidates.jsonl | sort -u | xargs)" = "view_000 view_001 view_002 view_003" ]
	jq -r 'select(.split == "train") | .ref' out/sentences.jsonl | sort >train
	jq -r .ref out/candidates.jsonl | sort -u >pointed
	[ -s pointed ]
	[ -z "$(comm -13 train pointed)" ]
	jq -se 'all(.[]; .score >= 0.2 and .score <= 0.95)' out/candidates.jsonl >/dev/null
}

@test "the truth scores 100 against itself, and candidates much less" {
	"$BIN/gs-synth" --views 10 --gaussians 5000 --size 160x120 -o out
	[ "$("$BIN/miou-score" --json --truth out/truth.jsonl out/truth.jsonl | jq .miou)" = 1 ]
	grep -v -F -f <(tr , '\n' <out/test-views) out/truth.jsonl >truth
	"$BIN/pseudomask-select" --method ciou -o ciou out/candidates.jsonl
	"$BIN/pseudomask-select" --method top1 -o top1 out/candidates.jsonl
	score() { "$BIN/miou-score" --json --truth truth "$1" | jq "$2"; }
	[ "$(score ciou '.miou > 0.5 and .miou < 0.95')" = true ]
	[ "$(score top1 '.miou > 0.2 and .miou < 0.65')" = true ]
	[ "$(jq -n "$(score ciou .miou) > $(score top1 .miou) + 0.1")" = true ]
}

@test "gs-import reads the scene, with its photographs and test views" {
	small --views 10 -o out
	"$BIN/gs-import" --images out/images --test-views "$(cat out/test-views)" -o scene out/point_cloud.ply
	[ "$(jq -r '.[] | select(.split == "test") | .name' scene/cameras.json | xargs)" = "view_004 view_009" ]
	[ "$(jq -r '.[] | .image' scene/cameras.json | xargs -n 1 basename | head -n 1)" = view_000.png ]
	"$BIN/gs-check" scene | grep -q "3000 gaussians"
}

@test "the same seed gives the same bytes, with 1 and 2 threads" {
	small --seed 7 --threads 1 -o one
	small --seed 7 --threads 2 -o two
	[ "$(hash_of one)" = "$(hash_of two)" ]
}

@test "another seed gives another scene" {
	small --seed 7 -o one
	small --seed 8 -o two
	for file in point_cloud.ply sparse/0/images.txt sentences.jsonl truth.jsonl candidates.jsonl images/view_000.png; do
		differ one/$file two/$file
	done
}

@test "more Gaussians leave sentences and cameras as they were" {
	small -o one
	small --gaussians 4000 -o two
	cmp one/sentences.jsonl two/sentences.jsonl
	cmp one/sparse/0/images.txt two/sparse/0/images.txt
	differ one/point_cloud.ply two/point_cloud.ply
}

@test "few and many objects, and a tall picture" {
	small --objects 2 --views 2 --size 16x40 -o few
	[ "$(wc -l <few/sentences.jsonl)" = 10 ]
	[ "$(cat few/test-views)" = view_001 ]
	small --objects 24 --gaussians 1000 -o many
	[ "$(wc -l <many/sentences.jsonl)" = 120 ]
	[ "$(jq -r .ref many/sentences.jsonl | sort -u | wc -l)" = 120 ]
	"$BIN/gs-check" few/truth.jsonl many/truth.jsonl many/candidates.jsonl many/sentences.jsonl
}

@test "sentences have 7 to 22 words, and photographs are not of one colour" {
	small -o out
	jq -se 'all(.[]; .text | split(" ") | length >= 7 and length <= 22)' out/sentences.jsonl >/dev/null
	[ "$(stat -c %s out/images/view_000.png)" -gt 3000 ]
}
