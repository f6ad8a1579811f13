#!/usr/bin/env bats
# Each rule of formats/records/detections.md broken once, and what it says of other detectors' files.

setup() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	load files
	cd "$BATS_TEST_TMPDIR"
	page=$BATS_TEST_DIRNAME/../../formats/records/detections.md
	good='"view":"v","size":[6,8],"box":[1,2,3,4]'
}

# refuses REASON LINE
refuses() {
	printf '%s\n' "{$good}" '' "$2" >x
	says 1 "x:3: $1" "$BIN/gs-check" x
}

@test "the example of the page, and what may be absent" {
	grep '^    {"view"' "$page" | cut -c5- >x
	says 0 'x: ok: detections, 1 boxes, 1 views, 1 classes' "$BIN/gs-check" x
	printf '%s\n' "{$good}" "{\"view\":\"w\",\"class\":null,\"score\":null,\"more\":1,\"size\":[6,8],\"box\":[-1,0.5,9,1e3]}" >x
	says 0 'x: ok: detections, 2 boxes, 2 views, 0 classes' "$BIN/gs-check" x
}

@test "each rule" {
	refuses "key 'view' is missing" '{"size":[6,8],"box":[1,2,3,4]}'
	refuses "key 'view' has a slash" '{"view":"a/b","size":[6,8],"box":[1,2,3,4]}'
	refuses "key 'class' is empty" "{\"class\":\"\",$good}"
	refuses "key 'score' is not a number" "{\"score\":\"1\",$good}"
	refuses "key 'score' is not within 0 to 1" "{\"score\":1.5,$good}"
	refuses "key 'size' is missing" '{"view":"v","box":[1,2,3,4]}'
	refuses "key 'size' is not 2 numbers" '{"view":"v","size":[6],"box":[1,2,3,4]}'
	refuses "key 'size' is not two whole numbers from 1 to 65536" '{"view":"v","size":[6.5,8],"box":[1,2,3,4]}'
	refuses "key 'size' is not two whole numbers from 1 to 65536" '{"view":"v","size":[0,8],"box":[1,2,3,4]}'
	refuses "key 'box' is missing" '{"view":"v","size":[6,8]}'
	refuses "key 'box' is not 4 numbers" '{"view":"v","size":[6,8],"box":[1,2,3]}'
	for box in 3,2,1,4 1,4,3,4 8,0,9,1 0,-2,3,0 0,7,3,9; do
		refuses "key 'box' is not [left,top,right,bottom] of a part of the picture" "{\"view\":\"v\",\"size\":[6,8],\"box\":[$box]}"
	done
	refuses 'not JSON at column 9' '{"view":x}'
}

# The command of the page that has this in it.
command_of() { awk -v text="$1" '/^    / { line = line substr($0, 5) "\n"; next } index(line, text) { printf "%s", line; line = ""; exit } { line = "" } END { printf "%s", index(line, text) ? line : "" }' "$page"; }

@test "COCO's results and YOLO's text files, as the page says" {
	echo '{"images":[{"id":7,"file_name":"left/a.b.jpg","width":8,"height":6}]}' >coco.json
	echo '[{"image_id":7,"category_id":1,"bbox":[1,2,3,1],"score":0.25}]' >results.json
	command_of results.json | bash -eu
	[ "$(cat boxes.jsonl)" = '{"view":"a.b","score":0.25,"size":[6,8],"box":[1,2,4,3]}' ]
	"$BIN/gs-check" boxes.jsonl
	mkdir labels
	echo '41 0.5 0.5 0.25 0.5 0.75' >labels/v7.txt
	command_of labels/ | bash -eu
	[ "$(cat boxes.jsonl)" = '{"view":"v7","score":0.75,"size":[728,986],"box":[369.75,182,616.25,546]}' ]
	"$BIN/gs-check" boxes.jsonl
}
