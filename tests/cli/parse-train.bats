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

@test "networks that learn from readings at once: the same bytes for any number of threads" {
	"$BIN/parse-train" --write 30 | "$BIN/text-encode" -q --model encoder -o examples
	"$BIN/parse-train" --write 400 --seed 5 >sentences
	"$BIN/text-encode" -q --model encoder -o text sentences
	jq -c '{ref,target:"cup",room:"a",clauses:[{relation:"near",anchors:[{noun:"box"}]}]}' sentences >readings
	for n in 1 2 7; do
		"$BIN/parse-train" --threads "$n" --epochs 1 --rounds 1 --readings readings --readings-text text examples -o "weights$n"
	done
	cmp weights1 weights2
	cmp weights1 weights7
}

@test "refuses sentences that it did not write" {
	encode "the wug on the dax"
	says 3 "parse-train: text: ref 'r0': not what parse-train --write makes with --seed 1" "$BIN/parse-train" text -o weights
	[ ! -e weights ]
}

@test "marked sentences: their texts, their parses, and weights that learnt from them" {
	"$BIN/parse-train" --write 60 | "$BIN/text-encode" -q --model encoder -o examples
	printf '%s\n' '# two of them' 'the wug/T on/P1:on the dax/A1, not the red/a@X fep/X' '' 'both daxes/T' >marked
	"$BIN/parse-train" --marked marked --sentences -o sentences
	[ "$(jq -r '.ref + " " + .text' sentences)" = $'m0 the wug on the dax, not the red fep\nm1 both daxes' ]
	"$BIN/gs-check" sentences
	"$BIN/text-encode" -q --model encoder -o text sentences
	"$BIN/parse-train" --marked marked --marked-text text --parses -o parses
	"$BIN/gs-check" parses
	[ "$(jq -c '[.ref, .target.noun, .clauses[]?.anchors[0].noun, .except[]?.words[0]]' parses)" = $'["m0","wug","dax","red"]\n["m1","daxes"]' ]
	"$BIN/parse-train" --epochs 1 --members 1 examples -o without
	for n in 1 7; do
		"$BIN/parse-train" --threads "$n" --epochs 1 --members 1 --marked marked --marked-text text examples -o "weights$n"
	done
	cmp weights1 weights7
	not cmp -s without weights1
	# a remark, a blank line or the end of the last line changes nothing
	printf '%s\n\n%s' 'the wug/T on/P1:on the dax/A1, not the red/a@X fep/X' 'both daxes/T' >bare
	"$BIN/parse-train" --epochs 1 --members 1 --marked bare --marked-text text examples -o same
	cmp weights1 same
}

@test "marked sentences: what is wrong is said, with its line" {
	"$BIN/parse-train" --write 20 | "$BIN/text-encode" -q --model encoder -o examples
	printf '%s\n' '# none' 'the wug/T' 'the dax/Q' >marked
	says 3 "parse-train: marked:3: '/Q' is no mark" "$BIN/parse-train" --marked marked --sentences -o out
	[ ! -e out ]
	printf '%s\n' 'the wug/T' 'near/P1:near@2 dax/A1 by/P2:near@1 fep/A2' >marked
	says 3 "parse-train: marked:2: 'near' hangs on itself, or on what has no mark" "$BIN/parse-train" --marked marked --parses -o out
	printf '%s\n' 'the wug/T' 'the dax/T' >marked
	encode "the wug" "the fep"
	says 3 "parse-train: marked:2: not the sentence that was encoded at its place" \
		"$BIN/parse-train" --marked marked --marked-text text examples -o out
	encode "the wug"
	says 3 "parse-train: marked:2: not the sentence that was encoded at its place" \
		"$BIN/parse-train" --marked marked --marked-text text examples -o out
	encode "the wug" "the dax" "the fep"
	says 3 "parse-train: text: ref 'r2': not in marked" "$BIN/parse-train" --marked marked --marked-text text examples -o out
	run "$BIN/parse-train" --marked marked examples -o out
	[ "$status" = 2 ]
	[ "${lines[0]}" = "parse-train: --marked and --marked-text go together" ]
	run "$BIN/parse-train" --sentences examples -o out
	[ "$status" = 2 ]
	[ "${lines[0]}" = "parse-train: --sentences and --parses go with --marked alone" ]
	[ ! -e out ]
}
