#!/usr/bin/env bats
# box-detect, mostly with weights that find a cup in each of 13 x 13 parts of any picture (detector.sh). Options that every tool has are in
# common.bats, each rule of the records in tests/format/detections.bats, the network itself in tests/unit/test_nanodet.c.

setup_file() { "$BATS_TEST_DIRNAME/detector.sh" "$BATS_FILE_TMPDIR/model"; }

setup() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	load ../format/files
	load pictures
	cd "$BATS_TEST_TMPDIR"
	export OMP_WAIT_POLICY=passive
	picture red.png 'ff0000 ff0000' 'ff0000 ff0000' '0000ff 0000ff'
}

find_in() { "$BIN/box-detect" --model "$BATS_FILE_TMPDIR/model" "$@"; }

# refused STATUS LINE ARGUMENT...: so it ends, and nothing is left.
refused() {
	local status=$1 line=$2
	shift 2
	says "$status" "box-detect: $line" find_in -o none "$@" && [ ! -e none ] && [ -z "$(find . -name '.*' -type f)" ]
}

# The sizes of the pictures in records, each once, and the outermost sides of all boxes.
frame() { jq -sc '[(map(.size) | unique[]), (map(.box) | [map(.[0]) | min, (map(.[1]) | min), (map(.[2]) | max), (map(.[3]) | max)][0:4])]' | head -c 200; }

@test "a record for each box, and what it has" {
	find_in -o boxes red.png
	"$BIN/gs-check" boxes | grep -qx 'boxes: ok: detections, 169 boxes, 1 views, 1 classes'
	[ "$(head -n 1 boxes)" = '{"view":"red","class":"cup","score":0.5,"size":[3,2],"box":[0,0,0.15,0.23]}' ]
	[ "$(tail -n 1 boxes)" = '{"view":"red","class":"cup","score":0.5,"size":[3,2],"box":[1.85,2.77,2,3]}' ]
	find_in red.png | cmp - boxes
	find_in -o - --threads 1 red.png | cmp - boxes
	find_in --threads 2 ./red.png | cmp - boxes
	find_in --score 0.51 -o few red.png
	[ -e few ] && [ ! -s few ]
}

@test "pictures in the order of the command line; those of one name keep their folders" {
	mkdir a b
	cp red.png a/v.png
	cp red.png b/v.png
	cp red.png 'two words.PNG'
	[ "$(find_in red.png b/v.png a/v.png 'two words.PNG' | jq -r .view | uniq)" = $'red\nb_v\na_v\ntwo words' ]
	refused 3 "the pictures: two views are of 'red.png': take one out" red.png red.png
}

@test "greys, palettes' like, 16 bits, what is transparent, and JPEG" {
	kind=0800 picture grey.png 'ff 00 80'
	kind=1002 picture deep.png 'ffffffffffff 000000000000' '000000000000 ffffffffffff'
	kind=0806 picture clear.png 'ff000000 ff0000ff'
	for one in 'grey [1,3]' 'deep [2,2]' 'clear [1,2]'; do
		[ "$(find_in "${one% *}.png" | jq -c .size | uniq)" = "${one#* }" ]
	done
	# 16 wide and 8 high as it is stored, and EXIF says that it is turned by a quarter
	xxd -r -p >plain.jpg <<<'ffd8ffe000104a46494600010100000100010000ffdb004300100b0c0e0c0a100e0d0e1211101318281a181616183123251d283a333d3c3933383740485c4e404457453738506d51575f626768673e4d71797064785c656763ffdb0043011112121815182f1a1a2f634238426363636363636363636363636363636363636363636363636363636363636363636363636363636363636363636363636363ffc00011080008001003012200021101031101ffc4001500010100000000000000000000000000000006ffc40014100100000000000000000000000000000000ffc40014010100000000000000000000000000000000ffc40014110100000000000000000000000000000000ffda000c03010002110311003f00895b003fffd9'
	{
		head -c 2 plain.jpg
		printf '\xff\xe1\0\x22Exif\0\0MM\0\x2a\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0\x06\0\0\0\0\0\0'
		tail -c +3 plain.jpg
	} >turned.jpg
	for name in plain turned; do
		[ "$(find_in $name.jpg | jq -c .size | uniq)" = '[8,16]' ]
	done
	cmp <(find_in plain.jpg | jq -c .box) <(find_in turned.jpg | jq -c .box)
}

@test "--crops: the whole picture and six parts" {
	picture wide.png "$(printf 'ffffff%.0s' {1..16})" "$(printf '000000%.0s' {1..16})" "$(printf 'ff00ff%.0s' {1..16})"
	find_in --crops wide.png >boxes
	[ "$(jq -sc 'map(.box) | [(map(.[0]) | min), (map(.[1]) | min), (map(.[2]) | max), (map(.[3]) | max)]' boxes)" = '[0,0,16,3]' ]
	[ "$(jq -s length boxes)" -gt 500 ]
	jq -se 'all(.[]; .box[0] < .box[2] and .box[1] < .box[3])' boxes
	picture one.png ffffff
	find_in --crops one.png | jq -se 'all(.[]; .box[2] <= 1 and .box[3] <= 1)'
}

@test "--scene: the views' photographs; views without one are told" {
	"$BIN/gs-synth" -q --objects 2 --views 3 --size 32x24 --gaussians 1000 -o .
	"$BIN/gs-import" -q --images images -o scene point_cloud.ply
	find_in --scene scene -o boxes
	[ "$(jq -r .view boxes | uniq | tr '\n' ' ')" = 'view_000 view_001 view_002 ' ]
	cmp boxes <(find_in images/*.png)
	jq -c '.[1].image = null' scene/cameras.json >c && mv c scene/cameras.json
	says 0 'box-detect: warning: scene/cameras.json: 1 of 3 views have no photograph' find_in --scene scene -o fewer
	cmp fewer <(grep -v view_001 boxes)
	jq -c 'map(.image = null)' scene/cameras.json >c && mv c scene/cameras.json
	refused 3 "scene/cameras.json: no view has a photograph: give 'gs-import --images DIR' their folder" --scene scene
}

@test "what is no picture, or too large, or not there" {
	echo text >text.png
	: >empty.png
	head -c 60 red.png >cut.png
	{ printf 89504e470d0a1a0a; chunk IHDR "$(number 30000)$(number 30000)0802000000"; chunk IDAT 789c030000000001; } | xxd -r -p >huge.png
	refused 3 "text.png: neither PNG nor JPEG: begins with byte 0x74: 'mogrify -format png' makes a PNG of most pictures" text.png
	refused 3 'empty.png: an empty file, not an image' empty.png
	refused 3 'huge.png: PNG: 30000x30000 pixels, more than 268435456 altogether' red.png huge.png
	run find_in -o none red.png cut.png
	[ "$status" = 3 ] && [[ $output == "box-detect: cut.png: PNG: "* ]] && [ ! -e none ]
	refused 4 'gone.png: No such file or directory' red.png gone.png
}

@test "the command line" {
	local try="Try 'box-detect --help'."
	refused 2 "either --scene SCENE or photographs
$try"
	refused 2 "either --scene SCENE or photographs
$try" --scene x red.png
	refused 2 "a photograph has a file's name, which is its view's: - has none
$try" -
	refused 2 "--score: '0' is not a number from 0.01 to 1
$try" --score 0 red.png
}

@test "weights: the default, damaged and other ones" {
	export XDG_CACHE_HOME=$PWD/cache
	says 4 "box-detect: $PWD/cache/refersplat/detector: no detector there: 'refersplat-detector' fetches one, in a checkout 'make detector'" \
		"$BIN/box-detect" red.png
	mkdir -p cache/refersplat
	ln -s "$BATS_FILE_TMPDIR/model" cache/refersplat/detector
	"$BIN/box-detect" red.png | cmp - <(find_in red.png)
	other() { says "$1" "box-detect: $2" "$BIN/box-detect" --model "$3" -o none red.png && [ ! -e none ]; }
	other 3 "$BATS_TEST_DIRNAME/../golden/bert/model.safetensors: tensor 'convs.0.weight' is missing" "$BATS_TEST_DIRNAME/../golden/bert"
	mkdir bad
	other 4 "bad: has no *.safetensors file" bad
	cp cache/refersplat/detector/model.safetensors bad
	sed -i '1s/\[288,16\]/[144,32]/' bad/model.safetensors
	other 3 "bad/model.safetensors: tensor 'convs.2.weight': is F16[144,32], expected F16[288,16]" bad
	cp cache/refersplat/detector/model.safetensors bad
	printf '\0\x7c' | dd of=bad/model.safetensors bs=1 conv=notrunc seek=$(($(stat -Lc %s bad/model.safetensors) - 2)) 2>dd
	other 3 "bad/model.safetensors: tensor 'convs.33.weight': item 15871 is not finite" bad
	truncate -s -2 bad/model.safetensors
	says_bad=$("$BIN/box-detect" --model bad -o none red.png 2>&1) && false
	[[ $says_bad == "box-detect: bad/model.safetensors: tensor 'convs.33.weight': ends at data offset "* ]]
}

# What TensorFlow.js makes of its own graph of these weights, on the same picture.
@test "NanoDet's weights on a made picture, where they are there" {
	local model=${XDG_CACHE_HOME:-$HOME/.cache}/refersplat/detector
	[ -e "$model/model.safetensors" ] || skip "no detector: 'make detector' fetches it"
	"$BIN/gs-synth" -q --scene diner --seed 1 --views 2 --gaussians 20000 --size 320x240 -o .
	"$BIN/box-detect" --model "$model" --score 0.4 -o boxes images/view_000.png
	jq -r '[.class, .score, .box[]] | map(tostring) | join(" ")' boxes >found
	paste -d' ' found - <<-END | awk '$1 != $7 { exit 1 } { for (k = 2; k < 7; k++) { d = $k - $(k + 6); if (d < 0) d = -d; if (d > (k == 2 ? 0.001 : 0.05)) exit 1 } } END { exit NR != 4 }'
		cake 0.5605189 1.241171 37.537747 320 236.292014
		apple 0.4587896 264.535140 64.349750 295.818676 93.295753
		banana 0.4553355 241.661877 98.292114 311.478273 135.408872
		apple 0.4240697 194.874029 88.747824 228.932229 120.211832
	END
}
