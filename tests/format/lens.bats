#!/usr/bin/env bats
# Lenses that distort, from camera files to masks. The formulae are in tests/unit/test_lens.c.

setup() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	load files
	load foreign
	load lens
	cd "$BATS_TEST_TMPDIR"
}

@test "the pinhole of each lens, the lens beside it, and the scene again" {
	made 64x48
	while read -r parameters; do
		bent $parameters
		"$BIN/gs-check" flat | grep -q '^flat: ok: scene, .*1500 gaussians, '
		[ "$(jq -r '.[3].lens | [.model, .parameters[]] | join(" ")' flat/cameras.json)" = "$parameters" ]
		jq -e --slurpfile plain plain/cameras.json 'map(.world_to_camera) == ($plain[0] | map(.world_to_camera))' flat/cameras.json
		jq -e 'all(.lens.width == 64 and .lens.height == 48 and .fx == .lens.parameters[0])' flat/cameras.json
	done <<-END
		SIMPLE_RADIAL 60 32 24 -0.125
		RADIAL 60 32 24 0.125 -0.03125
		OPENCV 60 61 31 24 -0.125 0.0625 0.001953125 -0.00390625
		OPENCV_FISHEYE 50 51 32 24 0.0625 -0.03125 0.0078125 0
		FULL_OPENCV 60 60 32 24 0.25 0.125 0.00390625 0 0.03125 0.375 0 0
		FOV 50 50 32 24 0.75
		SIMPLE_RADIAL_FISHEYE 50 32 24 0.0625
		RADIAL_FISHEYE 50 32 24 0.0625 0
		THIN_PRISM_FISHEYE 50 50 32 24 0.0625 0 0 0.00390625 0 0 0.001953125 0
		RAD_TAN_THIN_PRISM_FISHEYE 50 50 32 24 0.0625 0 0 0 0 0 0.00390625 0 0 0 0 0
		SIMPLE_DIVISION 60 32 24 -0.125
		DIVISION 60 60 32 24 -0.125
		SIMPLE_FISHEYE 50 32 24
		FISHEYE 50 51 32 24
		EUCM 50 50 32 24 0.5 1
	END
	# without a lens nothing is beside it
	jq -e 'all(has("lens") | not)' plain/cameras.json
}

@test "masks: to the photograph and back they are the same, for painted, labelled and recorded ones" {
	made 160x120
	bent OPENCV 150 152 79 61 -0.2 0.05 0.003 -0.002
	twin
	drawn made/truth.jsonl >drawn.jsonl
	# to the photograph's pinhole of another size, and to that of the same
	"$BIN/mask-import" --undistort twin -o back.jsonl drawn.jsonl
	iou made/truth.jsonl back.jsonl 0.9
	"$BIN/mask-import" --undistort flat -o flat.jsonl drawn.jsonl
	[ "$(jq -c .segmentation.size flat.jsonl | sort -u)" = "$(jq -c '.[0] | [.height, .width]' flat/cameras.json)" ]
	jq -c 'del(.segmentation)' drawn.jsonl | cmp - <(jq -c 'del(.segmentation)' flat.jsonl)
	# as COCO's JSON, and painted
	"$BIN/mask-import" -q --undistort flat -o coco.jsonl coco.json
	iou flat.jsonl coco.jsonl 1
	view=$(jq -r .view drawn.jsonl | head -n 1) object=$(jq -r .object drawn.jsonl | head -n 1)
	"$BIN/mask-export" --png tree -o /dev/null drawn.jsonl
	cp "tree/$view/$object.png" "$view.png"
	echo "255 $object" >names
	"$BIN/mask-import" --undistort flat --names names -o painted.jsonl "$view.png"
	head -n 1 flat.jsonl | jq -c '{view, object, segmentation}' | cmp - painted.jsonl
	# views without a lens stay
	"$BIN/mask-import" --undistort plain -o same.jsonl made/truth.jsonl
	cmp same.jsonl made/truth.jsonl
	"$BIN/mask-export" --distort --scene plain made/truth.jsonl | cmp - <("$BIN/mask-export" --scene plain made/truth.jsonl)
	# a mask of half the size is of the same photograph
	"$BIN/mask-export" -o half.json <(jq -c 'select(.object == "none")' drawn.jsonl; echo "{\"view\":\"$view\",\"object\":\"o\",\"segmentation\":{\"size\":[60,80],\"counts\":[0,4800]}}")
	"$BIN/mask-import" --undistort flat half.json | jq -e --slurpfile flat flat/cameras.json '.segmentation.size == ($flat[0][0] | [.height, .width])'
}

@test "what is lifted from masks on distorted photographs is what is lifted from those of the pinhole twin" {
	made 160x120
	bent OPENCV 150 152 79 61 -0.2 0.05 0.003 -0.002
	twin
	drawn made/truth.jsonl >drawn.jsonl
	"$BIN/mask-import" --undistort flat -o flat.jsonl drawn.jsonl
	"$BIN/text-encode" -q --model "$BATS_TEST_DIRNAME/../golden/bert" --names -o names.safetensors made/truth.jsonl
	for scene in plain flat; do
		masks=flat.jsonl
		[ $scene = flat ] || masks=made/truth.jsonl
		"$BIN/gs-weigh" -q -o $scene.weights $scene
		"$BIN/refer-lift" -q --scene $scene --weights $scene.weights --text names.safetensors --masks $masks -o $scene.model
		"$BIN/refer-render" -q --scene flat --text names.safetensors --model $scene.model --split all -o $scene.jsonl
	done
	iou plain.jsonl flat.jsonl 0.9
	iou flat.jsonl plain.jsonl 0.9
}

@test "photographs of a lens are compared as the view sees them" {
	made 160x120
	bent FOV 150 150 80 60 1
	twin
	# the largest mask of each view, white where its thing is dark, stands for its photograph, as the pinhole and as the lens has it
	jq -c -s 'group_by(.view)[] | max_by(.segmentation.counts | length) | .object = "thing"' made/truth.jsonl >thing.jsonl
	drawn thing.jsonl >drawn.jsonl
	for kind in thing drawn; do
		"$BIN/mask-export" --png $kind.tree -o /dev/null $kind.jsonl
		mkdir $kind
		for view in $kind.tree/*; do cp "$view/thing.png" "$kind/$(basename "$view").png"; done
	done
	"$BIN/gs-import" -v --images thing -o seen made/point_cloud.ply 2>straight
	"$BIN/gs-import" -v --undistort --cameras bent --images drawn -o seen made/point_cloud.ply 2>undone
	"$BIN/gs-import" -v --undistort --cameras bent --images thing -o seen made/point_cloud.ply 2>wrong
	mean() { sed -n 's/.*: resembles its photograph by //p' "$1" | awk '{ sum += $1 } END { print NR ? sum / NR : -1 }'; }
	echo "$(mean straight) $(mean undone) $(mean wrong)"
	awk -v a="$(mean straight)" -v b="$(mean undone)" -v c="$(mean wrong)" 'BEGIN { exit !(a < -0.1 && b < a + 0.03 && c > b + 0.04) }'
}

@test "masks that are not of the photographs" {
	made 64x48
	bent RADIAL 60 32 24 0.25 -0.03125
	size=$(jq -r '.[0] | "\(.height),\(.width)"' flat/cameras.json)
	record() { printf '{"view":"%s","object":"o","segmentation":{"size":[%s],"counts":[%d]}}\n' "$1" "$2" $((${2/,/*})); }
	pinhole=$(jq -r '.[0] | "\(.width)x\(.height)"' flat/cameras.json)
	record view_000 "$size" >m.jsonl
	says 3 "mask-import: m.jsonl:1: view 'view_000': a mask of $pinhole, but its photograph is 64x48: it is undistorted already" "$BIN/mask-import" --undistort flat -o out m.jsonl
	record view_000 48,70 >m.jsonl
	says 3 "mask-import: m.jsonl:1: view 'view_000': a mask of 70x48, but its photograph is 64x48 (width x height): the shapes differ, and nothing is stretched" "$BIN/mask-import" --undistort flat -o out m.jsonl
	says 3 "mask-export: m.jsonl: view 'view_000': a mask of 70x48, but its pinhole is $pinhole (width x height): the shapes differ, and nothing is stretched" "$BIN/mask-export" --distort --scene flat -o out m.jsonl
	record view_00 48,64 >m.jsonl
	says 3 "mask-import: m.jsonl:1: view 'view_00' is not in the scene; there are 10: view_000, view_001, view_002 ... view_009" "$BIN/mask-import" --undistort flat -o out m.jsonl
	"$BIN/mask-export" -o m.json m.jsonl
	jq '.annotations[0].segmentation.counts = [0,3072]' m.json >n.json
	says 3 "mask-import: n.json: view 'view_00' is not in the scene; there are 10: view_000, view_001, view_002 ... view_009" "$BIN/mask-import" --undistort flat -o out n.json
	[ ! -e out ]
	says 2 "mask-export: --distort needs --scene SCENE
Try 'mask-export --help'." "$BIN/mask-export" --distort m.jsonl
	says 4 "mask-import: none/cameras.json: No such file or directory" "$BIN/mask-import" --undistort none m.jsonl
}

@test "COLMAP's own undistorter, where it is: the same pinholes and masks" {
	type -P colmap >/dev/null || skip "colmap is not here"
	made 640x480
	mkdir -p bent masks
	cp made/sparse/0/points3D.txt bent
	cat >bent/cameras.txt <<-'END'
		1 SIMPLE_RADIAL 640 480 600 320 240 -0.15
		2 RADIAL 640 480 600 324 232 0.1 -0.03
		3 OPENCV 640 480 600 608 316 244 -0.2 0.05 0.003 -0.002
		4 OPENCV_FISHEYE 640 480 440 448 320 240 0.05 -0.02 0.004 -0.001
		5 FULL_OPENCV 640 480 600 604 320 240 0.3 0.1 0.002 -0.001 0.02 0.4 0.05 0.01
		6 FOV 640 480 480 484 320 240 0.8
		7 SIMPLE_RADIAL_FISHEYE 640 480 440 320 240 0.05
		8 RADIAL_FISHEYE 640 480 440 320 240 0.05 -0.01
		9 THIN_PRISM_FISHEYE 640 480 440 444 320 240 0.05 -0.02 0.001 0.002 0.003 -0.001 0.001 0.002
		10 SIMPLE_RADIAL 640 480 600 320 240 0.2
	END
	grep -v '^#' made/sparse/0/images.txt | grep . | awk '{ $9 = NR; print; print "" }' >bent/images.txt
	"$BIN/gs-import" --undistort --cameras bent -o flat made/point_cloud.ply
	# the largest mask of each view as its photograph
	jq -c -s 'group_by(.view)[] | max_by(.segmentation.counts | length) | .object = "thing"' made/truth.jsonl >drawn.jsonl
	"$BIN/mask-export" --png tree -o /dev/null drawn.jsonl
	for view in tree/*; do cp "$view/thing.png" "masks/$(basename "$view").png"; done
	export QT_QPA_PLATFORM=offscreen
	command colmap image_undistorter --image_path masks --input_path bent --output_path theirs >log 2>&1 || { cat log; false; }
	command colmap model_converter --input_path theirs/sparse --output_path theirs/sparse --output_type TXT >>log 2>&1
	"$BIN/gs-import" --cameras theirs/sparse -o theirs/scene made/point_cloud.ply
	for scene in flat theirs/scene; do
		jq -c '.[] | [.name, .width, .height, .fx, .fy, .cx, .cy | if type == "number" then . * 1e9 | round else . end]' $scene/cameras.json >$(basename $scene).cameras
	done
	cmp flat.cameras scene.cameras
	# their pictures are white where all that a pixel mixes is
	echo '255 thing' >names
	"$BIN/mask-import" -q --names names -o theirs.jsonl theirs/images/*.png
	"$BIN/mask-import" --undistort flat -o ours.jsonl drawn.jsonl
	iou theirs.jsonl ours.jsonl 0.93
}
