#!/usr/bin/env bash
# The time of a frame against Gaussians and size: BUILD/bench/render.jsonl.
. tests/bench/common.sh
heading "render: a frame"
if [ ! -x "$bench/bench_render" ]; then
	echo "left out: there is no bench_render"
	exit 0
fi
results=$out/render.jsonl gaussians=25000,50000,100000,200000,500000 sizes="493x364 986x728 1906x1070"
counts=$([ "$threads" = 1 ] || echo 1,)$threads
[ -z "$FULL" ] || gaussians=10000,$gaussians,1000000 sizes="246x182 $sizes 3840x2160"

measure() {
	local size
	"$bench/bench_render" --json --gaussians $gaussians --size 986x728 --threads "$counts" | sed 's/^{/{"sweep":"gaussians",/' >"$results" || return
	for size in $sizes; do
		"$bench/bench_render" --json --gaussians 100000 --size "$size" --threads "$threads" | sed 's/^{/{"sweep":"size",/' >>"$results" || return
	done
}

# Reference values, not measured here: other machines, other scenes.
published="
OpenSplat, CPU, 500,000 Gaussians	500 to 1200 ms	the project's design, section 8
ReferSplat, NVIDIA A6000	37 ms (26.8 a second)	He et al., ICML 2025; a mask of 986x728
"

report() {
	jq -rs '("Gaussians\tsize\tthreads\tchannels\tprepare, ms\tblend, ms\tframe, ms\tframes a second\tpairs"),
		(.[] | [.gaussians, "\(.width)x\(.height)", .threads, .channels, .prepare_ms, .blend_ms, .frame_ms, .fps, .pairs] | @tsv)' \
		"$results" | table
	printf '\nReference values, not measured here\n'
	{
		printf 'program\ta frame\tsource\n'
		sed '/^$/d' <<<"$published"
	} | table
	printf '\nFits: y = a + b x over all points; y = C x^exponent over the points where a is less than half\n'
	{
		fit_head
		rows gaussians '[.gaussians, .frame_ms]' | fit "a frame / Gaussians"
		rows gaussians '[.pairs, .blend_ms]' | fit "blending / pairs"
		rows size '[.width * .height, .frame_ms]' | fit "a frame / pixels"
	} | table
	{
		plot_head "A frame against Gaussians" "986x728 pixels" "Gaussians of the scene" "time of a frame, ms" xlog ylog \
			"ref${tab}37.3${tab}ReferSplat on an A6000, 26.8 a second"
		jq -r 'select(.sweep == "gaussians") | ["\(.threads) thread\(if .threads > 1 then "s" else "" end)", .gaussians, .frame_ms] | @tsv' "$results"
		printf 'OpenSplat, CPU (reference)\t500000\t775\t500\t1200\n#style\tOpenSplat, CPU (reference)\tpoints\n'
	} | plot render-gaussians
	{
		plot_head "A frame against its size" "100,000 Gaussians, $threads threads" "pixels of the frame" "time, ms" xlog ylog
		rows size '["a frame", .width * .height, .frame_ms]'
		rows size '["blending", .width * .height, .blend_ms]'
		rows size '["preparing: project, sort", .width * .height, .prepare_ms]'
	} | plot render-size
}

# rows SWEEP FILTER: a line of each result of a sweep with all threads.
rows() {
	jq -r "select(.sweep == \"$1\" and .threads == $threads) | $2 | @tsv" "$results"
}

measure || die "bench_render failed"
report
