#!/usr/bin/env bash
# Time and memory of feature-lift against Gaussians and channels: BUILD/bench/features.jsonl. The maps of all views are one file,
# read as often as there are views; `cat` of them is the least time that reading takes. Beside it NumPy, tests/peers/feature_lift.py, on the same weights
# (not packed) and maps.
. tests/bench/common.sh
results=$out/features.jsonl sizes=100000 views=100
for python in /usr/bin/python3 python3 ''; do
	[ -z "$python" ] || ! "$python" -c 'import numpy' 2>/dev/null || break
done
export PYTHONDONTWRITEBYTECODE=1
[ -z "$FULL" ] || sizes="100000 500000"

# maps DIR HEIGHT WIDTH CHANNELS VIEW...: a map of that shape for each view, of numbers from 1/2 to 1.
maps() {
	local dir=$1 count=$(($2 * $3 * $4)) view
	rm -rf "$dir" && mkdir -p "$dir"
	{
		printf '\x93NUMPY\x01\x00\x76\x00%-117s\n' "{'descr': '<f4', 'fortran_order': False, 'shape': ($2, $3, $4), }"
		awk -v n=$count 'BEGIN { srand(1); for (i = 0; i < n; i++) printf "%04x%02x3f", 65536 * rand(), 128 * rand() }' | xxd -r -p
	} >"$dir/map"
	shift 4
	for view; do ln "$dir/map" "$dir/$view.npy"; done
}

# measure GAUSSIANS CHANNELS HEIGHT WIDTH
measure() {
	local dir=$out/scenes/features-$1 started read_seconds
	maps "$dir/maps" "$3" "$4" "$2" $(ls "$dir/weights" | sed 's/\.safetensors$//') || return
	cat "$dir"/maps/*.npy >/dev/null
	started=$(date +%s%N)
	cat "$dir"/maps/*.npy >/dev/null
	read_seconds=$(awk -v ns=$(($(date +%s%N) - started)) 'BEGIN { print ns / 1e9 }')
	logged "$dir/log/feature-lift" feature-lift --scene "$dir/scene" --weights "$dir/weights" -o "$dir/features" "$dir/maps" || return
	peer='{}'
	if [ -n "$python" ]; then
		peer=$("$python" tests/peers/feature_lift.py time "$dir/plain" "$dir/maps" "$dir/peer") || return
	fi
	printf '{"bench":"features","gaussians":%d,"channels":%d,"map":"%dx%d","views":%d,"seconds":%s,"mib":%s,"read":%s,"bytes":%d,"peer":%s}\n' "$1" "$2" \
		"$4" "$3" "$(ls "$dir/weights" | wc -l)" "$(seconds "$dir/log/feature-lift")" "$(mebibytes "$dir/log/feature-lift")" \
		"$read_seconds" "$(wc -c <"$dir/features")" "$peer" >>"$results"
	rm -rf "$dir/maps" "$dir/features" "$dir/peer"
}

heading "features: feature-lift, synthetic scenes, $views views, weights of 328x243, float maps"
: >"$results"
for n in $sizes; do
	dir=$out/scenes/features-$n
	rm -rf "$dir"
	logged "$dir/log/gs-synth" gs-synth --gaussians "$n" --size 328x243 --views $views -o "$dir/data" &&
		logged "$dir/log/gs-import" gs-import --cameras "$dir/data/sparse/0" -o "$dir/scene" "$dir/data/point_cloud.ply" &&
		logged "$dir/log/gs-weigh" gs-weigh --packed --tolerance 0.05 -o "$dir/weights" "$dir/scene" &&
		if [ -n "$python" ]; then logged "$dir/log/plain" gs-weigh --precision u8 --tolerance 0.05 -o "$dir/plain" "$dir/scene"; fi &&
		measure "$n" 16 243 328 && measure "$n" 512 61 82 || die "a tool failed at $n Gaussians"
	rm -rf "$dir"
done
{
	printf 'Gaussians\tchannels\tmap\tviews\tseconds\tpeak MiB\tread, s\tfile, MB\tNumPy, s\tNumPy, MiB\n'
	jq -r '[.gaussians, .channels, .map, .views, .seconds, .mib, .read, (.bytes / 1e6 | round),
		(.peer.seconds // "-"), (.peer.mib // "-")] | @tsv' "$results"
} | table
