#!/usr/bin/env bash
# Usage: [BIN=build/bin] [BERT=DIR] [DATA=DIR/desk] [ROOM=DIR/room SPLATS=room.ply] [KEEP=DIR] tests/bench/questions.sh SET
#
# Asks refer-ask the questions of tests/bench/questions/SET, conversations among them: of a scene of gs-synth (SCENE-SEED.jsonl), with
# DATA of the desk, and with ROOM of the room of pipelines/lift.md. They were written from the pictures and a table of the things' boxes,
# without knowledge of the program, with what a person would answer. Those of `looked-at` were read while the program was changed; of
# `kept-back` please read only the figures.
#
# Prints for each kind how many were answered as a person would: exactly the things, the number, yes or no, a colour, a length within the
# tolerance, that there is none, or which of two is meant; of `looked-at` also each that was not. KEEP as in said.sh.
# ASK is another refer-ask, for scenes that KEEP has lifted; with ALONE=1 no question is told what was said before it.
set -euo pipefail
export LC_ALL=C
here=$(cd "$(dirname "$0")" && pwd)
BIN=$(cd "${BIN:-build/bin}" && pwd)
BERT=${BERT:-${XDG_CACHE_HOME:-$HOME/.cache}/refersplat/encoder}
[ $# = 1 ] && [ -d "$here/questions/$1" ] || { sed -n 's/^# Usage: //p' "$0" >&2; exit 2; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
scenes=${KEEP:-$work}
. "$here/scenes.sh"

for file in "$here/questions/$1"/*.jsonl; do
	name=$(basename "$file" .jsonl)
	case $name in desk) [ -n "${DATA:-}" ] || continue ;; room) [ -n "${ROOM:-}" ] || continue ;; esac
	[ -n "${ASK:-}" ] || make_scene "$name"
	# a blank line before each conversation
	jq -r --arg alone "${ALONE:-}" '(if .after and $alone == "" then empty else "" end), .question' "$file" >"$work/questions"
	"${ASK:-$BIN/refer-ask}" -q --json --encoder "$BERT" "$scenes/$name" <"$work/questions" >"$work/replies" || [ $? = 1 ]
	jq -c --slurpfile replies "$work/replies" --slurpfile asked "$file" -n '
		def near($x; $off): . > $x * (1 - $off) and . < $x * (1 + $off);
		range($asked | length) as $i | $asked[$i] | .reply = $replies[$i] | .reply as $r | . + {right: (
			if .asks_back then $r.unsure or ($r.answered | not)
			elif .none then ($r.answered | not) or $r.yes == false
			elif has("yes") then $r.yes == .yes
			elif has("number") then $r.number == .number
			elif (.value | type) == "number" then .value as $x | .tolerance as $off |
				[(($r.value // "") / ", ")[0] // "" | scan("[0-9.]+") | tonumber] + [$r.distance | .gap?, .centres? | numbers] | any(near($x; $off))
			elif .value then [.value] + (.accept // []) | any(. as $word | $r.value // "" | contains($word))
			elif .kind == "where" then .things as $all | $r.things[0].name as $first | any($all[]; . == $first)
			else (.things | sort) == ([$r.things[].name] | sort) end)}' >>"$work/answers"
done
jq -rs 'def row: "\(map(select(.right)) | length)/\(length)"; (group_by(.kind)[] | "\(.[0].kind)\t\(row)"), "all\t\(row)"' "$work/answers"
[ "$1" != looked-at ] || jq -r 'select(.right | not) | "\(.question) | \(.answer) | \(.reply | "\(.kind): \(.value // .reason // "") \([.things[].name] | join(", "))")"' "$work/answers"
