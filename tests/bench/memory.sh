#!/usr/bin/env bash
# Peak memory and time of each tool against the Gaussians of the scene: BUILD/bench/memory.jsonl.
. tests/bench/common.sh
results=$out/memory.jsonl sizes="20000 50000 100000 200000"
[ -z "$FULL" ] || sizes="$sizes 500000"
tools="gs-synth gs-import gs-weigh text-encode pseudomask-select refer-train refer-render miou-score"

# put TOOL GAUSSIANS LOG
put() {
	printf '{"bench":"memory","tool":"%s","gaussians":%d,"seconds":%s,"mib":%s}\n' "$1" "$2" "$(seconds "$3")" "$(mebibytes "$3")" >>"$results"
}

# All tools in turn on a synthetic scene of 5 views.
measure() {
	local n=$1 dir=$out/scenes/memory-$1 tool
	rm -rf "$dir"
	synthetic "$dir" "$n" 320x240 5 1 || return
	logged "$dir/log/gs-weigh" gs-weigh -o "$dir/weights" "$dir/scene" &&
		logged "$dir/log/refer-train" refer-train --scene "$dir/scene" --weights "$dir/weights" --text "$dir/text.safetensors" \
			--masks "$dir/masks.jsonl" --checkpoint 0 --iterations 10 -o "$dir/model.safetensors" &&
		logged "$dir/log/refer-render" refer-render --scene "$dir/scene" --text "$dir/text.safetensors" \
			--model "$dir/model.safetensors" -o "$dir/predictions.jsonl" &&
		logged "$dir/log/miou-score" miou-score --truth "$dir/data/truth.jsonl" --predicted-views "$dir/predictions.jsonl" || return
	for tool in $tools; do put "$tool" "$n" "$dir/log/$tool"; done
	rm -rf "$dir"
}

heading "memory: each tool, synthetic scenes of 5 views of 320x240"
need_encoder
: >"$results"
for n in $sizes; do measure "$n" || die "a tool failed at $n Gaussians"; done
jq -rs --arg tools "$tools" '($tools | split(" ")) as $tools | (map(.gaussians) | unique) as $sizes | . as $all
	| (["peak MiB at Gaussians:"] + $sizes + ["bytes a Gaussian"] | @tsv), ($tools[] as $t | [$all[] | select(.tool == $t)] | sort_by(.gaussians)
	| [$t] + map(.mib) + [((.[-1].mib - .[0].mib) * 1048576 / (.[-1].gaussians - .[0].gaussians) | round)] | @tsv)' "$results" | table
echo "bytes a Gaussian: between the smallest and the largest scene. refer-train holds the weights of its views, as far as --memory has room."
{
	plot_head "Peak memory of the tools" "synthetic scenes, 4 training views of 320x240 and 1 test view, 40 sentences" "Gaussians of the scene" \
		"peak memory, MiB" xlog ylog
	jq -rs --arg tools "$tools" '($tools | split(" ")[]) as $t | .[] | select(.tool == $t) | [.tool, .gaussians, .mib] | @tsv' "$results"
} | plot memory
