#!/usr/bin/env bash
# The time of a frame against Gaussians and size: BUILD/bench/render.jsonl.
. tests/bench/common.sh
heading "render: a frame"
results=$out/render.jsonl gaussians=25000,50000,100000,200000,500000 sizes=493x364,986x728,1906x1070 repeats=5
[ -z "$FULL" ] || gaussians=10000,$gaussians,1000000 sizes=246x182,$sizes,3840x2160 repeats=15

measure() {
	"$bench/bench_render" -r $repeats -n $gaussians -s 986x728 | sed 's/^{/{"sweep":"gaussians",/' >"$results" &&
		"$bench/bench_render" -r $repeats -n 100000 -s $sizes | sed 's/^{/{"sweep":"size",/' >>"$results" &&
		"$bench/bench_render" -r $repeats -n $gaussians -s 986x728 -l 0.02 | sed 's/^{/{"sweep":"lifted",/' >>"$results"
}

# Reference values, not measured here: other machines, other scenes.
published="
OpenSplat, CPU, 500,000 Gaussians	500 to 1200 ms	the project's design, section 8
ReferSplat, NVIDIA A6000	37 ms (26.8 a second)	He et al., ICML 2025; a mask of 986x728
"

# rows SWEEP CHANNELS FILTER: a line of each result with all threads in a frame.
rows() {
	jq -r "select(.sweep == \"$1\" and .threads == $threads and .mode == \"within\" and .channels == $2) | $3 | @tsv" "$results"
}

report() {
	echo "Medians; a channel is a sentence. part: of the Gaussians that the answers are of; below 1 only their tiles are rendered. within: all threads share a frame; beside: each has its own, times are a frame's share."
	jq -rs '("Gaussians\tpart\tsize\tthreads\tmode\tchannels\tprepare, ms\tblend, ms\tframe, ms\tms a channel\tframes a second\tpairs"),
		(.[] | select(.channels != 4) | [.gaussians, .part, "\(.width)x\(.height)", .threads, .mode, .channels, .prepare_median_ms, .blend_median_ms, .frame_median_ms,
		(.frame_median_ms / .channels * 1000 | round / 1000), (100000 / .frame_median_ms | round / 100), .pairs] | @tsv)' "$results" | table
	printf '\nReference values, not measured here\n'
	{
		printf 'program\ta frame\tsource\n'
		sed '/^$/d' <<<"$published"
	} | table
	printf '\nFits, one channel, %s threads: y = a + b x over all points; y = C x^exponent over the points where a is less than half\n' "$threads"
	{
		fit_head
		rows gaussians 1 '[.gaussians, .frame_median_ms]' | fit "a frame / Gaussians"
		rows gaussians 1 '[.gaussians, .prepare_median_ms]' | fit "preparing / Gaussians"
		rows lifted 1 '[.gaussians, .frame_median_ms]' | fit "a frame of a lifted answer / Gaussians"
		rows gaussians 1 '[.pairs, .blend_median_ms]' | fit "blending / pairs"
		rows size 1 '[.width * .height, .frame_median_ms]' | fit "a frame / pixels"
	} | table
	{
		plot_head "A frame against Gaussians" "986x728 pixels; one sentence, or sixteen" "Gaussians of the scene" "time of a frame, ms" xlog ylog \
			"ref${tab}37.3${tab}ReferSplat on an A6000, 26.8 a second"
		jq -r --argjson most "$threads" 'select(.sweep == "gaussians" and (.threads == 1 or .threads == $most) and (.channels == 1 or .channels == 16)
			and (.mode == "beside" or .threads == 1))
			| ["\(.threads) thread\(if .threads > 1 then "s" else "" end)\(if .channels > 1 then ", sixteen" else "" end)", .gaussians,
			.frame_median_ms] | @tsv' "$results" | sort -s -t "$tab" -k 1,1
		printf 'OpenSplat, CPU (reference)\t500000\t775\t500\t1200\n#style\tOpenSplat, CPU (reference)\tpoints\n'
	} | plot render-gaussians
	{
		plot_head "A frame against its size" "100,000 Gaussians, one sentence, $threads threads in a frame" "pixels of the frame" "time, ms" xlog ylog
		rows size 1 '["a frame", .width * .height, .frame_median_ms]'
		rows size 1 '["blending", .width * .height, .blend_median_ms]'
		rows size 1 '["preparing: project, sort", .width * .height, .prepare_median_ms]'
	} | plot render-size
}

measure || die "bench_render failed"
report
