#!/usr/bin/env bats
# Labels of other programs, as formats/records/annotations.md has them, by mask-import. Pictures are in mask-import.bats.

setup() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	load files
	load ../cli/pictures
	cd "$BATS_TEST_TMPDIR"
	picture view_1.png 'ff0000 0000ff 0000ff 000000' 'ff0000 0000ff 0000ff 000000' 'ff0000 ff0000 000000 ffffff'
	printf '#ff0000 red cup\n#0000FF\t kettle \n\n' >names
}

# made FILE...: the records of labels, a line each: view, object, and the mask's rows.
made() {
	"$BIN/mask-import" -o made.jsonl "$@" 2>err
	"$BIN/gs-check" made.jsonl >/dev/null
	"$BIN/miou-score" --json --truth truth.jsonl made.jsonl | jq -e '.miou == 1 and .missing == 0' >/dev/null
}

@test "LabelMe: polygons, rectangles and circles, shapes of one label together" {
	labelme '{"label":"cup","points":[[1,1],[3,1],[3,3],[1,3]],"shape_type":"polygon","group_id":null}' \
		'{"label":"box","points":[[6,4],[4,2]],"shape_type":"rectangle"}' '{"label":"cup","points":[[4.4,0],[6,0],[6,1]]}' >a.json
	# cup: columns 1 and 2, rows 1 and 2; and the two pixels at the upper right whose middles are inside. box: the lower right.
	printf '%s\n' '{"view":"view_1","object":"cup","segmentation":{"size":[4,6],"counts":[5,2,2,2,9,1,3]}}' \
		'{"view":"view_1","object":"box","segmentation":{"size":[4,6],"counts":[18,2,2,2]}}' >truth.jsonl
	made a.json
	[ "$(jq -r '[.view, .object] | join(" ")' made.jsonl)" = $'view_1 cup\nview_1 box' ]
	[ "$(cat err)" = "mask-import: warning: a.json: 2 shapes are 'cup' in view view_1, and are taken as one thing" ]
	labelme '{"label":"dot","points":[[3,2],[3,3.1]],"shape_type":"circle"}' '{"label":"line","points":[[0,0],[1,1]],"shape_type":"line"}' >b.json
	echo '{"view":"view_1","object":"dot","segmentation":{"size":[4,6],"counts":[9,2,2,2,9]}}' >truth.jsonl
	made b.json
	[ "$(cat err)" = "mask-import: warning: b.json: 1 shapes of type 'line' are left out" ]
}

@test "LabelMe's masks: a PNG of their box" {
	kind=0800 picture m.png 'ff 00' 'ff ff'
	mask() { labelme "{\"label\":\"cup\",\"points\":[$1],\"shape_type\":\"mask\",\"mask\":\"$(base64 -w0 m.png)\"}" >m.json; }
	mask '[3.2,1.7],[4,2]'
	echo '{"view":"view_1","object":"cup","segmentation":{"size":[4,6],"counts":[13,2,3,1,5]}}' >truth.jsonl
	made m.json
	mask '[3,1],[5,3]' # a box that is measured in another way
	made m.json
	for points in '[3,1],[6,2]' '[5,1],[6,2]' '[-1,1],[0,2]'; do
		mask "$points"
		says_like 3 "mask-import: m.json: shape 0: its mask is 2x2, but its points are " "$BIN/mask-import" -o none m.json
	done
}

@test "COCO: polygons, compressed and plain run lengths, of several pictures" {
	jq -n '{images: [{id: 5, file_name: "a/view_1.png", height: 3, width: 4}, {id: 6, file_name: "view_2.png", height: 3, width: 4}],
		categories: [{id: 1, name: "red cup"}, {id: 2, name: "kettle"}], annotations: [
		{image_id: 5, category_id: 1, segmentation: [[0, 0, 1, 0, 1, 3, 0, 3], [1, 2, 2, 2, 2, 3, 1, 3]]},
		{image_id: 5, category_id: 2, iscrowd: 1, segmentation: {size: [3, 4], counts: [3, 2, 1, 2, 4]}},
		{image_id: 6, category_id: 2, segmentation: {size: [3, 4], counts: "REPLACED"}}, {image_id: 6, category_id: 1, segmentation: []}]}' >coco.json
	printf '%s\n' '{"view":"view_1","object":"red cup","segmentation":{"size":[3,4],"counts":[0,3,2,1,6]}}' \
		'{"view":"view_1","object":"kettle","segmentation":{"size":[3,4],"counts":[3,2,1,2,4]}}' >truth.jsonl
	jq '.annotations |= .[:2]' coco.json >first.json
	made first.json
	[ ! -s err ]
	# the string that we write ourselves, which the format's own tests hold against pycocotools
	sed -i "s/REPLACED/$(jq -r 'select(.object == "kettle").segmentation.counts' made.jsonl)/" coco.json
	echo '{"view":"view_2","object":"kettle","segmentation":{"size":[3,4],"counts":[3,2,1,2,4]}}' >>truth.jsonl
	made coco.json
	[ "$(cat err)" = "mask-import: warning: coco.json: 1 annotations without an outline are left out" ]
	# a picture and labels together
	"$BIN/mask-import" --names names -o both view_1.png first.json
	[ "$(jq -s length both)" = 4 ]
}

@test "COCO: run lengths along rows, numbers that two have, labels with blanks, pictures without a name" {
	jq -n '{images: [{id: 5, file_name: "view_1.png", height: 6, width: 8}], categories: [{id: 1, name: " cup "}],
		annotations: [{image_id: 5, category_id: 1, segmentation: {size: [6, 8], counts: [8, 3, 3, 3, 3, 3, 25]}}]}' >columns.json
	jq '.images[0] += {height: 12, width: 20} | .annotations[0].segmentation = {size: [12, 20], counts: [42, 4, 16, 4, 16, 4, 16, 4, 16, 4, 16, 4, 94]}' columns.json >rows.json
	says 3 "mask-import: rows.json: annotation 0: its run lengths go along rows, as its shape shows; COCO's go down columns: encode the transposed mask (in NumPy order='F')" "$BIN/mask-import" -o none rows.json
	jq -c '{view: "v", object: "cup", segmentation: .annotations[0].segmentation}' rows.json >rows.jsonl
	says 3 "mask-import: rows.jsonl:1: its run lengths go along rows, as its shape shows; COCO's go down columns: encode the transposed mask (in NumPy order='F')" "$BIN/mask-import" -o none rows.jsonl
	for box in '[1, 2, 3, 3]' '[1, 2, 4, 5]'; do
		jq ".annotations[0].bbox = $box" columns.json >boxed.json
		"$BIN/mask-import" -o made.jsonl boxed.json
		[ "$(jq -r .object made.jsonl)" = cup ]
	done
	for ids in '.images[0].id = "5"' '.annotations[0].category_id = "1"' '.images[0].id = "a-b" | .annotations[0].image_id = "a-b"'; do
		jq "$ids" columns.json >text.json
		"$BIN/mask-import" text.json | cmp - made.jsonl
	done
	jq '.images += [{id: 5, file_name: "view_2.png", height: 6, width: 8}]' columns.json >twice.json
	says 3 "mask-import: twice.json: annotation 0: two of the file's images have its 'image_id', 5" "$BIN/mask-import" -o none twice.json
	jq '.categories += [{id: 1, name: "pot"}]' columns.json >twice.json
	says 3 "mask-import: twice.json: annotation 0: two of the file's categories have its 'category_id', 1" "$BIN/mask-import" -o none twice.json
	jq '.images[0].file_name = "a/"' columns.json >none.json
	says 3 "mask-import: none.json: image 0: key 'file_name' has no name: 'a/'" "$BIN/mask-import" -o none none.json
	[ ! -e none ]
}

# coco SEGMENTATION: a COCO file of one label in a picture of 20 by 12 pixels, on stdout.
coco() {
	jq -n --argjson s "$1" '{images: [{id: 1, file_name: "a.png", height: 12, width: 20}], categories: [{id: 1, name: "cup"}],
		annotations: [{image_id: 1, category_id: 1, segmentation: $s, bbox: [2, 2, 4, 6]}]}'
}

@test "things of one label that a file numbers are errors; parts of one are not" {
	local shape='"label":"cup","points":[[1,1],[3,1],[3,3],[1,3]]' two="'cup' is here two things, numbers 1 and 2 of their group or track: things that are alike need labels of their own, as 'cup 1' and 'cup 2'"
	labelme "{$shape,\"group_id\":1}" "{$shape,\"group_id\":2}" >a.json
	says 3 "mask-import: a.json: shape 1: $two" "$BIN/mask-import" -o none a.json
	coco '[[2,2,6,2,6,8,2,8]]' | jq '.annotations[0].attributes.track_id = 1 | .annotations += [.annotations[0] | .attributes.track_id = 2]' >b.json
	says 3 "mask-import: b.json: annotation 1: $two" "$BIN/mask-import" -o none b.json
	jq '.annotations |= map(.score = 0.5)' b.json >c.json
	[ "$("$BIN/mask-import" c.json | wc -l)" = 2 ]
	for group in 1 null '"a"'; do
		labelme "{$shape,\"group_id\":1}" "{$shape,\"group_id\":$group}" "{${shape/cup/bg},\"group_id\":1}" "{${shape/cup/bg},\"group_id\":2}" >a.json
		[ "$("$BIN/mask-import" -q a.json | wc -l)" = 1 ]
	done
}

@test "labels of another picture's size, in shares, or nested are errors; what has no area is named" {
	wrong() {
		coco "$1" >x.json
		says 3 "mask-import: x.json: annotation 0: $2" "$BIN/mask-import" -o none x.json
		[ ! -e none ]
	}
	wrong '[[2,2,6,2,6,8,2,8],[30,2,32,2,32,4]]' "its point 30,2 is outside the picture, 20x12 (width x height): is it of a picture of another size?"
	wrong '[[2,2,6,2,6,14]]' "its point 6,14 is outside the picture, 20x12 (width x height): is it of a picture of another size?"
	wrong '[[0.1,0.1,0.9,0.1,0.9,0.9]]' "all its points are within one pixel of the picture, 20x12: are they shares of it, not pixels?"
	wrong '[[[2,2,6,2,6,8]]]' "a point is not two numbers, but a list of more: is the outline nested too deep?"
	wrong '[[[[2,2],[6,2],[6,8]]]]' "a point is not two numbers, but a list of more: is the outline nested too deep?"
	wrong '{"size":[20,12],"counts":[0,240]}' "key 'segmentation.size' is 12x20, but its picture is 20x12 (width x height): height and width are exchanged in one of them"
	wrong '{"size":[10,24],"counts":[0,240]}' "key 'segmentation.size' is 24x10, but its picture is 20x12 (width x height)"
	wrong '{"counts":[0,240]}' "key 'segmentation.size' is not [height,width]"
	# a little beside the picture is at its edge
	coco '[[-1,-1,21,-1,21,13,-1,13]]' >x.json
	"$BIN/mask-import" x.json | "$BIN/mask-export" | jq -e '.annotations[0].area == 240'
	gone() {
		coco "$1" >x.json
		says 3 "mask-import: warning: x.json: 1 $2 are left out
mask-import: x.json: has no label with an area" "$BIN/mask-import" -o none x.json
	}
	for box in '[12, 1, 6, 4]' '[12, 1, 18, 5]'; do
		coco '[[1,12,1,18,5,18,5,12]]' | jq ".annotations[0].bbox = $box" >x.json
		says 3 "mask-import: x.json: annotation 0: its points have y before x, as its 'bbox' shows: they go [x,y,x,y, ...]" "$BIN/mask-import" -o none x.json
	done
	gone '[[2,2,6,8]]' "outlines of fewer than three corners"
	gone '[[2,2,2.2,2,2.2,2.2]]' "shapes without a pixel"
	gone '[]' "boxes (key 'bbox') without an outline"
	gone '{"size":[12,20],"counts":[240]}' "shapes without a pixel"
}

@test "LabelMe's and X-AnyLabeling's other shapes: what has four corners is read, other types are named" {
	echo '{"view":"view_1","object":"box","segmentation":{"size":[4,6],"counts":[5,2,2,2,13]}}' >truth.jsonl
	for type in rotation quadrilateral oriented_rectangle rectangle; do
		labelme '{"label":"box","points":[[1,1],[3,1],[3,3],[1,3]],"shape_type":"'$type'"}' >a.json
		made a.json
	done
	# a turned one may reach out, others not
	labelme '{"label":"box","points":[[-3,2],[2,-3],[5,2],[2,7]],"shape_type":"rotation"}' >a.json
	"$BIN/mask-import" -o made.jsonl a.json
	sed -i s/rotation/quadrilateral/ a.json
	says 3 "mask-import: a.json: shape 0: its point -3,2 is outside the picture, 6x4 (width x height): is it of a picture of another size?" "$BIN/mask-import" a.json
	labelme '{"label":"a","points":[[1,1],[3,1],[3,3]],"shape_type":"cuboid"}' '{"label":"b","points":[[1,1],[3,1],[3,3]],"shape_type":"linestrip"}' \
		'{"label":"c","points":[[1,1],[3,1]],"shape_type":"linestrip"}' '{"label":"d","points":[[1,1],[3,3]],"shape_type":"rectangle"}' >a.json
	"$BIN/mask-import" -o made.jsonl a.json 2>err
	[ "$(cat err)" = "mask-import: warning: a.json: 1 shapes of type 'cuboid' are left out
mask-import: warning: a.json: 2 shapes of type 'linestrip' are left out" ]
	[ "$(jq -r .object made.jsonl)" = d ]
}

@test "the smaller outline lies on the larger, whatever their order; parts and second names stay" {
	shape() { printf '{"label":"%s","points":[[%s],[%s],[%s],[%s]]}' "$1" $2,$3 $4,$3 $4,$5 $2,$5; }
	pad=$(shape pad 0 0 6 4) mouse=$(shape mouse 1 1 3 3)
	areas() { "$BIN/mask-import" -q "$1" | "$BIN/mask-export" | jq -r '[.categories[].name, .annotations[].area | tostring] | join(" ")'; }
	labelme "$pad" "$mouse" >a.json && [ "$(areas a.json)" = "pad mouse 20 4" ]
	labelme "$mouse" "$pad" >a.json && [ "$(areas a.json)" = "mouse pad 4 20" ]
	# a cable of three pixels on the mouse on the pad
	labelme "$mouse" "$pad" "$(shape cable 2 0 3 3)" >a.json && [ "$(areas a.json)" = "mouse pad cable 2 19 3" ]
	for part in "wheel of the pad" "wheel of pad" "pad's wheel"; do
		labelme "$(shape "$part" 1 1 3 3)" "$pad" >a.json && [ "$(areas a.json)" = "$part pad 4 24" ]
	done
	labelme "$(shape "wheel of the pad" 1 1 3 3)" "$(shape 'red pad' 0 0 6 4)" >a.json && [ "$(areas a.json)" = "wheel of the pad red pad 4 24" ]
	labelme "$(shape cover 0 0 6 4)" "$pad" >a.json && [ "$(areas a.json)" = "cover pad 24 24" ]
	# COCO's outlines too, but not run lengths, nor what a detector found, nor ISAT's
	jq -n '{images: [{id: 1, file_name: "a.png", height: 4, width: 6}], categories: [{id: 1, name: "pad"}, {id: 2, name: "mouse"}],
		annotations: [{image_id: 1, category_id: 1, segmentation: [[0,0,6,0,6,4,0,4]]}, {image_id: 1, category_id: 2, segmentation: [[1,1,3,1,3,3,1,3]]}]}' >coco.json
	[ "$(areas coco.json)" = "pad mouse 20 4" ]
	jq '.annotations[].score = 0.5' coco.json >found.json && [ "$(areas found.json)" = "pad mouse 24 4" ]
	jq '.annotations[0].segmentation = {size: [4, 6], counts: [0, 24]}' coco.json >runs.json && [ "$(areas runs.json)" = "pad mouse 24 4" ]
	jq -n '{info: {name: "a.jpg", width: 6, height: 4}, objects: [{category: "pad", segmentation: [[0,0],[6,0],[6,4],[0,4]]}, {category: "mouse", segmentation: [[1,1],[3,1],[3,3],[1,3]]}]}' >isat.json
	[ "$(areas isat.json)" = "pad mouse 24 4" ]
}

@test "LabelMe's size of the picture is that of imageData, and has the shape of the photograph" {
	labelme '{"label":"cup","points":[[1,1],[3,1],[3,3]]}' | jq '.imagePath = "view_1.png"' >a.json
	picture held.png '000000 000000 000000 000000 000000 000000' '000000 000000 000000 000000 000000 000000'
	refuse() { says 3 "mask-import: a.json: imageWidth and imageHeight are 6x4, but $1: the labels are of another picture" "$BIN/mask-import" -o none a.json; }
	picture view_1.png '000000 000000 000000' '000000 000000 000000'
	"$BIN/mask-import" a.json >made.jsonl
	picture view_1.png '000000' '000000' '000000' '000000' '000000' '000000' '000000' '000000' '000000'
	refuse "./view_1.png is 1x9"
	jq --arg data "$(base64 -w0 held.png)" '.imageData = $data' a.json >b.json && mv b.json a.json
	refuse "the picture in imageData is 6x2"
	# a JPEG's header, of a picture that may be turned: 4 wide, 6 high
	printf '\xff\xd8\xff\xe0\x00\x03x\xff\xff\xc0\x00\x0b\x08\x00\x06\x00\x04\x01\x01\x11\x00' >turned.jpg
	jq --arg data "$(base64 -w0 turned.jpg)" '.imageData = $data' a.json >b.json && mv b.json a.json
	refuse "the picture in imageData is 4x6"
	jq '.imageData = null | .imagePath = "turned.jpg"' a.json >b.json
	"$BIN/mask-import" b.json >made.jsonl
}

@test "a detector's: each thing that it found by itself, with its score; COCO's with its sentence" {
	jq -n '{image_path: "photos/view_1.jpg", img_height: 3, img_width: 4, box_format: "xyxy", annotations: [
		{class_name: "red cup", bbox: [0, 0, 1, 3], segmentation: {size: [3, 4], counts: [0, 3, 9]}, score: [0.75]},
		{class_name: "red cup", bbox: [3, 0, 4, 3], segmentation: {size: [3, 4], counts: [9, 3]}, score: 0.5},
		{class_name: "box", bbox: [1, 1, 2, 2], segmentation: {size: [3, 4], counts: [4, 1, 7]}, score: [0.25]}]}' >found.json
	"$BIN/mask-import" -o made.jsonl found.json 2>err
	[ ! -s err ]
	"$BIN/gs-check" made.jsonl
	[ "$(jq -c '[.view, .ref, .object, .score]' made.jsonl)" = '["view_1",null,"red cup",0.75]
["view_1",null,"red cup",0.5]
["view_1",null,"box",0.25]' ]
	# what mask-export made of a detector's records comes back as they were
	jq -c '.ref = "r" + (.score | tostring)' made.jsonl >refs.jsonl
	"$BIN/mask-export" -o coco.json refs.jsonl
	"$BIN/mask-import" coco.json | jq -cS . | cmp - <(jq -cS . refs.jsonl)
	# labels and finds of one name stay apart
	jq 'del(.annotations[1].score)' found.json >mixed.json
	"$BIN/mask-import" mixed.json | jq -s -e 'map(.score) == [0.75, null, 0.25]'
}

@test "labels that are wrong: exit 3, where, and nothing is written" {
	bad() {
		says 3 "mask-import: bad.json: $1" "$BIN/mask-import" -o none bad.json
		[ ! -e none ]
	}
	labelme '{"label":"cup","points":[[1,1],[3,"x"],[3,3]]}' >bad.json && bad "shape 0: a point is not two numbers"
	labelme '{"label":"cup","points":[[1,1],[3],[3,3]]}' >bad.json && bad "shape 0: a point is not two numbers"
	labelme '{"points":[]}' >bad.json && bad "shape 0: key 'label' is missing"
	labelme '{"label":"","points":[[1,1],[3,1],[3,3]]}' >bad.json && bad "shape 0: the label is empty"
	labelme '{"label":"cup","points":[[1,1],[3,1]],"shape_type":"mask"}' >bad.json && bad "shape 0: key 'mask' is missing"
	labelme '{"label":"cup","points":[[1,1]],"shape_type":"mask","mask":""}' >bad.json && bad "shape 0: a mask without the two points of its box"
	labelme '{"label":"cup","points":[[1,1],[3,1]],"shape_type":"mask","mask":""}' >bad.json && bad "shape 0: PNG: the file ends too early"
	labelme | sed 's/"imageHeight":4/"imageHeight":0.5/' >bad.json && bad "imageHeight and imageWidth are no size of a picture"
	labelme | sed 's/"imageHeight":4/"imageHeight":65536/; s/"imageWidth":[0-9]*/"imageWidth":65535/' >bad.json
	bad "the picture: 65535x65536 pixels, more than 268435456 altogether"
	labelme | jq 'del(.imageWidth)' >bad.json && bad "key 'imageWidth' is missing"
	labelme >bad.json && bad "has no label with an area"
	jq -n '{images: [], categories: [], annotations: [{image_id: 1, category_id: 2}]}' >bad.json && bad "annotation 0: none of the file's 0 images has its 'image_id', 1: is the file whole?"
	jq -n '{images: [], annotations: null}' >bad.json && bad "has no label with an area"
	jq -n '{images: [], annotations: {}}' >bad.json && bad "key 'annotations' is not a list"
	labelme | jq '.shapes = null' >bad.json && bad "has no label with an area"
	jq -n '{images: [{id: 1, file_name: "a.png", height: 2, width: 2}], categories: [{id: 2, name: "a"}],
		annotations: [{image_id: 1, category_id: 2, segmentation: {size: [2, 2], counts: [1, 2]}}]}' >bad.json
	says_like 3 "mask-import: bad.json: annotation 0: " "$BIN/mask-import" -o none bad.json
	jq '.annotations[0].segmentation = {a: 1}' bad.json >worse.json && mv worse.json bad.json
	bad "annotation 0: key 'segmentation' is neither polygons nor run lengths"
	jq -n '{image_path: "a.png", img_height: 2, img_width: 2, annotations: [{class_name: "a", score: "high", segmentation: {size: [2, 2], counts: [1, 3]}}]}' >bad.json
	bad "annotation 0: key 'score' is not a finite number"
	jq -n '{image_path: "a.png", img_height: 2, img_width: 2, annotations: [{class_name: "a", score: 1, ref: "", segmentation: {size: [2, 2], counts: [1, 3]}}]}' >bad.json
	bad "annotation 0: key 'ref' is empty"
	jq -n '{image_path: "a.png", img_height: 2, annotations: [{class_name: "a", score: 1}]}' >bad.json && bad "annotation 0: key 'img_width' is missing"
	jq -n '{image_path: "a.png", annotations: [{score: 1}]}' >bad.json && bad "annotation 0: key 'class_name' is missing"
	echo '{}' >bad.json && bad "no labels: neither LabelMe's JSON (shapes) nor COCO's (annotations) nor ISAT's or Ref-LERF's (objects)"
	echo '{' >bad.json && bad "not JSON at offset 2"
	echo '{"frames":[]}' >bad.json && bad "cameras, a transforms.json: gs-import --cameras reads it"
}

@test "Ref-LERF: the pictures that its labels name, those of one category together" {
	mkdir json gt_mask
	picture gt_mask/a.png 'ffffff 000000 000000 000000' 'ffffff 000000 000000 000000' '000000 000000 000000 000000'
	picture gt_mask/b.png '000000 000000 000000 000000' '000000 000000 000000 000000' '000000 000000 000000 010000'
	for key in object objects; do
		jq -n --arg key $key '{info: {name: "view_7.jpg", width: 9, height: 9}, ($key): [{category: "cup", segmentation: "a.png", sentence: ["x"]},
			{category: "pen", segmentation: "b.png"}, {category: "cup", segmentation: "b.png"}]}' >json/view_7.json
		printf '%s\n' '{"view":"view_7","object":"cup","segmentation":{"size":[3,4],"counts":[0,2,9,1]}}' \
			'{"view":"view_7","object":"pen","segmentation":{"size":[3,4],"counts":[11,1]}}' >truth.jsonl
		made json/view_7.json
		[ "$(cat err)" = "mask-import: warning: json/view_7.json: 2 shapes are 'cup' in view view_7, and are taken as one thing" ]
	done
	for path in ../secret.png a/../../secret.png "$PWD/gt_mask/b.png"; do
		cp gt_mask/b.png secret.png
		jq --arg path "$path" '(.object[0] // .objects[0]).segmentation = $path' json/view_7.json >json/out.json
		says 3 "mask-import: json/out.json: object 0: key 'segmentation': '$path' is not in the folder gt_mask" \
			"$BIN/mask-import" -o none json/out.json
		[ ! -e none ]
	done
	rm gt_mask/b.png
	says 4 "mask-import: json/../gt_mask/b.png: No such file or directory" "$BIN/mask-import" -o none json/view_7.json
	jq 'del(.objects[1].category)' json/view_7.json >json/bad.json
	says 3 "mask-import: json/bad.json: object 1: key 'category' is missing" "$BIN/mask-import" -o none json/bad.json
}

@test "boxes of LERF-OVS's labels, a box for each shape of a category" {
	jq -n '{info: {name: "a.jpg", width: 9, height: 9}, objects: [
		{category: "cup", segmentation: [[1, 1], [3, 1], [3, 3]], bbox: [1, 1, 3, 3.5]},
		{category: "cup", segmentation: [[5, 5], [8, 5], [8, 8]], bbox: [8, 8, 5, 5]},
		{category: "pan", segmentation: [[1, 5], [3, 5], [3, 8]]}]}' >a.json
	"$BIN/mask-import" -q -o a.jsonl a.json
	[ "$(jq -c '[.object, .boxes]' a.jsonl | tr '\n' ' ')" = '["cup",[[1,1,3,3.5],[5,5,8,8]]] ["pan",null] ' ]
	# not where one of several shapes has none
	jq '.objects[1] |= del(.bbox)' a.json >b.json
	"$BIN/mask-import" -q b.json | jq -se 'all(.[]; has("boxes") | not)'
	jq '.objects[1].bbox = [1, 2, 3]' a.json >b.json
	run "$BIN/mask-import" -q b.json
	[ "$status" = 3 ]
	[[ $output == "mask-import: b.json: object 1: a point is not two numbers" ]]
	jq '.objects[1].bbox = [1, 2]' a.json >b.json
	run "$BIN/mask-import" -q b.json
	[[ $output == "mask-import: b.json: object 1: key 'bbox' is not two corners" ]]
}

# pictures of two shapes, the second wider and lower: one buffer is for both
@test "COCO: pictures of several shapes" {
	jq -n '{images: [{id: 1, file_name: "a.png", height: 40, width: 3}, {id: 2, file_name: "b.png", height: 3, width: 4000}], categories: [{id: 1, name: "o"}],
		annotations: [1, 2 | {image_id: ., category_id: 1, segmentation: [[0, 0, 3, 0, 3, 3, 0, 3]]}]}' >coco.json
	"$BIN/mask-import" -o masks coco.json
	[ "$(jq -c .segmentation.size masks)" = '[40,3]
[3,4000]' ]
}
