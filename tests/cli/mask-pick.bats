#!/usr/bin/env bats
# mask-pick: the masks of a thing that is pointed at.

bats_require_minimum_version 1.5.0

setup_file() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	cd "$BATS_FILE_TMPDIR"
	"$BIN/gs-synth" -q --objects 3 --views 6 --size 96x72 --gaussians 3000 --seed 3 -o .
	"$BIN/gs-import" -q --images images --test-views "$(cat test-views)" -o scene point_cloud.ply
	"$BIN/gs-weigh" -q --packed --tolerance 0.05 -o weights scene
	"$BIN/mask-export" -o coco.json truth.jsonl
	jq -c '(.images | INDEX(.id)) as $of | .annotations[] | $of["\(.image_id)"] as $i | .bbox as [$x, $y, $w, $h] |
		{view: ($i.file_name | sub("\\.png$"; "")), size: [$i.height, $i.width], box: [$x, $y, $x + $w, $y + $h]}' coco.json >boxes.jsonl
	"$BIN/pseudomask-propose" --weights weights --boxes boxes.jsonl --regions regions.safetensors -o masks.jsonl scene
	# the first thing of the first view: its box, and the middle of that
	jq -c 'select(.view == "view_001")' boxes.jsonl | head -n 1 >first.json
}

setup() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	cd "$BATS_FILE_TMPDIR"
	out=$BATS_TEST_TMPDIR/out
	middle=$(jq -r '.box | "view_001:\((.[0] + .[2]) / 2 | floor),\((.[1] + .[3]) / 2 | floor)"' first.json)
	box=$(jq -r '.box | "view_001:\(map(tostring) | join(","))"' first.json)
}

pick() { "$BIN/mask-pick" --regions regions.safetensors --weights weights --name thing "$@" scene; }

# What the best thing of the truth has of the masks on stdin, in percent.
fit() { "$BIN/miou-score" -q --best --json --truth <(jq -c '.object = "thing"' "$out.true") - | jq '.miou * 100 | floor'; }

fails() {
	local expected=$1 message=$2
	shift 2
	run "$BIN/mask-pick" -o "$out" "$@"
	[ "$status" = "$expected" ] && [ "${lines[0]}" = "mask-pick: $message" ] && [ ! -e "$out" ] || { echo "$status: $output"; return 1; }
}

@test "help and version" {
	run "$BIN/mask-pick" --help
	[[ "$status" -eq 0 && "${lines[0]}" == "Usage: mask-pick [OPTION]... SCENE" ]]
	run "$BIN/mask-pick" -V
	[[ "$status" -eq 0 && "$output" == "mask-pick (refersplat) "* ]]
}

@test "a point and a box find the thing in all views, named and without a score" {
	jq -c --arg o "$(jq -r 'select(.view == "view_001").object' truth.jsonl | head -n 1)" 'select(.object == $o)' truth.jsonl >"$out.true"
	pick --point "$middle" -o "$out"
	[ "$(jq -sr 'map(.object) | unique | join(",")' "$out")" = thing ]
	jq -se 'all(.[]; has("score") | not) and (map(.view) | unique | length) == length' "$out"
	[ "$(fit <"$out")" -ge 60 ]
	[ "$(pick --box "$box" | fit)" -ge 60 ]
}

@test "larger and smaller, a place outside, several points" {
	area() { "$BIN/mask-export" - | jq '[.annotations[].area] | add'; }
	plain=$(pick --point "$middle" | area)
	[ "$(pick --point "$middle" --larger 2 | area)" -ge "$plain" ]
	[ "$(pick --point "$middle" --smaller 2 | area)" -le "$plain" ]
	[ "$(pick --point "$middle $middle" | area)" = "$plain" ]
	pick --point "$middle" --outside "$middle" 2>"$out" | area >"$out.area"
	[ "$(cat "$out.area")" = "$plain" ]
	grep -q '1 of 2 places are not as was asked' "$out"
}

@test "rendered and read views are nearly the same, and threads change no byte" {
	pick --point "$middle" -o "$out"
	pick --point "$middle" --threads 1 | cmp - "$out"
	"$BIN/mask-pick" --regions regions.safetensors --name thing --point "$middle" scene >"$out.rendered"
	[ "$(wc -l <"$out.rendered")" = "$(wc -l <"$out")" ]
}

@test "what is wrong with the command line and the input" {
	fails 2 "--regions FILE and --name NAME are required" --point "$middle" scene
	fails 2 "one of --point and --box says what is meant" --regions regions.safetensors --name x scene
	fails 2 "--outside, --larger and --smaller go with --point" --regions regions.safetensors --name x --box "$box" --larger 1 scene
	fails 2 "--point: no view 'other'" --regions regions.safetensors --name x --point other:1,1 scene
	fails 2 "--point: 'view_001:1' is not VIEW:x,y" --regions regions.safetensors --name x --point view_001:1 scene
	fails 2 "--point: ' ' is not VIEW:x,y" --regions regions.safetensors --name x --point ' ' scene
	for box in '' 'view_001:1,1,9,9 view_001:1,1,9,9'; do
		fails 2 "--box: '$box' is not VIEW:x0,y0,x1,y1" --regions regions.safetensors --name x --box "$box" scene
	done
	fails 2 "--point: 96 is outside of view 'view_001', which is 96x72" --regions regions.safetensors --name x --point view_001:96,1 scene
	fails 4 "none: No such file or directory" --regions none --name x --point "$middle" scene
}
