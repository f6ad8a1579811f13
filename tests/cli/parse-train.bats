#!/usr/bin/env bats
# parse-train on the tiny encoder of tests/golden/bert, whose vectors mean little: what any learning must keep.

setup() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	load ../format/files
	cd "$BATS_TEST_TMPDIR"
	cp -r "$BATS_TEST_DIRNAME/../golden/bert" encoder
}

MARKS=$'the wug/T on/P1:on the dax/A1, not the red/a@X fep/X\nboth daxes/T\nthe small/P1:smaller mug/T on/P2:on the plate/A2\nSee the shelf/A1, near/P1:near it the radiator/T'

# encode MARKED: MARKED.text, its sentences encoded
encode() {
	"$BIN/parse-train" --sentences "$1" | "$BIN/text-encode" -q --model encoder -o "$1.text"
}

# Fails where the command succeeds; a plain ! would let the test go on.
not() { ! "$@"; }

@test "weights that text-parse and gs-check take, the same bytes for any number of threads, others for another seed" {
	echo "$MARKS" >marked
	encode marked
	for n in 1 2 7; do
		"$BIN/parse-train" --threads "$n" --epochs 2 --text marked.text marked -o "weights$n"
	done
	cmp weights1 weights2
	cmp weights1 weights7
	"$BIN/parse-train" --seed 2 --epochs 2 --text marked.text marked -o other
	not cmp -s weights1 other
	"$BIN/gs-check" weights1
	# two members, unless one is wanted: the first is the same
	"$BIN/parse-train" --members 1 --epochs 2 --text marked.text marked -o single
	[ "$(head -c 10000 weights1 | grep -a -c '"1.closed"')" = 1 ]
	[ "$(head -c 10000 single | grep -a -c '"1.closed"')" = 0 ]
	crc() { head -c 10000 "$1" | grep -a -o '"crc32.closed":"[0-9a-f]*"'; }
	[ "$(crc weights1)" = "$(crc single)" ]
	"$BIN/text-parse" --parser weights1 marked.text >out
	[ "$(wc -l <out)" = 4 ]
}

@test "what is learnt is what the marks say" {
	printf '%s\n' 'the wug/T on/P1:on the dax/A1' >marked
	encode marked
	"$BIN/parse-train" --members 1 --epochs 500 --text marked.text marked -o weights
	"$BIN/parse-train" --parses --text marked.text marked >gold
	"$BIN/text-parse" --parser weights marked.text | jq -c 'del(.confidence)' | diff - <(jq -c 'del(.confidence)' gold)
	printf '%s\n' 'the wug/A1 on/P1:supports the dax/T' >turned
	"$BIN/parse-train" --members 1 --epochs 500 --text marked.text turned -o weights
	[ "$("$BIN/text-parse" --parser weights marked.text | jq -c '[.target.noun, .clauses[0].anchors[0].noun]')" = '["dax","wug"]' ]
}

@test "the marked sentences' texts and their parses" {
	printf '%s\n' '# two of them' 'the wug/T on/P1:on the dax/A1, not the red/a@X fep/X' '' 'both daxes/T' >marked
	"$BIN/parse-train" --sentences marked -o sentences
	[ "$(jq -r '.ref + " " + .text' sentences)" = $'m0 the wug on the dax, not the red fep\nm1 both daxes' ]
	"$BIN/gs-check" sentences
	encode marked
	"$BIN/parse-train" --parses --text marked.text marked -o parses
	[ "$(jq -c '[.ref, .target.noun, .clauses[]?.anchors[0].noun, .except[]?.words[0]]' parses)" = $'["m0","wug","dax","red"]\n["m1","daxes"]' ]
	"$BIN/parse-train" --epochs 1 --members 1 --text marked.text marked -o weights
	# a remark, a blank line or the end of the last line changes nothing
	printf '%s\n\n%s' 'the wug/T on/P1:on the dax/A1, not the red/a@X fep/X' 'both daxes/T' |
		"$BIN/parse-train" --epochs 1 --members 1 --text marked.text -o same
	cmp weights same
}

@test "what is wrong is said, with its line" {
	printf '%s\n' '# none' 'the wug/T' 'the dax/Q' >marked
	says 3 "parse-train: marked:3: '/Q' is no mark" "$BIN/parse-train" --sentences marked -o out
	[ ! -e out ]
	printf '%s\n' 'the wug/T' 'near/P1:near@2 dax/A1 by/P2:near@1 fep/A2' >marked
	says 3 "parse-train: marked:2: 'near' hangs on itself, or on what has no mark" "$BIN/parse-train" --parses marked -o out
	printf '%s\n' 'the wug/T' 'the dax/T' >marked
	printf '%s\n' 'the wug/T' 'the fep/T' >others
	encode others
	says 3 "parse-train: marked:2: not the sentence that was encoded at its place" \
		"$BIN/parse-train" --text others.text marked -o out
	printf '%s\n' 'the wug/T' >others
	encode others
	says 3 "parse-train: marked:2: not the sentence that was encoded at its place" \
		"$BIN/parse-train" --text others.text marked -o out
	printf '%s\n' 'the wug/T' 'the dax/T' 'the fep/T' >others
	encode others
	says 3 "parse-train: others.text: ref 'm2': not in marked" "$BIN/parse-train" --text others.text marked -o out
	run "$BIN/parse-train" marked -o out
	[ "$status" = 2 ]
	[ "${lines[0]}" = "parse-train: --text is needed to learn" ]
	run "$BIN/parse-train" --sentences --parses marked -o out
	[ "$status" = 2 ]
	[ "${lines[0]}" = "parse-train: --sentences and --parses exclude each other" ]
	run "$BIN/parse-train" --sentences --text others.text marked -o out
	[ "$status" = 2 ]
	[ "${lines[0]}" = "parse-train: --sentences needs no --text" ]
	[ ! -e out ]
}
