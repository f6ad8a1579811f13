#!/usr/bin/env bash
# How well scenes that move are understood: gs-synth --moving 48 at rest and moving, lifted from the true masks of training views. Run by hand;
# SEEDS="71 72" (71 to 76). Prints for each wording, seen and kept back: the share of views that show the right thing and mIoU (sentences that mean
# one thing, views of their time), 4D LangSplat's Acc and vIoU, the share refused of sentences of a motion that is not there; and mIoU of sentences
# without motion over time, beside the same at rest. Folders of runs are left in BUILD/bench/scenes/motion.
. tests/bench/common.sh
need_encoder
all=$out/scenes/motion log=$out/log/motion

# lifted DIR: scene, weights and model of what gs-synth made.
lifted() {
	local dir=$1 splats=$1/frames
	[ -d "$splats" ] || splats=$dir/point_cloud.ply
	logged "$log" gs-import --cameras "$dir/transforms.json" -o "$dir/scene" "$splats" &&
		logged "$log" gs-weigh -o "$dir/weights" "$dir/scene" &&
		logged "$log" text-encode --model "$BERT" -o "$dir/text.safetensors" "$dir/sentences.jsonl" &&
		logged "$log" refer-lift --scene "$dir/scene" --weights "$dir/weights" --text "$dir/text.safetensors" -o "$dir/model.safetensors" \
			--masks <(jq -c --arg test "$(cat "$dir/test-views")" 'select(.view as $v | $test | split(",") | index($v) | not)' "$dir/truth.jsonl")
	rm -rf "$dir/frames" "$dir/weights" "$dir/images"
}

# scored DIR SENTENCES NAME: masks of a file of sentences in all views, and their scores.
scored() {
	logged "$log" text-encode --model "$BERT" -o "$1/$3.safetensors" "$2" &&
		logged "$log" refer-render --when --split all --scene "$1/scene" --text "$1/$3.safetensors" --model "$1/model.safetensors" -o "$1/$3.masks.jsonl" &&
		"$bin/miou-score" -q --answers --json --sentences "$2" --truth "$1/truth.jsonl" -o "$1/$3.json" "$1/$3.masks.jsonl" || die "seed $seed: $3"
}

for seed in ${SEEDS:-71 72 73 74 75 76}; do
	for times in 48 1; do
		dir=$all/$seed-$times
		rm -rf "$dir"
		logged "$log" gs-synth --seed $seed --moving $times --views 48 -o "$dir" && lifted "$dir" || die "seed $seed"
		jq -c 'select(.kind == "motion-plain") | del(.when)' "$dir/moving.jsonl" >"$dir/plain.jsonl"
		scored "$dir" "$dir/plain.jsonl" plain
		[ $times = 1 ] || for set in moving moving-kept-back; do scored "$dir" "$dir/$set.jsonl" $set; done
	done
done
{
	printf 'sentences\tright\tmIoU\tAcc\tvIoU\trefused\n'
	for set in moving moving-kept-back; do
		jq -rs --arg set $set 'def mean(f): (map(f) | add / length * 1000 | round / 10); [$set, mean(.one.right), mean(.one.miou), mean(.one.accuracy), mean(.one.viou), mean(.none.refused)] | @tsv' \
			"$all"/*-48/$set.json
	done
	for times in 48 1; do
		jq -rs --arg times $times 'def mean(f): (map(f) | add / length * 1000 | round / 10); ["without motion, \($times) times", mean(.one.right), mean(.one.miou)] | @tsv' "$all"/*-$times/plain.json
	done
} | table
