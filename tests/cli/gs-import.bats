#!/usr/bin/env bats
# gs-import. What the formats refuse is in tests/format; options that every tool has are in common.bats.

setup() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	load ../format/files
	load ../format/foreign
	cd "$BATS_TEST_TMPDIR"
	splats_ply s.ply
	colmap model
}

# views COMMAND...: runs it, and prints names and splits of the views of scene.
views() {
	rm -rf scene
	"$@" && imported name split | tr -d '\n'
}

# Fails where the command succeeds; a plain ! would let the test go on.
not() { ! "$@"; }

@test "what a Gaussian's numbers become" {
	"$BIN/gs-import" --cameras model -o scene s.ply
	[ "$(ls scene | tr '\n' ' ')" = "cameras.json splats.safetensors " ]
	# Of the second Gaussian of two: mean, scales exp(-2 -3 -4), opacity sigmoid(2), then the colours.
	"$BIN/gs-check" scene/splats.safetensors | grep -q ': 2 gaussians\|, 2 gaussians'
	data() { tail -c 112 scene/splats.safetensors | od -An -v -tf4 -w4 | tr -s ' \n' ' '; }
	read -ra value < <(data; echo)
	[ "${value[*]:0:6}" = "0 0 2 1 0 3" ]
	[ "${value[*]:9:3}" = "0.13533528 0.049787067 0.01831564" ]
	[ "${value[*]:16:4}" = "0.5 0.5 0.5 0.5" ]
	[ "${value[*]:20:2}" = "0.5 0.8807971" ]
	[ "${value[*]:22:6}" = "1 0.5 0 0 0.5 1" ]
}

@test "stdin equals the file" {
	"$BIN/gs-import" --cameras model -o scene s.ply
	"$BIN/gs-import" --cameras model -o piped - <s.ply
	cat s.ply | "$BIN/gs-import" --cameras model -o pipe -
	diff -r scene piped
	diff -r scene pipe
	printf '[%s]' "$(camera3dgs)" >c.json
	"$BIN/gs-import" --cameras c.json -o one s.ply
	"$BIN/gs-import" --cameras - -o two s.ply <c.json
	diff -r one two
}

@test "the same bytes again, into the same folder or another" {
	"$BIN/gs-import" --cameras model --test-views b -o scene s.ply
	cp -r scene first
	"$BIN/gs-import" --cameras model --test-views b -o scene s.ply
	"$BIN/gs-import" --cameras ./model/ --test-views b -o new/deep/scene ./s.ply
	diff -r first scene
	diff -r first new/deep/scene
}

@test "an output from stdin without cameras, two from stdin, an output to stdout" {
	says 2 "gs-import: --cameras is required where SPLATS is stdin
Try 'gs-import --help'." "$BIN/gs-import" -o scene -
	says 2 "gs-import: --cameras and SPLATS cannot both be stdin
Try 'gs-import --help'." "$BIN/gs-import" --cameras - -o scene -
	says 2 "gs-import: -o: a scene is a folder and cannot go to stdout
Try 'gs-import --help'." "$BIN/gs-import" --cameras model -o - s.ply
	says 2 "gs-import: -o SCENE is required
Try 'gs-import --help'." "$BIN/gs-import" --cameras model s.ply
}

@test "cameras that are missing" {
	says 4 "gs-import: none: No such file or directory" "$BIN/gs-import" --cameras none -o scene s.ply
	mkdir empty
	says 3 "gs-import: empty: no cameras here: no COLMAP model (cameras.txt and images.txt, or .bin), cameras.json, sparse/0, sparse or transforms.json" \
		"$BIN/gs-import" --cameras empty -o scene s.ply
	says 2 "gs-import: --cameras is not given, and .: no cameras here: no COLMAP model (cameras.txt and images.txt, or .bin), cameras.json, sparse/0, sparse or transforms.json
Try 'gs-import --help'." "$BIN/gs-import" -o scene s.ply
	rm model/images.txt
	says 3 "gs-import: model: no cameras here: no COLMAP model (cameras.txt and images.txt, or .bin), cameras.json, sparse/0, sparse or transforms.json" \
		"$BIN/gs-import" --cameras model -o scene s.ply
	[ ! -e scene ]
}

@test "where cameras are looked for, first to last" {
	mkdir -p x/sparse
	cp s.ply x
	transforms "frames=[$(frame 'file_path="transforms"')]" >x/transforms.json
	[ "$(views "$BIN/gs-import" -o scene x/s.ply)" = '["transforms","train"]' ]
	mv x/transforms.json x/transforms_train.json
	[ "$(views "$BIN/gs-import" -o scene x/s.ply)" = '["transforms","train"]' ]
	transforms "frames=[$(frame 'file_path="val"')]" >x/Transforms_val.json
	[ "$(views "$BIN/gs-import" -o scene x/s.ply)" = '["transforms","train"]["val","test"]' ]
	transforms w=41 "frames=[$(frame 'file_path="test/transforms"'),$(frame 'file_path="c"')]" >x/transforms_test.json
	[ "$(views "$BIN/gs-import" -o scene x/s.ply)" = '["c","test"]["test_transforms","test"]["transforms","train"]' ]
	[ "$(imported width | tr -d '\n')" = '[41][41][40]' ]
	echo '{"frames":1}' >x/transforms_test.json
	rm -r scene
	says 3 "gs-import: x/transforms_test.json: key 'frames' is not a list" "$BIN/gs-import" -o scene x/s.ply
	rm x/transforms_test.json
	colmap x/sparse
	sed -i 's/a.jpg/sparse.jpg/' x/sparse/images.txt
	[ "$(views "$BIN/gs-import" -o scene x/s.ply)" = '["b","train"]["c","train"]["sparse","train"]' ]
	colmap x/sparse/0
	[ "$(views "$BIN/gs-import" -o scene x/s.ply)" = '["a","train"]["b","train"]["c","train"]' ]
	printf '[%s]' "$(camera3dgs 'img_name="json"')" >x/cameras.json
	[ "$(views "$BIN/gs-import" -o scene x/s.ply)" = '["json","train"]' ]
	[ "$(views "$BIN/gs-import" --cameras x -o scene s.ply)" = '["json","train"]' ]
	colmap x
	sed -i 's/a.jpg/here.jpg/' x/images.txt
	[ "$(views "$BIN/gs-import" -o scene x/s.ply)" = '["b","train"]["c","train"]["here","train"]' ]
	[ "$(views "$BIN/gs-import" --cameras x/sparse -o scene x/s.ply)" = '["b","train"]["c","train"]["sparse","train"]' ]
}

@test "cameras in other letters, and in folders of a folder, where one has some" {
	mkdir -p a/Sparse b/top/photos b/.git/sparse
	cp -r model a/Sparse/0
	mv a/Sparse/0/cameras.txt a/Sparse/0/Cameras.TXT && mv a/Sparse/0/images.txt a/Sparse/0/IMAGES.txt
	cp -r a b/top/colmap
	for cameras in a a/Sparse/0 b b/top; do
		[ "$(views "$BIN/gs-import" --cameras $cameras -o scene s.ply)" = '["a","train"]["b","train"]["c","train"]' ]
	done
	cp s.ply b
	"$BIN/gs-import" -o none b/s.ply 2>&1 | grep -q 'no cameras here'
	cp -r model b/top/photos
	"$BIN/gs-import" --cameras b -o none s.ply 2>err && return 1
	grep -qE '^gs-import: b: cameras in several of its folders, as b/top/[^ ]* and b/top/[^ ]*: name one$' err
	touch a/Sparse/0/images.TXT # two that differ in case alone: which one?
	"$BIN/gs-import" --cameras a -o none s.ply 2>err && return 1
	grep -q 'no cameras here' err
}

@test "the folders of a 3DGS model" {
	mkdir -p out/point_cloud/iteration_30000 out/point_cloud/other
	printf '[%s]' "$(camera3dgs)" >out/cameras.json
	cp s.ply out/point_cloud/iteration_30000
	cp s.ply out/point_cloud/other
	[ "$(views "$BIN/gs-import" -o scene out/point_cloud/iteration_30000/s.ply)" = '["b","train"]' ]
	cd out/point_cloud/other
	not "$BIN/gs-import" -o scene s.ply 2>err
	grep -q 'no cameras here' err
}

@test "test views by name, by number" {
	[ "$(views "$BIN/gs-import" --cameras model -o scene s.ply)" = '["a","train"]["b","train"]["c","train"]' ]
	[ "$(views "$BIN/gs-import" --cameras model --test-views c,a -o scene s.ply)" = '["a","test"]["b","train"]["c","test"]' ]
	[ "$(views "$BIN/gs-import" --cameras model --test-views every:2 -o scene s.ply)" = '["a","test"]["b","train"]["c","test"]' ]
	[ "$(views "$BIN/gs-import" --cameras model --test-views every:8 -o scene s.ply)" = '["a","test"]["b","train"]["c","train"]' ]
	[ "$(views "$BIN/gs-import" --cameras model --test-views every:1 -o scene s.ply)" = '["a","test"]["b","test"]["c","test"]' ]
}

@test "every N-th view as trainers count: by whole paths with their endings" {
	local order=0
	: >model/images.txt
	for name in b/1.jpg b/2.jpg a/3.jpg a/4.jpg 'c 1.jpg' c.jpg; do
		printf '%s 1 0 0 0 0 0 2 1 %s\n\n' $((++order)) "$name" >>model/images.txt
	done
	[ "$(views "$BIN/gs-import" --cameras model --test-views every:4 -o scene s.ply | grep -o '"[^"]*","test"' | tr -d '\n')" = '"3","test""c 1","test"' ]
}

@test "paths of Windows, and paths that are written in other ways: one photograph, one name" {
	mkdir photos
	for name in a b é; do : >"photos/$name.jpg"; done
	for path in 'photos\\' '.\\photos\\' 'C:\\x\\photos\\' './photos//./' '\\\\host\\photos\\'; do
		transforms "frames=[$(frame "file_path=\"${path}a.jpg\""),$(frame "file_path=\"${path}b.jpg\"")]" 'test_filenames=["photos/b.jpg"]' >t.json
		"$BIN/gs-import" --cameras t.json --images photos -o scene s.ply
		[ "$(imported name image | tr -d '\n')" = '["a","../photos/a.jpg"]["b","../photos/b.jpg"]' ]
		case $path in .*) [ "$(imported split | tr -d '\n')" = '["train"]["test"]' ] ;; esac
	done
	printf '[%s]' "$(camera3dgs 'img_name="cam1\\a"')" >c.json
	"$BIN/gs-import" --cameras c.json --images photos -o scene s.ply
	[ "$(imported name image)" = '["a","../photos/a.jpg"]' ]
	sed -i 's/ b.jpg/ cam1\\b.jpg/' model/images.txt
	"$BIN/gs-import" --cameras model -o scene s.ply
	[ "$(imported name | tr -d '\n')" = '["a"]["b"]["c"]' ]
	# decomposed, as macOS writes names: e and an accent
	printf '1 1 0 0 0 0 0 2 1 e\xcc\x81.jpg\n' >model/images.txt
	"$BIN/gs-import" --cameras model --images photos --test-views é -o scene s.ply
	[ "$(imported name image split)" = '["é","../photos/é.jpg","test"]' ]
	mv photos/é.jpg "photos/$(printf 'e\xcc\x81').jpg"
	"$BIN/gs-import" --cameras model --images photos -o scene s.ply
	[ "$(imported image)" = "[\"../photos/$(printf 'e\xcc\x81').jpg\"]" ]
}

@test "test views that are not there" {
	for name in x '' a.jpg A ab; do
		says 2 "gs-import: --test-views: no view '$name'; there are 3: a, b, c
Try 'gs-import --help'." "$BIN/gs-import" --cameras model --test-views "$name" -o scene s.ply
	done
	says 2 "gs-import: --test-views: no view ''; there are 3: a, b, c
Try 'gs-import --help'." "$BIN/gs-import" --cameras model --test-views a, -o scene s.ply
	for n in '' 0 -1 2x 1.5 ' 2' 99999999999999999999; do
		says 2 "gs-import: --test-views: 'every:$n' is not every:N with N from 1 to 1000000000
Try 'gs-import --help'." "$BIN/gs-import" --cameras model --test-views "every:$n" -o scene s.ply
	done
	[ ! -e scene ]
}

@test "photographs are named relative to the scene" {
	mkdir -p photos/deep out
	: >photos/a.jpg
	: >photos/deep/b.jpg
	sed -i 's, b.jpg, deep/b.jpg,' model/images.txt
	"$BIN/gs-import" --cameras model --images photos -o scene s.ply 2>err
	grep -qx "gs-import: warning: photos: no photograph for 1 of 3 views, such as 'c': give the folder with files of these names" err
	[ "$(imported image | tr -d '\n')" = '["../photos/a.jpg"]["../photos/deep/b.jpg"][null]' ]
	"$BIN/gs-import" -q --cameras model --images "$PWD/photos/deep" -o out/scene s.ply 2>err
	[ ! -s err ]
	[ "$(jq -c 'map(.image)' out/scene/cameras.json)" = '[null,"../../photos/deep/b.jpg",null]' ]
	# Each is where its path says, seen from the scene.
	cd scene && [ -e ../photos/a.jpg ]
}

@test "photographs whose names come without an extension" {
	mkdir photos
	: >photos/b.JPG
	printf '[%s]' "$(camera3dgs)" >c.json
	"$BIN/gs-import" --cameras c.json --images photos -o scene s.ply
	[ "$(imported image)" = '["../photos/b.JPG"]' ]
	load pictures
	kind=0800 picture photos/b.JPG '00 11 22 33'
	"$BIN/gs-import" --cameras c.json --images photos -o scene s.ply 2>err
	grep -q "photos: the photographs of 1 of 1 views have another shape than their cameras ('b' is 4x1): give those that the cameras are of" err
	says 4 "gs-import: none: No such file or directory" "$BIN/gs-import" --cameras c.json --images none -o scene s.ply
	says 4 "gs-import: s.ply: Not a directory" "$BIN/gs-import" --cameras c.json --images s.ply -o scene s.ply
}

@test "photographs in other letters or of another ending, where one file is meant" {
	mkdir -p photos/Deep
	: >photos/A.JPEG && : >photos/Deep/B.Jpg && : >photos/Deep/b.png
	sed -i 's, b.jpg, deep/b.jpg,' model/images.txt
	"$BIN/gs-import" -q --cameras model --images photos -o scene s.ply
	[ "$(imported image | tr -d '\n')" = '["../photos/A.JPEG"]["../photos/Deep/B.Jpg"][null]' ]
	: >photos/a.png && : >photos/Deep/b.JPG
	"$BIN/gs-import" -q --cameras model --images photos -o scene s.ply
	[ "$(imported image | tr -d '\n')" = '[null][null][null]' ]
}

@test "several models of COLMAP: a larger one is named" {
	mkdir -p kitchen/sparse
	for k in 0 1 2; do cp -r model kitchen/sparse/$k; done
	sed -i '/ b.jpg$/,+1d; / c.jpg$/d' kitchen/sparse/0/images.txt
	sed -i '/ c.jpg$/d' kitchen/sparse/1/images.txt
	for cameras in kitchen kitchen/sparse kitchen/sparse/0; do
		"$BIN/gs-import" --cameras $cameras -o scene s.ply 2>err
		grep -qx "gs-import: warning: kitchen/sparse/0: has 1 images, and kitchen/sparse/0/../2 3: COLMAP could not join them, and each model has a frame of its own: give the one that the scene was trained with, as a rule the largest: --cameras kitchen/sparse/0/../2" err
		[ "$(imported name | tr -d '\n')" = '["a"]' ]
	done
	"$BIN/gs-import" --cameras kitchen/sparse/2 -o scene s.ply 2>err
	not grep -q warning err
}

@test "a photograph's path does not lead out of --images" {
	mkdir photos
	: >away.png
	for path in ../away.png "$PWD/away.png" deep/../../away.png; do
		printf '1 PINHOLE 8 6 5 5 4 3\n' >model/cameras.txt
		printf '1 1 0 0 0 0 0 2 1 %s\n\n' "$path" >model/images.txt
		"$BIN/gs-import" -q --cameras model --images photos -o scene s.ply
		[ "$(jq -r '.[0].image' scene/cameras.json)" = null ]
	done
}

@test "without --images no photograph is named" {
	: >a.jpg
	"$BIN/gs-import" --cameras model -o scene s.ply
	[ "$(imported image | tr -d '\n')" = '[null][null][null]' ]
}

# What is said where no photographs are given.
unchecked="gs-import: model: without --images the sizes of the photographs, how EXIF turns them, and whether the scene looks like them are not checked; masks of another shape, and masks that show no one scene, are refused by pseudomask-select, refer-lift and refer-train"

@test "Gaussians that are left out are counted, and named with -v" {
	splats_ply s.ply '0 0 2 1 0.5 0 0 -3 -3 -3 1 0 0 0' '0 0 nan 1 0.5 0 0 -3 -3 -3 1 0 0 0' \
		'0 0 2 1 0.5 0 0 -3 -3 -3 0 0 0 0' '0 0 2 1 0.5 0 0 -3 90 -3 1 0 0 0'
	says 0 "gs-import: warning: s.ply: left out 3 of 4 Gaussians: 2 not finite, 1 with a zero quaternion
$unchecked" "$BIN/gs-import" --cameras model -o scene s.ply
	says 0 "" "$BIN/gs-import" -q --cameras model -o scene s.ply
	"$BIN/gs-import" -v --cameras model --test-views a -o scene s.ply 2>err
	grep -v 's, peak memory' err >rest
	diff - rest <<-END
		gs-import: s.ply: 1 Gaussians, spherical harmonics of degree 0, offset 0 0 0
		gs-import: warning: s.ply: left out 3 of 4 Gaussians: 2 not finite, 1 with a zero quaternion
		gs-import: s.ply: left out Gaussian 1
		gs-import: s.ply: left out Gaussian 2
		gs-import: s.ply: left out Gaussian 3
		gs-import: model: 3 views, 1 of them for testing
		$unchecked
	END
	[ "$(wc -l <err)" = 8 ]
}

@test "photographs whose names no view can have: escaped, and nothing is written outside the output" {
	for name in .. ../.. a/.. "$(printf 'caf\xe9')" "$(printf 'b\t1.png')" x,y.jpg; do
		printf '1 1 0 0 0 0 0 2 1 %s\n\n' "$name" >model/images.txt
		rm -rf in && mkdir in
		"$BIN/gs-import" --cameras model -o in/scene s.ply
		"$BIN/gs-weigh" -q -o in/weights in/scene
		"$BIN/gs-check" in/scene in/weights/*.safetensors >>checked
		[ "$(ls -A in | tr '\n' ' ')" = "scene weights " ]
		jq -r '.[].name' in/scene/cameras.json >>named
	done
	[ "$(tr '\n' ' ' <named)" = '%2E%2E %2E%2E %2E%2E caf%E9 b%091 x%2Cy ' ]
}

@test "photographs in folders: short names where they differ, paths where not, whichever order they come in" {
	{
		printf '%s 1 0 0 0 0 0 2 1 %s\n\n' 1 images/0001.jpg 2 cam1/0002.png 3 cam2/0002.png 4 x/a_b.jpg 5 x_a/b.jpg \
			6 y/a_b.jpg 7 y/b.jpg
	} >model/images.txt
	names='["0001"]["cam1_0002"]["cam2_0002"]["x%2Fa_b.jpg"]["x_a%2Fb.jpg"]["y_a_b"]["y_b"]'
	"$BIN/gs-import" --cameras model -o scene s.ply
	[ "$(imported name | tr -d '\n')" = "$names" ]
	grep . model/images.txt | tac | sed 's/$/\n/' >turned && mv turned model/images.txt
	rm -r scene
	"$BIN/gs-import" --cameras model -o scene s.ply
	[ "$(imported name | tr -d '\n')" = "$names" ]
	# a flat folder has one of two
	mkdir flat
	touch flat/0002.png
	rm -r scene
	says 3 "gs-import: flat: views 'cam1_0002' and 'cam2_0002' have one photograph, 0002.png: give the folder that theirs are in" \
		"$BIN/gs-import" --cameras model --images flat -o scene s.ply
}

@test "a photograph whose path is not UTF-8 is not named" {
	name=$(printf 'caf\xe9.jpg')
	mkdir photos && : >"photos/$name" && : >photos/a.jpg
	printf '1 1 0 0 0 0 0 2 1 %s\n\n2 1 0 0 0 0 0 2 1 a.jpg\n' "$name" >model/images.txt
	"$BIN/gs-import" --cameras model --images photos -o scene s.ply 2>err
	grep -q "gs-import: warning: photos: no photograph for 1 of 2 views, such as " err
	[ "$(imported image | tr -d '\n')" = '["../photos/a.jpg"][null]' ]
	iconv -f utf-8 -t utf-8 scene/cameras.json >/dev/null
}

@test "no Gaussians at all" {
	ply_header 0 >s.ply
	says 3 "gs-import: s.ply: holds no Gaussians" "$BIN/gs-import" --cameras model -o scene s.ply
	[ ! -e scene ]
}

@test "a scene far from the origin: the offset is kept and the cameras move with it" {
	splats_ply s.ply '1000 -2000 52 1 0.5 0 0 -3 -3 -3 1 0 0 0' '1001 -2000 50 1 0.5 0 0 -3 -3 -3 1 0 0 0'
	"$BIN/gs-import" --cameras model -o scene s.ply
	grep -a -q '"offset":"\[1001,-2000,52\]"' scene/splats.safetensors
	# View a has -x + 1, -y, z + 2.
	[ "$(jq -c '.[0].world_to_camera|map(.[3])' scene/cameras.json)" = "[-1000,2000,54,1]" ]
}

@test "the camera file is not overwritten by the scene's" {
	printf '[%s]' "$(camera3dgs)" >cameras.json
	cp cameras.json before
	says 2 "gs-import: -o . would overwrite --cameras ./cameras.json
Try 'gs-import --help'." "$BIN/gs-import" -o . s.ply
	says 2 "gs-import: -o ../$(basename "$PWD") would overwrite --cameras ./cameras.json
Try 'gs-import --help'." "$BIN/gs-import" -o "../$(basename "$PWD")" s.ply
	cmp before cameras.json
	[ ! -e splats.safetensors ]
}

@test "a failure leaves nothing behind" {
	head -c 300 s.ply >cut.ply
	mkdir clean
	for args in "cut.ply --cameras model" "s.ply --cameras cut.ply" "s.ply --cameras model --test-views x"; do
		not "$BIN/gs-import" $args -o clean/scene 2>err
		[ -z "$(ls -A clean)" ]
	done
	: >clean/file
	says 4 "gs-import: clean/file: Not a directory" "$BIN/gs-import" --cameras model -o clean/file/scene s.ply
	mkdir -p scene/cameras.json
	not "$BIN/gs-import" --cameras model -o scene s.ply 2>err
	not grep tmp <(ls scene)
}

@test "the folder that 3DGS wrote: the last iteration, with its cameras; a folder without is none" {
	mkdir -p trained/point_cloud/iteration_7000 trained/point_cloud/iteration_30000
	splats_ply trained/point_cloud/iteration_7000/point_cloud.ply
	cp s.ply trained/point_cloud/iteration_30000/point_cloud.ply
	splats_ply trained/point_cloud/iteration_7000/point_cloud.ply '0 0 2 1 0.5 0 0 -3 -3 -3 1 0 0 0'
	printf 'ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nend_header\n' >trained/input.ply
	echo "Namespace(sh_degree=3)" >trained/cfg_args
	printf '[%s]' "$(camera3dgs)" >trained/cameras.json
	"$BIN/gs-import" -o scene trained
	"$BIN/gs-import" -o same trained/point_cloud/iteration_30000/point_cloud.ply
	diff -r scene same
	for part in point_cloud point_cloud/iteration_30000; do
		"$BIN/gs-import" -o part "trained/$part" --cameras trained
		diff -r scene part
	done
	mkdir empty
	says 3 "gs-import: empty: no trained splats in this folder: no point_cloud/iteration_N/point_cloud.ply, as 3DGS writes them, and no point_cloud.ply" \
		"$BIN/gs-import" --cameras model -o none empty
	[ ! -e none ]
}

@test "dataparser_transforms.json beside the splats or the cameras: cameras are moved into nerfstudio's frame" {
	mkdir -p export capture
	cp s.ply export/splat.ply
	transforms >capture/transforms.json
	# a quarter turn about z, then a shift, then a half: (1,2,3) becomes ((-2,1,3) + (1,1,1)) / 2
	echo '{"transform": [[0,-1,0,1],[1,0,0,1],[0,0,1,1]], "scale": 0.5}' >dataparser_transforms.json
	centre() { jq -c '.[0].world_to_camera as $m | [range(3) as $i | -([range(3) as $k | $m[$k][$i] * $m[$k][3]] | add) | . * 1e6 | round / 1e6]' scene/cameras.json; }
	"$BIN/gs-import" --cameras capture -o scene export/splat.ply
	[ "$(centre)" = "[1,2,3]" ]
	for beside in export capture; do
		cp dataparser_transforms.json "$beside"
		"$BIN/gs-import" -v --cameras capture -o scene export/splat.ply 2>err
		grep -qF "$beside/dataparser_transforms.json: cameras are moved by it" err
		[ "$(centre)" = "[-0.5,1,2]" ]
		# camera x, which was the world's x, is now its y
		[ "$(jq -c '.[0].world_to_camera[0][:3]' scene/cameras.json)" = "[0,1,0]" ]
		rm "$beside/dataparser_transforms.json"
	done
	# what nerfstudio had applied before it wrote the transforms.json is in both files, and is done once
	cp dataparser_transforms.json capture
	transforms | jq '.applied_transform = [[0,-1,0,1],[1,0,0,1],[0,0,1,1]] | .applied_scale = 0.5' >capture/transforms.json
	"$BIN/gs-import" --cameras capture -o scene export/splat.ply
	[ "$(centre)" = "[1,2,3]" ]
	# 3DGS's own cameras are in the frame of its splats; a COLMAP model is where nerfstudio began
	printf '[%s]' "$(camera3dgs)" >capture/cameras.json
	"$BIN/gs-import" --cameras capture/cameras.json -o scene export/splat.ply
	[ "$(centre)" = "[1,2,3]" ]
	echo '{"transform": [[0,-1,0,1],[1,0,0,1],[0,0,2,1]], "scale": 0.5}' >capture/dataparser_transforms.json
	says 3 "gs-import: capture/dataparser_transforms.json: key 'transform' is not a rotation and a shift" \
		"$BIN/gs-import" --cameras capture/transforms.json -o none export/splat.ply
	echo '{"transform": [[0,-1,0,1],[1,0,0,1],[0,0,1,1]], "scale": 0}' >capture/dataparser_transforms.json
	says 3 "gs-import: capture/dataparser_transforms.json: key 'scale' is not positive" \
		"$BIN/gs-import" --cameras capture/transforms.json -o none export/splat.ply
	[ ! -e none ]
}

@test "splats that are not where the points of the cameras' reconstruction are: a warning, without photographs" {
	# 500 of a ball's surface, and a part of it
	awk 'BEGIN {for (i = 0; i < 500; i++) {z = i / 250 - 1; r = sqrt(1 - z * z); print r * cos(2.4 * i), r * sin(2.4 * i), z + 4}}' >places
	points() { awk '{print NR, $0, "9 9 9 0.5 1 2"}' "$1" >model/points3D.txt; }
	splats() { mapfile -t rows < <(awk -v s="$1" '{print s * $1, s * $2, s * $3, "1 0 0 0 -3 -3 -3 1 0 0 0"}' "$2"); splats_ply s.ply "${rows[@]}"; }
	points places
	splats 1 places
	says 0 "$unchecked" "$BIN/gs-import" --cameras model -o scene s.ply
	head -n 150 places >part
	splats 1 part
	says 0 "$unchecked" "$BIN/gs-import" --cameras model -o scene s.ply
	splats 0.5 places
	for kind in txt ply; do
		"$BIN/gs-import" --cameras model -o scene s.ply 2>err
		grep -qE '^gs-import: warning: model: the splats are in another frame than the cameras, or of another scene: [0-9]% of the points beside the cameras are near a splat, or the other way round, at least 40% is right: gsplat trains ' err
		rm -f model/points3D.txt
		{ ply_header 500 'x y z'; cat places; } >model/points3D.ply
	done
	# what is no points is none
	for file in bin txt; do
		echo "# nothing 1 2 3 nan" >"model/points3D.$file"
		splats 1 places
		says 0 "$unchecked" "$BIN/gs-import" --cameras model -o scene s.ply
	done
}

@test "a scene that does not look like its photographs: a warning; one that does: none" {
	"$BIN/gs-synth" -q --objects 3 --views 5 --size 96x72 --gaussians 2000 -o made
	"$BIN/gs-import" --cameras made/sparse/0 --images made/images -o scene made/point_cloud.ply 2>err
	[ ! -s err ]
	# the same photographs under the next names
	mkdir other
	for i in 0 1 2 3 4; do cp "made/images/view_00$(((i + 1) % 5)).png" "other/view_00$i.png"; done
	"$BIN/gs-import" --cameras made/sparse/0 --images other -o scene made/point_cloud.ply 2>err
	[ "$(wc -l <err)" = 1 ]
	grep -qE '^gs-import: warning: other: the scene does not look like its photographs \(by -?0\.[0-3][0-9] in the middle of 5 views, at least 0\.4 is right\): are made/sparse/0 the cameras that it was trained with, and in its frame\? gsplat trains .* were moved with them$' err
	"$BIN/gs-import" -q --cameras made/sparse/0 --images other -o scene made/point_cloud.ply 2>err
	[ ! -s err ]
	# what cannot be read is not compared, and that is said
	for i in 0 1 2; do cp "made/images/view_00$i.png" other; done
	for i in 3 4; do echo none >"other/view_00$i.png"; done
	says 0 "gs-import: warning: 2 of 5 photographs are not compared with the scene: scene/../other/view_003.png: neither PNG nor JPEG: begins with byte 0x6e: 'mogrify -format png' makes a PNG of most pictures" \
		"$BIN/gs-import" --cameras made/sparse/0 --images other -o scene made/point_cloud.ply
	# photographs that are turned against their cameras, which are turned about their axis here: by a quarter, and the first upside down
	turned() {
		says 0 "gs-import: warning: made/images: the photographs of $1 of 5 views are turned against their cameras ('view_000' is right after $2 degrees clockwise): turn their pixels as EXIF says ('mogrify -auto-orient'), or give those that the cameras are of" \
			"$BIN/gs-import" --cameras m --images made/images -o scene made/point_cloud.ply
	}
	mkdir m
	awk '/^[0-9]/ {print $1, $2, $4, $3, $5, $6, $8, $7}' made/sparse/0/cameras.txt >m/cameras.txt
	awk '/^[0-9]/ {print $1, $2 - $5, $3 - $4, $4 + $3, $5 + $2, -$7, $6, $8, $9, $10; print ""}' made/sparse/0/images.txt >m/images.txt
	turned 5 90
	cp made/sparse/0/cameras.txt m
	awk '/^1 / {print $1, -$5, -$4, $3, $2, -$6, -$7, $8, $9, $10; next} {print}' made/sparse/0/images.txt >m/images.txt
	turned 1 180
}
