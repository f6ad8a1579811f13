#!/usr/bin/env bats
# pseudomask-propose: regions of a scene that may be things.

bats_require_minimum_version 1.5.0

setup_file() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	cd "$BATS_FILE_TMPDIR"
	"$BIN/gs-synth" -q --objects 3 --views 6 --size 96x72 --gaussians 3000 --seed 3 -o .
	"$BIN/gs-import" -q --images images --test-views "$(cat test-views)" -o scene point_cloud.ply
	"$BIN/gs-import" -q -o bare point_cloud.ply
	"$BIN/gs-weigh" -q --packed --tolerance 0.05 -o weights scene
	# boxes around the true masks, as a good detector finds them
	"$BIN/mask-export" -o coco.json truth.jsonl
	jq -c '(.images | INDEX(.id)) as $of | .annotations[] | $of["\(.image_id)"] as $i | .bbox as [$x, $y, $w, $h] |
		{view: ($i.file_name | sub("\\.png$"; "")), class: "thing", score: 0.5, size: [$i.height, $i.width],
		box: [$x, $y, $x + $w, $y + $h]}' coco.json >boxes.jsonl
}

setup() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	cd "$BATS_FILE_TMPDIR"
	out=$BATS_TEST_TMPDIR/out
}

propose() { "$BIN/pseudomask-propose" --weights weights "$@" scene; }

# fails STATUS MESSAGE ARGUMENT...: this message alone, and no file left.
fails() {
	local status_expected=$1 message=$2
	shift 2
	run "$BIN/pseudomask-propose" -o "$out" "$@"
	[ "$status" = "$status_expected" ] && [ "${lines[0]}" = "pseudomask-propose: $message" ] && [ ! -e "$out" ] ||
		{ echo "$status: $output"; return 1; }
}

@test "help and version" {
	run "$BIN/pseudomask-propose" --help
	[ "$status" -eq 0 ]
	[[ "${lines[0]}" == "Usage: pseudomask-propose [OPTION]... SCENE" && "$output" == *"--boxes FILE"* ]]
	run "$BIN/pseudomask-propose" -V
	[[ "$status" -eq 0 && "$output" == "pseudomask-propose (refersplat) "* ]]
}

@test "usage errors" {
	fails 2 "unknown option '--nonsense'" --nonsense
	fails 2 "--weights WEIGHTS is required" scene
	fails 2 "--most: '0' is not a whole number from 1 to 10000" --weights weights --most 0 scene
}

@test "things are found by photographs, and better by boxes" {
	score() { "$BIN/miou-score" --best --json --predicted-views --truth truth.jsonl - | jq ".miou * 100 | floor"; }
	alone=$(propose --split all | score)
	boxes=$(propose --split all --boxes boxes.jsonl | score)
	apart=$(propose --split all --boxes boxes.jsonl --disjoint | score)
	echo "$alone $boxes $apart"
	[ "$alone" -ge 65 ] && [ "$boxes" -gt "$alone" ] && [ "$boxes" -ge 80 ] && [ "$apart" -ge 75 ]
}

@test "there are no more than --most" {
	propose --boxes boxes.jsonl --disjoint --most 5 -o "$out"
	[ "$(jq -r .object "$out" | sort -u | wc -l)" -le 5 ]
	"$BIN/gs-check" "$out"
}

@test "the same bytes for any number of threads, and by -" {
	propose --boxes boxes.jsonl --threads 1 -o "$out"
	propose --boxes boxes.jsonl --threads 3 | cmp - "$out"
	propose --boxes - <boxes.jsonl | cmp - "$out"
	propose --boxes <(shuf --random-source=boxes.jsonl boxes.jsonl) | jq -c 'del(.score)' | cmp - <(jq -c 'del(.score)' "$out")
}

@test "views for testing are rendered, and not learned from" {
	propose --split train -o "$out"
	propose --split all -o "$out.all"
	propose --split test -o "$out.test"
	sort "$out" "$out.test" | cmp - <(sort "$out.all")
	[ "$(jq -r .view "$out.test" | sort -u | tr '\n' ',')" = "$(tr ',' '\n' <test-views | sort -u | tr '\n' ',')" ]
}

@test "what is wrong with the input" {
	fails 3 "bare: no training view has a photograph: import the scene with --images" --weights weights bare
	fails 4 "none: has no weights of a training view" --weights none scene
	jq -c '.view = "other"' boxes.jsonl >"$BATS_TEST_TMPDIR/other.jsonl"
	fails 3 "$BATS_TEST_TMPDIR/other.jsonl: no box is of a training view of scene; views are called there as in its cameras.json" \
		--weights weights --boxes "$BATS_TEST_TMPDIR/other.jsonl" scene
	echo '{"view":"view_000","size":[10,10],"box":[5,5,5,6]}' >"$BATS_TEST_TMPDIR/empty.jsonl"
	fails 3 "$BATS_TEST_TMPDIR/empty.jsonl:1: key 'box' is not [left,top,right,bottom] of a part of the picture" \
		--weights weights --boxes "$BATS_TEST_TMPDIR/empty.jsonl" scene
}
