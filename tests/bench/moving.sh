#!/usr/bin/env bash
# A scene of many frames beside the same at rest, from the import to masks of all views: processor seconds of each step and their sums,
# BUILD/bench/moving.jsonl. Masks of the true objects are lifted, and every view is drawn for every sentence that speaks of no motion.
. tests/bench/common.sh
results=$out/moving.jsonl frames=100 gaussians=100000
need_encoder

# step NAME LOG TOOL ARGUMENT...: runs a tool, and writes what it took.
step() {
	local name=$1 scene=$2 begin end
	shift 2
	begin=$(cut -d' ' -f16,17 /proc/$$/stat)
	logged "$out/log/moving.$scene.$1" "$@" || die "$1 failed"
	end=$(cut -d' ' -f16,17 /proc/$$/stat)
	awk -v name="$name" -v scene="$scene" -v begin="$begin" -v end="$end" -v hertz="$(getconf CLK_TCK)" -v mib="$(mebibytes "$out/log/moving.$scene.$1")" \
		'BEGIN { split(begin, a); split(end, b); printf "{\"bench\":\"moving\",\"scene\":\"%s\",\"step\":\"%s\",\"seconds\":%.2f,\"mib\":%s}\n", scene, name, (b[1] + b[2] - a[1] - a[2]) / hertz, mib }' >>"$results"
}

heading "moving: $frames frames of $gaussians Gaussians beside the same scene at rest"
: >"$results"
for scene in rests:1 moves:$frames; do
	dir=$out/scenes/${scene%:*} name=${scene%:*}
	rm -rf "$dir"
	logged "$out/log/moving.gs-synth" gs-synth --seed 71 --moving "${scene#*:}" --views $frames --gaussians $gaussians -o "$dir" || die "no scene"
	splats=$dir/frames
	[ -d "$splats" ] || splats=$dir/point_cloud.ply
	{ cat "$dir/sentences.jsonl"; grep motion-plain "$dir/moving.jsonl"; } >"$dir/all.jsonl"
	step import $name gs-import --cameras "$dir/transforms.json" -o "$dir/scene" "$splats"
	rm -rf "$dir/frames"
	step weigh $name gs-weigh -o "$dir/weights" "$dir/scene"
	step encode $name text-encode --model "$BERT" -o "$dir/text.safetensors" "$dir/all.jsonl"
	step lift $name refer-lift --scene "$dir/scene" --weights "$dir/weights" --text "$dir/text.safetensors" --masks "$dir/truth.jsonl" -o "$dir/model.safetensors"
	step render $name refer-render --split all --scene "$dir/scene" --text "$dir/text.safetensors" --model "$dir/model.safetensors" -o "$dir/masks.jsonl"
	rm -rf "$dir"
done
{
	printf 'scene\timport\tweigh\tencode\tlift\trender\tall\tmost MiB\n'
	jq -rs 'group_by(.scene) | reverse[] | [.[0].scene] + map(.seconds) + [(map(.seconds) | add), (map(.mib) | max)] | @tsv' "$results"
} | table
jq -rs 'map(select(.scene == "moves").seconds) as $m | map(select(.scene == "rests").seconds) as $r | "\(($m | add) / ($r | add) * 100 | round / 100) times as long"' "$results"
