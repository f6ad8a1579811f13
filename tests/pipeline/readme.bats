#!/usr/bin/env bats
# README.md: its commands for a scene of one's own, as they are pasted, on a small scene that has its names.

setup() {
	ROOT=$BATS_TEST_DIRNAME/../..
	BIN=$(cd "${BIN:-$ROOT/build/bin}" && pwd)
	cd "$BATS_TEST_TMPDIR"
}

@test "README.md is short: under 100 lines, and 120 characters in each" {
	awk 'length > 120 { print FILENAME ":" FNR; bad = 1 } END { exit bad || NR >= 100 }' "$ROOT/README.md"
}

@test "the commands for a scene of one's own run, and those of lift.md that take things out" {
	"$BIN/gs-synth" -q --objects 3 --views 9 --size 64x48 --gaussians 1000 -o kitchen
	sed -i 's/view_003/frame_00041/' kitchen/sparse/0/images.txt kitchen/*.jsonl
	mv kitchen/images/view_003.png kitchen/images/frame_00041.png
	# The object of the first mask is painted.
	jq -c 'select(.view == "frame_00041")' kitchen/truth.jsonl | head -n 1 >one.jsonl
	"$BIN/mask-export" -q --png drawn -o coco.json one.jsonl
	mkdir painted
	mv drawn/frame_00041/*.png painted/frame_00041.png
	echo '#ffffff kettle' >names.txt
	ln -s "$ROOT/pipelines" pipelines
	mkdir -p home/.cache/refersplat
	cp -r "$ROOT/tests/golden/bert" home/.cache/refersplat/encoder
	sed -n '/^## A scene of/,/^## The tools/s/^    //p' "$ROOT/README.md" | grep -v '^{' >commands
	[ "$(grep -c '^make -f' commands)" = 2 ]
	sed -n '/^## Take things out/,/^## Sent/s/^    //p' "$ROOT/pipelines/lift.md" >out-of-it
	sed -i '/^refer-ask/r out-of-it' commands
	env -u XDG_CACHE_HOME HOME="$PWD/home" PATH="$BIN:$PATH" sh -eu commands >said 2>&1 || { cat said; false; }
	grep -q '^kettle: ' said
	"$BIN/gs-check" labelled.ply things/kettle.ply rest.spz work/kitchen/lifted/predictions.test.jsonl
	# and the records that it shows are read
	sed -n 's/^    {"ref"/{"ref"/p' "$ROOT/README.md" >sentence.jsonl
	"$BIN/gs-check" sentence.jsonl
}
