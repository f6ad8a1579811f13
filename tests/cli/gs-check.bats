#!/usr/bin/env bats
# gs-check. What it says of broken files is in tests/format; options that every tool has are in common.bats.

setup() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	load ../format/files
	cd "$BATS_TEST_TMPDIR"
	scene scene
	echo '{"ref":"r1","object":"cup","text":"the red cup"}' >sentences.jsonl
	echo '{"view":"v1","object":"cup","segmentation":{"size":[2,3],"counts":[0,2,4]}}' >masks.jsonl
	st foreign.safetensors '{"weight":{"dtype":"BF16","shape":[2,1],"data_offsets":[0,4]}}' 00000000
}

@test "a line for each file, in the order given" {
	says 0 "sentences.jsonl: ok: sentences, 1 training sentences, 0 test sentences, 1 objects
scene: ok: scene, 4x3, 1 gaussians, 1 harmonics, 1 training views, 0 test views, scene ef6eb604187a17fa
masks.jsonl: ok: masks, 3x2, 1 masks, 1 views, 1 objects
foreign.safetensors: ok: safetensors, 1 tensors
	weight BF16[2,1]" "$BIN/gs-check" sentences.jsonl scene masks.jsonl foreign.safetensors
}

@test "cameras of other programs" {
	echo '[{"id":0,"img_name":"a","width":4,"height":3,"position":[0,0,0],"rotation":[[1,0,0],[0,1,0],[0,0,1]],"fx":5,"fy":5}]' >c.json
	says 0 "c.json: ok: 3DGS cameras, 4x3, 1 training views, 0 test views" "$BIN/gs-check" c.json
	frames='"frames":[{"file_path":"a.png","transform_matrix":[[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]}]'
	printf '{"fl_x":5,"fl_y":5,"cx":2,"cy":1.5,"w":4,"h":3,%s}\n' "$frames" >one-line.json
	says 0 "one-line.json: ok: nerfstudio cameras, 4x3, 1 training views, 0 test views" "$BIN/gs-check" one-line.json
	tr , '\n' <one-line.json | sed 's/^/ /; 2,$s/^/,/' >lines.json
	cat lines.json | says_in 0 "stdin: ok: nerfstudio cameras, 4x3, 1 training views, 0 test views"
	mkdir model
	echo '1 PINHOLE 4 3 5 5 2 1.5' >model/cameras.txt
	printf '1 1 0 0 0 0 0 0 1 a.png\n\n' >model/images.txt
	says 0 "model: ok: COLMAP model, 4x3, 1 training views, 0 test views" "$BIN/gs-check" model
}

@test "what a file is depends on its content, not its name" {
	mv sentences.jsonl x.png
	says 0 "x.png: ok: sentences, 1 training sentences, 0 test sentences, 1 objects" "$BIN/gs-check" x.png
}

@test "arrays in a zip, by its content" {
	load npy
	golden=$BATS_TEST_DIRNAME/../golden/npz
	for saved in stored deflated; do
		said=$("$BIN/gs-check" "$golden/$saved.npz")
		[[ $said == *": ok: npz, "[1-9]*" arrays, "[1-9]*" values" ]]
		cp "$golden/$saved.npz" another
		[ "$("$BIN/gs-check" another)" = "another: ok: ${said##*: ok: }" ]
		[ "$(cat another | "$BIN/gs-check" -)" = "stdin: ok: ${said##*: ok: }" ]
	done
	npy a.npy '<f4' '2, 3' $(printf '%048d' 0)
	npy b.npy '|u1' '4' 01020304
	npz all.npz a.npy b.npy
	[ "$("$BIN/gs-check" all.npz)" = "all.npz: ok: npz, 2 arrays, 10 values" ]
	npy b.npy '|u1' '5' 01020304
	npz all.npz a.npy b.npy
	run "$BIN/gs-check" all.npz
	[ "$status" = 1 ]
	[[ $output == "all.npz: b.npy: offset 128: 4 bytes of data, the shape has 5 values of 1" ]] || { echo "$output"; false; }
	head -c 200 "$golden/stored.npz" >cut
	run "$BIN/gs-check" cut
	[ "$status" = 1 ]
	[[ $output == *"cut: not a zip, or its end is missing" ]]
}

@test "json: one object a line, the same facts" {
	"$BIN/gs-check" --json sentences.jsonl scene foreign.safetensors >out
	cat >expected <<-'END'
		{"file":"sentences.jsonl","ok":true,"kind":"sentences","training_sentences":1,"test_sentences":0,"objects":1}
		{"file":"scene","ok":true,"kind":"scene","width":4,"height":3,"gaussians":1,"harmonics":1,"training_views":1,"test_views":0,"scene":"ef6eb604187a17fa"}
		{"file":"foreign.safetensors","ok":true,"kind":"safetensors","tensors":1,"list":[{"name":"weight","dtype":"BF16","shape":[2,1]}]}
	END
	diff expected out
	echo '{}' >bad.jsonl
	says 1 '{"file":"bad.jsonl","ok":false,"reason":"bad.jsonl:1: neither a sentence (key '\''text'\'') nor a mask (key '\''segmentation'\'' or '\''path'\'')"}' \
		"$BIN/gs-check" --json bad.jsonl
}

@test "a malformed file is exit 1, and the others are checked all the same" {
	echo nonsense >bad
	says 1 "bad: not a kind of file that the suite reads
masks.jsonl: ok: masks, 3x2, 1 masks, 1 views, 1 objects" "$BIN/gs-check" bad masks.jsonl
}

@test "a file that cannot be read is exit 4, also beside a malformed one" {
	echo nonsense >bad
	says 4 "gs-check: none: No such file or directory" "$BIN/gs-check" none
	status=0
	"$BIN/gs-check" none bad masks.jsonl >out 2>err || status=$?
	[ $status = 4 ]
	[ "$(cat err)" = "gs-check: none: No such file or directory" ]
	[ "$(wc -l <out)" = 2 ]
}

@test "stdin is read as a file or as a pipe" {
	for file in sentences.jsonl masks.jsonl foreign.safetensors scene/splats.safetensors scene/cameras.json; do
		"$BIN/gs-check" "$file" | sed "s,^$file:,stdin:," >expected
		"$BIN/gs-check" - <"$file" | cmp - expected
		cat "$file" | "$BIN/gs-check" - | cmp - expected
	done
	echo nonsense | says_in 1 "stdin: not a kind of file that the suite reads"
	printf '{"text":1}' | says_in 1 "stdin:1: key 'ref' is missing"
	printf '' | says_in 1 "stdin: empty"
}

# says, for what comes through a pipe.
says_in() {
	local printed status=0
	printed=$("$BIN/gs-check" - 2>&1) || status=$?
	[ $status = "$1" ] && [ "$printed" = "$2" ] || { echo "$status: $printed"; return 1; }
}

@test "a pipe with a name, which cannot be read twice, is refused" {
	mkfifo pipe
	says 4 "gs-check: pipe: a pipe, which cannot be read twice: '-' reads one from standard input" timeout 9 "$BIN/gs-check" pipe
	# but not read as what is left of it: "ok, 0 masks"
	says 4 "gs-check: /dev/stdin: a pipe, which cannot be read twice: '-' reads one from standard input" \
		bash -c 'cat masks.jsonl | "$1" /dev/stdin' _ "$BIN/gs-check"
}

@test "files as large as no buffer come through a pipe whole" {
	for ((i = 0; i < 3000; i++)); do echo "{\"ref\":\"r$i\",\"object\":\"cup\",\"text\":\"the red cup $i\"}"; done >many
	cat many | says_in 0 "stdin: ok: sentences, 3000 training sentences, 0 test sentences, 1 objects"
}

@test "views and masks of several sizes have no size to print" {
	echo '{"view":"v2","object":"pot","segmentation":{"size":[3,3],"counts":[9]}}' >>masks.jsonl
	says 0 "masks.jsonl: ok: masks, 2 masks, 2 views, 2 objects" "$BIN/gs-check" masks.jsonl
	printf '[%s,%s]' "$(view)" "$(view name='"v2"' width=8 split='"test"')" >scene/cameras.json
	says 0 "scene: ok: scene, 1 gaussians, 1 harmonics, 1 training views, 1 test views, scene ef6eb604187a17fa" "$BIN/gs-check" scene
}

@test "a folder of another kind" {
	mkdir other
	says 1 "other: not a scene, COLMAP model or folder of weights" "$BIN/gs-check" other
}

@test "a folder of weights, and one view of it" {
	tensors='"indptr":{"dtype":"I64","shape":[3],"data_offsets":[0,24]},"index":{"dtype":"I32","shape":[2],"data_offsets":[24,32]},"dropped":{"dtype":"F32","shape":[2],"data_offsets":[32,40]},"weight":{"dtype":"F32","shape":[2],"data_offsets":[40,48]}'
	header="{\"__metadata__\":{\"format\":\"refer.weights\",\"version\":\"1\",\"width\":\"2\",\"height\":\"1\",\"gaussians\":\"3\"},$tensors}"
	while (((8 + ${#header}) % 8)); do header+=' '; done
	mkdir weights
	for id in 00 02 03; do
		st weights/v$id.safetensors "$header" 000000000000000001000000000000000200000000000000${id}00000001000000$f0$f0$fhalf$f1
	done
	says 0 "weights/v02.safetensors: ok: refer.weights, f32, 2x1, 2 weights, 3 gaussians of the scene" "$BIN/gs-check" weights/v02.safetensors
	says 1 "weights/v03.safetensors: tensor 'index': entry 0 is 3, not in 0 to 2" "$BIN/gs-check" weights
	rm weights/v03.safetensors
	says 0 "weights: ok: weights, 2 views, 4 weights" "$BIN/gs-check" weights
}

@test "no operand is a usage error" {
	says 2 "gs-check: missing operand: FILE...
Try 'gs-check --help'." "$BIN/gs-check"
}

@test "a full disk is an error" {
	[ -e /dev/full ] || skip "no /dev/full"
	status=0
	"$BIN/gs-check" scene >/dev/full 2>err || status=$?
	[ $status = 4 ]
	[ "$(cat err)" = "gs-check: stdout: No space left on device" ]
}

@test "-v ends with time and memory" {
	"$BIN/gs-check" -v scene 2>err >out
	grep -xE 'gs-check: [0-9.]+ s, peak memory [0-9.]+ MiB' err
}
