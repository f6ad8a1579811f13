#!/bin/sh
# desk.mk's target field: trains fields from the lifted model, by parses and taught, and, in as many processor seconds, in the paper's
# way, by words from the masks of photographs at a sixth of their size; prints what each finds of the test sentences and of those of
# ASK, mIoU and in brackets the share of the right object, and the processor seconds of its training.
# usage: TOOLS=DIR/ OUT=DIR SENTENCES=FILE CANDIDATES=FILE TRUTH=FILE SEEDS="1 2 3" TAUGHT=N BERT=DIR desk-field.sh
set -eu
field=$OUT/field/$TAUGHT # what was made with another number is left alone

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
if [ ! -e "$field/text.safetensors" ]; then
	"${TOOLS}pseudomask-select" --method ciou -o "$field/masks-2d.jsonl" "$CANDIDATES"
	"${TOOLS}gs-weigh" --scale 0.1667 -o "$field/weights" "$OUT/scene"
	: >"$field/said.jsonl"
	[ "$TAUGHT" = 0 ] || "${TOOLS}refer-say" --each "$TAUGHT" --encoder "$BERT" -o "$field/said.jsonl" "$OUT"
	cat "$SENTENCES" "$field/said.jsonl" | "${TOOLS}text-encode" --model "$BERT" -o "$field/text.safetensors"
fi
for row in taught field modules; do
	images="--weights $field/weights --text $OUT/text.safetensors --masks $field/masks-2d.jsonl --tolerance 0.01"
	case $row in
	taught) options="--weights $OUT/weights --text $field/text.safetensors --masks $OUT/lifted/masks.jsonl --init $OUT/lifted/model.safetensors
		--init-iterations 2500 --iterations 2500 --query parses --interaction none --contrast none" ;;
	field) options="$images --iterations 18000 --interaction none --contrast none" ;;
	modules) options="$images --iterations 6000" ;;
	esac
	for seed in $SEEDS; do
		model=$field/$row-$seed.safetensors
		if [ ! -e "$model" ]; then
			times >"$field/times"
			# shellcheck disable=SC2086 # options
			"${TOOLS}refer-train" --quiet --scene "$OUT/scene" $options --checkpoint 0 --seed "$seed" -o "$model"
			times >>"$field/times"
			# Every second line is of what this shell has waited for.
			awk -F '[ms ]+' '{ s = 60 * ($1 + $3) + $2 + $4 } NR == 2 { before = s } END { printf "%.0f\n", s - before }' \
				"$field/times" >"$field/$row-$seed.seconds"
		fi
		tests=$(render "$model" "$field/text.safetensors" test) others=$(render "$model" "$OUT/lifted/asked.safetensors" all)
		printf '%s, seed %s: test sentences %s, ASK %s, %s s\n' "$row" "$seed" "$tests" "$others" "$(cat "$field/$row-$seed.seconds")"
	done
done
