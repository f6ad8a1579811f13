#!/usr/bin/env bash
# Tries the tools on real scenes and checks what comes out against what is known of them. Ends with "N passed, N failed".
# usage: real.sh DATA BUILD ENCODER [ITERATIONS]
set -u
data=$1 build=$2 encoder=$3 iterations=${4:-3000}
desk=$data/desk
out=$build/desk-short
bin=$build/bin
export OMP_WAIT_POLICY=passive
passed=0 failed=0

# check NAME COMMAND...: one test; what it prints is shown when it fails.
check() {
	local name=$1 said
	shift
	if said=$("$@" 2>&1); then
		passed=$((passed + 1))
		echo "ok: $name${said:+ ($(echo "$said" | tail -n 1))}"
	else
		failed=$((failed + 1))
		printf 'FAILED: %s\n%s\n' "$name" "$said"
	fi
}

# within VALUE LOW HIGH
within() {
	echo "$1"
	awk -v x="$1" -v low="$2" -v high="$3" 'BEGIN { exit !(x >= low && x <= high) }'
}

# score FILE: its mIoU in percent, on the views that it has predictions of.
score() {
	"$bin/miou-score" --json --quiet --predicted-views --truth "$desk/truth.jsonl" "$1" | jq '100 * .miou'
}

# selected METHOD LOW HIGH: quality of the masks that a method selects in the labelled training views.
selected() {
	"$bin/pseudomask-select" --method "$1" "$desk/candidates.jsonl" >"$out/$1.jsonl" &&
		within "$(score "$out/$1.jsonl")" "$2" "$3"
}

# same_cameras FILE: those of the import are COLMAP's binary ones to 1e-6.
same_cameras() {
	"$bin/gs-import" -q --cameras "$1" -o "$out/other" "$desk/point_cloud.ply" || return 1
	paste <(jq -c 'sort_by(.name)[] | [.world_to_camera, .fx, .fy, .cx, .cy] | flatten[]' "$out/other/cameras.json") \
		<(jq -c 'sort_by(.name)[] | [.world_to_camera, .fx, .fy, .cx, .cy] | flatten[]' "$out/scene/cameras.json") |
		awk '{ d = $1 - $2; if (d < 0) d = -d; if (d > worst) worst = d } END { print "largest difference", worst; exit !(NR > 0 && worst < 1e-6) }'
}

# The scene's cameras as nerfstudio and as COLMAP's text have them.
other_cameras() {
	mkdir -p "$out/text"
	jq '{frames: map(.world_to_camera as $m | {file_path: "\(.name).jpg", w: .width, h: .height, fl_x: .fx, fl_y: .fy, cx, cy, transform_matrix:
		([range(3) as $r | [range(3) as $c | $m[$c][$r] * (if $c == 0 then 1 else -1 end)] + [-([range(3) as $k | $m[$k][$r] * $m[$k][3]] | add)]] +
		[[0, 0, 0, 1]])})}' "$out/scene/cameras.json" >"$out/transforms.json"
	jq -r 'to_entries[] | "\(.key + 1) PINHOLE \(.value.width) \(.value.height) \(.value.fx) \(.value.fy) \(.value.cx) \(.value.cy)"' \
		"$out/scene/cameras.json" >"$out/text/cameras.txt"
	jq -r 'def half(x): if x < 0 then 0 else x | sqrt / 2 end; def signed(a; x): if x < 0 then -a else a end; to_entries[] | .value.world_to_camera as $m |
		[half(1 + $m[0][0] + $m[1][1] + $m[2][2]), signed(half(1 + $m[0][0] - $m[1][1] - $m[2][2]); $m[2][1] - $m[1][2]),
		signed(half(1 - $m[0][0] + $m[1][1] - $m[2][2]); $m[0][2] - $m[2][0]), signed(half(1 - $m[0][0] - $m[1][1] + $m[2][2]); $m[1][0] - $m[0][1])] as $q |
		"\(.key + 1) \($q | join(" ")) \($m[0][3]) \($m[1][3]) \($m[2][3]) \(.key + 1) \(.value.name).jpg\n"' \
		"$out/scene/cameras.json" >"$out/text/images.txt"
}

cup() {
	head -c 100 "$data/cup/sparse/0/cameras.bin" >/dev/null || return 1
	"$bin/gs-import" -v --cameras "$data/cup/sparse/0" --images "$data/cup/images" --test-views every:8 -o "$out/cup" \
		"$desk/point_cloud.ply" && [ "$(jq length "$out/cup/cameras.json")" = 77 ]
}

# The truth through another layout: IoU with ours, in the mean, at least LEAST. layout LEAST OPERAND...
layout() {
	local least=$1
	shift
	"$bin/mask-import" -q -o "$out/layout.jsonl" "$@" || return 1
	within "$("$bin/miou-score" --json --quiet --truth "$desk/truth.jsonl" "$out/layout.jsonl" |
		jq 'if .missing == 0 and .pairs == 66 then .miou else 0 end')" "$least" 1
}

layouts() {
	rm -rf "$out/tree"
	"$bin/mask-export" --png "$out/tree" -o "$out/coco.json" "$desk/truth.jsonl"
}

# As if the photographs had been taken through a lens: the truth drawn on them, and undistorted again.
lens() {
	mkdir -p "$out/bent"
	jq 'map(.lens = {model: "OPENCV", width, height, parameters: [.fx, .fy, .cx, .cy, -0.2, 0.05, 0.002, -0.001]})' \
		"$out/scene/cameras.json" >"$out/bent/cameras.json"
	"$bin/mask-export" --distort --scene "$out/bent" -o "$out/bent.json" "$desk/truth.jsonl" &&
		layout 0.98 --undistort "$out/bent" "$out/bent.json"
}

# What IoU the best of a detector's boxes has with each true mask's, in the mean, of OPTION...; where the detector's weights are there. detected LEAST OPTION...
detected() {
	local least=$1
	shift
	[ -e "${XDG_CACHE_HOME:-$HOME/.cache}/refersplat/detector/model.safetensors" ] || { echo "not tried: 'make detector' fetches the weights"; return; }
	"$bin/box-detect" -q "$@" -o "$out/boxes.jsonl" --scene "$out/scene" && "$bin/gs-check" "$out/boxes.jsonl" || return 1
	within "$(jq -n --slurpfile boxes "$out/boxes.jsonl" --slurpfile coco "$out/coco.json" '
		($boxes | group_by(.view) | map({(.[0].view): map(.box)}) | add) as $of | ($coco[0].images | INDEX(.id)) as $images | [$coco[0].annotations[] |
		.bbox as [$x, $y, $w, $h] | [$of[$images["\(.image_id)"].file_name | sub("[.][^.]*$"; "")][] | . as [$l, $t, $r, $b] |
			([([$r, $x + $w] | min) - ([$l, $x] | max), 0] | max) * ([([$b, $y + $h] | min) - ([$t, $y] | max), 0] | max) |
			. / (($r - $l) * ($b - $t) + $w * $h - .)] | max] | add / length')" "$least" 1
}

mkdir -p "$out"
check "the whole workflow, $iterations steps a stage" make --no-print-directory -f pipelines/desk.mk DATA="$desk" OUT="$out" \
	ITERATIONS="$iterations" BERT="$encoder" BIN="$bin"
check "confidence-weighted IoU selects as known (72 +- 2)" selected ciou 70 74
check "IoU selects as known (66 +- 2)" selected iou 64 68
check "top-1 selects as known (44 +- 2)" selected top1 42 46
check "cameras in other formats" other_cameras
check "cameras.json has COLMAP's cameras" same_cameras "$desk/cameras.json"
check "transforms.json has the same" same_cameras "$out/transforms.json"
check "COLMAP's text has the same" same_cameras "$out/text"
check "the truth as COCO's JSON and as pictures" layouts
check "COCO's JSON has the same truth" layout 1 "$out/coco.json"
check "a folder of pictures has the same truth" layout 1 "$out/tree"
check "Ref-LERF's layout has the same truth" layout 1 "$desk"/ref-lerf/json/*.json
check "LERF-OVS's layout has the same truth, as polygons (IoU over 0.97)" layout 0.97 "$desk"/lerf-ovs/*.json
check "masks drawn through a lens are the pinhole's (IoU over 0.98)" lens
check "each thing is in a detector's box (IoU over 0.86)" detected 0.86
check "and closer in one of a part of a photograph (over 0.9)" detected 0.9 --crops
check "77 views of a COLMAP model with SIMPLE_PINHOLE cameras" cup
check "weights agree with the float64 twin on the desk" env REFER_SCENE="$out/scene" "$build/unit/test_render"
check "the encoder agrees with the published vector" env REFER_BERT="$encoder" "$build/unit/test_bert"
check "everything made is well-formed" "$bin/gs-check" "$out/scene" "$out/text.safetensors" "$out/stage2/model.safetensors" \
	"$out/stage2/predictions.test.jsonl"
check "stage 1 finds training sentences in new views (mIoU over 25)" \
	within "$(score "$out/stage1/predictions.train.jsonl")" 25 100
check "stage 2 too" within "$(score "$out/stage2/predictions.train.jsonl")" 25 100
check "the workflow without training" make --no-print-directory -f pipelines/desk.mk lift DATA="$desk" OUT="$out-lift" \
	BERT="$encoder" BIN="$bin"
check "selection in 3D (masks' mIoU over 90)" within "$(score "$out-lift/lifted/masks.jsonl")" 90 100
check "lifted objects are found by test sentences (mIoU over 87)" \
	within "$(score "$out-lift/lifted/predictions.test.jsonl")" 87 100
check "and by relations alone (mIoU over 79)" within "$(score "$out-lift/lifted/asked.jsonl")" 79 100
pipelines/report.sh "$out"
pipelines/report.sh "$out-lift"
echo "$passed passed, $failed failed"
[ $failed = 0 ] && [ $passed != 0 ]
