#!/usr/bin/env bash
# Usage: [DATA=DIR SPLATS=FILE BOXES=FILE [TEST_VIEWS=LIST]] [SEEDS="71 72"] [SCENES="diner toys"] [DETECTOR=DIR] [BIN=build/bin] [KEEP=DIR] tests/bench/propose.sh
#
# How well regions without names fit things, each thing by its best region (miou-score --best): of a scene in the desk's layout
# (sparse/0, images, truth.jsonl), by the photographs alone and, with BOXES, by a detector's boxes; in the labelled views for
# testing, or in all labelled ones where there are none. Without DATA of gs-synth's scenes, by the
# boxes of a DETECTOR if there is one, ten regions a thing.
# Prints mIoU and the shares of things and views with an IoU of 0.5 and 0.75, for 110 regions and for 40 of which none is in
# another; and the time and memory of making them. Of real scenes also what clicks mean, where `make benches` has built
# bench_pick beside BIN. KEEP keeps scenes and weights for the next run.
set -euo pipefail
export LC_ALL=C
BIN=$(cd "${BIN:-build/bin}" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
keep=${KEEP:-$work}

# weighed DIR SCALE SPLATS CAMERAS IMAGES [TEST_VIEWS]
weighed() {
	[ -e "$1/weights" ] && return
	"$BIN/gs-import" -q --cameras "$4" --images "$5" ${6:+--test-views "$6"} -o "$1/scene" "$3"
	"$BIN/gs-weigh" -q --split all --scale "$2" --packed --tolerance 0.05 -o "$1/weights.part" "$1/scene"
	mv "$1/weights.part" "$1/weights"
}

# row NAME DIR TRUTH SPLIT ARGUMENT...
row() {
	local name=$1 dir=$2 truth=$3 split=$4
	shift 4
	"$BIN/pseudomask-propose" -v --weights "$dir/weights" --split "$split" -o "$work/masks" "$@" "$dir/scene" 2>"$work/log"
	printf '%-40s %s  %s\n' "$name" "$("$BIN/miou-score" -q --best --json --predicted-views --truth "$truth" "$work/masks" |
		jq -r '[.miou, .p50, .p75] | map(. * 1000 | round / 10 | tostring) | join("  ")')" "$(tail -n 1 "$work/log" | sed 's/^[^:]*: //')"
}

echo "                                         mIoU  P@50  P@75"
if [ -n "${DATA:-}" ]; then
	weighed "$keep/real" 0.3333 "${SPLATS:-$DATA/point_cloud.ply}" "$DATA/sparse/0" "$DATA/images" "${TEST_VIEWS:-}"
	split=${TEST_VIEWS:+test}
	for boxes in "" ${BOXES:+"$BOXES"}; do
		row "${boxes:+boxes, }photographs, nested" "$keep/real" "$DATA/truth.jsonl" "${split:-train}" ${boxes:+--boxes "$boxes"}
		row "${boxes:+boxes, }photographs, disjoint" "$keep/real" "$DATA/truth.jsonl" "${split:-train}" ${boxes:+--boxes "$boxes"} --disjoint
	done
	pick=$BIN/../bench/bench_pick
	[ ! -x "$pick" ] || [ -z "${BOXES:-}" ] || {
		"$BIN/pseudomask-propose" --weights "$keep/real/weights" --boxes "$BOXES" --regions "$work/regions" -o /dev/null "$keep/real/scene"
		"$pick" "$keep/real/scene" "$keep/real/weights" "$work/regions" "$DATA/truth.jsonl"
	}
	exit
fi
for scene in ${SCENES:-diner toys}; do
	for seed in ${SEEDS:-71 72}; do
		dir=$keep/$scene-$seed
		[ -e "$dir/truth.jsonl" ] || "$BIN/gs-synth" -q --scene "$scene" --seed "$seed" -o "$dir"
		weighed "$dir" 0.5 "$dir/point_cloud.ply" "$dir/sparse/0" "$dir/images" "$(cat "$dir/test-views")"
		[ -z "${DETECTOR:-}" ] || [ -e "$dir/found.jsonl" ] || "$BIN/box-detect" -q --model "$DETECTOR" --scene "$dir/scene" -o "$dir/found.jsonl"
		boxes=(${DETECTOR:+--boxes "$dir/found.jsonl"})
		things=$(jq -r .object "$dir/truth.jsonl" | sort -u | wc -l)
		row "$scene $seed, nested" "$dir" "$dir/truth.jsonl" test "${boxes[@]}" --most $((10 * things))
		row "$scene $seed, disjoint" "$dir" "$dir/truth.jsonl" test "${boxes[@]}" --disjoint
	done
done
