#!/usr/bin/env bash
# Processor time and memory of refer-train against --memory, its room for the weights of the views: BUILD/bench/views.jsonl. Each
# model must be the same.
#	DATA=DIR     a real scene in the desk's layout, for the synthetic one
#	SCALE        of the views; default 0.3333
#	STEPS        of a training; default 300
#	TRAIN        more options for refer-train
. tests/bench/common.sh
results=$out/views.jsonl scale=${SCALE:-0.3333} steps=${STEPS:-300} scene=synthetic-views
[ -z "$DATA" ] || scene=$(basename "$DATA")
dir=$out/scenes/$scene weights=$out/scenes/$scene/weights.f32

# train NAME STEPS MEMORY: its processor time goes to NAME.cpu.
train() {
	local TIMEFORMAT='%U %S'
	{ time learn "$@" 2>&3; } 3>&2 2>"$dir/log/$1.cpu"
}

learn() {
	logged "$dir/log/$1" refer-train --scene "$dir/scene" --weights "$weights" --text "$dir/text.safetensors" --masks "$dir/masks.jsonl" \
		--checkpoint 0 --iterations "$2" --memory "$3" ${TRAIN:-} -o "$dir/$1.safetensors"
}

# cpu NAME: seconds.
cpu() {
	awk '{ print $1 + $2 }' "$dir/log/$1.cpu"
}

# measure MEMORY: a training of one step is taken off the time.
measure() {
	local filed begin whole
	train begin 1 "$1" && train "views-$1" "$steps" "$1" || return
	begin=$(cpu begin) whole=$(cpu "views-$1")
	filed=$(sed -n 's/.*: the weights of \([0-9]*\) views are in a file.*/\1/p' "$dir/log/views-$1")
	printf '{"bench":"views","memory":%d,"filed":%d,"begin":%s,"step":%s,"mib":%s}\n' "$1" "${filed:-0}" "$begin" \
		"$(awk -v whole="$whole" -v begin="$begin" -v n="$steps" 'BEGIN { printf "%.1f", 1e3 * (whole - begin) / (n - 1) }')" \
		"$(mebibytes "$dir/log/views-$1")" >>"$results"
	cmp "$dir/views-0.safetensors" "$dir/views-$1.safetensors"
}

heading "views: refer-train with room for some views, $scene, f32 weights at $scale, $steps steps"
need_encoder
if [ -z "$DATA" ]; then
	synthetic "$dir" 50000 640x480 25 1
else
	prepare "$dir" "$DATA/point_cloud.ply" "$DATA/sparse/0" "${TEST_VIEWS:-input_0001,input_0009,input_0017,input_0025}" \
		"$DATA/sentences.jsonl" "$DATA/candidates.jsonl"
fi && logged "$dir/log/gs-weigh" gs-weigh --scale "$scale" -o "$weights" "$dir/scene" || die "a tool failed"
: >"$results"
for memory in 0 256 512 1024; do measure $memory || die "refer-train --memory $memory failed"; done
rm -rf "$weights" "$dir"/views-*.safetensors
{
	printf -- '--memory, MiB\tviews in the file\tpeak MiB\tto begin, processor s\ta step, processor ms\n'
	jq -r '[.memory, .filed, .mib, .begin, .step] | @tsv' "$results"
} | table
