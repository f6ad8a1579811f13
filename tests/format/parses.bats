#!/usr/bin/env bats
# Each rule of formats/parses.md and formats/parser_weights.md broken once.

setup() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	load files
	cd "$BATS_TEST_TMPDIR"
	page=$BATS_TEST_DIRNAME/../../formats/parses.md
}

# refuses REASON LINE...: after a good first line, these lines are refused so.
refuses() {
	local reason=$1
	shift
	printf '%s\n' '{"ref":"a","target":{"noun":"wug"}}' "$@" >x
	says 1 "x:$reason" "$BIN/gs-check" x
}

@test "the example of the page, and what is written is read" {
	sed -n '/^## Example/,$s/^    //p' "$page" >x
	says 0 'x: ok: parses, 1 parses, 2 clauses' "$BIN/gs-check" x
	cp -r "$BATS_TEST_DIRNAME/../golden/bert" encoder
	"$BIN/parse-train" --sentences "$BATS_TEST_DIRNAME/../../pipelines/marked/test/31.txt" | "$BIN/text-encode" -q --model encoder -o text
	"$BIN/text-parse" -q text >all
	"$BIN/gs-check" all
}

@test "names and texts" {
	refuses "2: key 'ref' is missing" '{"target":{"noun":"wug"}}'
	printf '%s\n' '{"ref":"a","target":{}}' '{"ref":"a","target":{}}' >x
	says 1 "x: ref 'a' appears twice" "$BIN/gs-check" x
	refuses "2: key 'text' is not a string" '{"ref":"b","text":1,"target":{}}'
	refuses "2: key 'target' is not an object" '{"ref":"b","target":"wug"}'
	refuses "2: key 'noun' is not a string" '{"ref":"b","target":{"noun":["wug"]}}'
	refuses "2: key 'words' is not a list of words" '{"ref":"b","target":{"words":"red"}}'
	refuses "2: key 'confidence' is not a finite number" '{"ref":"b","target":{},"confidence":"x"}'
}

@test "spans" {
	refuses "2: key 'span' is not [begin,end]" '{"ref":"b","text":"wug","target":{"span":3}}'
	refuses "2: key 'span' is not two character offsets of the text" '{"ref":"b","text":"wug","target":{"span":[0,1.5]}}'
	refuses "2: key 'span' is not two rising character offsets" '{"ref":"b","text":"wug","target":{"span":[2,1]}}'
	refuses "2: key 'span' is not within the text" '{"ref":"b","text":"wug","target":{"span":[0,4]}}'
}

@test "counts and ordinals" {
	refuses "2: key 'count' is not 'one', 'several', 'all' or a whole number from 1" '{"ref":"b","target":{},"count":0}'
	refuses "2: key 'group' is not 'one', 'several', 'all' or a whole number from 1" '{"ref":"b","target":{},"group":"two"}'
	refuses "2: key 'ordinal' is not an object with a whole number 'k' that is not 0" '{"ref":"b","target":{},"ordinal":{"k":0}}'
	refuses "2: key 'from' is not 'left', 'right', 'front', 'behind', 'above' or 'below'" \
		'{"ref":"b","target":{},"ordinal":{"k":1,"from":"top"}}'
}

@test "what a thing is one of is written, and read" {
	echo 'Of the wug/M, the dax/M2 and the fep/M3 on/P1:on@M3 the gorp/A1, bring the tallest/P2:taller one/T.' >marks
	"$BIN/parse-train" --sentences -o sentences marks
	"$BIN/text-encode" -q --model "$BATS_TEST_DIRNAME/../golden/bert" -o text sentences
	"$BIN/parse-train" --parses --text text -o x marks
	[ "$(jq -c '[.group] + [.among[].noun]' x)" = '[3,"wug","dax","fep"]' ]
	says 0 'x: ok: parses, 1 parses, 2 clauses' "$BIN/gs-check" x
	refuses "2: key 'among' is not a list of phrases" '{"ref":"b","target":{},"among":["x"]}'
}

@test "clauses" {
	local deep='{"noun":"x"}'
	refuses "2: key 'clauses' is not a list of objects" '{"ref":"b","target":{},"clauses":{}}'
	refuses "2: key 'clauses' is not a list of objects" '{"ref":"b","target":{},"clauses":[1]}'
	refuses "2: key 'relation' is not the name of a relation" '{"ref":"b","target":{},"clauses":[{"relation":"beneath"}]}'
	refuses "2: key 'degree' is not 'more' or 'most'" '{"ref":"b","target":{},"clauses":[{"relation":"left","degree":"very"}]}'
	refuses "2: key 'anchors' is not a list of phrases" '{"ref":"b","target":{},"clauses":[{"relation":"left","anchors":["x"]}]}'
	refuses "2: key 'view' is not 'from' or 'facing'" '{"ref":"b","target":{},"clauses":[{"relation":"viewpoint"}]}'
	for _ in {1..140}; do deep="{\"clauses\":[{\"relation\":\"on\",\"anchors\":[$deep]}]}"; done
	refuses "2: key 'clauses' is more than 128 deep" "{\"ref\":\"b\",\"target\":{},\"clauses\":[{\"relation\":\"on\",\"anchors\":[$deep]}]}"
}

@test "the weights: a file cut short at any place, and one of another format" {
	local weights=$BATS_TEST_DIRNAME/../../formats/parser_default.safetensors size
	cp "$weights" w
	"$BIN/gs-check" w
	size=$(stat -c %s w)
	cp -r "$BATS_TEST_DIRNAME/../golden/bert" encoder
	echo '{"ref":"a","object":"x","text":"the wug"}' | "$BIN/text-encode" -q --model encoder -o text
	for at in 0 7 8 500 $((size / 2)) $((size - 1)); do
		head -c "$at" "$weights" >w
		run "$BIN/text-parse" --parser w -o out text
		[ "$status" = 3 ]
		[ ! -e out ]
	done
	says 3 "text-parse: text: format is 'refer.text', expected 'refer.parser'" "$BIN/text-parse" --parser text text
}
