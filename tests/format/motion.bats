#!/usr/bin/env bats
# Each rule of formats/scene/motion.md broken once, and what gs-import makes of frames and displacements. The container: safetensors.bats.

setup() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	load files
	load foreign
	load ../cli/npy
	cd "$BATS_TEST_TMPDIR"
}


d0=0000000000000000 dhalf=000000000000e03f d1=000000000000f03f

# motion FILE [NAME=VALUE]...: two times of one moving Gaussian of two. VALUE replaces a tensor's data (hexadecimal) or its shape
# (NAME_shape), or a value of the metadata; "none" leaves a tensor out.
motion() {
	local file=$1 assignment at=0 name header= data= hex meta= value type
	local format=refer.motion version=1 gaussians=2 scene=
	local times=$d0$d1 ids=01000000 means=$f0$f0$f0$f1$f0$f0 quats=$f1$f0$f0$f0$f1$f0$f0$f0 scales=none
	local times_shape='[2]' ids_shape='[1]' means_shape='[2,1,3]' quats_shape='[2,1,4]' scales_shape='[2,1,3]'
	shift
	for assignment; do local "${assignment%%=*}=${assignment#*=}"; done
	for name in times ids means quats scales; do
		hex=${!name}
		[ "$hex" = none ] && continue
		local shape=${name}_shape
		case $name in times) type=F64 ;; ids) type=I32 ;; *) type=F32 ;; esac
		header+=",\"$name\":{\"dtype\":\"$type\",\"shape\":${!shape},\"data_offsets\":[$at,$((at + ${#hex} / 2))]}"
		at=$((at + ${#hex} / 2)) data+=$hex
	done
	for name in format version gaussians scene; do
		value=${!name}
		[ -z "$value" ] || meta+=",\"$name\":\"$value\""
	done
	header="{\"__metadata__\":{${meta#,}}$header}"
	while (((8 + ${#header}) % 8)); do header+=' '; done
	st "$file" "$header" "$data"
}

# refuses REASON [NAME=VALUE]...
refuses() {
	local reason=$1
	shift
	motion x "$@"
	says 1 "x: $reason" "$BIN/gs-check" x
}

# frames DIR NAME...: a frame each, in which the first Gaussian of two is a step farther.
frames() {
	local dir=$1 x=0 name
	shift
	mkdir -p "$dir"
	for name; do
		splats_ply "$dir/$name" "$x 0 2 1 0.5 0 0 -3 -3 -3 1 0 0 0" '1 0 3 0 0.5 1 2 -2 -3 -4 0.5 0.5 0.5 0.5'
		x=$((x + 1))
	done
}

import() { rm -rf scene && "$BIN/gs-import" -q --cameras "${cameras:-model}" -o scene "$@"; }

# refused STATUS REASON ARGUMENT...: and nothing is there after it.
refused() {
	local status=$1 reason=$2
	shift 2
	says "$status" "gs-import: $reason" import "$@" && [ ! -e scene ]
}

# Fails where the command succeeds; a plain ! would let the test go on.
not() { ! "$@"; }

# stored BYTES: those that are stored.
stored() { tail -c "$(($(wc -c <scene/motion.safetensors) - 8 - $(od -An -t u8 -N 8 scene/motion.safetensors)))" scene/motion.safetensors | od -An -v -t f8 -w8 -N "$1" | xargs; }

@test "good files" {
	motion x
	says 0 'x: ok: refer.motion, 2 times, 1 moving gaussians, 2 gaussians of the scene' "$BIN/gs-check" x
	motion x scales=$fhalf$fhalf$fhalf$f0$f1$f1
	says 0 'x: ok: refer.motion, 2 times, 1 moving gaussians, 2 gaussians of the scene' "$BIN/gs-check" x
	motion x times=$d1 times_shape='[1]' ids= ids_shape='[0]' means= means_shape='[1,0,3]' quats= quats_shape='[1,0,4]'
	says 0 'x: ok: refer.motion, 1 times, 0 moving gaussians, 2 gaussians of the scene' "$BIN/gs-check" x
}

@test "version, Gaussians and tensors" {
	refuses 'refer.motion version 2 is newer than this program reads (1)' version=2
	refuses "metadata 'gaussians' is 'many', not a whole number from 0 to 2147483647" gaussians=many
	refuses "metadata 'scene' is 'it', not 16 hexadecimal digits" scene=it
	local name
	for name in times ids means quats; do refuses "tensor '$name' is missing" $name=none; done
	refuses "tensor 'means': is F32[1,2,3], expected F32[2,1,3]" means_shape='[1,2,3]'
	refuses "tensor 'quats': is F32[1,2,4], expected F32[2,1,4]" quats_shape='[1,2,4]'
	refuses "tensor 'scales': is F32[1,1,3], expected F32[2,1,3]" scales=$f0$f0$f0 scales_shape='[1,1,3]'
}

@test "numbers" {
	refuses "tensor 'times': there is none" times= times_shape='[0]'
	refuses "tensor 'times': item 1 does not rise, or is not finite" times=$d1$d1
	refuses "tensor 'times': item 1 does not rise, or is not finite" times=${d1}000000000000f07f
	refuses "tensor 'ids': item 0 does not rise within 0 to 1" ids=02000000
	refuses "tensor 'ids': item 0 does not rise within 0 to 1" ids=ffffffff
	refuses "tensor 'means': item 4 is not finite" means=$f0$f0$f0$f1$fnan$f0
	refuses "tensor 'quats': Gaussian 1 at time 1 is zero or not finite" quats=$f1$f0$f0$f0$f0$f0$f0$f0
	refuses "tensor 'quats': Gaussian 1 at time 0 is zero or not finite" quats=$finf$f0$f0$f0$f1$f0$f0$f0
	refuses "tensor 'scales': item 5 is negative or not finite" scales=$f0$f0$f0$f0$f0$fminus
}

@test "of its scene" {
	scene s
	motion s/motion.safetensors gaussians=1 ids=00000000
	says 0 's: ok: scene, 4x3, 1 gaussians, 1 harmonics, 1 training views, 0 test views, 2 times, 1 moving gaussians, scene ef6eb604187a17fa' \
		"$BIN/gs-check" s
	local m=s/motion.safetensors
	motion $m gaussians=1 ids=00000000 scene=0123456789abcdef
	says 1 "$m: is of another scene than s/splats.safetensors (0123456789abcdef, not ef6eb604187a17fa)" "$BIN/gs-check" s
	motion $m
	says 1 "$m: is of 2 Gaussians, s/splats.safetensors has 1" "$BIN/gs-check" s
	motion $m gaussians=1 ids=00000000 means=$f1$f0$f0$f1$f0$f0
	says 1 "$m: tensor 'means': Gaussian 0 is at its first time elsewhere than in s/splats.safetensors" "$BIN/gs-check" s
	motion $m gaussians=1 ids=00000000
	printf '[%s]\n' "$(view time=2)" >s/cameras.json
	says 1 "s: v1: $m: time 2 is not within its times, 0 to 1" "$BIN/gs-check" s
	printf '[%s]\n' "$(view time='"now"')" >s/cameras.json
	says 1 "s/cameras.json: view 0: key 'time' is not a number" "$BIN/gs-check" s
}

@test "frames: numbers are numbers, and what does not move is not stored" {
	colmap model
	frames f t8.ply t9.ply t10.ply
	import f
	"$BIN/gs-check" scene | grep -q '2 gaussians, .* 3 times, 1 moving gaussians'
	[ "$(stored 24)" = "0 0.5 1" ]
	# where the files stand in the folder is nothing
	mkdir g && cp f/t10.ply f/t8.ply f/t9.ply g
	cp -r scene first && import g && diff -r first scene
	import --times 2:6 f && [ "$(stored 24)" = "2 4 6" ]
	import --times 4fps f && [ "$(stored 24)" = "0 0.25 0.5" ]
	printf '1\n2, 7\n' >at && import --times at f && [ "$(stored 24)" = "1 2 7" ]
	# a scene that is still leaves nothing of one that moved
	"$BIN/gs-import" -q --cameras model -o scene f/t8.ply && [ ! -e scene/motion.safetensors ]
}

@test "frames that are refused" {
	colmap model
	frames f t1.ply t2.ply t3.ply
	printf '1 b 2' >at && refused 3 "at: item 2 ('b') is not a number" --times at f
	printf '1 2' >at && refused 3 'at: has 2 times, and there are 3 frames' --times at f
	printf '1 2 2' >at && refused 3 'at: time 3 (2) does not rise, or is not finite' --times at f
	refused 2 "--times: '3:1' is not T0:T1 with T1 above T0
Try 'gs-import --help'." --times 3:1 f
	refused 2 "--times: '0fps' is not a rate above 0
Try 'gs-import --help'." --times 0fps f
	refused 4 'none: No such file or directory' --times none f
	refused 2 "--times: f/t1.ply is one file and there is no --motion: the scene is still
Try 'gs-import --help'." --times 0:1 f/t1.ply
	mkdir gap && cp f/t1.ply gap && cp f/t2.ply gap/t3.ply && cp f/t3.ply gap/t4.ply
	refused 3 "gap: frame 2 is missing, between 't1.ply' and 't3.ply'" gap
	mkdir two && cp f/t1.ply two/a1.ply && cp f/t2.ply two/b2.ply
	refused 3 "two: 'a1.ply' and 'b2.ply' are not frames of one sequence" two
	mkdir same && cp f/t1.ply same/t1.ply && cp f/t2.ply same/t01.ply
	refused 3 "same: 't01.ply' and 't1.ply' are one frame" same
	mkdir bare && cp f/t1.ply bare/t1.ply && cp f/t2.ply bare/t.ply
	refused 3 "bare: 't.ply' has no number that says which frame it is" bare
	local a='0 0 2 1 0.5 0 0 -3 -3 -3 1 0 0 0' b='1 0 3 0 0.5 1 2 -2 -3 -4 0.5 0.5 0.5 0.5'
	splats_ply f/t2.ply "$a"
	refused 3 'f/t2.ply: holds 1 Gaussians, f/t1.ply holds 2' f
	splats_ply f/t2.ply "$b" "$a"
	refused 3 'f/t2.ply: the order of its Gaussians is another than in f/t1.ply (Gaussian 0 is there what 1 is here, by opacity and colour): export frames in one order' f
	splats_ply f/t2.ply "${a/ 0 -3/ 1 -3}" "$b"
	refused 3 'f/t2.ply: opacity or colour of 1 Gaussians, the first of them 0, is another than in f/t1.ply: only places, rotations and sizes may change' f
	splats_ply f/t2.ply "$a" "${b/1 0 3/nan 0 3}"
	refused 3 'f/t2.ply: Gaussian 1 is not finite, or has no rotation: of a scene that moves none may be left out' f
}

@test "cameras with times" {
	local cameras=c.json
	frames f t1.ply t2.ply
	printf '[%s,%s]' "$(camera3dgs time=0.5)" "$(camera3dgs 'img_name="a"' time=1)" >c.json
	import f
	[ "$(jq -c 'map(.time)' scene/cameras.json)" = '[1,0.5]' ]
	# of a still scene they are nothing
	import f/t1.ply && [ "$(jq -c 'map(.time)' scene/cameras.json)" = '[null,null]' ]
	printf '[%s,%s]' "$(camera3dgs time=0.5)" "$(camera3dgs 'img_name="a"')" >c.json
	refused 3 "c.json: view 'b' has a time, and view 'a' has none" f
	transforms "frames=[$(frame time=3)]" >c.json
	refused 3 "c.json: view 'b': time 3 is not within those of f, 0 to 1: --times says them" f
	refused 2 "--time: view 'b' has a time of its own, 3
Try 'gs-import --help'." --time 1 f
	import --times 0:3 f && [ "$(jq -c 'map(.time)' scene/cameras.json)" = '[3]' ]
}

@test "displacements and means in an archive" {
	colmap model
	frames f t1.ply t2.ply
	npy displacements.npy '<f4' '2, 2, 3' "$f0$f0$f0$f0$f0$f0$f1$f0$f0$f0$f0$f0"
	npy means.npy '<f4' '2, 2, 3' "$f0$f0${f2:=00000040}$f1$f0${f3:=00004040}$f1$f0$f2$f1$f0$f3"
	npy times.npy '<f8' '2,' "$d0$d1"
	npz d.npz displacements.npy times.npy && npz m.npz means.npy
	import f && mv scene first
	import --motion d.npz f/t1.ply && diff -r first scene
	import --motion m.npz f/t1.ply && diff -r first scene
	import --motion d.npz --times 3:5 f/t1.ply && [ "$(stored 16)" = "3 5" ]
	# places at the first time that are not those of the .ply
	import --motion m.npz f/t2.ply && diff first/motion.safetensors scene/motion.safetensors
	npy quats.npy '<f4' '2, 2, 4' "$f1$f0$f0$f0$fhalf$fhalf$fhalf$fhalf$f0$f1$f0$f0$fhalf$fhalf$fhalf$fhalf"
	npz q.npz means.npy quats.npy && import --motion q.npz f/t1.ply
	"$BIN/gs-check" scene | grep -q ' 1 moving gaussians'
	npy quats.npy '<f4' '2, 2, 4' "$f1$f0$f0$f0$f1$f0$f0$f0$f0$f0$f0$f0$f1$f0$f0$f0"
	npz q.npz means.npy quats.npy && refused 3 'q.npz: quats.npy: Gaussian 0 at index 1 of the times is zero' --motion q.npz f/t1.ply
	npy quats.npy '<f4' '1, 2, 4' "$f1$f0$f0$f0$f1$f0$f0$f0"
	npz q.npz means.npy quats.npy && refused 3 'q.npz: quats.npy: is of 1 times and 2 Gaussians, the means of 2 and 2' --motion q.npz f/t1.ply
	npz t.npz times.npy && refused 3 "t.npz: has no array 'means' or 'displacements'" --motion t.npz f/t1.ply
	npy means.npy '<f4' '4, 3' "$f0$f0$f0$f0$f0$f0$f0$f0$f0$f0$f0$f0"
	npz m.npz means.npy && refused 3 'm.npz: means.npy: has not the shape [T,N,3]' --motion m.npz f/t1.ply
	npy means.npy '<f4' '1, 1, 3' "$f0$f0$f0"
	npz m.npz means.npy && refused 3 'm.npz: has 1 Gaussians, f/t1.ply has 2' --motion m.npz f/t1.ply
	npy means.npy '<f4' '1, 2, 3' "$f0$f0$f0$f0$fnan$f0"
	npz m.npz means.npy && refused 3 'm.npz: means.npy: Gaussian 1 at index 0 of the times is not finite' --motion m.npz f/t1.ply
	npy times.npy '<f8' '2,' "$d1$d0"
	npz d.npz displacements.npy times.npy && refused 3 'd.npz: times.npy: time 2 (0) does not rise, or is not finite' --motion d.npz f/t1.ply
	npy times.npy '<f8' '1,' "$d1"
	npz d.npz displacements.npy times.npy && refused 3 'd.npz: times.npy: has 1 times, and there are 2 frames' --motion d.npz f/t1.ply
}

@test "cameras without times: one for all, or weights are refused" {
	colmap model
	frames f t1.ply t2.ply
	refused 2 "--time: f/t1.ply is one file and there is no --motion: the scene is still
Try 'gs-import --help'." --time 1 f/t1.ply
	refused 3 "model: view 'a': time 2 is not within those of f, 0 to 1: --times says them" --time 2 f
	import --time 1 f && [ "$(jq -c 'map(.time)' scene/cameras.json)" = '[1,1,1]' ]
	"$BIN/gs-weigh" -q -o w scene
	import f
	says 3 "gs-weigh: scene: the scene moves, and view 'a' has no time: gs-import takes it from the key 'time' of a camera, or one for all with --time" \
		"$BIN/gs-weigh" -q -o none scene && [ ! -e none ]
	# at the second time the scene is the second frame
	import f/t2.ply && "$BIN/gs-weigh" -q -o still scene
	local tensors
	tensors() { tail -c "$(($(wc -c <"$1") - 8 - $(od -An -t u8 -N 8 "$1")))" "$1"; }
	for tensors in w/*; do cmp <(tensors "$tensors") <(tensors "still/${tensors##*/}"); done
}

@test "masks: of what does not move those of the still scene, else those of the frame at the view's time" {
	weighed_scene
	"$BIN/refer-lift" -q --scene scene --weights weights --text text.safetensors --masks masks.jsonl -o lifted
	local render=("$BIN/refer-render" -q --text text.safetensors --split all)
	"${render[@]}" --scene scene --model lifted -o still.jsonl
	mkdir f && cp point_cloud.ply f/1.ply && cp point_cloud.ply f/2.ply
	"$BIN/gs-import" -q --cameras sparse/0 --test-views "$(cat test-views)" --time 1 -o same f
	"$BIN/gs-weigh" -q -o same-weights same
	"$BIN/refer-lift" -q --scene same --weights same-weights --text text.safetensors --masks masks.jsonl -o same-lifted
	"${render[@]}" --scene same --model same-lifted -o same.jsonl
	cmp still.jsonl same.jsonl
	# the second frame in motion, from what was lifted at the first
	"$BIN/gs-transform" -q --translate 0.1,0,0 -o f/2.ply point_cloud.ply
	"$BIN/gs-import" -q --cameras sparse/0 --test-views "$(cat test-views)" --time 1 -o moved f
	"$BIN/gs-import" -q --cameras sparse/0 --test-views "$(cat test-views)" -o second f/2.ply
	"${render[@]}" --scene moved --model lifted -o moved.jsonl
	not cmp -s still.jsonl moved.jsonl
	"$BIN/gs-weigh" -q -o second-weights second && "$BIN/gs-weigh" -q -o moved-weights moved
	local view=second-weights/view_000.safetensors threads
	cmp <(tail -c 4000 $view) <(tail -c 4000 moved-weights/view_000.safetensors)
	for threads in 1 2 7; do
		"${render[@]}" --threads $threads --scene moved --model lifted -o threads.jsonl && cmp moved.jsonl threads.jsonl
	done
}
