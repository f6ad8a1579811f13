#!/usr/bin/env bash
# Usage: [BIN=build/bin] [BERT=DIR] tests/bench/parts.sh DIR...
#
# Asks refer-ask the sentences of unseen.jsonl of cells of pipelines/ablation.mk (target unseen) that are said from the usual viewpoint,
# with all parts of the choice and without each (--without). Prints how many are answered with exactly the meant objects: of those that
# mean one thing, nothing that is there, and several.
set -euo pipefail
export LC_ALL=C
BIN=${BIN:-build/bin} BERT=${BERT:-${XDG_CACHE_HOME:-$HOME/.cache}/refersplat/encoder}
[ $# -gt 0 ] || { sed -n 's/^# Usage: //p' "$0" >&2; exit 2; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

printf 'without\tone thing\tnothing there\tseveral\n'
for part in '' words names knowledge colours surfaces sizes relations except purpose sentence; do
	for dir; do
		jq -c 'select(has("view") or has("views") | not)' "$dir/data/unseen.jsonl" >"$work/asked"
		jq -r .text "$work/asked" >"$work/questions"
		# 1: one of them has no answer
		"$BIN/refer-ask" -q --json ${part:+--without "$part"} --encoder "$BERT" --scene "$dir/scene" \
			--model "$dir/lifted/full.safetensors" "$dir" <"$work/questions" >"$work/replies" || [ $? = 1 ]
		jq -c --slurpfile replies "$work/replies" --slurpfile asked "$work/asked" -n '
			range($asked | length) as $i | ($asked[$i] | .objects // [.object] | sort) as $meant
			| ($replies[$i] | if .answered then [.things[].name] | sort else [] end) as $got
			| {meant: ($meant | length), right: ($got == $meant)}'
	done >"$work/answers"
	jq -rs --arg part "$part" 'def n(f): map(select(.meant | f)) | "\(map(select(.right)) | length)/\(length)";
		[$part, n(. == 1), n(. == 0), n(. > 1)] | join("\t")' "$work/answers"
done
