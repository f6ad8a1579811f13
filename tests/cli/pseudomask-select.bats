#!/usr/bin/env bats
# pseudomask-select: which candidate stands for an object in a view.

bats_require_minimum_version 1.5.0

setup() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	cd "$BATS_TEST_TMPDIR"
	# one row of six pixels, one column each: A = 1 to 3, B = 2 to 4
	A='{"size":[1,6],"counts":[1,3,2]}' B='{"size":[1,6],"counts":[2,3,1]}' C='{"size":[1,6],"counts":[5,1]}'
	cat > candidates.jsonl <<-END
	{"view":"v2","ref":"cup-1","object":"cup","score":0.9,"segmentation":$A}
	{"view":"v1","ref":"cup-1","object":"cup","score":0.9,"segmentation":$A}
	{"view":"v1","ref":"pan-1","object":"pan","score":0.2,"segmentation":$A}
	{"view":"v1","ref":"cup-2","object":"cup","score":0.5,"segmentation":$B}

	{"view":"v2","ref":"jar-1","object":"jar","segmentation":$C}
	{"view":"v1","ref":"cup-3","object":"cup","score":0.6,"segmentation":$B}
	END
}

# what is in the folder beside the input
strays() { ls | grep -v -x candidates.jsonl || true; }

@test "help and version" {
	run "$BIN/pseudomask-select" --help
	[ "$status" -eq 0 ]
	[[ "${lines[0]}" == "Usage: pseudomask-select [OPTION]... [CANDIDATES]" ]]
	[[ "$output" == *"--method ciou|iou|top1"* && "$output" == *"--min-score G"* ]]
	run "$BIN/pseudomask-select" -V
	[ "$status" -eq 0 ]
	[[ "$output" == "pseudomask-select (refersplat) "* ]]
}

@test "usage errors" {
	run "$BIN/pseudomask-select" --nonsense
	[ "$status" -eq 2 ]
	[ "${lines[0]}" = "pseudomask-select: unknown option '--nonsense'" ]
	[ "${lines[1]}" = "Try 'pseudomask-select --help'." ]
	run "$BIN/pseudomask-select" --method best candidates.jsonl
	[ "$status" -eq 2 ]
	[ "${lines[0]}" = "pseudomask-select: --method: 'best' is not one of ciou|iou|top1" ]
	run "$BIN/pseudomask-select" --min-score 1.5 candidates.jsonl
	[ "$status" -eq 2 ]
	[ "${lines[0]}" = "pseudomask-select: --min-score: '1.5' is not a number from 0 to 1" ]
	run "$BIN/pseudomask-select" candidates.jsonl other.jsonl
	[ "$status" -eq 2 ]
	[ "${lines[0]}" = "pseudomask-select: unexpected operand 'other.jsonl'" ]
}

@test "ciou: the object's sentences outvote the most confident of them" {
	run "$BIN/pseudomask-select" --method ciou candidates.jsonl
	[ "$status" -eq 0 ]
	[ "${#lines[@]}" -eq 3 ]
	[ "${lines[0]}" = '{"view":"v2","object":"cup","score":1,"segmentation":{"size":[1,6],"counts":"132"}}' ]
	# (1 + 1.2/3.3 + 0.5/0.6) / 3
	[[ "${lines[1]}" =~ ^'{"view":"v1","object":"cup","score":0.7323232323232'[0-9]+',"segmentation":{"size":[1,6],"counts":"231"}}'$ ]]
	[ "${lines[2]}" = '{"view":"v2","object":"jar","score":1,"segmentation":{"size":[1,6],"counts":"51"}}' ]
}

@test "ciou is the default" {
	"$BIN/pseudomask-select" candidates.jsonl > default
	"$BIN/pseudomask-select" --method ciou --min-score 0.3 candidates.jsonl > ciou
	cmp default ciou
}

@test "iou: without the confidences" {
	run "$BIN/pseudomask-select" --method iou candidates.jsonl
	[ "$status" -eq 0 ]
	# (1 + 2/4 + 1) / 3
	[[ "${lines[1]}" == '{"view":"v1","object":"cup","score":0.8333333333333334,'*'"counts":"231"}}' ]]
}

@test "top1: the most confident" {
	run "$BIN/pseudomask-select" --method top1 candidates.jsonl
	[ "$status" -eq 0 ]
	[ "${lines[1]}" = '{"view":"v1","object":"cup","score":0.9,"segmentation":{"size":[1,6],"counts":"132"}}' ]
	# without a score it is 1
	[[ "${lines[2]}" == '{"view":"v2","object":"jar","score":1,'* ]]
}

@test "min-score cuts strictly and -v counts what it cost" {
	run --separate-stderr "$BIN/pseudomask-select" -v --method top1 --min-score 0.9 candidates.jsonl
	[ "$status" -eq 0 ]
	[ "${#lines[@]}" -eq 1 ]
	[[ "${lines[0]}" == *'"object":"jar"'* ]]
	[ "${stderr_lines[0]}" = "pseudomask-select: 6 candidates, 5 of them not above 0.9" ]
	[ "${stderr_lines[1]}" = "pseudomask-select: 1 masks; 3 views of an object without one" ]
	run "$BIN/pseudomask-select" --min-score 0.19 candidates.jsonl
	[ "${#lines[@]}" -eq 4 ]
}

@test "a candidate without an object is pooled with its own sentence only" {
	jq -c 'if .object == "cup" then del(.object) else . end' candidates.jsonl > some.jsonl
	run "$BIN/pseudomask-select" --method top1 some.jsonl
	[ "$status" -eq 0 ]
	[ "${#lines[@]}" -eq 5 ]
	[ "${lines[2]}" = '{"view":"v1","ref":"cup-2","score":0.5,"segmentation":{"size":[1,6],"counts":"231"}}' ]
	# the sentence of that name is not the object of that name
	printf '%s\n' "{\"view\":\"v\",\"ref\":\"cup\",\"segmentation\":$A}" "{\"view\":\"v\",\"object\":\"cup\",\"segmentation\":$B}" > two
	run "$BIN/pseudomask-select" two
	[ "${#lines[@]}" -eq 2 ]
}

@test "any order, a pipe, - and any number of threads give the same" {
	"$BIN/pseudomask-select" -o expected candidates.jsonl
	"$BIN/pseudomask-select" --threads 1 candidates.jsonl > one
	"$BIN/pseudomask-select" --threads 2 < candidates.jsonl > two
	cat candidates.jsonl | "$BIN/pseudomask-select" --threads 7 - -o - > seven
	cmp expected one && cmp expected two && cmp expected seven
	tac candidates.jsonl | "$BIN/pseudomask-select" | sed 's/"score":[0-9.]*//' | sort > backwards
	sed 's/"score":[0-9.]*//' expected | sort | cmp - backwards
}

@test "many objects: threads do not change a byte" {
	for i in $(seq 300); do
		echo "{\"view\":\"v$((i % 7))\",\"object\":\"o$((i % 11))\",\"score\":0.$((310 + i % 600)),\"segmentation\":{\"size\":[10,10],\"counts\":[$((i % 50)),$((10 + i % 13)),$((90 - i % 50 - i % 13))]}}"
	done > many.jsonl
	"$BIN/pseudomask-select" --threads 1 many.jsonl > one
	"$BIN/pseudomask-select" --threads 2 many.jsonl > two
	[ "$(wc -l < one)" -eq 77 ]
	cmp one two
}

@test "masks of one view must have one size" {
	echo '{"view":"v1","ref":"cup-4","object":"jug","segmentation":{"size":[2,3],"counts":[6]}}' >> candidates.jsonl
	run "$BIN/pseudomask-select" -o out candidates.jsonl
	[ "$status" -eq 3 ]
	[ "$output" = "pseudomask-select: candidates.jsonl:8: a mask of 3x2, but view 'v1' has 6x1 on line 2" ]
	[ -z "$(strays)" ]
}

@test "no candidates: nothing, and a warning" {
	run --separate-stderr "$BIN/pseudomask-select" /dev/null
	[ "$status" -eq 0 ]
	[ -z "$output" ]
	[ "$stderr" = "pseudomask-select: warning: /dev/null: no candidates" ]
	run "$BIN/pseudomask-select" -q < /dev/null
	[ -z "$output" ]
}

@test "missing, truncated and foreign input, and no stray file" {
	run "$BIN/pseudomask-select" -o out nowhere.jsonl
	[ "$status" -eq 4 ]
	[ "$output" = "pseudomask-select: nowhere.jsonl: No such file or directory" ]
	head -c 200 candidates.jsonl > ../cut.jsonl
	run "$BIN/pseudomask-select" -o out ../cut.jsonl
	[ "$status" -eq 3 ]
	[[ "$output" == "pseudomask-select: ../cut.jsonl:2: not JSON at column "* ]]
	printf '\x89PNG\r\n' > ../image.png
	run "$BIN/pseudomask-select" -o out ../image.png
	[ "$status" -eq 3 ]
	[ "$output" = "pseudomask-select: ../image.png:1: not JSON at column 1" ]
	run "$BIN/pseudomask-select" -o out .
	[ "$status" -eq 4 ]
	[ "$output" = "pseudomask-select: .: Is a directory" ]
	[ -z "$(strays)" ]
	run "$BIN/pseudomask-select" -o nowhere/out candidates.jsonl
	[ "$status" -eq 4 ]
	[ "$output" = "pseudomask-select: nowhere/out: No such file or directory" ]
}

@test "an existing output is kept when the input is bad" {
	echo before > out
	run "$BIN/pseudomask-select" -o out nowhere.jsonl
	[ "$(cat out)" = before ]
}
