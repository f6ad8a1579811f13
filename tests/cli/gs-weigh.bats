#!/usr/bin/env bats
# gs-weigh. Options that every tool has are in common.bats; what makes a weights file malformed in format/weights.bats;
# whether the weights are right in unit/test_render.c.

setup() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	load ../format/files
	load npy
	cd "$BATS_TEST_TMPDIR"
	scene scene
}

# cameras VIEW...: replaces the scene's views.
cameras() {
	local IFS=,
	printf '[%s]\n' "$*" >scene/cameras.json
}

@test "a file for each training view" {
	cameras "$(view)" "$(view name='"v2"')" "$(view name='"v3"' split='"test"')"
	"$BIN/gs-weigh" -o weights scene
	[ "$(ls weights)" = "v1.safetensors
v2.safetensors" ]
	"$BIN/gs-check" weights/v1.safetensors weights/v2.safetensors
}

@test "--split chooses test views, or all" {
	cameras "$(view)" "$(view name='"v3"' split='"test"')"
	"$BIN/gs-weigh" --split test -o test scene
	[ "$(ls test)" = v3.safetensors ]
	"$BIN/gs-weigh" --split all -o all scene
	[ "$(ls all)" = "v1.safetensors
v3.safetensors" ]
}

@test "a split without views is exit 3, and nothing is made" {
	says 3 "gs-weigh: scene: no view belongs to split 'test'" "$BIN/gs-weigh" --split test -o weights scene
	[ ! -e weights ]
}

@test "the one Gaussian is in every pixel, strongest in the middle" {
	cameras "$(view width=3 height=1 cx=1.5 cy=0.5)"
	"$BIN/gs-weigh" -o weights scene
	[ "$(tensor weights/v1.safetensors indptr d8)" = "0 1 2 3" ]
	[ "$(tensor weights/v1.safetensors index d4)" = "0 0 0" ]
	[ "$(tensor weights/v1.safetensors dropped f4)" = "0 0 0" ]
	# sigma^2 = (5 * 0.5 / 2)^2 + 0.3; beside the middle exp(-1 / (2 sigma^2)), and there 0.99 in place of 1
	tensor weights/v1.safetensors weight f4 | awk '{
		d = exp(-1 / (2 * (1.25 ^ 2 + 0.3)))
		exit !(($1 - d) ^ 2 < 1e-12 && ($2 - 0.99) ^ 2 < 1e-12 && ($3 - d) ^ 2 < 1e-12)
	}'
	[ "$(meta weights/v1.safetensors width)x$(meta weights/v1.safetensors height)" = 3x1 ]
	[ "$(meta weights/v1.safetensors gaussians)" = 1 ]
	[ "$(meta weights/v1.safetensors view)" = v1 ]
	[ "$(meta weights/v1.safetensors options)" = "--scale 1 --tolerance 0 --precision f32" ]
}

@test "--scale rounds the size, and is at least a pixel" {
	cameras "$(view width=5 height=3)"
	"$BIN/gs-weigh" --scale 0.5 -o weights scene
	[ "$(meta weights/v1.safetensors width)x$(meta weights/v1.safetensors height)" = 3x2 ]
	"$BIN/gs-weigh" --scale 0.01 -o weights scene
	[ "$(meta weights/v1.safetensors width)x$(meta weights/v1.safetensors height)" = 1x1 ]
}

@test "--precision f16 stores the nearest halves" {
	cameras "$(view width=3 height=1 cx=1.5 cy=0.5)"
	"$BIN/gs-weigh" --precision f16 -o weights scene
	# 0.7645 is 1.529 / 2: 0x3a1e; 0.99 is 0x3bec
	[ "$(tensor weights/v1.safetensors weight x2)" = "3a1e 3bec 3a1e" ]
	"$BIN/gs-check" weights/v1.safetensors
}

@test "--precision u8 stores whole numbers of 1/255" {
	cameras "$(view width=3 height=1 cx=1.5 cy=0.5)"
	"$BIN/gs-weigh" --precision u8 -o weights scene
	# 0.7645 is 194.9 / 255, 0.99 is 252.45 / 255
	[ "$(tensor weights/v1.safetensors weight u1)" = "195 252 195" ]
	[ "$(tensor weights/v1.safetensors dropped f4)" = "0 0 0" ]
	[ "$(meta weights/v1.safetensors options)" = "--scale 1 --tolerance 0 --precision u8" ]
	says 0 "weights/v1.safetensors: ok: refer.weights, u8, 3x1, 3 weights, 1 gaussians of the scene, scene ef6eb604187a17fa, camera 235f55ec169d8d85" \
		"$BIN/gs-check" weights/v1.safetensors
}

# Two Gaussians behind each other in one pixel: 0.5 in front, then 0.99 of the rest. OPACITIES, of the one behind and the one
# in front, are others.
two_layers() {
	local header opacities=${1:-$f1$fhalf}
	header='{"__metadata__":{"format":"refer.splats","version":"1"},"means":{"dtype":"F32","shape":[2,3],"data_offsets":[0,24]},"scales":{"dtype":"F32","shape":[2,3],"data_offsets":[24,48]},"quats":{"dtype":"F32","shape":[2,4],"data_offsets":[48,80]},"opacities":{"dtype":"F32","shape":[2],"data_offsets":[80,88]},"sh":{"dtype":"F32","shape":[2,1,3],"data_offsets":[88,112]}}'
	while (((8 + ${#header}) % 4)); do header+=' '; done
	st scene/splats.safetensors "$header" \
		"$f0$f0$f1$f0$f0$f0$f1$f1$f1$f1$f1$f1$f1$f0$f0$f0$f1$f0$f0$f0$opacities$f0$f0$f0$f0$f0$f0"
	cameras "$(view width=1 height=1 cx=0.5 cy=0.5)"
}

@test "layers stand front to back, whatever their order in the scene" {
	two_layers
	"$BIN/gs-weigh" -o weights scene
	[ "$(tensor weights/v1.safetensors index d4)" = "1 0" ]
	tensor weights/v1.safetensors weight f4 | awk '{ exit !(($1 - 0.5) ^ 2 < 1e-12 && ($2 - 0.495) ^ 2 < 1e-12) }'
}

@test "--tolerance leaves out the smallest weights and records their sum" {
	two_layers
	"$BIN/gs-weigh" --tolerance 0.49 -o weights scene # the smaller is 0.4975 of the sum
	[ "$(tensor weights/v1.safetensors index d4)" = "1 0" ]
	[ "$(tensor weights/v1.safetensors dropped f4)" = 0 ]
	"$BIN/gs-weigh" --tolerance 0.5 -o weights scene
	[ "$(tensor weights/v1.safetensors indptr d8)" = "0 1" ]
	[ "$(tensor weights/v1.safetensors index d4)" = 1 ]
	tensor weights/v1.safetensors dropped f4 | awk '{ exit !(($1 - 0.495) ^ 2 < 1e-12) }'
	"$BIN/gs-check" weights/v1.safetensors
}

@test "--precision u8 leaves out what would round to 0, and records it with the rest" {
	two_layers cdcccc3d$f1 # 0.1 behind 0.99: 0.001, which is below 1/510
	"$BIN/gs-weigh" --precision u8 -v -o weights scene 2>err
	grep -q '^gs-weigh: v1: 1x1, 1 weights' err
	[ "$(tensor weights/v1.safetensors indptr d8)" = "0 1" ]
	[ "$(tensor weights/v1.safetensors index d4)" = 1 ]
	[ "$(tensor weights/v1.safetensors weight u1)" = 252 ]
	tensor weights/v1.safetensors dropped f4 | awk '{ exit !(($1 - 0.001) ^ 2 < 1e-12) }'
	two_layers cdcc4c3e$f1 # 0.2: 0.002, which is 1/255
	"$BIN/gs-weigh" --precision u8 -o weights scene
	[ "$(tensor weights/v1.safetensors weight u1)" = "252 1" ]
	# What --tolerance leaves out is in the same sum: 0.495 of 0.5 in front, 0.99 of the rest behind.
	two_layers
	"$BIN/gs-weigh" --precision u8 --tolerance 0.5 -o weights scene
	tensor weights/v1.safetensors dropped f4 | awk '{ exit !(($1 - 0.495) ^ 2 < 1e-12) }'
	"$BIN/gs-check" weights/v1.safetensors
}

@test "a scene without Gaussians has empty weights" {
	header='{"__metadata__":{"format":"refer.splats","version":"1"},"means":{"dtype":"F32","shape":[0,3],"data_offsets":[0,0]},"scales":{"dtype":"F32","shape":[0,3],"data_offsets":[0,0]},"quats":{"dtype":"F32","shape":[0,4],"data_offsets":[0,0]},"opacities":{"dtype":"F32","shape":[0],"data_offsets":[0,0]},"sh":{"dtype":"F32","shape":[0,1,3],"data_offsets":[0,0]}}'
	while (((8 + ${#header}) % 4)); do header+=' '; done
	st scene/splats.safetensors "$header"
	"$BIN/gs-weigh" -o weights scene
	says 0 "weights/v1.safetensors: ok: refer.weights, f32, 4x3, 0 weights, 0 gaussians of the scene, scene ef46db3751d8e999, camera 94cadf8ef19b53e7" \
		"$BIN/gs-check" weights/v1.safetensors
}

@test "splats that no view sees are a mistake, and nothing is left; a view that sees none is fine" {
	cameras "$(view)" "$(view name='"v2"' 'world_to_camera=[[1,0,0,0],[0,-1,0,0],[0,0,-1,0],[0,0,0,1]]')"
	"$BIN/gs-weigh" -o weights scene
	[ "$(ls weights)" = $'v1.safetensors\nv2.safetensors' ]
	cameras "$(view 'world_to_camera=[[1,0,0,0],[0,-1,0,0],[0,0,-1,0],[0,0,0,1]]')"
	rm -r weights
	says 3 "gs-weigh: scene: its splats are seen in none of 1 views (in at most 0% of the pixels of one): the cameras are in another frame than the splats, or of another scene; import it with the cameras that it was trained with" \
		"$BIN/gs-weigh" -o weights scene
	[ ! -e weights ]
}

@test "--threads 1, 2 and 3 give the same bytes" {
	cameras "$(view width=150 height=70 cx=75 cy=35)" "$(view name='"v2"')"
	for precision in f32 u8; do
		for n in 1 2 3; do "$BIN/gs-weigh" --threads $n --tolerance 0.01 --precision $precision -o t$n scene; done
		diff -r t1 t2
		diff -r t1 t3
	done
}

@test "files that exist are replaced" {
	mkdir weights
	echo old >weights/v1.safetensors
	"$BIN/gs-weigh" -o weights scene
	"$BIN/gs-check" weights/v1.safetensors
	[ "$(ls -A weights)" = v1.safetensors ]
}

@test "-v has a line for each view" {
	"$BIN/gs-weigh" -v -o weights scene 2>err
	grep -qE '^gs-weigh: v1: 4x3, 12 weights, 1\.0 a pixel, [0-9.]+ ms$' err
	"$BIN/gs-weigh" -o weights scene 2>err
	[ ! -s err ]
}

@test "usage errors" {
	says 2 "gs-weigh: --scale: '0' is not a number from 0.001 to 1
Try 'gs-weigh --help'." "$BIN/gs-weigh" --scale 0 -o weights scene
	says 2 "gs-weigh: --tolerance: '1' is not a number from 0 to 0.999
Try 'gs-weigh --help'." "$BIN/gs-weigh" --tolerance 1 -o weights scene
	says 2 "gs-weigh: --split: 'both' is not one of train|test|all
Try 'gs-weigh --help'." "$BIN/gs-weigh" --split both -o weights scene
	says 2 "gs-weigh: --output: weights go to a folder, not to stdout
Try 'gs-weigh --help'." "$BIN/gs-weigh" -o - scene
	[ ! -e weights ]
}

@test "a scene that is malformed or incomplete: the reason, and nothing is made" {
	says 4 "gs-weigh: none/splats.safetensors: No such file or directory" "$BIN/gs-weigh" -o weights none
	: >scene/splats.safetensors
	says 3 "gs-weigh: scene/splats.safetensors: 0 bytes, too short for a safetensors file" "$BIN/gs-weigh" -o weights scene
	splats scene/splats.safetensors
	truncate -s -1 scene/splats.safetensors
	says 3 "gs-weigh: scene/splats.safetensors: tensor 'sh': ends at data offset 56 but the file has 55 data bytes" \
		"$BIN/gs-weigh" -o weights scene
	splats scene/splats.safetensors
	weigh() { "$BIN/gs-weigh" -o weights scene; }
	weigh
	cp weights/v1.safetensors scene/splats.safetensors
	rm -r weights
	says 3 "gs-weigh: scene/splats.safetensors: format is 'refer.weights', expected 'refer.splats'" weigh
	[ ! -e weights ]
}

@test "a folder that cannot be made or written: exit 4" {
	: >file
	says 4 "gs-weigh: file: Not a directory" "$BIN/gs-weigh" -o file/weights scene
	mkdir -p weights/v1.safetensors
	says 4 "gs-weigh: weights/v1.safetensors: Is a directory" "$BIN/gs-weigh" -o weights scene
	[ "$(ls -A weights)" = v1.safetensors ]
}

@test "--packed: the weights of --precision u8 in fewer bytes; what is lifted from them is the same" {
	"$BIN/gs-synth" -q --objects 3 --views 4 --size 90x70 --gaussians 3000 -o made
	"$BIN/gs-import" -q -o made/scene made/point_cloud.ply
	"$BIN/gs-weigh" --tolerance 0.05 --precision u8 -o plain made/scene
	"$BIN/gs-weigh" --tolerance 0.05 --packed -o packed made/scene
	view=$(basename "$(ls plain | head -n 1)")
	[ "$(stat -c %s "packed/$view")" -lt "$(($(stat -c %s "plain/$view") / 3))" ]
	[ "$("$BIN/gs-check" "packed/$view" | sed 's/packed/u8/g')" = "$("$BIN/gs-check" "plain/$view" | sed 's/plain/u8/g')" ]
	[ "$(meta "packed/$view" options)" = "--scale 1 --tolerance 0.05 --precision u8 --packed" ]
	"$BIN/text-encode" -q --model "$BATS_TEST_DIRNAME/../golden/bert" -o text.safetensors made/sentences.jsonl
	for weights in plain packed; do
		"$BIN/refer-lift" -q --scene made/scene --weights $weights --text text.safetensors --masks made/truth.jsonl -o $weights.model
		"$BIN/refer-render" --scene made/scene --text text.safetensors --model $weights.model --split train -o $weights.jsonl
	done
	"$BIN/miou-score" --json --truth <(jq -c 'del(.score)' plain.jsonl) packed.jsonl | jq -e '.miou > 0.999'
	# whatever the threads
	"$BIN/gs-weigh" --threads 3 --tolerance 0.05 --packed -o again made/scene
	diff -r packed again
	# a bit of any stream
	for at in 2000 3000 5000; do
		cp "packed/$view" broken
		printf '\xff\x00\xff' | dd of=broken bs=1 seek=$at conv=notrunc status=none
		run "$BIN/gs-check" broken
		[ "$status" = 1 ]
	done
}
