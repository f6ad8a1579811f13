#!/usr/bin/env bats
# Each rule of formats/cameras/colmap.md broken once, in text models. Binary ones are in tests/unit/test_colmap.c.

setup() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	load files
	load foreign
	cd "$BATS_TEST_TMPDIR"
	splats_ply s.ply
	colmap model
}

# Fails where the command succeeds; a plain ! would let the test go on.
not() { ! "$@"; }

import() {
	"$BIN/gs-import" --cameras model -o scene "$@" s.ply
}

# bad_camera REASON LINE: as the first camera of the model; it is line 2.
bad_camera() {
	printf '# cameras\n%s\n' "$2" >model/cameras.txt
	says 3 "gs-import: model/cameras.txt:2: $1" import && [ ! -e scene ]
}

# bad_image REASON LINE: as the first image, line 2.
bad_image() {
	printf '# images\n%s\n\n' "$2" >model/images.txt
	says 3 "gs-import: model/images.txt:2: $1" import && [ ! -e scene ]
}

@test "a text model: names sorted, intrinsics by camera, poses" {
	import
	imported name width height fx fy cx cy >out
	diff - out <<-'END'
		["a",40,30,50,50,20,15]
		["b",40,30,50,51,20,15]
		["c",40,30,50,51,20,15]
	END
	imported world_to_camera >out
	diff - out <<-'END'
		[[[-1,0,0,1],[0,-1,0,0],[0,0,1,2],[0,0,0,1]]]
		[[[1,0,0,0],[0,1,0,0],[0,0,1,2],[0,0,0,1]]]
		[[[1,0,0,0],[0,1,0,1],[0,0,1,2],[0,0,0,1]]]
	END
}

@test "quaternions are normalised; zero and infinite ones refused" {
	sed -i 's/^1 1 0 0 0/1 -8 0 0 0/' model/images.txt
	import
	[ "$(jq -c .[1].world_to_camera[0] scene/cameras.json)" = "[1,0,0,0]" ]
	rm -r scene
	for q in '0 0 0 0' 'inf 0 0 0' 'nan 1 0 0'; do
		printf '1 %s 0 0 0 1 b.jpg\n' "$q" >model/images.txt
		says 3 "gs-import: model/images.txt: image 'b.jpg': its rotation is zero or not finite" import
	done
	printf '1 1 0 0 0 inf 0 0 1 b.jpg\n' >model/images.txt
	says 3 "gs-import: model/images.txt: view 'b.jpg': its pose is not a rotation and a translation: is it mirrored, scaled or rounded to few digits?" import
}

@test "CR LF, CR, blank lines and comments between entries; names with blanks" {
	sed -i 's/^3 /\n# more\n3 /; s/c.jpg/my c.jpg  /; s/$/\r/' model/images.txt
	sed -i 's/$/\r/' model/cameras.txt
	import
	[ "$(imported name | tr -d '\n')" = '["a"]["b"]["my c"]' ]
	tr -d '\r' <model/images.txt | tr '\n' '\r' >old && mv old model/images.txt
	import
	[ "$(imported name | tr -d '\n')" = '["a"]["b"]["my c"]' ]
}

@test "camera lines" {
	bad_camera "does not begin with a camera id" 'x PINHOLE 40 30 50 51 20 15'
	bad_camera "does not begin with a camera id" '-1 PINHOLE 40 30 50 51 20 15'
	bad_camera "does not begin with a camera id" '4294967296 PINHOLE 40 30 50 51 20 15'
	printf '1 Pinhole 40 30 50 51 20 15\n2 pinhole 40 30 50 51 20 15\n' >model/cameras.txt
	import
	rm -r scene
	bad_camera "camera model 'PIN' is unknown" '1 PIN 40 30 50 51 20 15'
	bad_camera "camera model '' is unknown" '1'
	bad_camera "no width and height" '1 PINHOLE 40 x'
	bad_camera "model PINHOLE needs 4 parameters, has 3" '1 PINHOLE 40 30 50 51 20'
	bad_camera "more than 4 parameters" '1 PINHOLE 40 30 50 51 20 15 0'
}

@test "cameras out of range" {
	for size in '0 30' '40 65537' '40.5 30' 'nan 30'; do
		printf '1 PINHOLE %s 50 51 20 15\n' "$size" >model/cameras.txt
		says 3 "gs-import: model/cameras.txt: camera 1: size ${size/ /x} is not whole numbers in 1 to 65536" import
	done
	printf '1 PINHOLE 40 30 50 51 inf 15\n' >model/cameras.txt
	says 3 "gs-import: model/cameras.txt: camera 1: parameter 2 is not finite" import
	printf '1 PINHOLE 40 30 0 51 20 15\n2 PINHOLE 40 30 5 5 2 1' >model/cameras.txt
	says 3 "gs-import: model/images.txt: view 'b.jpg': its focal length is not positive" import
	printf '1 PINHOLE 40 30 50 51 20 15\n1 PINHOLE 40 30 50 51 20 15\n' >model/cameras.txt
	says 3 "gs-import: model/cameras.txt: camera 1 appears twice" import
}

@test "lens distortion: what it is, and the two ways out" {
	printf '1 SIMPLE_RADIAL 40 30 50 20 15 0.01\n2 PINHOLE 40 30 50 50 20 15\n' >model/cameras.txt
	ways="gs-import --undistort takes the pinhole of the same view, and so does 'colmap image_undistorter --image_path"
	says 3 "gs-import: model: view 'b': camera model SIMPLE_RADIAL distorts: $ways IMAGES --input_path model --output_path undistorted'" import
	mkdir photographs
	says 3 "gs-import: model: view 'b': camera model SIMPLE_RADIAL distorts: $ways photographs --input_path model --output_path undistorted'" import --images photographs
	[ ! -e scene ]
	printf '1 SIMPLE_RADIAL 40 30 50 20 15 0\n2 FULL_OPENCV 40 30 50 51 20 15 0 0 0 0 0 0 0 0\n' >model/cameras.txt
	import
	[ "$(imported fy | tr -d '\n')" = '[51][50][50]' ]
	import --undistort -o same
	cmp scene/cameras.json same/cameras.json
}

@test "image lines" {
	for text in 1 '1 1 0 0 0 0 0 2' '1 1 0 0 0 0 0 2 x b.jpg' '1 1 0 0 0 0 0 2 -1 b.jpg' 'x 1 0 0 0 0 0 2 1 b.jpg'; do
		bad_image "not 'ID QW QX QY QZ TX TY TZ CAMERA_ID NAME'" "$text"
	done
	bad_image "image without a name" '1 1 0 0 0 0 0 2 1 '
	printf '1 1 0 0 0 0 0 2 3 b.jpg\n' >model/images.txt
	says 3 "gs-import: model/images.txt: image 'b.jpg': no camera 3 in the model" import
	printf '1 1 0 0 0 0 0 2 1 b.jpg\n\n2 1 0 0 0 0 0 2 1 b.jpg\n' >model/images.txt
	says 3 "gs-import: model/images.txt: two views are of 'b.jpg': take one out" import
	printf '1 1 0 0 0 0 0 2 1 x/.png\n' >model/images.txt
	says 3 "gs-import: model/images.txt: image 'x/.png' gives no view name" import
}

@test "lines of points, perhaps none: what a line is counts, and how many there are by the comment" {
	model() {
		printf '%b\n' "$@" >model/images.txt
		import -o "$BATS_TEST_TMPDIR/out"
		[ "$(jq -c '[.[].name]' out/cameras.json)" = '["12","a b 7","b"]' ]
	}
	local one='1 1 0 0 0 0 0 2 1 b.jpg' two='2 1 0 0 0.5 0 0 2 1 a b 7.jpg' three='3 1 0 0 0 0 1.5 2 2 12'
	model "$one" "$two" "$three"
	model "$one" '# none' "$two" '# of it' '1.5 2.5 -1 3 4 7' "$three"
	model "$one\r" '1 2 3 4 5 6 7 8 9 \r' "$two\r" '\r' "$three\r" ' 1e2 2 18446744073709551615'
	model '# Number of images: 3, mean observations per image: 0' "$one" "$two" '' '' "$three"
	printf '%s\n' "# Number of images: 3" "$one" "$two" >model/images.txt
	says 3 "gs-import: model/images.txt: has 2 images, but line 1 says 3: is the file whole? If so, take that line out" import
	for line in '1 2' '1 2 3 4' '1 2 x' '2 1 0.5 0 0 0 0 2 1' '512.5 1 0 0 0 0 0 2 1 b.jpg'; do
		printf '%s\n' "$one" "$line" "$three" >model/images.txt
		not import 2>err
		grep -q "^gs-import: model/images.txt:2: \(not 'ID .* NAME', and not the points of the image before, 'X Y POINT3D_ID ...'\|image without a name\)$" err
	done
}

@test "zero bytes, no entries, UTF-16 and half of it" {
	for part in cameras images; do
		iconv -f UTF-8 -t UTF-16 model/$part.txt >wide
		mv wide model/$part.txt
	done
	import && rm -r scene
	printf x >>model/images.txt
	says 3 "gs-import: model/images.txt: UTF-16 that is cut within a character at offset $(($(wc -c <model/images.txt) - 1)): save it as UTF-8" import
	printf '# images\n\0' >model/images.txt
	says 3 "gs-import: model/images.txt: a NUL byte at offset 9" import
	printf '# images\n' >model/images.txt
	says 3 "gs-import: model: no views: a COLMAP model has them in images.bin or images.txt, a transforms.json in its frames" import
}

@test "binary files that cannot be" {
	printf '1234567' >model/cameras.bin
	cp model/cameras.bin model/images.bin
	says 3 "gs-import: model/cameras.bin: 7 bytes, too short for a COLMAP file" import
	printf '\377\377\377\377\377\377\377\377' >model/cameras.bin
	says 3 "gs-import: model/cameras.bin: 18446744073709551615 entries at offset 0 do not fit a file of 8 bytes" import
	# One camera of model 17, which this program does not know the length of.
	{ printf '\1\0\0\0\0\0\0\0\5\0\0\0\21\0\0\0'; head -c 64 /dev/zero; } >model/cameras.bin
	says 3 "gs-import: model/cameras.bin: camera 5: model id 17 at offset 12 is unknown" import
}

@test "cameras in one form and images in the other" {
	xxd -r -p >model/cameras.bin <<<'0100000000000000 01000000 01000000 2800000000000000 1e00000000000000
		0000000000004940 0000000000804940 0000000000003440 0000000000002e40'
	sed -i 's/ 2 a.jpg/ 1 a.jpg/; s/ 50 51 / 60 61 /' model/images.txt model/cameras.txt
	import
	[ "$(imported fx fy | tr -d '\n')" = '[60,61][60,61][60,61]' ]
	rm model/cameras.txt
	import
	[ "$(imported name fx fy | tr -d '\n')" = '["a",50,51]["b",50,51]["c",50,51]' ]
}
