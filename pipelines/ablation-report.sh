#!/bin/sh
# Prints a table of ablation.mk as Markdown: the paper's figures beside ours, and where the order agrees.
# usage: ROOT=DIR SCENES="..." SEEDS="..." RUNS="..." ablation-report.sh TABLE
set -eu
table=$1
here=$(dirname "$0")

# Tab-separated: RUN CELL SEED KIND VALUE; kinds test and train are mIoU in test views, quality that of masks in training views.
values() {
	for scene in $SCENES; do
		for seed in $SEEDS; do
			cell=$scene-$seed
			for run in $RUNS; do
				for kind in test train; do
					awk -F, -v OFS='\t' -v run="$run" -v cell="$cell" -v seed="$seed" -v kind=$kind \
						'$1 == "all" { print run, cell, seed, kind, 100 * $4 }' "$ROOT/$cell/$run/$kind.csv"
				done
			done
			[ "$table" = masks ] || continue
			for run in both=ciou iou=iou top1=top1 first=first; do
				sed -n 's/.*"miou":\([0-9.eE+-]*\),"oiou.*/\1/p' "$ROOT/$cell/masks/${run#*=}.quality.json" |
					awk -v OFS='\t' -v run="${run%=*}" -v cell="$cell" -v seed="$seed" \
						'{ print run, cell, seed, "quality", 100 * $1 }'
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
					awk -F, -v OFS='\t' -v run="$run" -v kind=$kind '$1 == "relation" || $1 == "visibility" {
						print run, kind, $1, $2, $3, 100 * $4 }' "$ROOT/$scene-$seed/$run/$kind.csv"
				done
			done
		done
	done
}

if [ "$table" = sentences ]; then
	groups | awk -f "$here/ablation-groups.awk" -v runs="$RUNS"
else
	values | awk -f "$here/ablation-table.awk" -v table="$table" -v seeds="$SEEDS" -v scenes="$SCENES" "$here/published.tsv" -
fi
