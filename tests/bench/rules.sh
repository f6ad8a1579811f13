#!/usr/bin/env bash
# Usage: [BIN=build/bin] [BERT=DIR] tests/bench/rules.sh
#        DATA=DIR/desk ROOM=DIR/room SPLATS=room.ply KEEP=DIR tests/bench/rules.sh questions
#
# Leaves out each rule of language (libcommon/lang/rules.def) and prints how many parses it changes of the sentences of
# tests/bench/said: of those that nobody read who works on the program, of later ones, and of those that were looked at; and of
# the marked sentences kept for testing. With `questions` how many of the questions of questions.sh, kept back and looked at, are answered
# wrongly that were not, without each kind of rows of libcommon/lang/question_kinds.tsv, and without what was said before.
set -euo pipefail
export LC_ALL=C
here=$(cd "$(dirname "$0")/../.." && pwd)
BIN=${BIN:-${BUILD:-$here/build}/bin} BERT=${BERT:-${XDG_CACHE_HOME:-$HOME/.cache}/refersplat/encoder}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# right SET: how many
right() { "$here/tests/bench/questions.sh" "$1" 2>/dev/null | sed -n 's,^all\t\([0-9]*\)/.*,\1,p'; }

if [ "${1:-}" = questions ]; then
	build=$work/build inc=$work/build/tables/lang/question_kinds.inc
	all=$(right kept-back) && looked=$(right looked-at)
	cp -a "${BUILD:-$here/build}" "$build"
	cp "$inc" "$work/all.inc"
	printf 'rows\tkept back\tlooked at\n'
	for kind in $(cut -d'"' -f2 "$inc" | sort -u) conversation; do
		grep -v "{\"$kind\"" "$work/all.inc" >"$inc"
		make -s -C "$here" BUILD="$build" "$build/bin/refer-ask" >/dev/null
		export ASK=$build/bin/refer-ask ALONE=
		[ $kind != conversation ] || ALONE=1
		printf '%s\t%d\t%d\n' $kind $((all - $(right kept-back))) $((looked - $(right looked-at)))
	done
	exit
fi

sets="kept-back later looked-at test"
for set in $sets; do
	if [ "$set" = test ]; then
		cat "$here"/pipelines/marked/test/*.txt | "$BIN/parse-train" --sentences -o "$work/$set.jsonl" -
	else
		cat "$here/tests/bench/said/$set"/*.jsonl | jq -c '{ref: "\(input_line_number)", object: "?", text, split: "test"}' >"$work/$set.jsonl"
	fi
	"$BIN/text-encode" -q --model "$BERT" -o "$work/$set" "$work/$set.jsonl"
	"$BIN/text-parse" -q -o "$work/$set.all" "$work/$set"
done
printf 'rule\tkept back\tlater\tlooked at\ttest\n'
for rule in $(sed -n 's/^RULE(\([a-z_]*\),.*/\1/p' "$here/libcommon/lang/rules.def"); do
	printf '%s' "$rule"
	for set in $sets; do
		printf "\t%d" "$("$BIN/text-parse" -q --without "$rule" "$work/$set" | diff "$work/$set.all" - | grep -c "^<" || true)"
	done
	echo
done
