#!/bin/sh
# desk.mk's target field: trains fields from the lifted model, by parses and taught, by parses alone and by words, and prints what
# each finds of the test sentences and of those of ASK, mIoU and in brackets the share of the right object.
# usage: TOOLS=DIR/ OUT=DIR SENTENCES=FILE TRUTH=FILE SEEDS="1 2 3" TAUGHT=N BERT=DIR desk-field.sh
set -eu
field=$OUT/field

# "86.7 (100)"
score() {
	"${TOOLS}miou-score" --csv --quiet --predicted-views --truth "$TRUTH" "$1" | awk -F, '
		NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i }
		$1 == "all" { printf "%.1f (%.0f)", 100 * $at["miou"], 100 * $at["right"] }'
}

# render MODEL TEXT SENTENCES: the score of its masks in the test views
render() {
	"${TOOLS}refer-render" --quiet --scene "$OUT/scene" --text "$2" --model "$1" --sentences "$3" -o "$field/masks.jsonl"
	score "$field/masks.jsonl"
}

mkdir -p "$field"
for n in "$TAUGHT" 0; do
	[ ! -e "$field/text-$n.safetensors" ] || continue
	: >"$field/said.jsonl"
	[ "$n" = 0 ] || "${TOOLS}refer-say" --each "$n" --encoder "$BERT" -o "$field/said.jsonl" "$OUT"
	cat "$SENTENCES" "$field/said.jsonl" | "${TOOLS}text-encode" --model "$BERT" -o "$field/text-$n.safetensors"
done
for row in "parses $TAUGHT" "parses 0" "words 0"; do
	for seed in $SEEDS; do
		text=$field/text-${row#* }.safetensors model=$field/${row% *}-${row#* }-$seed.safetensors
		[ -e "$model" ] || "${TOOLS}refer-train" --quiet --scene "$OUT/scene" --weights "$OUT/weights" --text "$text" \
			--masks "$OUT/lifted/masks.jsonl" --init "$OUT/lifted/model.safetensors" --init-iterations 2500 --iterations 2500 \
			--query "${row% *}" --interaction none --contrast none --checkpoint 0 --seed "$seed" -o "$model"
		tests=$(render "$model" "$text" test) others=$(render "$model" "$OUT/lifted/asked.safetensors" all)
		printf '%s taught, seed %s: test sentences %s, ASK %s\n' "$row" "$seed" "$tests" "$others"
	done
done
