#!/usr/bin/env bats
# formats/records/parses.md, and each rule of formats/encoders/parser_weights.md broken once.

setup() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	load files
	cd "$BATS_TEST_TMPDIR"
}

@test "what a thing is one of" {
	echo 'Of the wug/M, the dax/M2 and the fep/M3 on/P1:on@M3 the gorp/A1, bring the tallest/P2:taller one/T.' >marks
	"$BIN/parse-train" --sentences -o sentences marks
	"$BIN/text-encode" -q --model "$BATS_TEST_DIRNAME/../golden/bert" -o text sentences
	"$BIN/parse-train" --parses --text text -o x marks
	[ "$(jq -c '[.group] + [.among[].noun]' x)" = '[3,"wug","dax","fep"]' ]
}

@test "the weights: a file cut short at any place, and one of another format" {
	local weights=$BATS_TEST_DIRNAME/../../formats/encoders/parser_default.safetensors size
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
