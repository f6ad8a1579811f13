#!/usr/bin/env bats
# mask-import on pictures of a few pixels. Options that every tool has are in common.bats.

setup() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	load ../format/files
	load pictures
	cd "$BATS_TEST_TMPDIR"
	# 4 wide, 3 high: red at the left, blue in the middle, black and a pixel of white
	picture view_1.png 'ff0000 0000ff 0000ff 000000' 'ff0000 0000ff 0000ff 000000' 'ff0000 ff0000 000000 ffffff'
	printf '#ff0000 red cup\n#0000FF\t kettle \n\n' >names
}

@test "a mask for each colour that has a name, with the view's name" {
	"$BIN/mask-import" --names names -o masks view_1.png
	"$BIN/gs-check" masks
	[ "$(jq -c '[.view, .object, .segmentation.size]' masks)" = '["view_1","red cup",[3,4]]
["view_1","kettle",[3,4]]' ]
	# down the columns: 3 red, blue blue red, blue blue black, black black white
	printf '{"view":"view_1","object":"red cup","segmentation":{"size":[3,4],"counts":[0,3,2,1,6]}}
{"view":"view_1","object":"kettle","segmentation":{"size":[3,4],"counts":[3,2,1,2,4]}}\n' >truth
	"$BIN/miou-score" --json --truth truth masks | jq -e '.miou == 1 and .pairs == 2'
}

@test "several pictures in order, stdin, stdout, and greys" {
	mkdir more
	picture more/frame.a.png '030303 0000ff'
	{ cat names; echo '3 plate'; } >all
	"$BIN/mask-import" --names all -o masks view_1.png more/frame.a.png
	[ "$(jq -r '.view + " " + .object' masks)" = "view_1 red cup
view_1 kettle
frame.a kettle
frame.a plate" ]
	"$BIN/mask-import" --names - view_1.png more/frame.a.png <all | cmp - masks
}

@test "numbers of 16 bits are numbers, what is transparent is nothing, and JPEG is refused" {
	kind=1000 picture map.png '0001 012c 0000 0100'
	printf '1 cup\n300 plate\n' >names
	says 0 "mask-import: warning: map.png: 256, 25.0% of it, has no name" "$BIN/mask-import" --names names -o masks map.png
	[ "$(jq -c .object masks)" = '"cup"
"plate"' ]
	printf '%s\n' '{"view":"map","object":"cup","segmentation":{"size":[1,4],"counts":[0,1,3]}}' \
		'{"view":"map","object":"plate","segmentation":{"size":[1,4],"counts":[1,1,2]}}' >truth
	"$BIN/miou-score" --json --truth truth masks | jq -e '.miou == 1 and .pairs == 2'
	mkdir -p tree/map
	kind=0806 picture map.png 'ff0000ff ff000000 ff000001 000000ff'
	echo '#ff0000 cup' >names
	cp map.png tree/map/cup.png
	echo '{"view":"map","object":"cup","path":"map.png"}' >path.jsonl
	head -n 1 truth >one
	for way in "--names names map.png" tree path.jsonl; do
		"$BIN/mask-import" -o masks $way
		"$BIN/miou-score" --json --truth one masks | jq -e '.miou == 1 and .pairs == 1'
	done
	printf '\xff\xd8\xff' >map.png
	says 3 "mask-import: map.png: a JPEG, whose colours are not quite those that were painted: save it as PNG" "$BIN/mask-import" --names names -o none map.png
}

@test "numbers that were scaled with mixing, so that others lie between them, are refused" {
	rows() { for ((i = 0; i < 40; i++)); do echo "000000 000000 $1 0a0a0a 0a0a0a"; done; }
	printf '5 cup\n10 plate\n' >names
	mapfile -t rows < <(rows 050505)
	picture a.png "${rows[@]}"
	says_like 3 "mask-import: a.png: at 33% of its edges are values between those on either side, some of them other labels: it was a JPEG" "$BIN/mask-import" --names names -o none a.png
	mapfile -t rows < <(rows 0a0a0a)
	picture a.png "${rows[@]}"
	[ "$("$BIN/mask-import" -q --names names a.png | wc -l)" = 1 ]
}

@test "what has no name, and a name that has no pixel, are told; -q is silent" {
	echo '7 plate' >names
	echo '#ff0000 cup' >>names
	says 0 "mask-import: warning: view_1.png: #0000ff, 33.3% of it, has no name
mask-import: warning: 'plate' is in no picture" "$BIN/mask-import" --names names -o masks view_1.png
	says 0 '' "$BIN/mask-import" -q --names names -o masks view_1.png
	[ "$(jq -r .object masks)" = cup ]
}

# refuses STATUS MESSAGE: so it ends, and nothing is left.
refuses() {
	says "$1" "mask-import: $2" "$BIN/mask-import" -q --names names -o none view_1.png && [ ! -e none ]
}

@test "pictures of one name in two folders: COCO's views are as gs-import names them, else an error" {
	mkdir -p a b
	cp view_1.png a && cp view_1.png b
	two() {
		local first=$1 second=$2
		says 3 "mask-import: $second: of view 'view_1', and so is $first, of another folder's picture: name pictures as their views are in the scene, or import them one by one" \
			"$BIN/mask-import" -q --names names -o none "$first" "$second"
		[ ! -e none ]
	}
	two a/view_1.png b/view_1.png
	labelme '{"label":"cup","points":[[1,1],[3,1],[3,3]]}' >a/1.json
	cp a/1.json a/2.json
	cp a/1.json b/1.json # of ../photos, which is the same for both
	"$BIN/mask-import" -o masks a/1.json a/2.json b/1.json 2>err
	grep -qx "mask-import: warning: a/2.json: of the picture of a/1.json, 'a/../photos/view_1.jpg': is that right, or was the file renamed?" err
	sed -i 's,\.\.\\\\photos\\\\,,' a/1.json b/1.json
	grep -q '"imagePath":"view_1.jpg"' a/1.json
	two a/1.json b/1.json
	jq -n '{images: ["left\\0.jpg", "right/0.jpg", "a/1.png"] | to_entries | map({id: .key, file_name: .value, height: 3, width: 4}), categories: [{id: 1, name: "cup"}],
		annotations: [0, 1, 2 | {image_id: ., category_id: 1, segmentation: [[0, 0, 4, 0, 4, 3, 0, 3]]}]}' >coco.json
	[ "$("$BIN/mask-import" coco.json | jq -r .view | tr '\n' ' ')" = "left_0 right_0 1 " ]
	jq '.images[2].file_name = "right/0.jpg"' coco.json >bad.json
	says 3 "mask-import: bad.json: images 1 and 2 have one file_name, 'right/0.jpg': their labels would be of one view" "$BIN/mask-import" bad.json
}

@test "COLMAP's names of masks: the photograph's name with its ending, and .png" {
	mkdir -p tree/v.JPG tree/w
	cp view_1.png v.jpg.png
	cp view_1.png tree/v.JPG/cup.png
	cp view_1.png tree/w/cup.png
	[ "$("$BIN/mask-import" -q --names names v.jpg.png | jq -r .view | sort -u)" = v ]
	[ "$("$BIN/mask-import" tree | jq -r .view | tr '\n' ' ')" = "v w " ]
	# two photographs of one name keep their endings, as in the scene
	cp -r tree/w tree/v.png
	[ "$("$BIN/mask-import" tree | jq -r .view | tr '\n' ' ')" = "v.JPG v.png w " ]
	cp view_1.png tree/w/0.jpg.png
	says 3 "mask-import: tree/w/0.jpg.png: the mask of a photograph, as COLMAP names them, not of a thing: give such pictures by themselves, with --names" "$BIN/mask-import" -o none tree
}

@test "names that are malformed: exact messages" {
	names() { printf "$1" >names; }
	names '#ff0000 cup\n#ff00 mug\n' && refuses 3 "names:2: does not begin with #rrggbb, R,G,B or 0 to 65535, and a blank or comma before the name"
	for bad in 'ff0000 cup' '65536 cup' '-1 cup' '#ff00001 cup' '3cup' '256,0,0 cup' 'cup'; do
		names "$bad" && refuses 3 "names:1: does not begin with #rrggbb, R,G,B or 0 to 65535, and a blank or comma before the name"
	done
	names '3 ,\n' && refuses 3 "names:1: the name is empty"
	names '3 caf\xe9\n' && refuses 3 "names:1: the name is not UTF-8 at byte 4"
	names '3 cup\n#030303 mug\n' && refuses 3 "names:2: its colour or number has a name already"
	names '3 cup\n4 cup\n' && refuses 3 "names:2: the name 'cup' has a colour already"
	names '\n# a comment' && refuses 3 "names: holds no names"
	names '9 cup\n' && refuses 3 "view_1.png: has none of the colours that have names"
}

@test "names as tables have them: commas, quotes, three numbers, comments" {
	for line in '#ff0000,red cup' '"#ff0000","red cup"' '#ff0000: red cup' '“#ff0000” “red cup”' '255,0,0,red cup' '255 0 0\tred cup\r' '# colours\n#ff0000;\xc2\xa0red cup '; do
		printf "$line\n" >names
		"$BIN/mask-import" -q --names names -o made.jsonl view_1.png
		[ "$(jq -r .object made.jsonl)" = "red cup" ]
	done
	printf '3 2 mugs\n5 2nd mug\n0000ff x\n' >names
	refuses 3 "names:3: does not begin with #rrggbb, R,G,B or 0 to 65535, and a blank or comma before the name"
	printf '7 2nd mug\n255 2 mugs\n' >names
	"$BIN/mask-import" -q --names names view_1.png | jq -e '.object == "2 mugs"'
}

@test "what is neither a PNG nor labels that are read: what it is, and the way out" {
	while IFS='|' read -r file text reason; do
		echo "$text" >"$file"
		says 3 "mask-import: $file: $reason" "$BIN/mask-import" -o none "$file"
	done <<-'END'
		a.xml|<annotations>|XML, as of CVAT or Pascal VOC: export the labels as COCO there
		a.txt|0 0.1 0.2|text, as YOLO's labels: export the labels as COCO there
		a.npy|x|an array of NumPy: save each thing's mask as a PNG, VIEW/NAME.png
		a.json|[{"image":"a.jpg","label":[]}]|an export of Label Studio: export the labels as COCO there
		a.json|{"description":"","tags":[],"size":{},"objects":[]}|labels of Supervisely: export the labels as COCO there
	END
	[ ! -e none ]
}

@test "pictures that are none, and outputs that are inputs" {
	says 4 "mask-import: gone.png: No such file or directory" "$BIN/mask-import" --names names -o none gone.png
	head -c 60 view_1.png >cut.png
	run "$BIN/mask-import" --names names -o none view_1.png cut.png
	[ "$status" = 3 ]
	[[ $output == "mask-import: cut.png: PNG: "* ]]
	[ ! -e none ]
	says 2 "mask-import: --names NAMES is required for pictures, which view_1.png is
Try 'mask-import --help'." "$BIN/mask-import" view_1.png
	says 2 "mask-import: -o names would overwrite --names names
Try 'mask-import --help'." "$BIN/mask-import" --names names -o names view_1.png
	says 2 "mask-import: -o ./view_1.png would overwrite picture view_1.png
Try 'mask-import --help'." "$BIN/mask-import" --names names -o ./view_1.png view_1.png
}

@test "paintings that were JPEGs: each pixel is of the nearest colour, but a map of labels is as it is" {
	local rows=() row x y
	for y in 0 1 2 3 4 5 6 7; do
		row=
		for x in 0 1 2 3 4 5 6 7 8 9; do
			row+=$(if ((x < 4)); then printf 'e6%02x%02x ' $((25 + y)) $((75 + x)); elif ((x > 8)); then printf '8080%02x ' $y; else printf '%02x00%02x ' $y $x; fi)
		done
		rows+=("$row")
	done
	picture lossy.png "${rows[@]}"
	printf '%s\n' '#e6194b cup' >names
	says 0 "mask-import: warning: lossy.png: 31 colours near those that have names, as of a JPEG or a soft brush: each pixel is taken for the nearest; save paintings without loss" \
		"$BIN/mask-import" --names names -o made.jsonl lossy.png
	"$BIN/mask-export" made.jsonl | jq -e '.annotations | length == 1 and .[0].bbox == [0, 0, 4, 8] and .[0].area == 32'
	picture labels.png "${rows[@]:0:6}"
	"$BIN/mask-import" -q --names names -o made.jsonl labels.png
	"$BIN/mask-export" made.jsonl | jq -e '.annotations[0].area == 1'
	kind=0800 picture grey.png '00 03 05 fb' '02 00 fe ff'
	echo '255 cup' >names
	"$BIN/mask-import" -q --names names -o made.jsonl grey.png
	[ "$(jq -c .segmentation made.jsonl)" = '{"size":[2,4],"counts":"53"}' ]
}

@test "masks that were JPEGs, and black ones on nothing" {
	kind=0800 picture grey.png '00 03 05 fb' '02 00 fe ff'
	kind=0806 picture black.png '00000000 00000000 00000000 000000ff' '00000000 00000000 000000ff 000000ff'
	picture two.png '000000 000300 050000 b40000' '000200 000000 fe00fe 00ffff'
	for file in grey black two; do
		echo "{\"view\":\"v\",\"object\":\"cup\",\"path\":\"$file.png\"}" >$file.jsonl
		"$BIN/mask-import" -o made.jsonl $file.jsonl
		[ "$(jq -c .segmentation made.jsonl)" = '{"size":[2,4],"counts":"53"}' ]
	done
	picture two.png 'ff0000 ffffff' 'fff0f0 ffffff'
	says 3 "mask-import: ./two.png: no pixel is black or transparent, so that all would be of the thing: paint black what is not" "$BIN/mask-import" two.jsonl
	picture two.png 'f0fff0 ffffff' 'fff0f0 ffffff'
	"$BIN/mask-import" two.jsonl | jq -e '.segmentation.counts == "04"'
}

@test "a folder of masks: views, names, and classes.txt" {
	mkdir -p tree/v2 tree/v1 tree/v1/deep
	picture tree/v1/cup.png 'ffffff 000000' '000000 000000'
	picture "tree/v1/a%2Fb%.png" '000000 010101' '000000 000000'
	picture tree/v2/cup.png '000000 000000' '000000 808080'
	picture tree/v2/black.png '000000 000000' '000000 000000'
	cp tree/v1/cup.png tree/v1/.hidden.png
	cp tree/v1/cup.png tree/stray.png
	echo text >tree/v1/notes.txt
	"$BIN/mask-import" -o masks tree
	[ "$(jq -c '[.view, .object]' masks)" = '["v1","a/b%"]
["v1","cup"]
["v2","cup"]' ]
	printf '%s\n' '{"view":"v1","object":"a/b%","segmentation":{"size":[2,2],"counts":[2,1,1]}}' '{"view":"v1","object":"cup","segmentation":{"size":[2,2],"counts":[0,1,3]}}' \
		'{"view":"v2","object":"cup","segmentation":{"size":[2,2],"counts":[3,1]}}' >truth.jsonl
	"$BIN/miou-score" --json --truth truth.jsonl masks | jq -e '.miou == 1 and .missing == 0 and .pairs == 3'
	# what mask-export writes is read back
	"$BIN/mask-export" --png again -o /dev/null masks
	"$BIN/mask-import" again | cmp - masks
	printf ' cup \r\nother\n' >tree/classes.txt
	"$BIN/mask-import" tree | jq -r .object | sort -u >names
	[ "$(cat names)" = cup ]
	echo plate >tree/classes.txt
	says 3 "mask-import: tree: has no masks VIEW/NAME.png of the names in classes.txt; give pictures of views, and labels, one by one" "$BIN/mask-import" -o none tree
	mkdir empty
	says 3 "mask-import: empty: has no masks VIEW/NAME.png; give pictures of views, and labels, one by one" "$BIN/mask-import" -o none empty
	rm tree/classes.txt
	echo broken >tree/v2/cup.png
	says_like 3 "mask-import: tree/v2/cup.png: " "$BIN/mask-import" -o none tree
	[ ! -e none ]
}

@test "a folder of masks by thing: as the scene's views or else numbers say; and CVAT's masks of classes" {
	mkdir -p by/cup by/mug by/v by/w
	picture by/cup/img_001.png 'ffffff 000000'
	cp by/cup/img_001.png by/mug/img_002.jpg.png
	says 0 "mask-import: warning: by: its folders are things and their pictures views, as their names say" "$BIN/mask-import" -o masks by
	[ "$(jq -r '.view + " " + .object' masks | tr '\n' ';')" = "img_001 cup;img_002 mug;" ]
	touch by/cup/img_003.jpg by/v/img_003.jpg
	says 0 "mask-import: warning: by: its folders are things and their pictures views, as their names say
mask-import: warning: by: 1 pictures that are no PNG are left out" "$BIN/mask-import" -o masks by
	mkdir -p jpegs && cp -r by/v jpegs
	says 3 "mask-import: jpegs: has no masks VIEW/NAME.png, but pictures of another kind: save masks as PNG; give pictures of views, and labels, one by one" "$BIN/mask-import" jpegs
	rm by/*/*.jpg
	mv by/cup/img_001.png by/cup/a.png && mv by/mug/img_002.jpg.png by/mug/b.png
	[ "$("$BIN/mask-import" -q by | jq -r .view | tr '\n' ' ')" = "cup mug " ]
	scene s
	printf '[%s,%s]' "$(view name='"a"' width=2 height=1)" "$(view name='"b"' width=2 height=1)" >s/cameras.json
	[ "$("$BIN/mask-import" -q --undistort s by | jq -r .view | tr '\n' ' ')" = "a b " ]
	# without a scene: a folder and its picture, and the view and the thing; none where it is either
	picture one.png 'ffffff 000000'
	while read -r path view thing; do
		rm -rf numbered
		mkdir -p "numbered/${path%/*}"
		cp one.png "numbered/$path.png"
		[ "$("$BIN/mask-import" -q numbered | jq -r '.view + " " + .object')" = "$view $thing" ] || [ "$view" = - ]
		[ "$view" != - ] || says 3 "mask-import: numbered: numbered folders of numbered pictures: --undistort SCENE tells, by the scene's views, which of them are things" "$BIN/mask-import" -o none numbered
	done <<-'END'
		obj_001/0001 0001 obj_001
		cup/1 1 cup
		mask3/12 12 mask3
		cup_001/frame_0001 frame_0001 cup_001
		IMG_0001/001 IMG_0001 001
		view_01/obj_001 view_01 obj_001
		0001/12 0001 12
		0/apple 0 apple
		0001/00001 -
		1/2 -
		garden_001/001 -
	END
	mkdir -p cvat/SegmentationClass cvat/SegmentationObject
	picture cvat/SegmentationClass/f.png '800000 008000' '000000 000000'
	cp cvat/SegmentationClass/f.png cvat/SegmentationObject
	says 3 "mask-import: cvat/SegmentationClass/f.png: its colours need --names NAMES, or CVAT's labelmap.txt beside its folder" "$BIN/mask-import" -o none cvat
	printf '# label:color_rgb:parts:actions\nbackground:0,0,0::\ncup:128,0,0::\nred mug:0,128,0:handle:\n' >cvat/labelmap.txt
	"$BIN/mask-import" -q -o masks cvat
	[ "$(jq -r '.view + " " + .object' masks | tr '\n' ';')" = "f cup;f red mug;" ]
}

@test "what is called background, __ignore__ or the like is no thing" {
	square() { echo "{\"label\":\"$1\",\"points\":[[$2,0],[$3,0],[$3,4],[$2,4]]}"; }
	labelme "$(square _background_ 0 6)" "$(square cup 1 3)" "$(square __ignore__ 4 5)" >a.json
	says 0 "mask-import: warning: 2 masks are left out, whose names say that they are of no thing, as 'background' does" "$BIN/mask-import" -o masks a.json
	[ "$(jq -r .object masks)" = cup ]
	printf '0 Unlabeled\n255,0,0 void\n#0000ff kettle' >names
	mkdir -p tree/v
	cp view_1.png tree/v/bg.png
	cp view_1.png tree/v/mug.png
	"$BIN/mask-import" -q --names names -o masks view_1.png tree
	[ "$(jq -r .object masks | tr '\n' ' ')" = "kettle mug " ]
	rm tree/v/mug.png
	says_like 3 "mask-import: tree: has no label with an area" "$BIN/mask-import" -q -o none tree
}

@test "mask records are written again" {
	cp view_1.png black.png
	printf '%s\n' '{"view":"v","ref":"r","object":"o","score":0.5,"visible":0.25,"segmentation":{"size":[3,4],"counts":[0,3,9]}}' '{"view":"v","object":"p","path":"black.png"}' >m.jsonl
	"$BIN/mask-import" -o again.jsonl m.jsonl
	[ "$(jq -c 'del(.segmentation)' again.jsonl)" = '{"view":"v","ref":"r","object":"o","score":0.5,"visible":0.25}
{"view":"v","object":"p"}' ]
	[ "$(jq -c .segmentation.size again.jsonl | sort -u)" = '[3,4]' ]
	echo '{"view":"v"}' >m.jsonl
	says_like 3 "mask-import: m.jsonl:1: " "$BIN/mask-import" -o none m.jsonl
	[ ! -e none ]
}
