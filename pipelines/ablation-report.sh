#!/bin/sh
# Prints a table of ablation.mk as Markdown: the paper's figures beside ours, and where the order agrees.
# usage: ROOT=DIR SCENES="..." SEEDS="..." RUNS="..." ablation-report.sh TABLE
set -eu
table=$1
here=$(dirname "$0")

# The mIoU in a JSON score file, in percent.
quality() {
	sed -n 's/.*"miou":\([0-9.eE+-]*\),"oiou.*/\1/p' "$1" | awk '{ print 100 * $1 }'
}

# Tab-separated: RUN CELL SEED KIND VALUE; kinds test and train are mIoU in test views, test-right and train-right
# the share of masks on the right object, quality the mIoU of masks in training views.
values() {
	for scene in $SCENES; do
		for seed in $SEEDS; do
			cell=$scene-$seed
			for run in $RUNS; do
				for kind in test train; do
					awk -F, -v OFS='\t' -v run="$run" -v cell="$cell" -v seed="$seed" -v kind=$kind '
						NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i }
						$1 == "all" { print run, cell, seed, kind, 100 * $at["miou"]; print run, cell, seed, kind "-right", 100 * $at["right"] }
						' "$ROOT/$cell/$run/$kind.csv"
				done
			done
			case $table in
			masks) made='both=masks/ciou iou=masks/iou top1=masks/top1 first=masks/first two=both/teach' ;;
			second) made='both=masks/ciou two=both/teach onscene=masks/scene two-lifted=masks/lifted' ;;
			lifted) made='both=masks/ciou two=both/teach onscene=masks/scene warmed=masks/scene lift=masks/scene lift-voted=masks/ciou' ;;
			*) continue ;;
			esac
			for run in $made; do
				[ -e "$ROOT/$cell/${run#*=}.quality.json" ] || continue
				printf '%s\t%s\t%s\tquality\t%s\n' "${run%=*}" "$cell" "$seed" "$(quality "$ROOT/$cell/${run#*=}.quality.json")"
			done
		done
	done
}

# Tab-separated: RUN CELL KIND GROUP NAME PAIRS VALUE, of the groups of sentences and targets.
groups() {
	for scene in $SCENES; do
		for seed in $SEEDS; do
			for run in $RUNS; do
				for kind in test train; do
					awk -F, -v OFS='\t' -v run="$run" -v kind=$kind '
						$1 == "relation" || $1 == "visibility" { print run, kind, $1, $2, $3, 100 * $4 }
						$1 == "object" { n++; name[n] = base[n] = $2; sub(/ [0-9]+$/, "", base[n]); same[base[n]]++; pairs[n] = $3; miou[n] = $4 }
						END { for (i = 1; i <= n; i++) print run, kind, "alike", (same[base[i]] > 1 ? "several" : "one"), pairs[i], 100 * miou[i] }
						' "$ROOT/$scene-$seed/$run/$kind.csv"
				done
			done
		done
	done
}

# What the data are: a row for each scene and seed, from gs-synth's own statistics and the scores of the selected masks.
statistics() {
	printf '### The scenes\n\n'
	printf '| scene | objects | alike | stacked | sentences | words each | test targets less than half visible | less than 0.15 | top-1 | IoU | confidence-weighted |\n'
	printf '|---|---|---|---|---|---|---|---|---|---|---|\n'
	for scene in $SCENES; do
		for seed in $SEEDS; do
			cell=$ROOT/$scene-$seed
			for mask in top1 iou ciou; do
				quality "$cell/masks/$mask.quality.json"
			done | paste -sd' ' - | cat "$cell/data/statistics.json" - | awk -v name="$scene, seed $seed" '
				function number(key) { return match(json, "\"" key "\":[0-9.]+") ? substr(json, RSTART + length(key) + 3, RLENGTH - length(key) - 3) + 0 : 0 }
				NR == 1 {
					json = $0; objects = number("objects"); alike = number("alike"); stacked = number("stacked")
					rest = json; sub(/.*"sentences":/, "", rest); json = rest; train = number("train"); test = number("test")
					sub(/.*"words":/, "", rest); json = rest; words = (number("train") * train + number("test") * test) / (train + test)
					sub(/.*"visibility":/, "", rest); sub(/.*"test":/, "", rest); json = rest
					hidden = number("0") + number("<0.15"); half = hidden + number("0.15-0.5")
				}
				NR == 2 { printf "| %s | %d | %d | %d | %d + %d | %.1f | %.0f%% | %.0f%% | %.1f | %.1f | %.1f |\n", name, objects, alike, stacked,
					train, test, words, 100 * half, 100 * hidden, $1, $2, $3 }'
		done
	done
	echo
}

# Boxes and whole outlines of the lifted objects: a row for each scene and seed.
space() {
	printf '### Where things are, and all of them\n\n'
	printf 'Of test sentences / training sentences, in percent. Outlines: mIoU with the whole objects, hidden parts too, of --amodal and of ordinary masks.\n\n'
	printf '| scene | boxes along the axes, IoU | over 0.25 | over 0.5 | turned boxes, IoU | centre off, of the diagonal | whole outlines | ordinary masks |\n|---|---|---|---|---|---|---|---|\n'
	for scene in $SCENES; do
		for seed in $SEEDS; do
			for kind in test train; do
				cell=$ROOT/$scene-$seed/lift
				jq -r --slurpfile whole "$cell/whole.$kind.score.json" --slurpfile visible "$cell/visible.$kind.score.json" \
					'[.aligned.miou, .aligned.p25, .aligned.p50, .oriented.miou, .centre_relative, $whole[0].miou, $visible[0].miou]
					| map(100 * .) | @tsv' "$cell/boxes.$kind.score.json"
			done | awk -v name="$scene, seed $seed" '
				NR == 1 { split($0, test) }
				END { printf "| %s |", name; for (i = 1; i <= NF; i++) printf " %.1f / %.1f |", test[i], $i; print "" }'
		done
	done
	echo
}

# Sentences in a wording kept apart: a row for each kind, pooled over all scenes and seeds by their pairs.
unseen() {
	printf '### Sentences in a wording kept apart\n\n'
	printf 'Scenes %s, seeds %s; in percent of the pairs of a sentence and a test view.\n\n' "$SCENES" "$SEEDS"
	printf '| sentences | pairs | right | mIoU | refused | F1@25 |\n|---|---|---|---|---|---|\n'
	for run in $RUNS; do
		[ "$run" = lift ] || printf '| **%s** | | | | | |\n' "$run"
		for scene in $SCENES; do
			for seed in $SEEDS; do
				cat "$ROOT/$scene-$seed/$run/unseen.answers.json"
			done
		done | jq -rs '[.[] | ({"that mean one thing": .one, "that mean several": .several, "that mean nothing there": .none} + .kinds) | to_entries[]
			| select(.value.pairs > 0)] | group_by(.key) | map({key: .[0].key, pairs: (map(.value.pairs) | add), v: map(.value)})
		| sort_by(if .key | startswith("that") then [0, -.pairs] else [1, .key] end) | .[]
		| . as $g | "| \(.key) | \(.pairs) | " + ([("right", "miou", "refused", "f1_25") as $f
			| ($g.v | map((.[$f] // 0) * .pairs) | add) / $g.pairs | 1000 * . | round / 10 | tostring] | join(" | ")) + " |"'
	done
	echo
}

if [ "$table" = unseen ]; then
	unseen
elif [ "$table" = statistics ]; then
	statistics
elif [ "$table" = space ]; then
	space
elif [ "$table" = hard ]; then
	groups | awk -f "$here/ablation-groups.awk" -v runs="$RUNS"
else
	values | awk -f "$here/ablation-table.awk" -v table="$table" -v seeds="$SEEDS" -v scenes="$SCENES" "$here/published.tsv" -
fi
