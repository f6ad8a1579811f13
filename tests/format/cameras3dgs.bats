#!/usr/bin/env bats
# Each rule of formats/cameras/cameras3dgs.md broken once.

setup() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	load files
	load foreign
	cd "$BATS_TEST_TMPDIR"
	splats_ply s.ply
}

import() {
	"$BIN/gs-import" --cameras cameras.json -o scene s.ply
}

# refused REASON KEY=VALUE...: the second of two cameras, with those changes.
refused() {
	local reason=$1
	shift
	printf '[%s,%s]' "$(camera3dgs)" "$(camera3dgs 'img_name="c"' "$@")" >cameras.json
	says 3 "gs-import: cameras.json: camera 1: $reason" import && [ ! -e scene ]
}

@test "camera-to-world rotation and position become world to camera; the principal point is the file's, else the centre" {
	printf '[%s,%s]' "$(camera3dgs cy=14)" "$(camera3dgs 'img_name="a.v2.JPG"' width=41)" >cameras.json
	import
	imported name width height fx fy cx cy split >out
	diff - out <<-'END'
		["a.v2",41,30,50,51,20.5,15,"train"]
		["b",40,30,50,51,20,14,"train"]
	END
	# R^T, and -R^T (1,2,3).
	[ "$(jq -c .[1].world_to_camera scene/cameras.json)" = "[[0,1,0,-2],[0,0,1,-3],[1,0,0,-1],[0,0,0,1]]" ]
}

@test "each key missing, null or of another type" {
	for key in width height fx fy; do
		refused "key '$key' is missing" $key=
		refused "key '$key' is missing" $key=null
		refused "key '$key' is not a number" $key='"5"'
		refused "key '$key' is not a number" $key=1e999
	done
	refused "key 'img_name' is missing" img_name=
	refused "key 'img_name' is not a string" img_name=1
	refused "key 'position' is missing" position=
	for value in '[1,2]' '[1,2,3,4]' '[1,2,"3"]' 5; do
		refused "key 'position' is not 3 numbers" position="$value"
	done
	refused "key 'rotation' is missing" rotation=
	for value in '[[1,0,0],[0,1,0]]' '[[1,0,0],[0,1,0],[0,0]]' '[[1,0,0],[0,1,0],[0,0,1],[0,0,0]]' '[1,2,3]' '"x"'; do
		refused "key 'rotation' is not 3x3 numbers" rotation="$value"
	done
}

@test "values out of range" {
	refused "size 0x30 is not whole numbers in 1 to 65536" width=0
	refused "size 40x30.5 is not whole numbers in 1 to 65536" height=30.5
	printf '[%s]' "$(camera3dgs fx=-1)" >cameras.json
	says 3 "gs-import: cameras.json: view 'b': its focal length is not positive" import
	for rotation in '[[1,0,0],[0,1,0],[0,0,-1]]' '[[2,0,0],[0,1,0],[0,0,1]]' '[[0,0,0],[0,0,0],[0,0,0]]'; do
		printf '[%s]' "$(camera3dgs "rotation=$rotation")" >cameras.json
		says 3 "gs-import: cameras.json: view 'b': its pose is not a rotation and a translation: is it mirrored, scaled or rounded to few digits?" import
	done
	printf '[%s,%s]' "$(camera3dgs)" "$(camera3dgs)" >cameras.json
	says 3 "gs-import: cameras.json: two views are of 'b': take one out" import
}

@test "not such a file" {
	printf '[' >cameras.json
	says 3 "gs-import: cameras.json: not JSON at offset 1" import
	: >cameras.json
	says 3 "gs-import: cameras.json: not JSON at offset 0" import
	printf '[]\0' >cameras.json
	says 3 "gs-import: cameras.json: not JSON: a NUL byte at offset 2" import
	printf '5' >cameras.json
	says 3 "gs-import: cameras.json: neither the folder of a COLMAP model, nor a 3DGS cameras.json or a transforms.json" import
	printf '[]' >cameras.json
	says 3 "gs-import: cameras.json: no views: a COLMAP model has them in images.bin or images.txt, a transforms.json in its frames" import
	printf '[7]' >cameras.json
	says 3 "gs-import: cameras.json: camera 0: key 'img_name' is missing" import
}

@test "cut at every length" {
	printf '[%s]' "$(camera3dgs)" >whole
	for ((n = 0; n < $(wc -c <whole); n++)); do
		head -c $n whole >cameras.json
		status=0
		import 2>err || status=$?
		[ $status = 3 ] && grep -q '^gs-import: cameras.json: not JSON at offset ' err || { cat err; return 1; }
	done
	[ ! -e scene ]
}
