#!/usr/bin/env bats
# Each rule of formats/records/boxes.md broken once, and how boxes are scored.

setup() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	load files
	cd "$BATS_TEST_TMPDIR"
	turned='"oriented":{"centre":[0.5,0.5,0.5],"quat":[1,0,0,0],"size":[1,1,1]}'
	unit="\"min\":[0,0,0],\"max\":[1,1,1],$turned"
}

# refuses REASON LINE...: after a good first line and an empty one, these lines are refused so.
refuses() {
	local reason=$1
	shift
	printf '%s\n' "{\"ref\":\"r1\",\"object\":\"o\",$unit}" '' "$@" >x
	says 1 "x:$reason" "$BIN/gs-check" x
	says 3 "miou-score: x:$reason" "$BIN/miou-score" --boxes --truth x x
}

score() { "$BIN/miou-score" --boxes --truth truth "$@"; }

@test "the examples of the page" {
	sed -n '/^## Example/,$s/^    //p' "$BATS_TEST_DIRNAME/../../formats/records/boxes.md" >x
	says 0 'x: ok: boxes, 1 boxes, 2 objects, 1 empty' "$BIN/gs-check" x
}

@test "names" {
	refuses "3: neither key 'ref' nor key 'object'" "{$unit}"
	refuses "3: key 'ref' is not a string" "{\"ref\":1.5,$unit}"
	refuses "3: key 'object' is empty" "{\"object\":\"\",$unit}"
	refuses "3: key 'object' has a control character at byte 2" "{\"object\":\"o\\nx\",$unit}"
	refuses "3: key 'ref' is not UTF-8 at byte 1" "{\"ref\":\"$(printf '\xff')\",\"object\":\"o\",$unit}"
	refuses "3: ref 'r1' is already on line 1" "{\"ref\":\"r1\",$unit}"
	refuses "4: object 'o' is already on line 3" "{\"object\":\"o\",$unit}" "{\"object\":\"o\",$unit}"
}

@test "numbers" {
	refuses "3: key 'score' is not a number" "{\"ref\":\"a\",\"score\":\"x\",$unit}"
	refuses "3: key 'min' is missing" "{\"ref\":\"a\",\"max\":[1,1,1],$turned}"
	refuses "3: key 'max' is missing" "{\"ref\":\"a\",\"min\":[1,1,1],\"max\":null,$turned}"
	refuses "3: key 'min' is not 3 numbers" "{\"ref\":\"a\",\"min\":[0,0],\"max\":[1,1,1],$turned}"
	refuses "3: key 'max' is not 3 numbers" "{\"ref\":\"a\",\"min\":[0,0,0],\"max\":[1,1,1e999],$turned}"
	refuses "3: key 'min' is above 'max'" "{\"ref\":\"a\",\"min\":[0,2,0],\"max\":[1,1,1],$turned}"
}

@test "the turned box" {
	local both='"min":[0,0,0],"max":[1,1,1]'
	refuses "3: key 'oriented' is not an object" "{\"ref\":\"a\",$both,\"oriented\":[1]}"
	refuses "3: key 'oriented' is not an object" "{\"ref\":\"a\",$both}"
	refuses "3: key 'centre' is missing" "{\"ref\":\"a\",$both,\"oriented\":{\"quat\":[1,0,0,0],\"size\":[1,1,1]}}"
	refuses "3: key 'quat' is not of length 1" \
		"{\"ref\":\"a\",$both,\"oriented\":{\"centre\":[0,0,0],\"quat\":[0,0,0,0],\"size\":[1,1,1]}}"
	refuses "3: key 'size' has something below 0" \
		"{\"ref\":\"a\",$both,\"oriented\":{\"centre\":[0,0,0],\"quat\":[1,0,0,0],\"size\":[1,-1,1]}}"
}

@test "lines that are not objects, and no line" {
	refuses '3: not JSON at column 8' '{"ref":x}'
	refuses '3: not a JSON object' '["ref"]'
	printf '\n' >x
	says 3 "miou-score: x: holds no boxes" "$BIN/miou-score" --boxes --truth x x
}

@test "scores: the same boxes" {
	printf '%s\n' "{\"object\":\"a\",$unit}" "{\"object\":\"b\",$unit}" >truth
	printf '%s\n' "{\"ref\":\"a1\",\"object\":\"a\",$unit}" "{\"ref\":\"a2\",\"object\":\"a\",$unit}" "{\"ref\":\"b1\",\"object\":\"b\",$unit}" >x
	says 0 '{"aligned":{"miou":1,"p25":1,"p50":1},"oriented":{"miou":1,"p25":1,"p50":1},"centre":0,"centre_relative":0,"pairs":3,"missing":0,"empty":0,"empty_truth":0,"objects":{"a":{"pairs":2,"aligned":1,"oriented":1,"centre_relative":0},"b":{"pairs":1,"aligned":1,"oriented":1,"centre_relative":0}}}' \
		score --json x
	score - <x | cmp - <(score x)
	score --fail-under 0.99 x
}

@test "scores: beside, missing, empty, unknown" {
	local beside='"min":[0.5,0,0],"max":[1.5,1,1],"oriented":{"centre":[1,0.5,0.5],"quat":[1,0,0,0],"size":[1,1,1]}'
	local none='"min":null,"max":null,"oriented":null'
	printf '%s\n' "{\"ref\":\"s\",\"object\":\"a\",$unit}" "{\"object\":\"b\",$unit}" "{\"object\":\"c\",$unit}" "{\"object\":\"d\",$none}" >truth
	printf '%s\n' "{\"ref\":\"s\",$beside}" "{\"ref\":\"t\",\"object\":\"b\",$none}" "{\"object\":\"d\",$unit}" >x
	says 0 '{"aligned":{"miou":0.111111,"p25":0.333333,"p50":0},"oriented":{"miou":0.111111,"p25":0.333333,"p50":0},"centre":0.5,"centre_relative":0.288675,"pairs":3,"missing":1,"empty":1,"empty_truth":1,"objects":{"a":{"pairs":1,"aligned":0.333333,"oriented":0.333333,"centre_relative":0.288675},"b":{"pairs":1,"aligned":0,"oriented":0,"centre_relative":null},"c":{"pairs":1,"aligned":0,"oriented":0,"centre_relative":null}}}' \
		score --json x
	says 1 'miou-score: mIoU 0.1111 is below 0.5' score --json -o out --fail-under 0.5 x
	echo "{\"ref\":\"u\",\"object\":\"v\",$unit}" >>x
	score --json x 2>err >out
	[ "$(cat err)" = "miou-score: warning: x: 1 boxes match no truth's ref or object and were left out" ]
	jq -e '.pairs == 3' out
	echo "{\"object\":\"d\",$none}" >truth
	says 3 "miou-score: truth: no box at all: there is nothing to score" score x
}

@test "scores: what does not go with --boxes" {
	echo "{\"ref\":\"s\",$unit}" >truth
	for option in --csv --predicted-views "--compare x" "--sentences x" "--whole x" "--bootstrap 10"; do
		says 2 "miou-score: --boxes goes with --truth, --json and --fail-under only
Try 'miou-score --help'." score $option truth
	done
}
