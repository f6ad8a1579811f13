#!/usr/bin/env bash
# A training step, gs-weigh, refer-render and a frame with 1 to all threads: BUILD/bench/threads.jsonl. Threads share a frame,
# or each has frames of its own.
. tests/bench/common.sh
results=$out/threads.jsonl repeats=3 gaussians=100000 size=640x480 scene=$out/scenes/threads
[ -z "$FULL" ] || repeats=9
counts=$(seq 1 "$threads")
if [ "$threads" -gt 8 ]; then counts="1 2 4 $(seq 8 8 "$threads") $threads"; fi
counts=$(printf '%s\n' $counts | sort -nu)

# put WHAT THREADS MS
put() {
	printf '{"bench":"threads","what":"%s","threads":%d,"ms":%s}\n' "$1" "$2" "$3" >>"$results"
}

# The least wall time of several runs, ms.
least() {
	local i best="" s
	for ((i = 0; i < repeats; i++)); do
		logged "$out/log/threads" "$@" || return
		s=$(seconds "$out/log/threads")
		best=$(awk -v a="${best:-$s}" -v b="$s" 'BEGIN { print a < b ? a : b }')
	done
	awk -v s="$best" 'BEGIN { print 1000 * s }'
}

measure() {
	local t ms
	# One view's worth of sentences trained for a moment makes a model to render.
	synthetic "$scene" $gaussians $size 5 1 || return
	[ -d "$scene/weights" ] || logged "$scene/log/gs-weigh" gs-weigh --scale 0.25 -o "$scene/weights" "$scene/scene" || return
	[ -e "$scene/model.safetensors" ] || logged "$scene/log/refer-train" refer-train --scene "$scene/scene" --weights "$scene/weights" \
		--text "$scene/text.safetensors" --masks "$scene/masks.jsonl" --checkpoint 0 --iterations 10 -o "$scene/model.safetensors" || return
	: >"$results"
	for t in $counts; do
		# Wall time at every number of threads: bench_step has the process's own time at one.
		ms=$("$bench/bench_step" --json --wall --gaussians $gaussians --threads "$t" | jq .min_ms) && put "a training step" "$t" "$ms" || return
		ms=$(least gs-weigh --threads "$t" --split all -o "$scene/again" "$scene/scene") && put "gs-weigh, 5 views" "$t" "$ms" || return
		ms=$(least refer-render --threads "$t" --split all --scene "$scene/scene" --text "$scene/text.safetensors" \
			--model "$scene/model.safetensors" -o "$scene/again.jsonl") && put "refer-render, 5 views, 40 sentences" "$t" "$ms" || return
	done
	rm -rf "$scene/again" "$scene/again.jsonl"
	"$bench/bench_render" -r $repeats -n $gaussians -s 986x728 | jq -c 'select(.channels == 1)
		| {bench: "threads", what: (if .mode == "within" then "a frame" else empty end, if .mode == "beside" or .threads == 1 then
		"a frame each" else empty end), threads, ms: .frame_ms}' >>"$results"
}

heading "threads: 1 to $threads"
need_encoder
measure || die "a measurement failed"
jq -rs '("what\tthreads\tms\tfaster\tof ideal"), (group_by(.what)[] | .[0].ms as $one | .[] | [.what, .threads, (.ms * 100 | round / 100),
	($one / .ms * 100 | round / 100), "\($one / .ms / .threads * 100 | round) %"] | @tsv)' "$results" | table
{
	plot_head "Speed against threads" "100,000 Gaussians; weights and masks at 640x480" threads "times faster than one thread" xzero yzero
	jq -rs 'group_by(.what)[] | .[0].ms as $one | .[] | [.what, .threads, $one / .ms] | @tsv' "$results"
	printf '#style\tas many times as threads\tdashed\n'
	for t in $counts; do printf 'as many times as threads\t%s\t%s\n' "$t" "$t"; done
} | plot threads
