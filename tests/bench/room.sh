#!/usr/bin/env bash
# Usage: DATA=DIR/room SPLATS=room.ply [BIN=build/bin] [BERT=DIR] [KEEP=DIR] tests/bench/room.sh [SENTENCES]
#
# The room of pipelines/lift.md, in its layout (sparse/0, images, truth.jsonl, sentences.jsonl, dev.jsonl): lifts the true masks with
# their names alone and with training sentences, and asks dev.jsonl or SENTENCES. Beside this are sentences of writers who saw photographs
# alone: room-looked-at.jsonl was read, of room.jsonl every second one; of those of room-kept-back.jsonl please read only the figures.
# Prints what is right by kind (miou-score --answers). KEEP
# keeps the scene and its weights for the next run, which lifts again.
set -euo pipefail
export LC_ALL=C
here=$(cd "$(dirname "$0")/../.." && pwd)
BIN=$(cd "${BIN:-build/bin}" && pwd)
BERT=${BERT:-${XDG_CACHE_HOME:-$HOME/.cache}/refersplat/encoder}
[ -d "${DATA:-}" ] && [ -f "${SPLATS:-}" ] || { sed -n 's/^# Usage: //p' "$0" >&2; exit 2; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
keep=${KEEP:-$work}
jq -c 'if .objects or .object then . else . + {objects: []} end' "${1:-$DATA/dev.jsonl}" >"$work/dev.jsonl"
"$BIN/text-encode" -q --model "$BERT" -o "$work/dev.safetensors" "$work/dev.jsonl"

# lift WAY [VARIABLE]: KEEP/WAY
lift() {
	rm -f "$keep/$1/lifted/model.safetensors" # what makes it may have changed
	make -s -f "$here/pipelines/lift.mk" BIN="$BIN" BERT="$BERT" SCENE="$keep/$1" SPLATS="$SPLATS" CAMERAS="$DATA/sparse/0" IMAGES="$DATA/images" \
		MASKS="$DATA/truth.jsonl" "${@:2}" "$keep/$1/lifted/model.safetensors"
}

lift names
lift sentences SENTENCES="$DATA/sentences.jsonl"
for way in names sentences; do
	masks=$work/$way.jsonl
	"$BIN/refer-render" -q --split all --views "$(jq -rs 'map(.view) | unique | join(",")' "$DATA/truth.jsonl")" --scene "$keep/$way/scene" --text "$work/dev.safetensors" \
		--model "$keep/$way/lifted/model.safetensors" -o "$masks"
	echo "$way:"
	"$BIN/miou-score" --answers --sentences "$work/dev.jsonl" --truth "$DATA/truth.jsonl" --predicted-views "$masks"
done
