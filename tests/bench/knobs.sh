#!/usr/bin/env bash
# What each knob of the tools brings in speed and costs in accuracy. Every value of every knob is a whole run, all else exact:
# gs-weigh, refer-train, refer-render on the test views, miou-score; once for each seed of the training. A run's result is
# kept in BUILD/bench/runs, and made again only where the tools have changed since.
#	DATA=DIR       a real scene in the desk's layout, for the synthetic one
#	ITERATIONS     sentences shown in a training, 1000 or more
#	SEEDS="1 2"    seeds of the trainings
#	KNOBS="a b"    only these knobs
. tests/bench/common.sh

# A knob is a line here: its name, its tool, the option, and the values, the exact one first. Options and values that the
# built tools do not know are left out. Values of weigh-scale are shares of the exact run's size. A batch of S sentences
# gets an S-th of the steps, so that every training sees the same number of sentences. Besides these there is a run, named
# defaults, with every option as the tools have it where nothing is said (but for the size and the length).
knobs="
weigh-scale     gs-weigh    --scale     1 0.71 0.5 0.35
weigh-tolerance gs-weigh    --tolerance 0 0.02 0.1
weigh-precision gs-weigh    --precision f32 f16 u8
tolerance       refer-train --tolerance 0 0.01 0.1
share           refer-train --share     0 0.01 0.04 0.15
negatives       refer-train --negatives 0 12 4
batch           refer-train --batch     1 2 4
precision       refer-train --precision f32 f16 u8
"

[ -z "${KNOBS:=}" ] || knobs=$(awk -v names="$KNOBS" 'BEGIN { count = split(names, want) }
	{ shown = 0; for (i = 1; i <= count; i++) if ($1 == want[i]) shown = 1
	if (!shown && NF) NF = 4; print }' <<<"$knobs")

SHORT=10 # steps of the training that is taken off a run's time: reading, setting up
# The quick run learns at higher rates than the defaults, to get somewhere in few steps.
size=160x120 gaussians=10000 scale=1 scene=synthetic steps=1200 seeds="1 2 3" rates="--feature-rate 0.01 --mlp-rate 0.0005"
if [ -n "$FULL" ]; then
	size=320x240 gaussians=20000 scale=0.5 scene=synthetic-full steps=6000 seeds="1 2 3 4 5" rates=
fi
if [ -n "$DATA" ]; then
	scene=$(basename "$DATA") scale=0.1667 steps=3000 seeds="1 2 3" rates=
	[ -z "$FULL" ] || steps=15000
fi
steps=${ITERATIONS:-$steps} seeds=${SEEDS:-$seeds}
[ "$steps" -ge 1000 ] 2>/dev/null || die "ITERATIONS is to be at least 1000"
dir=$out/scenes/$scene runs=$out/runs/$scene-$steps${rates:+-fast}
results=$out/knobs.jsonl summary=$out/knobs-summary.jsonl

setup() {
	mkdir -p "$runs"
	if [ -z "$DATA" ]; then
		truth=$dir/data/truth.jsonl
		synthetic "$dir" $gaussians $size 25 1
	else
		truth=$DATA/truth.jsonl
		prepare "$dir" "$DATA/point_cloud.ply" "$DATA/sparse/0" "${TEST_VIEWS:-input_0001,input_0009,input_0017,input_0025}" \
			"$DATA/sentences.jsonl" "$DATA/candidates.jsonl"
	fi
}

# known TOOL OPTION VALUE: whether the built tool takes it; a value that is a word is one of the choices that --help shows.
known() {
	has_option "$1" "$2" || return
	case $3 in
	[0-9]*) ;;
	*) "$bin/$1" --help | grep -e "^ *\(-., \)\? *$2 " | grep -q -e "[ |]$3\(|\| \|$\)" ;;
	esac
}

# options TOOL KNOB VALUE: the tool's options in a run: every knob exact but the one.
options() {
	local name tool option exact rest
	while read -r name tool option exact rest; do
		if [ "$tool" != "$1" ] || ! known "$tool" "$option" "$exact"; then continue; fi
		if [ "$2" = defaults ] && [ "$name" != weigh-scale ]; then continue; fi
		[ "$name" != "$2" ] || exact=$3
		[ "$name" != weigh-scale ] || exact=$(awk -v a="$scale" -v b="$exact" 'BEGIN { print a * b }')
		printf '%s %s ' "$option" "$exact"
	done <<<"$knobs"
}

# train RUN STEPS SEED LOG OPTION...
train() {
	local run=$1 count=$2 seed=$3 log=$4
	shift 4
	logged "$log" refer-train --scene "$dir/scene" --weights "$weights" --text "$dir/text.safetensors" \
		--masks "$dir/masks.jsonl" --checkpoint 0 --iterations "$count" --seed "$seed" $rates "$@" -o "$run.safetensors"
}

# score RUN SPLIT: mIoU in test views of one split's sentences; the time of rendering is left in RUN.render-SPLIT.
score() {
	logged "$1.render-$2" refer-render --scene "$dir/scene" --text "$dir/text.safetensors" --model "$1.safetensors" \
		--sentences "$2" -o "$1.$2.jsonl" || return
	"$bin/miou-score" --json --quiet --predicted-views --truth "$truth" "$1.$2.jsonl" | jq .miou
}

# respond RUN DIR: response maps as trained, of the training sentences in the test views.
respond() {
	rm -rf "$2"
	logged "$1.respond" refer-render --scene "$dir/scene" --text "$dir/text.safetensors" --model "$1.safetensors" --calibration none \
		--sentences train --scale "$scale" --response "$2" --response-type npy
}

# apart RUN SEED: relative rms of the run's responses against those of the exact run of a seed.
apart() {
	local maps
	mapfile -t maps < <(cd "$1.responses" && find . -name '*.npy' | sort)
	"$bench/bench_rms" "$runs/exact-$2.responses" "$1.responses" "${maps[@]}" | jq .relative
}

# measure KNOB VALUE SEED: one run; its line in RUN.json, and its response maps in RUN.responses where it is exact.
measure() {
	local knob=$1 value=$2 seed=$3 batch=1 count shown name=$1=$2 run short first=${seeds%% *} how
	local trained tested relative=null noise=null
	[ "$value" != - ] || name=$knob
	run=$runs/$name-$seed
	read -ra weigh < <(options gs-weigh "$knob" "$value")
	read -ra learn < <(options refer-train "$knob" "$value")
	how="gs-weigh ${weigh[*]}; refer-train $rates ${learn[*]}"
	[ "$(jq -r '"\(.build) \(.how)"' "$run.json" 2>/dev/null)" != "$build $how" ] || return 0
	rm -f "$run.json"
	[ "$knob" != batch ] || batch=$value
	count=$((steps / batch)) shown=$((steps / batch * batch))
	weights=$runs/$(printf '%s' "${weigh[@]}").weights
	if ! is_of "$weights/build" "$build"; then
		rm -rf "$weights"
		logged "$weights.log" gs-weigh "${weigh[@]}" -o "$weights" "$dir/scene" && echo "$build" >"$weights/build" || return
	fi
	train "$run" $SHORT "$seed" "$run.short" "${learn[@]}" && train "$run" "$count" "$seed" "$run.train" "${learn[@]}" || return
	short=$(seconds "$run.short")
	trained=$(score "$run" train) && tested=$(score "$run" test) && respond "$run" "$run.responses" || return
	[ "$knob" = exact ] || relative=$(apart "$run" "$seed") || return
	[ "$knob" != exact ] || [ "$seed" = "$first" ] || noise=$(apart "$run" "$first") || return
	jq -nc --arg knob "$knob" --arg value "$value" --argjson seed "$seed" --arg build "$build" --arg scene "$scene" \
		--argjson steps "$count" --argjson batch "$batch" --argjson shown "$shown" --argjson short_steps $SHORT \
		--argjson threads "$threads" --argjson train_s "$(seconds "$run.train")" --argjson short_s "$short" \
		--argjson weigh_s "$(seconds "$weights.log")" --argjson render_s "$(seconds "$run.render-train")" \
		--argjson weights_bytes "$(cat "$weights"/*.safetensors | wc -c)" --argjson model_bytes "$(wc -c <"$run.safetensors")" \
		--argjson memory_mib "$(mebibytes "$run.train")" --argjson trained "$trained" --argjson tested "$tested" \
		--argjson relative "$relative" --argjson noise "$noise" --arg how "$how" \
		'{bench: "knobs", scene: $scene, knob: $knob, value: $value, seed: $seed, threads: $threads, steps: $steps, batch: $batch,
		ms_a_sentence: (1000 * ($train_s - $short_s) / ($shown - $short_steps * $batch)), train_s: $train_s, weigh_s: $weigh_s,
		render_s: $render_s, weights_bytes: $weights_bytes, model_bytes: $model_bytes, memory_mib: $memory_mib,
		miou_train_sentences: $trained, miou_test_sentences: $tested, response_rms: $relative, seed_rms: $noise, build: $build, how: $how}' \
		>"$run.json" || return
	[ "$knob" = exact ] || rm -rf "$run.responses"
	rm -f "$run".{train,test}.jsonl "$run.safetensors"
}

# others VALUES: all but the first, which is exact.
others() {
	[ "${1#* }" = "$1" ] || echo "${1#* }"
}

# All runs, a seed's close together in time; one that fails is named and left out.
measure_all() {
	local name tool option values value seed
	for seed in $seeds; do
		measure exact - "$seed" || die "the exact run with seed $seed failed"
		while read -r name tool option values; do
			for value in $(others "$values"); do
				if known "$tool" "$option" "$value"; then
					measure "$name" "$value" "$seed" || echo "FAILED: $name $value, seed $seed"
				elif [ "$seed" = "${seeds%% *}" ]; then
					echo "left out: $tool has no $option $value"
				fi
			done
		done <<<"$knobs"
		measure defaults - "$seed" || echo "FAILED: the defaults, seed $seed"
	done
	# The results of what was asked for this time, and no others that lie there.
	for seed in $seeds; do cat "$runs/exact-$seed.json" "$runs/defaults-$seed.json"; done >"$results"
	while read -r name tool option values; do
		for value in $(others "$values"); do
			for seed in $seeds; do cat "$runs/$name=$value-$seed.json" 2>/dev/null; done
		done
	done <<<"$knobs" | jq -c "select(.build == \"$build\")" >>"$results"
}

# Each value's runs in one record, in the table's order: medians, least and largest, and the change against the exact run of
# the same seed.
summarise() {
	local order
	order=$(awk 'NF { for (i = 5; i <= NF; i++) printf ",\"%s %s\"", $1, $i }' <<<"$knobs")
	jq -s 'def median: sort | (.[(length - 1) / 2 | floor] + .[length / 2 | floor]) / 2;
		def spread(f): map(f) | {mid: median, low: min, high: max};
		['"\"exact -\"$order"', "defaults -"] as $order
		| (map(select(.knob == "exact") | {key: "\(.seed)", value: .}) | from_entries) as $exact
		| [group_by([.knob, .value])[] | {knob: .[0].knob, value: .[0].value, runs: length,
			label: (if .[0].value == "-" then .[0].knob else .[0].value end),
			ms: spread(.ms_a_sentence), faster: spread($exact["\(.seed)"].ms_a_sentence / .ms_a_sentence),
			miou: spread(100 * .miou_train_sentences), test: spread(100 * .miou_test_sentences),
			change: spread(100 * (.miou_train_sentences - $exact["\(.seed)"].miou_train_sentences)),
			rms: (if .[0].response_rms then spread(.response_rms) else null end),
			weigh_s: (map(.weigh_s) | median), weights_mb: (.[0].weights_bytes / 1e6), model_kb: (.[0].model_bytes / 1e3)}]
		| sort_by("\(.knob) \(.value)" as $k | $order | index($k))[]' "$results" | jq -c . >"$summary"
	noise=$(jq -rs '[.[] | select(.seed_rms) | .seed_rms] | if length > 0 then add / length else empty end' "$results")
}

tables() {
	{
		printf 'knob\tvalue\truns\tms a sentence\tfaster\tmIoU, %%\tleast\tlargest\tchange\tleast\tlargest\tmIoU, test sentences\trms of responses\tweigh, s\tweights, MB\tmodel, kB\n'
		jq -r 'def to(digits): (. * pow(10; digits) | round) / pow(10; digits) + 0;
			[.knob, .value, .runs, (.ms.mid, .faster.mid | to(2)), (.miou.mid, .miou.low, .miou.high, .change.mid, .change.low,
			.change.high, .test.mid | to(1)), (if .rms then (.rms.mid | to(4)) else "-" end), (.weigh_s | to(2)),
			(.weights_mb | to(1)), (.model_kb | to(0))] | @tsv' "$summary"
	} | table
	echo "mIoU: the training sentences in the test views; change: against the exact run of the same seed; $steps sentences shown, $threads threads.${rates:+ Rates: $rates.}"
	echo "rms of responses: of the difference to the exact run of the same seed, as a share.${noise:+ Exact runs of two seeds are $noise apart.}"
}

# paths PLACE: a line of points for each knob, from the exact run through its values. PLACE makes a run's numbers.
paths() {
	jq -rs 'map(select(.knob == "exact"))[0] as $exact | map(select(.value != "-")) as $runs
		| ($runs | map(.knob) | reduce .[] as $k ([]; if index([$k]) then . else . + [$k] end))[] as $k
		| ($exact | .label = ""), ($runs[] | select(.knob == $k)) | [$k, '"$1"', .label] | @tsv' "$summary"
}

# each SELECTION PLACE: a point for each run that the selection holds for.
each() {
	jq -r "select($1) | [.knob, $2, .label] | @tsv" "$summary"
}

plots() {
	local note place styles="" knob exact
	note="scene $scene, $steps sentences shown, $(wc -w <<<"$seeds") seeds: medians and ranges"
	exact=$(jq 'select(.knob == "exact") | .model_kb' "$summary")
	# The same colours in every plot.
	for knob in $(jq -r 'select(.knob != "exact") | .knob' "$summary" | uniq); do styles+="#style$tab$knob${tab}path"$'\n'; done
	styles+="#style${tab}exact${tab}points"
	{
		plot_head "Speed against accuracy, one knob at a time" "$note" "training, ms a sentence" "mIoU in test views, %"
		echo "$styles"
		place='.ms.mid, .miou.mid, .miou.low, .miou.high, .ms.low, .ms.high'
		paths "$place"
		each '.value == "-"' "$place"
	} | plot knobs-miou
	{
		plot_head "Speed against the error of responses, one knob at a time" "$note" "training, ms a sentence" \
			"rms difference to the exact run, share" yzero ${noise:+"ref$tab$noise${tab}exact, another seed"}
		echo "$styles"
		each .rms '.ms.mid, .rms.mid, .rms.low, .rms.high, .ms.low, .ms.high'
	} | plot knobs-responses
	{
		plot_head "Size of the model against accuracy" "$note" "model, kB" "mIoU in test views, %"
		echo "$styles"
		each ".knob == \"exact\" or (.model_kb / $exact - 1 | fabs) > 0.02" '.model_kb, .miou.mid, .miou.low, .miou.high, "", ""'
	} | plot knobs-size
}

heading "knobs: speed against accuracy, scene $scene"
need_encoder
setup || die "the scene could not be made"
build=$(build_sum)
measure_all
summarise
tables
plots
