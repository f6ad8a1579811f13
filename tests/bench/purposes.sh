#!/usr/bin/env bash
# How often a sentence that says only what a thing is for finds it. The objects of a made scene get other names, fourteen
# at a time, each with no sentence but its name; a list has a name and a sentence a line. Then the sentences of the next
# fourteen are asked: how many are refused (some are of use for what is here too). usage: tests/bench/purposes.sh [PARTS]; PARTS as
# refer-render --without
#	LIST=purposes   the list, tests/bench/LIST.tsv: purposes, situations (both were looked at, and constants of ask/usage.h
#			fitted to them) or situations-kept, which nobody read
#	BIN=build/bin   the tools
#	BERT            folder of the language encoder
set -eu -o pipefail
BIN=${BIN:-build/bin} BERT=${BERT:-${XDG_CACHE_HOME:-$HOME/.cache}/refersplat/encoder}
list=$(dirname "$0")/${LIST:-purposes}.tsv
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

"$BIN/gs-synth" -q --scene kitchen --seed 83 --objects 14 -o "$work/data"
"$BIN/gs-import" -q --cameras "$work/data/sparse/0" --test-views "$(cat "$work/data/test-views")" -o "$work/scene" "$work/data/point_cloud.ply"
"$BIN/gs-weigh" -q --packed --tolerance 0.05 --scale 0.5 -o "$work/weights" "$work/scene"
"$BIN/pseudomask-select" -q --scene "$work/scene" --weights "$work/weights" -o "$work/masks" "$work/data/candidates.jsonl"
jq -r .object "$work/masks" | sort -u >"$work/objects"
cut -f 1 "$list" | sort -u | shuf --random-source="$list" | split -l "$(wc -l <"$work/objects")" - "$work/names."

# ask SENTENCES: a name and a reply a line
ask() {
	cut -f 2 "$1" >"$work/questions"
	# 1: one of them has no answer
	"$BIN/refer-ask" -q --json ${without:+--without "$without"} --scene "$work/scene" --model "$work/model" --encoder "$BERT" "$work" \
		<"$work/questions" >"$work/replies" || [ $? = 1 ]
	cut -f 1 "$1" | paste - "$work/replies"
}

# count: of a name and a reply a line, how many there are, are answered with the name's thing, and are refused
count() {
	jq -Rrs 'split("\n") | map(select(. != "") | split("\t") | {meant: .[0]} + (.[1:] | join("\t") | fromjson))
		| "\(length) \(map(select(.answered and ([.things[].name] == [.meant]))) | length) \(map(select(.answered | not)) | length)"'
}

without=${1:-} batches=("$work"/names.*)
for i in "${!batches[@]}"; do
	names=${batches[i]} others=${batches[(i + 1) % ${#batches[@]}]}
	head -n "$(wc -l <"$names")" "$work/objects" | paste - "$names" | jq -R 'split("\t") | {(.[0]): .[1]}' | jq -s add >"$work/called"
	jq -c --slurpfile to "$work/called" 'select($to[0][.object]) | .object = $to[0][.object]' "$work/masks" >"$work/named"
	jq -Rc '{ref: "s\(input_line_number)", object: ., text: ., split: "train"}' "$names" >"$work/said"
	"$BIN/text-encode" -q --model "$BERT" -o "$work/text" "$work/said"
	"$BIN/refer-lift" -q --names masks --scene "$work/scene" --weights "$work/weights" --text "$work/text" --masks "$work/named" -o "$work/model"
	awk -F '\t' 'NR == FNR { here[$1]; next } $1 in here' "$names" "$list" >"$work/here"
	awk -F '\t' 'NR == FNR { here[$1]; next } $1 in here' "$others" "$list" >"$work/elsewhere"
	ask "$work/here" >>"$work/answers"
	ask "$work/elsewhere" >>"$work/absent"
done
read -r asked right refused < <(count <"$work/answers")
echo "$right of $asked right, $refused refused"
read -r asked _ refused < <(count <"$work/absent")
echo "not here: $refused of $asked refused"
