#!/usr/bin/env bash
# Time and memory of each step of the way without training against Gaussians and views: BUILD/bench/chain.jsonl. Wall-clock
# seconds on all processors, once each; weights at a quarter of 986x728 are packed.
#	FULL=1       to a million Gaussians
#	DATA=DIR     a real scene in the desk's layout too
. tests/bench/common.sh
results=$out/chain.jsonl
steps="gs-import gs-weigh text-encode pseudomask-select refer-lift refer-render"
sizes="50000:25 100000:25 200000:25"
[ -z "$FULL" ] || sizes="50000:125 200000:125 500000:125 1000000:250"

# chain NAME SPLATS CAMERAS TEST_VIEWS SENTENCES CANDIDATES SCALE: all steps in $out/scenes/NAME.
chain() {
	local dir=$out/scenes/$1 log=$out/log/chain.$1
	rm -rf "$dir/weights" "$dir/scene"
	mkdir -p "$dir"
	logged "$log.gs-import" gs-import --cameras "$3" --test-views "$4" -o "$dir/scene" "$2" &&
		logged "$log.gs-weigh" gs-weigh --packed --tolerance 0.05 --scale "$7" -o "$dir/weights" "$dir/scene" &&
		logged "$log.text-encode" text-encode --model "$BERT" -o "$dir/text.safetensors" "$5" &&
		logged "$log.pseudomask-select" pseudomask-select --scene "$dir/scene" --weights "$dir/weights" -o "$dir/masks.jsonl" "$6" &&
		logged "$log.refer-lift" refer-lift --scene "$dir/scene" --weights "$dir/weights" --text "$dir/text.safetensors" \
			--masks "$dir/masks.jsonl" -o "$dir/model.safetensors" &&
		logged "$log.refer-render" refer-render --scene "$dir/scene" --text "$dir/text.safetensors" --model "$dir/model.safetensors" \
			--sentences test -o "$dir/predictions.jsonl" || die "a tool failed"
	for step in $steps; do
		printf '{"bench":"chain","scene":"%s","gaussians":%d,"views":%d,"candidates":%d,"step":"%s","seconds":%s,"mib":%s}\n' "$1" \
			"$(sed -n 's/^element vertex //p;/^end_header/q' "$2")" "$(find "$dir/weights" -type f | wc -l)" "$(wc -l <"$6")" "$step" \
			"$(seconds "$log.$step")" "$(mebibytes "$log.$step")" >>"$results"
	done
	rm -rf "$dir"
}

heading "chain: the way without training against Gaussians and views"
need_encoder
: >"$results"
for size in $sizes; do
	data=$out/scenes/chain.data
	rm -rf "$data"
	logged "$out/log/chain.gs-synth" gs-synth --scene kitchen --seed 901 --objects 24 --views "${size#*:}" --size 986x728 \
		--gaussians "${size%:*}" -o "$data" || die "gs-synth failed"
	rm -rf "$data/images"
	chain "$size" "$data/point_cloud.ply" "$data/sparse/0" "$(cat "$data/test-views")" "$data/sentences.jsonl" "$data/candidates.jsonl" 0.25
	rm -rf "$data"
done
[ -z "$DATA" ] || chain "$(basename "$DATA")" "$DATA/point_cloud.ply" "$DATA/sparse/0" \
	"${TEST_VIEWS:-input_0001,input_0009,input_0017,input_0025}" "$DATA/sentences.jsonl" "$DATA/candidates.jsonl" 0.5
{
	printf 'Gaussians\tviews\tcandidates'
	for step in $steps all; do printf '\t%s' "$step"; done
	printf '\tmost MiB\n'
	jq -rs 'group_by(.scene) | map({first: .[0], seconds: map(.seconds), most: (map(.mib) | max)}) | sort_by(.first.gaussians)[] |
		[.first.gaussians, .first.views, .first.candidates] + .seconds + [(.seconds | add * 10 | round / 10), .most] | @tsv' "$results"
} | table
echo
{
	fit_head
	for step in $steps; do
		jq -r --arg step "$step" 'select(.step == $step and (.scene | test("^[0-9]+:(25|125)$"))) | [.gaussians, .seconds * 1000] | @tsv' "$results" |
			fit "$step"
	done
} | table
