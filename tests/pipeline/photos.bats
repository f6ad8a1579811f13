#!/usr/bin/env bats
# pipelines/photos.mk, with a colmap that writes the model that gs-synth made. Parts: pipelines/photos.mk cmd/train/fitting.*

setup() {
	ROOT=$(cd "$BATS_TEST_DIRNAME/../.." && pwd)
	BIN=${BIN:-$ROOT/build/bin}
	cd "$BATS_TEST_TMPDIR"
	"$BIN/gs-synth" -q --objects 3 --views 6 --size 64x48 --gaussians 1000 -o made
	export MADE=$PWD/made PATH=$PWD/stub:$PATH
	mkdir stub
	cat >stub/colmap <<-'END'
		#!/bin/sh
		echo "$@" >>"$MADE/../called"
		[ "$1" = mapper ] || exit 0
		while [ "$1" != --output_path ]; do shift; done
		mkdir "$2/0" "$2/1" && : >"$2/0/images.txt" && cp "$MADE"/sparse/0/* "$2/1"
	END
	chmod +x stub/colmap
}

photos() { make -s -f "$ROOT/pipelines/photos.mk" BIN="$BIN" SCENE=out PHOTOS=made/images FIT="--gaussians 300 --iterations 30" "$@"; }

@test "photographs become splats; each step says its time; a second make does nothing" {
	photos >said
	"$BIN/gs-check" out/splats.ply
	grep -qE '^features: [0-9]+ s$' said
	grep -qE '^fit: [0-9]+ s$' said
	[ "$(cut -d' ' -f1 called | tr '\n' ' ')" = "feature_extractor exhaustive_matcher mapper " ]
	grep -q 'use_gpu 0' called
	cp -p out/splats.ply before
	photos
	[ ! before -ot out/splats.ply ] && [ "$(wc -l <called)" = 3 ]
	# Another FIT trains again, and looks for no cameras.
	photos FIT="--gaussians 300 --iterations 40"
	! cmp -s before out/splats.ply
	[ "$(wc -l <called)" = 3 ]
}

@test "in sequence, photographs are compared with those of near numbers, and from time to time with all" {
	mkdir many
	for i in {1..135}; do : >many/$i.jpg; done
	run photos PHOTOS=many FIT= # which ends at gs-train: these are no photographs
	[[ $output == *"matches: each photograph with those taken near it; "* ]]
	grep -q '^matches_importer .*--match_type pairs --match_list_path out/colmap/pairs ' called
	for pair in '1.jpg 2.jpg' '9.jpg 10.jpg' '9.jpg 19.jpg' '9.jpg 25.jpg' '5.jpg 133.jpg' '5.jpg 120.jpg'; do grep -qx "$pair" out/colmap/pairs; done
	! grep -qx '9.jpg 21.jpg' out/colmap/pairs
	[ "$(wc -l <out/colmap/pairs)" -lt 2000 ]
	run photos MATCHER=some
	[[ $output == *"MATCHER is 'some', and exhaustive or sequential are what it can be"* ]]
}

@test "a program that is not there is named, with the way out" {
	rm stub/colmap
	mkdir empty
	for tool in bash sh make sed date mkdir rm touch printf cat cmp dirname basename ls head awk grep tail sort env uname tr; do ln -s "$(command -v $tool)" empty/; done
	PATH=$PWD/empty run photos
	[ "$status" = 2 ]
	[[ $output == *"photos.mk: colmap is not installed: run 'make deps-photos' in "* ]]
}
