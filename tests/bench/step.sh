#!/usr/bin/env bash
# A training step against everything it depends on, one at a time: BUILD/bench/step.jsonl.
. tests/bench/common.sh
# The contrast takes NEGATIVES sentences, refer-train's default, but where all of the scene's are said.
NEGATIVES=12
results=$out/step.jsonl repeats=9
gaussians=25000,50000,100000,200000,500000
sentences="11 22 44 88" batches="1 2 4 8" words="5 10 20 40"
sizes="80x45 159x89 318x178 450x252 636x356"
if [ -n "$FULL" ]; then
	repeats=25 gaussians=10000,25000,50000,100000,200000,300000,500000,1000000
	sentences="11 22 44 88 176" batches="1 2 4 8 16" sizes="$sizes 953x535"
fi

# sweep NAME OPTION...: measures, and names what was varied in the results.
sweep() {
	local name=$1
	shift
	"$bench/bench_step" --json --repeats $repeats "$@" | sed "s/^{/{\"sweep\":\"$name\",/" >>"$results"
}

measure() {
	local v all="--negatives $NEGATIVES --threads $threads"
	: >"$results"
	sweep gaussians --gaussians $gaussians --negatives $NEGATIVES --threads "$([ "$threads" = 1 ] || echo 1,)$threads" || return
	sweep similarity --gaussians 100000 --similarity cosine $all || return
	for v in $sentences; do sweep sentences --gaussians 50000 --sentences "$v" $all || return; done
	for v in $sentences; do sweep all-sentences --gaussians 50000 --sentences "$v" --negatives 0 --threads "$threads" || return; done
	for v in $batches; do sweep batch --gaussians 50000 --batch "$v" $all || return; done
	for v in $words; do sweep words --gaussians 50000 --words "$v" $all || return; done
	for v in $sizes; do sweep weights --gaussians 50000 --size "$v" $all || return; done
}

# rows SWEEP FILTER: a line of each result of a sweep with all threads.
rows() {
	jq -r "select(.sweep == \"$1\" and .threads == $threads) | $2 | @tsv" "$results"
}

tables() {
	echo "Against Gaussians: 14 words, 44 sentences, $NEGATIVES of them in the contrast, one a step, 318x178 pixels. peer: PyTorch, $threads threads, without images and contrast."
	{
		printf 'Gaussians\tthreads\tmedian, ms\tleast, ms\tGFLOP/s\tof peak\tpeer, ms\tpeer / median\n'
		jq -rs --slurpfile peer "$peer" '.[] | select(.sweep == "gaussians") | . as $r
			| ([$peer[] | select(.gaussians == $r.gaussians and .threads == $r.threads)][0].feature_ms) as $p
			| [.gaussians, .threads, .ms, .min_ms, .gflops, "\(.share_of_peak * 1000 | round / 10) %",
				$p // "-", (if $p then ($p / .ms * 10 | round / 10) else "-" end)] | @tsv' "$results"
	} | table
	printf '\nPhases of a step, ms, medians, %s threads\n' "$threads"
	jq -rs "[.[] | select(.sweep == \"gaussians\" and .threads == $threads)] | ([\"Gaussians\"] + (.[0].phases | keys_unsorted) | @tsv),
		(.[] | [.gaussians] + [.phases[]] | @tsv)" "$results" | table
	for by in sentences all-sentences batch words weights; do
		printf '\nAgainst %s: 50,000 Gaussians, %s threads\n' "$by" "$threads"
		jq -rs "[.[] | select(.sweep == \"$by\")] | ([\"words\", \"sentences\", \"in the contrast\", \"a step\", \"pixels\", \"weights\", \"median, ms\",
			\"ms a sentence\", \"of peak\"] | @tsv), (.[] | [.words, .sentences,
			(if .negatives > 0 then \"4 + \(.negatives)\" else \"all\" end), .batch, .pixels, .weights, .ms,
			(.ms / .batch * 1000 | round / 1000), \"\(.share_of_peak * 1000 | round / 10) %\"] | @tsv)" "$results" | table
	done
	printf '\nSimilarity at 100,000 Gaussians, %s threads\n' "$threads"
	jq -rs "(\"similarity\tmedian, ms\"), (.[] | select(.gaussians == 100000 and .threads == $threads and
		(.sweep == \"gaussians\" or .sweep == \"similarity\")) | [.similarity, .ms] | @tsv)" "$results" | table
	printf '\nFits: y = a + b x over all points; y = C x^exponent over the points where a is less than half\n'
	{
		fit_head
		rows gaussians '[.gaussians, .ms]' | fit "a step / Gaussians"
		rows gaussians '[.gaussians, .ms - .phases.words - .phases.images]' | fit "its part / Gaussians (1)"
		rows weights '[.weights, .ms]' | fit "a step / weights"
		rows weights '[.weights, .phases.images]' | fit "images / weights"
		rows sentences '[.sentences, .ms]' | fit "a step / sentences of the scene"
		rows all-sentences '[.sentences, .ms]' | fit "a step / sentences, all in the contrast"
		rows all-sentences '[.sentences, .phases.words]' | fit "words / sentences, all in the contrast"
		rows batch '[.batch, .ms]' | fit "a step / sentences a step"
		rows words '[.words, .ms]' | fit "a step / words of a sentence"
		jq -r "select(.threads == $threads) | [.gaussians, .feature_ms] | @tsv" "$peer" | fit "the peer / Gaussians"
	} | table
	echo "(1) without the phases words and images, whose time does not depend on the Gaussians"
}

plots() {
	{
		plot_head "A training step against Gaussians" "14 words, 44 sentences, one a step, 318x178 pixels; PyTorch without images and contrast" \
			"Gaussians that learn" "time of a step, ms" xlog ylog "ref${tab}20${tab}goal: 45,000 steps in 15 minutes"
		jq -r '"refer-train, \(.threads) thread\(if .threads > 1 then "s" else "" end)\t\(.gaussians)\t\(.ms)"' \
			<(jq -c 'select(.sweep == "gaussians")' "$results")
		jq -r '"PyTorch, \(.threads) thread\(if .threads > 1 then "s" else "" end)\t\(.gaussians)\t\(.feature_ms)"' "$peer"
	} | plot step-gaussians
	{
		plot_head "How much of the processor a training step uses" "multiply-adds that the folded model needs, of the peak that was measured" \
			"Gaussians that learn" "share of peak, %" xlog yzero
		jq -r 'select(.sweep == "gaussians") | "\(.threads) thread\(if .threads > 1 then "s" else "" end)\t\(.gaussians)\t\(.share_of_peak * 100)"' "$results"
	} | plot step-peak
	{
		plot_head "A training step against the sentences of the scene" "50,000 Gaussians, 14 words, one sentence a step; $threads threads" \
			"sentences of the scene" "time of a step, ms" xzero yzero
		rows sentences "[\"a step, contrast with $NEGATIVES\", .sentences, .ms]"
		rows all-sentences '["a step, contrast with all", .sentences, .ms]'
		rows all-sentences '["of this, MLP_t", .sentences, .phases.words]'
	} | plot step-sentences
	{
		plot_head "A training step against its sentences" "50,000 Gaussians, 14 words, 44 sentences; $threads threads" \
			"sentences in a step" "time, ms" xzero yzero
		rows batch '["a step", .batch, .ms]'
		rows batch '["a sentence of it", .batch, .ms / .batch]'
	} | plot step-batch
	{
		plot_head "A training step against the words of a sentence" "50,000 Gaussians, 44 sentences; $threads threads" \
			"words of a sentence" "time of a step, ms" xzero yzero
		rows words '["a step", .words, .ms]'
		rows words '["of this, MLP_t", .words, .phases.words]'
	} | plot step-words
	{
		plot_head "A training step against the weights of its view" "50,000 Gaussians, 56 weights a pixel; $threads threads" \
			"blend weights of the view" "time, ms" xzero yzero
		rows weights '["a step", .weights, .ms]'
		rows weights '["images: blending, loss, and back", .weights, .phases.images]'
	} | plot step-weights
}

heading "step: a training step"
measure || die "bench_step failed"
peer=$out/peer.jsonl
[ -s "$peer" ] || peer=/dev/null
tables
plots
