#!/usr/bin/env bash
# How often a sentence that says only what a thing is for finds it. The objects of a made scene get other names, fourteen
# at a time, each with no sentence but its name; purposes.tsv has a name and a sentence a line. The constants of
# ask/purposes.h were fitted to these sentences. usage: tests/bench/purposes.sh [PARTS]; PARTS as refer-render --without
#	BIN=build/bin   the tools
#	BERT            folder of the language encoder
set -eu -o pipefail
BIN=${BIN:-build/bin} BERT=${BERT:-${XDG_CACHE_HOME:-$HOME/.cache}/refersplat/encoder}
list=$(dirname "$0")/purposes.tsv
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

"$BIN/gs-synth" -q --scene kitchen --seed 83 --objects 14 -o "$work/data"
"$BIN/gs-import" -q --cameras "$work/data/sparse/0" --test-views "$(cat "$work/data/test-views")" -o "$work/scene" "$work/data/point_cloud.ply"
"$BIN/gs-weigh" -q --packed --tolerance 0.05 --scale 0.5 -o "$work/weights" "$work/scene"
"$BIN/pseudomask-select" -q --scene "$work/scene" --weights "$work/weights" -o "$work/masks" "$work/data/candidates.jsonl"
jq -r .object "$work/masks" | sort -u >"$work/objects"
cut -f 1 "$list" | sort -u | shuf --random-source="$list" | split -l "$(wc -l <"$work/objects")" - "$work/names."

asked=0 right=0 refused=0
for names in "$work"/names.*; do
	head -n "$(wc -l <"$names")" "$work/objects" | paste - "$names" | jq -R 'split("\t") | {(.[0]): .[1]}' | jq -s add >"$work/called"
	jq -c --slurpfile to "$work/called" 'select($to[0][.object]) | .object = $to[0][.object]' "$work/masks" >"$work/named"
	jq -Rc '{ref: "s\(input_line_number)", object: ., text: ., split: "train"}' "$names" >"$work/said"
	"$BIN/text-encode" -q --model "$BERT" -o "$work/text" "$work/said"
	"$BIN/refer-lift" -q --names masks --scene "$work/scene" --weights "$work/weights" --text "$work/text" --masks "$work/named" -o "$work/model"
	awk -F '\t' 'NR == FNR { here[$1]; next } $1 in here' "$names" "$list" >"$work/asked"
	cut -f 2 "$work/asked" >"$work/questions"
	# 1: one of them has no answer
	"$BIN/refer-ask" -q --json ${1:+--without "$1"} --scene "$work/scene" --model "$work/model" --encoder "$BERT" "$work" \
		<"$work/questions" >"$work/replies" || [ $? = 1 ]
	cut -f 1 "$work/asked" | paste - "$work/replies" >"$work/answers"
	read -r a r n < <(jq -Rrs 'split("\n") | map(select(. != "") | split("\t") | {meant: .[0]} + (.[1:] | join("\t") | fromjson))
		| [length, (map(select(.answered and ([.things[].name] == [.meant]))) | length), (map(select(.answered | not)) | length)] | join(" ")' "$work/answers")
	asked=$((asked + a)) right=$((right + r)) refused=$((refused + n))
done
echo "$right of $asked right, $refused refused"
