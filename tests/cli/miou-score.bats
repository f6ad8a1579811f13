#!/usr/bin/env bats
# miou-score: predictions against truth.

bats_require_minimum_version 1.5.0

setup() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	cd "$BATS_TEST_TMPDIR"
	# one row of eight pixels
	four='{"size":[1,8],"counts":[0,4,4]}' two='{"size":[1,8],"counts":[0,2,6]}' none='{"size":[1,8],"counts":[8]}'
	cat > truth.jsonl <<-END
	{"view":"v1","object":"cup","segmentation":$four}
	{"view":"v1","object":"plate","segmentation":$none}
	{"view":"v1","ref":"spoon-1","object":"spoon","segmentation":$two}
	{"view":"v2","object":"cup","segmentation":$four}
	END
	cat > pred.jsonl <<-END
	{"view":"v1","ref":"cup-1","object":"cup","score":0.5,"segmentation":$four}
	{"view":"v1","ref":"cup-2","object":"cup","segmentation":$two}
	{"view":"v1","ref":"plate-1","object":"plate","segmentation":$four}
	{"view":"v1","ref":"spoon-1","segmentation":$two}
	{"view":"v9","ref":"cup-1","object":"cup","segmentation":$four}
	END
}

# what is in the folder beside the input
strays() { ls | grep -v -x -e truth.jsonl -e pred.jsonl || true; }

@test "the table" {
	run --separate-stderr "$BIN/miou-score" --truth truth.jsonl pred.jsonl
	[ "$status" -eq 0 ]
	[ -z "$stderr" ]
	# 1, 1/2, 1 and a missing one; 4+2+2 of 4+4+2+4 pixels
	diff - <(echo "$output") <<-END
	mIoU          62.50 %
	overall IoU   57.14 %
	P@0.25        75.00 %
	P@0.5         75.00 %
	P@0.75        50.00 %
	pairs             4
	missing           1
	empty truth       1

	pairs     mIoU  object
	    3  50.00 %  cup
	    0        -  plate
	    1 100.00 %  spoon
	END
}

@test "--json has the same figures in 0 to 1" {
	run --separate-stderr "$BIN/miou-score" --json --truth truth.jsonl pred.jsonl
	[ "$status" -eq 0 ]
	[ "$(echo "$output" | jq -c '[.miou,.p25,.p50,.p75,.pairs,.empty_truth,.missing]')" = "[0.625,0.75,0.75,0.5,4,1,1]" ]
	[ "$(echo "$output" | jq '.oiou * 14 - 8 | fabs < 1e-12')" = true ]
	[ "$(echo "$output" | jq -c .objects)" = \
		'{"cup":{"pairs":3,"miou":0.5},"plate":{"pairs":0,"miou":null},"spoon":{"pairs":1,"miou":1}}' ]
	[ "$(echo "$output" | jq -c keys)" = '["empty_truth","miou","missing","objects","oiou","p25","p50","p75","pairs"]' ]
}

@test "truth against itself is 1" {
	"$BIN/miou-score" --json --truth truth.jsonl truth.jsonl | jq -e '.miou == 1 and .oiou == 1 and .missing == 0'
}

@test "--fail-under: exit 1 below, 0 at it, and the scores all the same" {
	run --separate-stderr "$BIN/miou-score" --fail-under 0.626 --truth truth.jsonl pred.jsonl
	[ "$status" -eq 1 ]
	[ "${lines[0]}" = "mIoU          62.50 %" ]
	[ "$stderr" = "miou-score: mIoU 0.6250 is below 0.626" ]
	run --separate-stderr "$BIN/miou-score" --fail-under 0.625 --truth truth.jsonl pred.jsonl
	[ "$status" -eq 0 ]
	[ -z "$stderr" ]
	run "$BIN/miou-score" --fail-under 62 --truth truth.jsonl pred.jsonl
	[ "$status" -eq 2 ]
	[ "${lines[0]}" = "miou-score: --fail-under: '62' is not a number from 0 to 1" ]
}

@test "a mask without ref serves every sentence of its object" {
	printf '%s\n' "{\"view\":\"v\",\"ref\":\"r1\",\"object\":\"cup\",\"segmentation\":$four}" \
		"{\"view\":\"v\",\"ref\":\"r2\",\"object\":\"cup\",\"segmentation\":$two}" > t
	echo "{\"view\":\"v\",\"object\":\"cup\",\"segmentation\":$two}" > p
	"$BIN/miou-score" --json --truth t p | jq -e '.pairs == 2 and .miou == 0.75 and .missing == 0'
}

@test "predictions that no truth belongs to are left out and told" {
	echo "{\"view\":\"v1\",\"ref\":\"fork-1\",\"object\":\"fork\",\"segmentation\":$four}" >> pred.jsonl
	run --separate-stderr "$BIN/miou-score" -v --truth truth.jsonl pred.jsonl
	[ "$status" -eq 0 ]
	[ "${lines[0]}" = "mIoU          62.50 %" ]
	[ "${stderr_lines[0]}" = "miou-score: 1 predictions of views without truth were left out" ]
	[ "${stderr_lines[1]}" = \
		"miou-score: warning: pred.jsonl: 1 predictions of labelled views match no truth's ref or object and were left out" ]
	run --separate-stderr "$BIN/miou-score" -q --truth truth.jsonl pred.jsonl
	[ -z "$stderr" ]
}

@test "a prediction of another size is brought to the truth's" {
	echo '{"view":"v1","object":"cup","segmentation":{"size":[2,16],"counts":[0,16,16]}}' > p
	head -n 1 truth.jsonl > t
	"$BIN/miou-score" --json --truth t p | jq -e '.miou == 1'
	echo '{"view":"v1","object":"cup","segmentation":{"size":[1,4],"counts":[0,1,3]}}' > p
	"$BIN/miou-score" --json --truth t p | jq -e '.miou == 0.5'
}

@test "no predictions at all: everything is missing" {
	run "$BIN/miou-score" --json --truth truth.jsonl /dev/null
	[ "$status" -eq 0 ]
	[ "$(echo "$output" | jq -c '[.miou,.oiou,.pairs,.missing,.empty_truth]')" = "[0,0,3,3,1]" ]
}

@test "- is stdin on either side, but not on both" {
	"$BIN/miou-score" --truth truth.jsonl -o expected pred.jsonl
	"$BIN/miou-score" --truth truth.jsonl < pred.jsonl | cmp expected -
	cat pred.jsonl | "$BIN/miou-score" --truth truth.jsonl - -o - | cmp expected -
	"$BIN/miou-score" --truth - pred.jsonl < truth.jsonl | cmp expected -
	run "$BIN/miou-score" --truth - < truth.jsonl
	[ "$status" -eq 2 ]
	[ "${lines[0]}" = "miou-score: truth and predictions cannot both be stdin" ]
	run "$BIN/miou-score" pred.jsonl
	[ "$status" -eq 2 ]
	[ "${lines[0]}" = "miou-score: --truth TRUTH is required" ]
}

@test "two records of one name are an error with both lines" {
	echo "{\"view\":\"v1\",\"ref\":\"cup-2\",\"object\":\"mug\",\"segmentation\":$two}" >> pred.jsonl
	run "$BIN/miou-score" --truth truth.jsonl -o out pred.jsonl
	[ "$status" -eq 3 ]
	[ "$output" = "miou-score: pred.jsonl:6: view 'v1', ref 'cup-2' is on line 2 already" ]
	echo "{\"view\":\"v2\",\"object\":\"cup\",\"segmentation\":$two}" >> truth.jsonl
	run "$BIN/miou-score" --truth truth.jsonl -o out pred.jsonl
	[ "$status" -eq 3 ]
	[ "$output" = "miou-score: truth.jsonl:5: view 'v2', object 'cup' is on line 4 already" ]
	[ -z "$(strays)" ]
}

@test "truth without anything in it cannot be scored" {
	run "$BIN/miou-score" --truth /dev/null pred.jsonl
	[ "$status" -eq 3 ]
	[ "$output" = "miou-score: /dev/null: no mask with anything in it: there is nothing to score" ]
	sed -n 2p truth.jsonl > ../empty.jsonl
	run "$BIN/miou-score" --truth ../empty.jsonl -o out pred.jsonl
	[ "$status" -eq 3 ]
	[ "$output" = "miou-score: ../empty.jsonl: no mask with anything in it: there is nothing to score" ]
	[ -z "$(strays)" ]
}

@test "missing, truncated and foreign input, and no stray file" {
	run "$BIN/miou-score" --truth truth.jsonl -o out nowhere.jsonl
	[ "$status" -eq 4 ]
	[ "$output" = "miou-score: nowhere.jsonl: No such file or directory" ]
	run "$BIN/miou-score" --truth nowhere.jsonl -o out pred.jsonl
	[ "$status" -eq 4 ]
	[ "$output" = "miou-score: nowhere.jsonl: No such file or directory" ]
	head -c 150 pred.jsonl > ../cut.jsonl
	run "$BIN/miou-score" --truth truth.jsonl -o out ../cut.jsonl
	[ "$status" -eq 3 ]
	[[ "$output" == "miou-score: ../cut.jsonl:2: not JSON at column "* ]]
	[ -z "$(strays)" ]
}

@test "--predicted-views leaves out the truth of views without a prediction" {
	printf '{"view":"v%d","object":"cup","segmentation":{"size":[2,3],"counts":[0,2,4]}}\n' 1 2 >two.jsonl
	head -n 1 two.jsonl >one.jsonl
	[ "$("$BIN/miou-score" --json --truth two.jsonl one.jsonl | jq -c '[.miou,.pairs,.missing]')" = '[0.5,2,1]' ]
	[ "$("$BIN/miou-score" --json --predicted-views --truth two.jsonl one.jsonl | jq -c '[.miou,.pairs,.missing]')" = '[1,1,0]' ]
}
