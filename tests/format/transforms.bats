#!/usr/bin/env bats
# Each rule of formats/cameras/transforms.md broken once.

setup() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	load files
	load foreign
	cd "$BATS_TEST_TMPDIR"
	splats_ply s.ply
}

import() {
	"$BIN/gs-import" --cameras transforms.json -o scene s.ply
}

# refused REASON KEY=VALUE...: a file with those changes, named frame 0.
refused() {
	local reason=$1
	shift
	transforms "$@" >transforms.json
	says 3 "gs-import: transforms.json: frame 0: $reason" import && [ ! -e scene ]
}

# bad_frame REASON KEY=VALUE...: a frame with those changes.
bad_frame() {
	local reason=$1
	shift
	refused "$reason" "frames=[$(frame "$@")]"
}

# lens KEY...: what the one view of the imported file has.
lens() {
	rm -rf scene
	import && imported "$@"
}

@test "OpenGL axes become COLMAP's" {
	# Rows of camera to world: x_world = -z_camera, y_world = x_camera, z_world = -y_camera (OpenGL's).
	transforms "frames=[$(frame 'transform_matrix=[[0,0,-1,4],[1,0,0,5],[0,-1,0,6],[0,0,0,1]]')]" >transforms.json
	import
	imported name width height fx fy cx cy split >out
	echo '["b",40,30,50,51,19,14,"train"]' | diff - out
	# x_camera = y_world; y down = z_world; z forward = x_world; and the centre goes to 0.
	[ "$(jq -c .[0].world_to_camera scene/cameras.json)" = "[[0,1,0,-5],[0,0,1,-6],[1,0,0,-4],[0,0,0,1]]" ]
}

@test "the fourth row may be absent" {
	transforms "frames=[$(frame 'transform_matrix=[[1,0,0,1],[0,1,0,2],[0,0,1,3]]')]" >transforms.json
	import
	[ "$(jq -c .[0].world_to_camera scene/cameras.json)" = "[[1,0,0,-1],[0,-1,0,2],[0,0,-1,3],[0,0,0,1]]" ]
}

@test "intrinsics: defaults, angles, and a frame's own" {
	transforms cx= cy= fl_y= >transforms.json
	[ "$(lens fx fy cx cy)" = "[50,50,20,15]" ]
	transforms fl_x= fl_y= camera_angle_x=1.5707963267948966 >transforms.json
	[ "$(lens fx fy | sed 's/\.00*[0-9]\{1,2\}\b//g')" = "[20,20]" ]
	transforms fl_x= fl_y= camera_angle_x=1.5707963267948966 camera_angle_y=1.5707963267948966 >transforms.json
	[ "$(lens fx fy | sed 's/\.00*[0-9]\{1,2\}\b//g')" = "[20,15]" ]
	transforms "frames=[$(frame w=80 h=60 fl_x=7 fl_y=8 cx=9 cy=10)]" >transforms.json
	[ "$(lens width height fx fy cx cy)" = "[80,60,7,8,9,10]" ]
	transforms w= h= fl_x= fl_y= cx= cy= "frames=[$(frame w=80 h=60 fl_x=7)]" >transforms.json
	[ "$(lens width height fx fy cx cy)" = "[80,60,7,7,40,30]" ]
}

@test "splits" {
	frames="frames=[$(frame), $(frame 'file_path="./x/a.png"'), $(frame 'file_path="c"')]"
	transforms "$frames" 'test_filenames=["c"]' >transforms.json
	[ "$(lens name split | tr -d '\n')" = '["a","train"]["b","train"]["c","test"]' ]
	transforms "$frames" 'val_filenames=["images/b.png","other"]' 'test_filenames=["c"]' >transforms.json
	[ "$(lens name split | tr -d '\n')" = '["a","train"]["b","test"]["c","test"]' ]
	transforms "$frames" 'train_filenames=["./x/a.png"]' >transforms.json
	[ "$(lens name split | tr -d '\n')" = '["a","train"]["b","test"]["c","test"]' ]
	rm -r scene
	"$BIN/gs-import" --cameras transforms.json --test-views a -o scene s.ply
	[ "$(imported name split | tr -d '\n')" = '["a","test"]["b","train"]["c","train"]' ]
	rm -r scene
	transforms 'train_filenames=5' >transforms.json
	says 3 "gs-import: transforms.json: key 'train_filenames' is not a list" import
	transforms 'test_filenames=[5]' >transforms.json
	says 3 "gs-import: transforms.json: key 'test_filenames' is not a list of strings" import
}

@test "keys that are missing or of another type" {
	refused "key 'w' is missing" w=
	refused "key 'h' is missing" h=
	refused "neither 'fl_x' nor 'camera_angle_x'" fl_x=
	for key in w h fl_x fl_y cx cy k1 p2; do
		refused "key '$key' is not a number" $key='"5"'
		bad_frame "key '$key' is not a number" $key=1e999
	done
	bad_frame "key 'file_path' is missing" file_path=
	bad_frame "key 'file_path' is not a string" file_path=7
	bad_frame "key 'transform_matrix' is missing" transform_matrix=
	bad_frame "key 'transform_matrix' is not 4x4 numbers" transform_matrix='[[1,0,0,0],[0,1,0,0]]'
	bad_frame "key 'transform_matrix' is not 3x4 numbers" transform_matrix='[[1,0,0,0],[0,1,0,0],[0,0,1]]'
	bad_frame "key 'transform_matrix' is not 4x4 numbers" transform_matrix=5
	refused "key 'file_path' is missing" frames=[1]
	transforms frames= >transforms.json
	says 3 "gs-import: transforms.json: neither a transforms.json, which has a key 'frames', nor a 3DGS cameras.json, which is a list" import
	for frames in 5 '{}'; do
		transforms "frames=$frames" >transforms.json
		says 3 "gs-import: transforms.json: key 'frames' is not a list" import
	done
	transforms frames=[] >transforms.json
	says 3 "gs-import: transforms.json: no views: a COLMAP model has them in images.bin or images.txt, a transforms.json in its frames" import
}

@test "values out of range" {
	refused "size 40.5x30 is not whole numbers in 1 to 65536" w=40.5
	refused "key 'camera_angle_x': 3.2 is not an angle in (0, pi)" fl_x= camera_angle_x=3.2
	refused "key 'camera_angle_y': 0 is not an angle in (0, pi)" fl_y= camera_angle_y=0
	bad_frame "key 'transform_matrix': the last row is not 0 0 0 1" \
		transform_matrix='[[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,2]]'
	transforms "frames=[$(frame 'transform_matrix=[[1,0,0,0],[0,1,0,0],[0,0,2,0],[0,0,0,1]]')]" >transforms.json
	says 3 "gs-import: transforms.json: view 'images/b.png': its pose is not a rotation and a translation: is it mirrored, scaled or rounded to few digits?" import
	transforms fl_x=-5 >transforms.json
	says 3 "gs-import: transforms.json: view 'images/b.png': its focal length is not positive" import
}

@test "focal lengths and principal points as shares of the picture" {
	for lens in '"fl_x":0.9,"cx":320,"cy":240' '"fl_x":600,"cx":0.5,"cy":0.5' '"fl_x":600,"cx":0,"cy":0'; do
		printf '{"w":640,"h":480,%s,"frames":[%s]}' "$lens" "$(frame)" >t.json
		says 1 "t.json: view 'images/b.png': its focal length or principal point is that of a picture of size 1, or none: both are in pixels" "$BIN/gs-check" t.json
	done
}

@test "lenses that are not pinholes: refused, or their pinhole with --undistort" {
	for key in k1 k2 k3 p1 p2; do
		transforms $key=-0.05 >transforms.json
		model=OPENCV
		[ $key != k3 ] || model=FULL_OPENCV
		says 3 "gs-import: transforms.json: view 'b': camera model $model distorts: gs-import --undistort takes the pinhole of the same view" import
	done
	for key in k4 k5 k6; do
		refused "key '$key': -0.5, which is read with camera_model FULL_OPENCV only" $key=-0.5
	done
	refused "key 'k4' is not a number" k4='"x"'
	bad_frame "key 'camera_model': 'EQUIRECTANGULAR' is not a perspective camera" 'camera_model="EQUIRECTANGULAR"'
	transforms 'camera_model="OPENCV"' is_fisheye=false k1=0 k2=0 p1=0 p2=0.0 >transforms.json
	import
	jq -e '.[0].lens == null' scene/cameras.json
	# of each key, as COLMAP orders them
	undistorted() { rm -rf scene; "$BIN/gs-import" --undistort --cameras transforms.json -o scene s.ply && jq -c '.[0].lens | [.model, .width, .height, .parameters[]]' scene/cameras.json; }
	transforms k1=0.5 k2=0.25 p1=0.125 p2=0.0625 >transforms.json
	[ "$(undistorted)" = '["OPENCV",40,30,50,51,19,14,0.5,0.25,0.125,0.0625]' ]
	transforms "frames=[$(frame k1=0.5 k2=0.25 k3=0.03125 p1=0.125 p2=0.0625)]" >transforms.json
	[ "$(undistorted)" = '["FULL_OPENCV",40,30,50,51,19,14,0.5,0.25,0.125,0.0625,0.03125,0,0,0]' ]
	transforms 'camera_model="FULL_OPENCV"' k1=0.5 k4=0.25 k5=0.125 k6=0.0625 >transforms.json
	[ "$(undistorted)" = '["FULL_OPENCV",40,30,50,51,19,14,0.5,0,0,0,0,0.25,0.125,0.0625]' ]
	transforms 'camera_model="OPENCV_FISHEYE"' k1=0.5 k2=0.25 k3=0.125 k4=0.0625 >transforms.json
	[ "$(undistorted)" = '["OPENCV_FISHEYE",40,30,50,51,19,14,0.5,0.25,0.125,0.0625]' ]
	transforms distortion_params='[0.5,0.25,0,0,0.125,0.0625]' k1=9 >transforms.json
	[ "$(undistorted)" = '["OPENCV",40,30,50,51,19,14,0.5,0.25,0.125,0.0625]' ]
	transforms "frames=[$(frame distortion_params='[0,0,0.25,0,0,0]')]" >transforms.json
	[ "$(undistorted)" = '["FULL_OPENCV",40,30,50,51,19,14,0,0,0,0,0.25,0,0,0]' ]
	transforms 'camera_model="Opencv_fisheye"' k1=0.5 >transforms.json
	[ "$(undistorted)" = '["OPENCV_FISHEYE",40,30,50,51,19,14,0.5,0,0,0]' ]
	transforms "frames=[$(frame is_fisheye=true)]" k1=0.5 >transforms.json
	[ "$(undistorted)" = '["OPENCV_FISHEYE",40,30,50,51,19,14,0.5,0,0,0]' ]
	transforms is_fisheye=true k1=0.5 >transforms.json
	[ "$(undistorted)" = '["OPENCV_FISHEYE",40,30,50,51,19,14,0.5,0,0,0]' ]
}
