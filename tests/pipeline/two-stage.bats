#!/usr/bin/env bats
# The pipelines, on the smallest scene there is.

load two-stage.bash

@test "it makes models, predictions, overlays and scores of both stages" {
	for stage in 1 2; do
		"$BIN/gs-check" "$WORK/stage$stage/model.safetensors" "$WORK/stage$stage/predictions.test.jsonl"
		[ "$(jq -s length "$WORK/stage$stage/predictions.test.jsonl")" = 2 ]
		[ "$(jq -s length "$WORK/stage$stage/predictions.train.jsonl")" = 8 ]
		[ "$(find "$WORK/stage$stage/overlays" -name '*.png' | wc -l)" = 2 ]
		jq -e '.miou >= 0 and .pairs > 0' "$WORK/stage$stage/predictions.test.score.json"
	done
}

@test "it ends with a table of both stages and of times" {
	grep -qE '^stage 1, test views, training sentences +[0-9.]+ ' "$BATS_FILE_TMPDIR/first.log"
	grep -qE '^stage 2, test views, test sentences +[0-9.]+ ' "$BATS_FILE_TMPDIR/first.log"
	grep -qE '^train2 +[0-9.]+ +[0-9.]+$' "$BATS_FILE_TMPDIR/first.log"
}

@test "a second make does nothing" {
	run two_stage predictions overlays scores
	[ "$status" = 0 ]
	not grep -qE "$BIN/" <<<"$output"
}

@test "a changed input remakes what depends on it, and nothing else" {
	touch "$DATA/candidates.jsonl"
	run two_stage -n predictions
	grep -q pseudomask-select <<<"$output"
	grep -q refer-train <<<"$output"
	not grep -qE 'gs-import|gs-weigh' <<<"$output"
	# The sentences that the scene writes of itself go with it, those of people do not.
	[ "$(grep -c text-encode <<<"$output")" = 1 ]
}

@test "make -j gives the same bytes" {
	WORK=$BATS_TEST_TMPDIR/parallel two_stage -j4 predictions
	for stage in 1 2; do
		cmp "$WORK/stage$stage/model.safetensors" "$BATS_TEST_TMPDIR/parallel/stage$stage/model.safetensors"
		cmp "$WORK/stage$stage/predictions.test.jsonl" "$BATS_TEST_TMPDIR/parallel/stage$stage/predictions.test.jsonl"
	done
}

@test "all missing variables are named at once" {
	run make -f "$ROOT/pipelines/two-stage.mk" SCENE=x
	[ "$status" = 2 ]
	grep -q "two-stage.mk: SPLATS MASKS not set; the things" <<<"$output"
}

@test "a step that fails shows what its tool said, and leaves no result" {
	printf '{"view":1}\n' >"$BATS_TEST_TMPDIR/bad.jsonl"
	WORK=$BATS_TEST_TMPDIR/bad run two_stage CANDIDATES="$BATS_TEST_TMPDIR/bad.jsonl"
	[ "$status" = 2 ]
	grep -q "two-stage.mk: CANDIDATES: .*bad.jsonl:1: " <<<"$output"
	[ ! -e "$BATS_TEST_TMPDIR/bad/stage1/masks.jsonl" ]
}

@test "the table's figures are those of the score files" {
	for stage in 1 2; do
		score=$(jq '100 * .miou' "$WORK/stage$stage/predictions.train.score.json")
		row=$(grep "^stage $stage, test views, training sentences" "$BATS_FILE_TMPDIR/first.log" | awk '{ print $7 }')
		awk -v a="$score" -v b="$row" 'BEGIN { exit !(a - b < 0.051 && b - a < 0.051) }'
	done
	score=$(jq '100 * .miou' "$WORK/stage1/masks.score.json")
	row=$(grep "^selected masks" "$BATS_FILE_TMPDIR/first.log" | awk '{ print $5 }')
	[ "$(printf %.1f "$score")" = "$row" ]
}

# demo SEED OPTIONS: the demo's data, and which files of them are new.
demo() {
	touch -d '1 hour ago' stamp "$BATS_TEST_TMPDIR"/demo/data/* 2>/dev/null || true
	make -f "$ROOT/pipelines/demo.mk" DEMO=demo BIN="$BIN" SEED="$1" SYNTH="$2" demo/data/made-by >log 2>&1
	find demo/data -maxdepth 1 -newer stamp -type f | grep -c . || true
}

@test "the demo makes its data anew when SEED or the options of gs-synth change, and only then" {
	cd "$BATS_TEST_TMPDIR"
	small="--objects 2 --views 5 --size 32x24 --gaussians 1000"
	[ "$(demo 1 "$small")" -gt 3 ]
	cp demo/data/truth.jsonl first
	[ "$(demo 1 "$small")" = 0 ]
	[ "$(demo 2 "$small")" -gt 3 ]
	not cmp -s first demo/data/truth.jsonl
	[ "$(demo 2 "${small/1000/1001}")" -gt 3 ]
	[ "$(demo 2 "${small/1000/1001}")" = 0 ]
	# A remake that fails leaves no data that pass for the old ones.
	[ "$(demo 3 "--objects 64 --views 2 --size 16x16 --gaussians 1000")" = 0 ]
	[ ! -e demo/data/made-by ]
	[ "$(demo 2 "${small/1000/1001}")" -gt 3 ]
}
