#!/bin/sh
# Prints the cost table of ablation.mk as Markdown: trains again in one cell of it, alone and with every processor, and times that.
# usage: CELL=DIR OUT=DIR [BIN=DIR/] ablation-cost.sh RUN...
set -eu
bin=${BIN:-}
unset OMP_NUM_THREADS
mkdir -p "$OUT"
text=$CELL/text/contextual.safetensors

# The seconds and the MiB that a tool's -v ends with.
seconds() { sed -n 's/.*: \([0-9.]*\) s, peak memory \([0-9.]*\) MiB$/\1/p' "$1" | tail -n 1; }
memory() { sed -n 's/.*: \([0-9.]*\) s, peak memory \([0-9.]*\) MiB$/\2/p' "$1" | tail -n 1; }
miou() { awk -F, '$1 == "all" { printf "%.1f", 100 * $4 }' "$1"; }

# A sentence's mask in some views: what many views take longer than one, for each view more.
frames() {
	ref=$(sed -n 's/.*"ref":"\([^"]*\)".*/\1/p' "$CELL/data/sentences.jsonl" | head -n 1)
	view=$(cut -d, -f1 "$CELL/data/test-views")
	for views in "--views $view" "--split all"; do
		# shellcheck disable=SC2086 # an option and its value
		"${bin}refer-render" --scene "$CELL/scene" --text "$text" --model "$1" --refs "$ref" $views -v -o "$OUT/masks.jsonl" 2>"$OUT/log"
		printf '%s %s\n' "$(wc -l <"$OUT/masks.jsonl")" "$(seconds "$OUT/log")"
	done | awk '{ n[NR] = $1; t[NR] = $2 } END { printf "%.1f", (t[2] > t[1]) ? (n[2] - n[1]) / (t[2] - t[1]) : 0 }'
}

size=$(sed -n 's/.*"width":\([0-9]*\),"height":\([0-9]*\).*/\1x\2/p' "$CELL/scene/cameras.json" | head -n 1)
printf '### Cost (table 5)\n\n%s, views of %s, every processor of this machine (%s).\n\n' "$(cat "$CELL/data/made-by")" "${size:-one size}" "$(nproc)"
printf '| | training, s | memory, MiB | masks a second | model, MB | test sentences | training sentences |\n|---|---|---|---|---|---|---|\n'
printf '| published (RTX A6000, 45,000 steps, ramen) | 3480 | | 26.8 | 3.3 | 35.2 | |\n'
for run in "$@"; do
	model=$OUT/$run.safetensors
	# shellcheck disable=SC2046 # options
	"${bin}refer-train" --scene "$CELL/scene" --weights "$CELL/weights" --text "$text" --masks "$CELL/masks/ciou.jsonl" \
		$(cat "$CELL/$run/options") --checkpoint 0 -v -o "$model" 2>"$OUT/$run.log"
	printf '| %s | %s | %s | %s | %s | %s | %s |\n' "$run: $(sed 's/--seed [0-9]* *//' "$CELL/$run/options")" "$(seconds "$OUT/$run.log")" \
		"$(memory "$OUT/$run.log")" "$(frames "$model")" "$(wc -c <"$model" | awk '{ printf "%.2f", $1 / 1e6 }')" \
		"$(miou "$CELL/$run/test.csv")" "$(miou "$CELL/$run/train.csv")"
done
# Without training: selection in 3D and lifting.
"${bin}pseudomask-select" --scene "$CELL/scene" --weights "$CELL/weights" -v -o "$OUT/lifted.jsonl" "$CELL/data/candidates.jsonl" 2>"$OUT/select.log"
model=$OUT/lifted.safetensors
"${bin}refer-lift" --scene "$CELL/scene" --weights "$CELL/weights" --text "$text" --masks "$OUT/lifted.jsonl" -v -o "$model" 2>"$OUT/lift.log"
printf '| lifted: selection in 3D, refer-lift | %s + %s | %s | %s | %s | %s | %s |\n\n' "$(seconds "$OUT/select.log")" "$(seconds "$OUT/lift.log")" \
	"$({ memory "$OUT/select.log"; memory "$OUT/lift.log"; } | sort -n | tail -n 1)" "$(frames "$model")" \
	"$(wc -c <"$model" | awk '{ printf "%.2f", $1 / 1e6 }')" "$(miou "$CELL/lift/test.csv")" "$(miou "$CELL/lift/train.csv")"
