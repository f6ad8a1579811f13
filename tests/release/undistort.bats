#!/usr/bin/env bats
# UNDISTORT=1: the workflow without training, from masks on photographs of a lens that distorts.
# Parts: pipelines/(lift|two-stage|common).* libcommon/geom/lens.* cmd/mask-import.c

setup_file() {
	export BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	BIN=$(cd "$BIN" && pwd)
	export ROOT=$BATS_TEST_DIRNAME/../..
	cd "$BATS_FILE_TMPDIR"
	load ../format/lens
	made 96x72
	bent OPENCV 91 91 48 36 -0.2 0.04 0.002 -0.001
	twin
	for kind in candidates truth whole; do drawn made/$kind.jsonl >$kind.jsonl; done
	lift bent.work CAMERAS=bent UNDISTORT=1 CANDIDATES=candidates.jsonl TRUTH=truth.jsonl WHOLE=whole.jsonl >bent.log 2>&1 || { cat bent.log; false; }
}

# lift FOLDER ARGUMENT...
lift() {
	make -f "$ROOT/pipelines/lift.mk" V=1 SCENE="$1" SPLATS=made/point_cloud.ply IMAGES=made/images TEST_VIEWS="$(cat made/test-views)" \
		SENTENCES=made/sentences.jsonl BERT="$ROOT/tests/golden/bert" BIN="$BIN" SCALE=1 "${@:2}"
}

setup() {
	cd "$BATS_FILE_TMPDIR"
	load ../format/lens
}

@test "all masks are as the views see them, and scores are of those" {
	size=$(jq -c '.[0] | [.height, .width]' bent.work/scene/cameras.json)
	[ "$size" != "[72,96]" ]
	for kind in candidates truth whole; do
		[ "$(jq -c .segmentation.size bent.work/undistorted/$kind.jsonl | sort -u)" = "$size" ]
	done
	jq -e '.miou > 0.9' bent.work/lifted/masks.score.json
	jq -e '.miou > 0.8 and .pairs > 0' bent.work/lifted/predictions.train.score.json
	jq -e '.pairs > 0' bent.work/lifted/whole.score.json
}

@test "the answers are those of the pinhole twin" {
	lift plain.work CAMERAS=made/sparse/0 CANDIDATES=made/candidates.jsonl >plain.log 2>&1 || { cat plain.log; false; }
	for work in plain bent; do
		"$BIN/refer-render" -q --scene bent.work/scene --text $work.work/text.safetensors --model $work.work/lifted/model.safetensors \
			--split all --sentences train -o $work.jsonl
	done
	iou plain.jsonl bent.jsonl 0.9
}

@test "a second make does nothing, and a changed candidate goes through" {
	again() { lift bent.work CAMERAS=bent UNDISTORT=1 CANDIDATES=candidates.jsonl TRUTH=truth.jsonl WHOLE=whole.jsonl "$@"; }
	[ -z "$(again | grep "$BIN/'")" ]
	touch -d '+2 seconds' candidates.jsonl
	[ "$(again -n | grep -o "$BIN/'mask-import .*candidates\|$BIN/'refer-lift" | wc -l)" = 2 ]
	again >/dev/null 2>&1
}

@test "drawn masks and painted ones" {
	jq -c 'select(.view == "view_001") | {view, object, segmentation}' truth.jsonl >drawn.jsonl
	lift drawn.work CAMERAS=bent UNDISTORT=1 MASKS=drawn.jsonl SENTENCES= TEST_VIEWS= >log 2>&1 || { cat log; false; }
	"$BIN/gs-check" drawn.work/painted.jsonl drawn.work/lifted/model.safetensors
	"$BIN/mask-export" --png tree -o /dev/null drawn.jsonl
	object=$(jq -r .object drawn.jsonl | head -n 1)
	mkdir painted
	cp "tree/view_001/$object.png" painted/view_001.png
	echo "255 $object" >names
	lift painted.work CAMERAS=bent UNDISTORT=1 MASKS=painted NAMES=names SENTENCES= TEST_VIEWS= >log 2>&1 || { cat log; false; }
	cmp <(head -n 1 drawn.work/painted.jsonl) painted.work/painted.jsonl
}
