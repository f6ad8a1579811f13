#!/usr/bin/env bats
# Each rule of formats/splats/glb.md broken once, in files that are put together here. Round trips and cuts at every byte are in
# tests/unit/test_glb.c.

setup() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	load files
	load foreign
	cd "$BATS_TEST_TMPDIR"
	colmap model
	# One Gaussian: POSITION, ROTATION, SCALE, OPACITY, SH_DEGREE_0_COEF_0.
	numbers='000080bf000000c000004040 00000000000000000000803f00000000 0000803f0000003f0000803e 0000403f 0000803f00000000000080bf'
	json='{"asset":{"version":"2.0"},"extensionsUsed":["KHR_gaussian_splatting"],"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
		"meshes":[{"primitives":[{"mode":0,"attributes":{"POSITION":0,"KHR_gaussian_splatting:ROTATION":1,"KHR_gaussian_splatting:SCALE":2,
		"KHR_gaussian_splatting:OPACITY":3,"KHR_gaussian_splatting:SH_DEGREE_0_COEF_0":4},
		"extensions":{"KHR_gaussian_splatting":{"kernel":"ellipse","colorSpace":"srgb_rec709_display"}}}]}],
		"buffers":[{"byteLength":56}],"bufferViews":[{"buffer":0,"byteLength":12},{"buffer":0,"byteOffset":12,"byteLength":16},
		{"buffer":0,"byteOffset":28,"byteLength":12},{"buffer":0,"byteOffset":40,"byteLength":4},{"buffer":0,"byteOffset":44,"byteLength":12}],
		"accessors":[{"bufferView":0,"componentType":5126,"count":1,"type":"VEC3"},{"bufferView":1,"componentType":5126,"count":1,"type":"VEC4"},
		{"bufferView":2,"componentType":5126,"count":1,"type":"VEC3"},{"bufferView":3,"componentType":5126,"count":1,"type":"SCALAR"},
		{"bufferView":4,"componentType":5126,"count":1,"type":"VEC3"}]}'
}

# word N: 4 bytes in hexadecimal.
word() { printf '%08x' "$1" | fold -w2 | tac | tr -d '\n'; }

# glb [FILTER] [NUMBERS]: s.glb, with the JSON that jq's filter makes of the one above.
glb() {
	local text hex
	text=$(jq -c "${1:-.}" <<<"$json")
	while ((${#text} % 4)); do text+=' '; done
	hex=$(tr -d ' \t\n' <<<"${2:-$numbers}")
	{
		printf '676c544602000000%s%s4a534f4e' "$(word $((28 + ${#text} + ${#hex} / 2)))" "$(word ${#text})"
		printf '%s' "$text" | xxd -p | tr -d '\n'
		printf '%s42494e00%s' "$(word $((${#hex} / 2)))" "$hex"
	} | xxd -r -p >s.glb
}

import() { "$BIN/gs-import" --cameras model -o scene "$@"; }

# refused REASON
refused() { says 3 "gs-import: s.glb: $1" import s.glb && [ ! -e scene ]; }

# breaks REASON FILTER [NUMBERS]
breaks() { glb "${@:2}" && refused "$1"; }

# values NAME: the tensor's numbers.
values() {
	local from to begin
	read -r from to <<<"$(head -c 4000 scene/splats.safetensors | tail -c +9 | grep -ao '{.*}}' | jq -r ".$1.data_offsets | @tsv")"
	begin=$((8 + 16#$(xxd -p -l 8 scene/splats.safetensors | fold -w2 | tac | tr -d '\n') + from))
	od -An -tf4 -v -j $begin -N $((to - from)) scene/splats.safetensors | tr -s ' \n' ' ' | sed 's/^ //; s/ $//; s/-0\b\([^.]\|$\)/0\1/g'
}

@test "one Gaussian, whatever the file's name, and from a pipe" {
	glb
	import s.glb
	[ "$(values means)" = "1 2 3" ]
	[ "$(values quats)" = "1 0 0 0" ]
	[ "$(values scales)" = "1 0.5 0.25" ]
	[ "$(values opacities)" = 0.75 ]
	[ "$(values sh)" = "1 0 -1" ]
	cp scene/splats.safetensors first
	mv s.glb anything
	import anything
	cmp first scene/splats.safetensors
	"$BIN/gs-import" --cameras model -o scene - <anything
	cmp first scene/splats.safetensors
	says 0 "anything: ok: glb, 1 gaussians, 1 harmonics" "$BIN/gs-check" anything
}

@test "the golden file of splat-transform is the scene that it was made of" {
	local golden=$BATS_TEST_DIRNAME/../golden
	import "$golden/glb/eight.glb"
	for name in means scales quats opacities sh; do values $name; echo; done >theirs
	import "$golden/sog/eight.ply"
	for name in means scales quats opacities sh; do values $name; echo; done >truth
	[ "$(wc -w <truth)" = $((8 * (3 + 3 + 4 + 1 + 12))) ]
	paste -d '\n' <(tr ' ' '\n' <theirs) <(tr ' ' '\n' <truth) |
		awk 'NR % 2 { a = $1; next } { d = a - $1; if (d > 2e-6 || d < -2e-6) bad = 1 } END { exit bad }'
}

@test "where it is: nodes above nodes, by matrix or by parts" {
	glb '.nodes = [{"mesh":0,"translation":[1,0,0]},{"children":[0],"scale":[2,2,2]}]'
	import s.glb
	# (-1 + 1, -2, 3) twice as large, then x and y turned round
	[ "$(values means)" = "0 4 6" ]
	[ "$(values scales)" = "2 1 0.5" ]
	glb '.nodes = [{"mesh":0,"matrix":[2,0,0,0,0,2,0,0,0,0,2,0,2,0,0,1]}]'
	cp scene/splats.safetensors first
	import s.glb
	cmp first scene/splats.safetensors
	# a quarter turn about z: (-1, -2, 3) is (2, -1, 3), and back with signs (-2, 1, 3)
	glb '.nodes = [{"mesh":0,"rotation":[0,0,1,1]}]'
	import s.glb
	[ "$(values means | awk '{ printf "%.4f %.4f %.4f", $1, $2, $3 }')" = "-2.0000 1.0000 3.0000" ]
	glb '.nodes = [] | .scenes = []'
	import s.glb
	[ "$(values means)" = "1 2 3" ]
	# far away, to the double
	glb '.nodes[0].translation = [-1e9,0,0]'
	import s.glb
	head -c 4000 scene/splats.safetensors | grep -aq '"offset":"\[1000000001,2,3\]"'
	rm -r scene
	breaks "the Gaussians are in 2 places, expected one" '.nodes += [{"mesh":0}]'
	breaks "node 0: is mirrored or scaled unevenly, which Gaussians cannot be" '.nodes[0].scale = [1,1,2]'
	breaks "node 0: is mirrored or scaled unevenly, which Gaussians cannot be" '.nodes[0].scale = [-1,1,1]'
	breaks "node 0: is mirrored or scaled unevenly, which Gaussians cannot be" '.nodes[0].scale = [0,0,0]'
	breaks "node 0: key 'rotation' is zero" '.nodes[0].rotation = [0,0,0,0]'
	breaks "node 0: key 'matrix' is not 16 numbers" '.nodes[0].matrix = [1]'
	breaks "node 0: more than 64 nodes above a node" '.nodes[0].children = [0]'
}

@test "bytes and shorts, and a stride" {
	# rotation as signed bytes, scale as unsigned shorts, opacity as unsigned bytes; their views and offsets are kept
	glb '.accessors[1].componentType = 5120 | .accessors[1].normalized = true | .accessors[2].componentType = 5122 |
		.accessors[3].componentType = 5121 | .accessors[3].normalized = true' \
		'000080bf000000c000004040 00007f00000000000000000000000000 010002000300ffff0000ffff 33000000 0000803f00000000000080bf'
	import s.glb
	[ "$(values quats)" = "1 0 0 0" ]
	[ "$(values scales)" = "1 2 3" ]
	[ "$(values opacities)" = 0.2 ]
	# two Gaussians whose means are 16 bytes apart
	glb '.accessors[].count = 2 | .bufferViews[0] = {"buffer":0,"byteLength":28,"byteStride":16} |
		.bufferViews[1] = {"buffer":0,"byteOffset":28,"byteLength":32} | .bufferViews[2] = {"buffer":0,"byteOffset":60,"byteLength":24} |
		.bufferViews[3] = {"buffer":0,"byteOffset":84,"byteLength":8} | .bufferViews[4] = {"buffer":0,"byteOffset":92,"byteLength":24}' \
		'000080bf000000c000004040 ffffffff 000000c0000000c000004040
		00000000000000000000803f00000000 00000000000000000000803f00000000 0000803f0000003f0000803e 0000803f0000003f0000803e
		0000403f0000403f 0000803f00000000000080bf 0000803f00000000000080bf'
	import s.glb
	[ "$(values means)" = "1 2 3 2 2 3" ]
}

@test "the container" {
	glb
	cp s.glb good
	printf 'glTF\2\0\0' >s.glb
	refused "7 bytes, the header has 12"
	printf 'abcdefghijkl' >s.glb
	refused "not a .glb: it does not begin with 'glTF'"
	{ head -c 4 good; printf '\1'; tail -c +6 good; } >s.glb
	refused "version 1 of glTF, expected 2"
	head -c 100 good >s.glb
	refused "has 100 bytes, its header says $(wc -c <good)"
	printf '676c5446 02000000 0c000000' | xxd -r -p >s.glb
	refused "no chunk at offset 12"
	printf '676c5446 02000000 14000000 00000000 42494e00' | xxd -r -p >s.glb
	refused "the chunk at offset 12 is not of type JSON"
	printf '676c5446 02000000 14000000 01000000 4a534f4e' | xxd -r -p >s.glb
	refused "a chunk of 1 from offset 12 does not fit a file of 20"
	printf '676c5446 02000000 18000000 04000000 4a534f4e 7b7b7b7b' | xxd -r -p >s.glb
	refused "not JSON at offset 2"
	printf '676c5446 02000000 20000000 04000000 4a534f4e 7b7d2020 00000000 4a534f4e' | xxd -r -p >s.glb
	refused "the chunk at offset 24 is not of type BIN"
}

@test "what it is of" {
	breaks "0 primitives with KHR_gaussian_splatting, expected 1: it is no scene of Gaussians" 'del(.meshes)'
	breaks "2 primitives with KHR_gaussian_splatting, expected 1" '.meshes[0].primitives += [.meshes[0].primitives[0]]'
	breaks "the primitive's mode is 4, expected 0 (points)" 'del(.meshes[0].primitives[0].mode)'
	breaks "needs the extension 'EXT_meshopt_compression', which is not read" '.extensionsRequired = ["KHR_gaussian_splatting","EXT_meshopt_compression"]'
	breaks "Gaussians of the extension 'KHR_gaussian_splatting_compression_spz_2', which is not read" \
		'.meshes[0].primitives[0].extensions.KHR_gaussian_splatting.extensions = {"KHR_gaussian_splatting_compression_spz_2":{"bufferView":0}}'
	breaks "key 'kernel' is 'cube', expected 'ellipse'" '.meshes[0].primitives[0].extensions.KHR_gaussian_splatting.kernel = "cube"'
	breaks "key 'projection' is 'orthographic', expected 'perspective'" '.meshes[0].primitives[0].extensions.KHR_gaussian_splatting.projection = "orthographic"'
	breaks "key 'colorSpace' is 'lin_rec709_display', expected 'srgb_rec709_display'" \
		'.meshes[0].primitives[0].extensions.KHR_gaussian_splatting.colorSpace = "lin_rec709_display"'
	# another mesh beside it does no harm
	glb '.meshes = [{"primitives":[{"attributes":{}}]}] + .meshes | .nodes[0].mesh = 1'
	import s.glb
}

@test "attributes" {
	for name in POSITION KHR_gaussian_splatting:SCALE KHR_gaussian_splatting:ROTATION KHR_gaussian_splatting:OPACITY \
		KHR_gaussian_splatting:SH_DEGREE_0_COEF_0; do
		breaks "no attribute $name" "del(.meshes[0].primitives[0].attributes[\"$name\"])"
	done
	breaks "no attribute KHR_gaussian_splatting:SH_DEGREE_1_COEF_1" \
		'.meshes[0].primitives[0].attributes["KHR_gaussian_splatting:SH_DEGREE_1_COEF_0"] = 4'
	breaks "KHR_gaussian_splatting:SCALE: 0 items for 1 Gaussians" '.accessors[2].count = 0'
	breaks "attributes: key 'POSITION' is not a whole number from 0" '.meshes[0].primitives[0].attributes.POSITION = -1'
	breaks "no item 9 in 'accessors'" '.meshes[0].primitives[0].attributes.POSITION = 9'
	breaks "POSITION: key 'count' is not a whole number from 0" '.accessors[0].count = 1.5'
	breaks "POSITION: is of type VEC2, expected VEC3" '.accessors[0].type = "VEC2"'
	breaks "POSITION: is of type none, expected VEC3" 'del(.accessors[0].type)'
	breaks "POSITION: has components of type 5121" '.accessors[0].componentType = 5121'
	breaks "KHR_gaussian_splatting:OPACITY: has components of type 5120" '.accessors[3].componentType = 5120'
	breaks "POSITION: is sparse" '.accessors[0].sparse = {}'
	breaks "POSITION: key 'bufferView' is not a whole number from 0" 'del(.accessors[0].bufferView)'
	breaks "no item 7 in 'bufferViews'" '.accessors[0].bufferView = 7'
	breaks "POSITION: its bytes are not in the file as they are" '.bufferViews[0].buffer = 1'
	breaks "POSITION: its bytes are not in the file as they are" '.bufferViews[0].extensions = {"EXT_meshopt_compression":{}}'
	breaks "POSITION: 12 bytes from offset 50 do not fit a binary chunk of 56" '.bufferViews[0].byteOffset = 50'
	breaks "POSITION: 2 items of 12 bytes do not fit 12" '.accessors[0].count = 2'
	breaks "POSITION: 9007199254740992 items of 12 bytes do not fit 12" '.accessors[0].count = 9007199254740992'
	breaks "POSITION: 1 items of 12 bytes do not fit 4" '.accessors[0].byteOffset = 8'
	breaks "POSITION: 1 items of 4 bytes do not fit 12" '.bufferViews[0].byteStride = 4'
}

@test "scales are no logarithms" {
	breaks "Gaussian 0: a scale of -0.5: drafts of KHR_gaussian_splatting had logarithms, which are not read" . "${numbers/0000003f/000000bf}"
}

@test "what is written is that one Gaussian, and what is not finite is left out" {
	glb
	"$BIN/gs-transform" -o out.glb s.glb
	# but for the signs of zeros
	[ "$(tail -c 56 out.glb | xxd -p | tr -d '\n' | fold -w8 | sed 's/^00000080$/00000000/' | tr -d '\n')" = "$(tr -d ' ' <<<"$numbers")" ]
	glb . "0000c07f${numbers:8}"
	says 3 "gs-transform: s.glb: none of its 1 Gaussians can be used: 1 have a value that is not finite, 0 a zero quaternion" \
		"$BIN/gs-transform" -o none.glb s.glb
}
