#!/usr/bin/env bash
# Usage: [BIN=build/bin] [BERT=DIR] [DATA=DIR/desk] [KEEP=DIR] tests/bench/said.sh SET
#
# Asks the sentences of tests/bench/said/SET: of scenes of gs-synth that are made and lifted here (SCENE-SEED.jsonl) and, with
# DATA, of a desk in the layout of pipelines/desk.mk (desk.jsonl). They were written from the pictures and a table of the
# objects' places, without knowledge of the program. Those of `looked-at` and `later` its authors have read and worked on; those of
# `kept-back` nobody has who works on the program: please keep it so, and read only the figures.
#
# Prints, for each file and in all, how many were answered with exactly the meant objects: of those that mean one thing (plain and
# chatty rewordings, new ones), several, and nothing that is there. At last what was believed of the answers to those that mean one thing,
# and how many that are refused --always guesses rightly.
#
# With KEEP the scenes, their weights and their selected masks stay in DIR for the next run, which lifts them again.
set -euo pipefail
export LC_ALL=C
here=$(cd "$(dirname "$0")" && pwd)
BIN=$(cd "${BIN:-build/bin}" && pwd)
BERT=${BERT:-${XDG_CACHE_HOME:-$HOME/.cache}/refersplat/encoder}
[ $# = 1 ] && [ -d "$here/said/$1" ] || { sed -n 's/^# Usage: //p' "$0" >&2; exit 2; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
scenes=${KEEP:-$work}

. "$here/scenes.sh"

# count FILE...: a row of right/asked from records with `got`
count() {
	jq -rs 'def n(f): map(select(f)) | "\(map(select(.right)) | length)/\(length)";
		def one: .objects | length == 1;
		[n(one and .style == "plain"), n(one and .style == "chatty"), n(one and .style == "new"), n(one),
		 n(.objects | length > 1), n(.objects == [])] | join("\t")' "$@"
}

printf 'file\tplain\tchatty\tnew\tone thing\tseveral\tnothing there\n'
for file in "$here/said/$1"/*.jsonl; do
	name=$(basename "$file" .jsonl)
	[ "$name" != desk ] || [ -n "${DATA:-}" ] || continue
	make_scene "$name"
	jq -r '"", .text' "$file" >"$work/questions"
	# 1 or 5: one of them has no answer, or a guess
	"$BIN/refer-ask" -q --json --always --encoder "$BERT" "$scenes/$name" <"$work/questions" >"$work/replies" || grep -qx '[15]' <<<$?
	jq -c --slurpfile replies "$work/replies" --slurpfile asked "$file" -n '
		range($asked | length) as $i | $asked[$i] + ($replies[$i] | {guess: (if .guess then [.things[].name] else null end),
			got: (if .answered and (.guess | not) then [.things[].name] | sort else [] end), belief: .things[0].probability})
		| .right = (.got == (.objects | sort))' >"$work/$name.answers"
	printf '%s\t%s\n' "$name" "$(count "$work/$name.answers")"
	[ -n "${KEEP:-}" ] || rm -rf "${work:?}/$name" "$work/raw.$name"
done
printf 'all\t%s\n' "$(count "$work"/*.answers)"
jq -rs 'map(select((.objects | length == 1) and .got != [])) | def percent: . * 1000 | round / 10;
	"of one thing: \(length) answered, mean belief \(map(.belief) | add / length | percent)%, right \((map(select(.right)) | length) / length | percent)%"' \
	"$work"/*.answers
jq -rs 'map(select((.objects | length == 1) and .guess)) | "of one thing: \(length) guessed by --always, right \(map(select(.guess == .objects)) | length)"' "$work"/*.answers
