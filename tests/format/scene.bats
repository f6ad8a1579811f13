#!/usr/bin/env bats
# Each rule of formats/scene/scene.md broken once.

setup() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	load files
	cd "$BATS_TEST_TMPDIR"
	scene scene
}

# bad_splats REASON [NAME=VALUE]...: one Gaussian with those changes is refused.
bad_splats() {
	local reason=$1
	shift
	splats scene/splats.safetensors "$@"
	says 1 "scene/splats.safetensors: $reason" "$BIN/gs-check" scene
}

# bad_view REASON [KEY=VALUE]...: a list of one view with those changes is refused.
bad_view() {
	local reason=$1
	shift
	printf '[%s]' "$(view "$@")" >scene/cameras.json
	says 1 "scene/cameras.json: view 0: $reason" "$BIN/gs-check" scene
}

# bad_list REASON TEXT
bad_list() {
	printf '%s' "$2" >scene/cameras.json
	says 1 "scene/cameras.json: $1" "$BIN/gs-check" scene
}

# Fails where the command succeeds; a plain ! would let the test go on.
not() { ! "$@"; }

@test "the smallest scene is fine, and its parts are" {
	says 0 "scene: ok: scene, 4x3, 1 gaussians, 1 harmonics, 1 training views, 0 test views, scene ef6eb604187a17fa" "$BIN/gs-check" scene
	says 0 "scene/splats.safetensors: ok: refer.splats, 1 gaussians, 1 harmonics, scene ef6eb604187a17fa" "$BIN/gs-check" scene/splats.safetensors
	says 0 "scene/cameras.json: ok: scene cameras, 4x3, 1 training views, 0 test views" "$BIN/gs-check" scene/cameras.json
}

@test "tensors that are missing or of another shape" {
	bad_splats "tensor 'means' is missing" header='"x":{"dtype":"U8","shape":[56],"data_offsets":[0,56]}'
	bad_splats "tensor 'scales': is F32[3,1], expected F32[1,3]" header='"means":{"dtype":"F32","shape":[1,3],"data_offsets":[0,12]},"scales":{"dtype":"F32","shape":[3,1],"data_offsets":[12,24]},"rest":{"dtype":"U8","shape":[32],"data_offsets":[24,56]}'
	bad_splats "tensor 'means': is F32[3], expected F32[*,3]" header='"means":{"dtype":"F32","shape":[3],"data_offsets":[0,12]},"rest":{"dtype":"U8","shape":[44],"data_offsets":[12,56]}'
	bad_splats "tensor 'means': is I32[1,3], expected F32[*,3]" header='"means":{"dtype":"I32","shape":[1,3],"data_offsets":[0,12]},"rest":{"dtype":"U8","shape":[44],"data_offsets":[12,56]}'
}

@test "harmonics that are not a full degree" {
	splats good
	head=$(head -c "$(($(wc -c <good) - 56))" good | tail -c +9 | sed 's/"sh":.*/"sh":{"dtype":"F32","shape":[1,2,3],"data_offsets":[44,68]}}/')
	while (((8 + ${#head}) % 4)); do head+=' '; done
	st scene/splats.safetensors "$head" "$f0$f0$f0$f1$f1$f1$f1$f0$f0$f0$f1$f0$f0$f0$f0$f0$f0"
	says 1 "scene/splats.safetensors: tensor 'sh': 2 coefficients, expected 1, 4, 9 or 16" "$BIN/gs-check" scene
}

@test "values out of range" {
	bad_splats "tensor 'means': Gaussian 0 is not finite" means=$f0$fnan$f0
	bad_splats "tensor 'means': Gaussian 0 is not finite" means=$f0$f0$finf
	bad_splats "tensor 'scales': Gaussian 0 is negative or not finite" scales=$f1$fminus$f1
	bad_splats "tensor 'scales': Gaussian 0 is negative or not finite" scales=$f1$f1$fnan
	bad_splats "tensor 'scales': Gaussian 0 is negative or not finite" scales=$finf$f1$f1
	bad_splats "tensor 'quats': Gaussian 0 is zero or not finite" quats=$f0$f0$f0$f0
	bad_splats "tensor 'quats': Gaussian 0 is zero or not finite" quats=$f1$f0$f0$fnan
	bad_splats "tensor 'opacities': Gaussian 0 is not in [0,1]" opacities=$fminus
	bad_splats "tensor 'opacities': Gaussian 0 is not in [0,1]" opacities=$fnan
	bad_splats "tensor 'opacities': Gaussian 0 is not in [0,1]" opacities=0100803f
	bad_splats "tensor 'sh': value 2 is not finite" sh=$f0$f1$finf
}

@test "values at the edges of their ranges are fine" {
	# Scale 0, the largest finite scale, a quaternion whose squares vanish, opacity 0.
	splats scene/splats.safetensors scales=$f0${f0}ffff7f7f quats=01000000$f0$f0$f0 opacities=$f0
	"$BIN/gs-check" scene
}

@test "the near plane" {
	splats scene/splats.safetensors meta=',"near":"7.5e-3"'
	"$BIN/gs-check" scene
	for near in '' x '1 2' 0 -0.2 nan inf; do
		bad_splats "metadata 'near' is not a number above 0" meta=",\"near\":\"$near\""
	done
	# the Gaussian is 2 before the camera
	splats scene/splats.safetensors meta=',"near":"1.99"'
	"$BIN/gs-weigh" -q -o weights scene
	splats scene/splats.safetensors meta=',"near":"2"'
	not "$BIN/gs-weigh" -q -o weights scene
}

@test "the offset of the import" {
	splats scene/splats.safetensors meta=',"offset":"[1,2.5,-3e6]"'
	"$BIN/gs-check" scene
	for offset in '' '[1,2]' '1,2,3' '[1,2,nan]'; do
		bad_splats "metadata 'offset' is not three numbers" meta=",\"offset\":\"$offset\""
	done
}

@test "a missing part" {
	rm scene/cameras.json
	says 1 "scene: a scene without cameras.json" "$BIN/gs-check" scene
	scene scene
	rm scene/splats.safetensors
	says 1 "scene: not a scene, COLMAP model or folder of weights" "$BIN/gs-check" scene
}

@test "cameras.json that is no list of views" {
	bad_list "not JSON at offset 0" ""
	bad_list "not JSON at offset 1" "["
	bad_list "not a list of views" "{}"
	bad_list "view name 'v1' appears twice" "[$(view),$(view)]"
	{ printf '[]'; printf '\0x'; } >scene/cameras.json
	says 1 "scene/cameras.json: not JSON: a NUL byte at offset 2" "$BIN/gs-check" scene
}

@test "each key of a view missing or of a wrong type" {
	for key in width height fx fy cx cy; do
		bad_view "key '$key' is missing" $key=
		bad_view "key '$key' is not a number" $key='"4"'
	done
	for name in '' 1 null; do
		bad_view "key 'name' is not a string" name="$name"
	done
	for split in '' '"x"' 1; do
		bad_view 'key '\''split'\'' is not "train" or "test"' split="$split"
	done
	bad_view "key 'image' is not a string" image=1
}

@test "names that no file can have" {
	bad_view "key 'name' is empty" name='""'
	bad_view "key 'name' has a slash" name='"a/b"'
	for name in . ..; do
		bad_view "key 'name' is '.' or '..'" name="\"$name\""
	done
	bad_view "key 'name' has a control character at byte 2" name='"a\n"'
	bad_view "key 'name' has a control character at byte 3" name='"é\u0085"'
	bad_view "key 'name' is not UTF-8 at byte 1" name="$(printf '"\xff"')"
	printf '[%s]' "$(view name='"a\u0000b"')" >scene/cameras.json
	says 1 'scene/cameras.json: a NUL character (\u0000) in a string' "$BIN/gs-check" scene
	for name in ... '杯 1' 50% '-a' 'a\\b'; do
		printf '[%s]' "$(view name="\"$name\"")" >scene/cameras.json
		"$BIN/gs-check" scene
	done
}

@test "numbers of a view out of range" {
	bad_view "size 0x3 is not whole numbers in 1 to 65536" width=0
	bad_view "size 4x3.5 is not whole numbers in 1 to 65536" height=3.5
	bad_view "size 65537x3 is not whole numbers in 1 to 65536" width=65537
	bad_view "its focal length is not positive" fx=0
	bad_view "its focal length is not positive" fy=-5
}

@test "poses that are not rigid" {
	bad_view "key 'world_to_camera' is missing" world_to_camera=
	bad_view "key 'world_to_camera' is not 4x4 numbers" world_to_camera='[[1,0,0,0],[0,1,0,0],[0,0,1,2]]'
	bad_view "key 'world_to_camera' is not 4x4 numbers" world_to_camera='[[1,0,0,0],[0,1,0,0],[0,0,1],[0,0,0,1]]'
	bad_view "key 'world_to_camera' is not 4x4 numbers" world_to_camera='[[1,0,0,0],[0,1,"0",0],[0,0,1,2],[0,0,0,1]]'
	bad_view "its pose is not a rotation and a translation: is it mirrored, scaled or rounded to few digits?" world_to_camera='[[2,0,0,0],[0,1,0,0],[0,0,1,2],[0,0,0,1]]'
	bad_view "its pose is not a rotation and a translation: is it mirrored, scaled or rounded to few digits?" world_to_camera='[[1,0,0,0],[1,0,0,0],[0,0,1,2],[0,0,0,1]]'
	bad_view "its pose is not a rotation and a translation: is it mirrored, scaled or rounded to few digits?" world_to_camera='[[1,0,0,0],[0,1,0,0],[0,0,-1,2],[0,0,0,1]]'
	bad_view "its pose is not a rotation and a translation: is it mirrored, scaled or rounded to few digits?" world_to_camera='[[1,0,0,0],[0,1,0,0],[0,0,1,2],[0,0,1,1]]'
}

@test "splats.safetensors and cameras.json cut at every length" {
	splats=$(wc -c <scene/splats.safetensors) list=$(wc -c <scene/cameras.json)
	cp -r scene whole
	folders=()
	for ((n = 0; n < splats; n += 3)); do
		mkdir cut.$n && head -c $n whole/splats.safetensors >cut.$n/splats.safetensors && ln whole/cameras.json cut.$n
		folders+=(cut.$n)
	done
	# The last byte is the line's end, which JSON does not need.
	for ((n = 0; n < list - 1; n += 3)); do
		mkdir end.$n && head -c $n whole/cameras.json >end.$n/cameras.json && ln whole/splats.safetensors end.$n
		folders+=(end.$n)
	done
	status=0
	"$BIN/gs-check" "${folders[@]}" >out 2>err || status=$?
	[ $status = 1 ] && [ ! -s err ]
	[ "$(grep -cE '^(cut|end)\.[0-9]+/(splats.safetensors|cameras.json): ' out)" = ${#folders[@]} ]
	not grep ': ok: ' out
}

@test "a photograph's lens: read, kept, and each of its rules broken" {
	lens() { entry 'model width height parameters' 'model="RADIAL"' width=6 height=5 'parameters=[5,2,1.5,0.1,-0.5]' "$@"; }
	load foreign
	printf '[%s]' "$(view "lens=$(lens)")" >scene/cameras.json
	says 0 "scene/cameras.json: ok: scene cameras, 4x3, 1 training views, 0 test views" "$BIN/gs-check" scene/cameras.json
	bad_view "key 'lens': key 'model' is missing" "lens=$(lens model=)"
	bad_view "key 'lens': camera model 'RADIALS' is unknown" "lens=$(lens 'model="RADIALS"')"
	bad_view "key 'lens': key 'width' is not a number" "lens=$(lens 'width="6"')"
	bad_view "key 'lens': size 6.5x5 is not whole numbers in 1 to 65536" "lens=$(lens width=6.5)"
	bad_view "key 'lens': key 'parameters' is not 5 numbers" "lens=$(lens 'parameters=[5,2,1.5,0.1]')"
	bad_view "key 'lens': focal length is not positive" "lens=$(lens 'parameters=[0,2,1.5,0.1,0]')"
	bad_view "key 'lens': key 'model' is missing" lens=5
}
