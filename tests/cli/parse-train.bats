#!/usr/bin/env bats
# parse-train on the tiny encoder of tests/golden/bert, whose vectors mean little: what any learning must keep.

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

# Fails where the command succeeds; a plain ! would let the test go on.
not() { ! "$@"; }

@test "the same sentences for a seed, others for another; test wordings have other nouns" {
	"$BIN/parse-train" --write 50 -o a
	"$BIN/parse-train" --write 50 -o b
	"$BIN/parse-train" --write 50 --seed 2 -o c
	"$BIN/parse-train" --write 50 --test -o d
	cmp a b
	not cmp -s a c
	[ "$(wc -l <d)" = 50 ]
	jq -e '.split == "test"' d >/dev/null
}

@test "weights that text-parse and gs-check take, the same bytes for any number of threads" {
	"$BIN/parse-train" --write 60 | "$BIN/text-encode" -q --model encoder -o examples
	for n in 1 2 7; do
		"$BIN/parse-train" --threads "$n" --epochs 2 examples -o "weights$n"
	done
	cmp weights1 weights2
	cmp weights1 weights7
	"$BIN/gs-check" weights1
	# two members, unless one is wanted: the first is the same
	"$BIN/parse-train" --members 1 --epochs 2 examples -o single
	[ "$(head -c 10000 weights1 | grep -a -c '"1.closed"')" = 1 ]
	[ "$(head -c 10000 single | grep -a -c '"1.closed"')" = 0 ]
	crc() { head -c 10000 "$1" | grep -a -o '"crc32.closed":"[0-9a-f]*"'; }
	[ "$(crc weights1)" = "$(crc single)" ]
	"$BIN/text-parse" --parser weights1 examples >out
	[ "$(wc -l <out)" = 60 ]
	"$BIN/gs-check" out
}

@test "readings and folds" {
	"$BIN/parse-train" --write 60 | "$BIN/text-encode" -q --model encoder -o examples
	encode "the wug on the dax" "the dax left of the fep"
	printf '%s\n' '{"ref":"r0","target":"wug","room":"a","clauses":[{"relation":"above","anchors":[{"noun":"dax"}]}]}' \
		'{"ref":"r1","target":"dax","room":"b","clauses":[{"relation":"left","anchors":[{"noun":"fep"}]}]}' >readings
	"$BIN/parse-train" --epochs 1 --readings readings --readings-text text examples -o weights
	"$BIN/gs-check" weights
	"$BIN/parse-train" --epochs 1 --readings readings --readings-text text --folds 2 examples -o out
	[ "$(jq -r .ref out | sort | tr '\n' ' ')" = 'r0 r1 ' ]
	run "$BIN/parse-train" --folds 2 examples
	[ "$status" = 2 ]
	[ "${lines[0]}" = "parse-train: --folds needs --readings" ]
}

@test "refuses sentences that it did not write" {
	encode "the wug on the dax"
	says 3 "parse-train: text: ref 'r0': not what parse-train --write makes with --seed 1" "$BIN/parse-train" text -o weights
	[ ! -e weights ]
}
