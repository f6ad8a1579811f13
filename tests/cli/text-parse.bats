#!/usr/bin/env bats
# text-parse on the tiny encoder of tests/golden/bert: its vectors mean little, so that what is
# held here is what any weights must do, and what the grammar alone does.

setup() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	load ../format/files
	cd "$BATS_TEST_TMPDIR"
	cp -r "$BATS_TEST_DIRNAME/../golden/bert" encoder
}

# encode TEXT...: text.safetensors of sentences r0, r1 ...
encode() {
	local i=0 text
	for text; do
		jq -cn --arg ref "r$i" --arg text "$text" '{$ref,object:"x",$text}'
		i=$((i + 1))
	done | "$BIN/text-encode" -q --model encoder -o text
}

# grammar TEXT FILTER: what jq's filter says of the parse of one sentence.
grammar() {
	encode "$1"
	"$BIN/text-parse" --method grammar text | jq -c "$2"
}

# Fails where the command succeeds; a plain ! would let the test go on.
not() { ! "$@"; }

@test "one parse a sentence, in their order, with their names" {
	encode "the red wug" "the dax on the wug" "" "?!"
	"$BIN/text-parse" -q text >out
	[ "$(jq -r .ref out | tr '\n' ' ')" = 'r0 r1 r2 r3 ' ]
	[ "$(jq -s 'map(.text) | @json' out)" = "$(jq -n '["the red wug","the dax on the wug","","?!"] | @json')" ]
}

@test "- is stdin and stdout, -o a file" {
	encode "the red wug"
	"$BIN/text-parse" -q text >a
	"$BIN/text-parse" -q - <text >b
	"$BIN/text-parse" -q -o c text
	"$BIN/text-parse" -q -o - text >d
	cmp a b
	cmp a c
	cmp a d
}

@test "vectors of another encoder: by grammar alone, and it says so" {
	encode "the wug on the dax"
	"$BIN/text-parse" text >a 2>err
	grep -qx 'text-parse: warning: text: of another encoder than the parser.s weights: by grammar alone' err
	"$BIN/text-parse" --method grammar text >b 2>err
	[ ! -s err ]
	cmp a b
	[ "$("$BIN/text-parse" -q text 2>&1 >/dev/null)" = "" ]
}

@test "words without a middle layer: by grammar alone, and it says so" {
	jq -cn '{ref:"r",object:"x",text:"the wug on the dax"}' | "$BIN/text-encode" -q --words static --model encoder -o text
	"$BIN/text-parse" text >a 2>err
	grep -qx "text-parse: warning: text: has no tensor 'middle': by grammar alone" err
	"$BIN/text-parse" --method grammar text | cmp - a
}

@test "weights of an older version are refused, as they are of another network" {
	encode "the wug on the dax"
	sed 's/"version":"7"/"version":"5"/' "$BATS_TEST_DIRNAME/../../formats/encoders/parser_default.safetensors" >old
	says 3 'text-parse: old: refer.parser version 5 is older than this program reads (7)' "$BIN/text-parse" --parser old text
}

@test "spans are characters, not bytes" {
	[ "$(grammar 'die kühle Tasse on the wug' '.clauses[0].anchors[0].span')" = '[23,26]' ]
	[ "$(grammar 'die kuhle Tasse on the wug' '.clauses[0].anchors[0].span')" = '[23,26]' ]
}

@test "nesting, negation, counts, groups, ordinals and what is left out, by grammar" {
	[ "$(grammar 'the wug on the dax left of the fep' '.clauses[0].anchors[0].clauses[0].anchors[0].noun')" = '"fep"' ]
	[ "$(grammar 'the wug that is not on the dax' '.clauses[0] | [.relation,.contact,.negated]')" = '["above",true,true]' ]
	[ "$(grammar 'all the wugs' .count)" = '"all"' ]
	[ "$(grammar 'the three wugs' .count)" = 3 ]
	[ "$(grammar 'two of the four wugs' .count)" = 2 ]
	[ "$(grammar 'the wugs beside them' .count)" = '"several"' ]
	[ "$(grammar 'the second wug from the left' .ordinal)" = '{"k":2,"from":"left"}' ]
	[ "$(grammar 'all the wugs except the dax' '.except[0].noun')" = '"dax"' ]
	[ "$(grammar 'the largest wug' '.clauses[0] | [.relation,.degree]')" = '["larger","most"]' ]
	[ "$(grammar 'when facing the dax, the wug on the left' '.clauses[] | select(.relation == "viewpoint") | .anchors[0].noun')" = '"dax"' ]
}

@test "--without leaves out a rule" {
	encode 'the empty wug'
	"$BIN/text-parse" --method grammar text | grep -q '"negated":true'
	not grep -q negated <("$BIN/text-parse" --method grammar --without empty,isnt text)
	run "$BIN/text-parse" --without empty,full text
	[ "$status" -eq 2 ]
	[ "${lines[0]}" = "text-parse: --without: 'full' is no rule" ]
}

@test "slips of spelling are mended, other words left" {
	[ "$(grammar 'the wug behnid teh dax' '.clauses[0].relation')" = '"behind"' ]
	[ "$(grammar 'the wug that isnt on the dax' '.clauses[0].negated')" = true ]
}

@test "a sentence of any length and any UTF-8 is taken" {
	local long
	long=$(printf 'the wug on %.0s' {1..3000})
	encode "$long" "$(printf '\u732b on the \U0001F600 box')" "$(printf '(%.0s' {1..500})"
	"$BIN/text-parse" -q text >out
	[ "$(wc -l <out)" = 3 ]
}
