#!/usr/bin/env bats
# Each rule of formats/splats/ply.md, of the container as of its contents, broken once. Binary layouts, cuts at every byte, what is left out and
# recentring are in tests/unit/test_ply.c.

setup() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	load files
	load foreign
	cd "$BATS_TEST_TMPDIR"
	colmap model
}

import() {
	"$BIN/gs-import" --cameras model -o scene "$@"
}

# refused REASON: s.ply is, for that reason, and nothing is left.
refused() {
	says 3 "gs-import: s.ply: $1" import s.ply && [ ! -e scene ]
}

# header REASON LINE...: a header with these lines after a good format line is refused at the last of them.
header() {
	local reason=$1
	shift
	{ printf 'ply\nformat ascii 1.0\n'; printf '%s\n' "$@"; echo end_header; } >s.ply
	says 3 "gs-import: s.ply:$(($# + 2)): $reason" import s.ply
}

@test "the smallest scene" {
	splats_ply s.ply
	import s.ply
	says 0 "scene: ok: scene, 40x30, 2 gaussians, 1 harmonics, 3 training views, 0 test views, scene 27a5296455df5ef9" "$BIN/gs-check" scene
}

@test "not a PLY file" {
	for text in '' p ply plx 'ply ' 'plyformat'; do
		printf '%s' "$text" >s.ply
		refused "not a PLY file: the first line is not 'ply' and nothing else"
	done
}

@test "the format line" {
	printf 'ply\ncomment x\nformat ascii 1.0\n' >s.ply
	says 3 "gs-import: s.ply:2: the second line is not 'format ...' (comments come after it)" import s.ply
	for format in '' ascii 'ascii 1.1' 'binary 1.0' 'binary_middle_endian 1.0'; do
		printf 'ply\nformat %s\nend_header\n' "$format" >s.ply
		read -r name version <<<"$format"
		says 3 "gs-import: s.ply:2: format '$name $version' is not ascii, binary_little_endian or binary_big_endian 1.0" \
			import s.ply
	done
}

@test "element lines" {
	header "not 'element NAME COUNT'" 'element vertex'
	header "not 'element NAME COUNT'" 'element vertex -1'
	header "not 'element NAME COUNT'" 'element vertex 1e3'
	header "element 'vertex' appears twice" 'element vertex 1' 'element vertex 1'
	header "element 'vertex': 99999999999999999999 rows do not fit in memory" 'element vertex 99999999999999999999'
}

@test "property lines" {
	header "property before any element" 'property float x'
	header "property type 'real' is unknown: export the scene with floats where it was made" 'element vertex 1' 'property real x'
	header "property type '' is unknown: export the scene with floats where it was made" 'element vertex 1' property
	header "property without a name" 'element vertex 1' 'property float'
	header "property 'x' appears twice" 'element vertex 1' 'property float x' 'property int x'
	header "list count type 'float' is not an integer type" 'element vertex 1' 'property list float int x'
	header "property type 'x' is unknown: export the scene with floats where it was made" 'element vertex 1' 'property list int x'
	header "header line 'vertex' is unknown" 'vertex 1'
}

@test "a header without an end, or with a zero byte" {
	printf 'ply\nformat ascii 1.0\nelement vertex 1\n' >s.ply
	says 3 "gs-import: s.ply:4: the header has no end_header" import s.ply
	printf 'ply\nformat ascii 1.0\ncomment \0\nend_header\n' >s.ply
	says 3 "gs-import: s.ply:3: a NUL byte in the header" import s.ply
}

@test "elements and properties that are missing" {
	printf 'ply\nformat ascii 1.0\nend_header\n' >s.ply
	refused "no element 'vertex'"
	for name in $ply_names; do
		[ $name != scale_2 ] || continue # 2DGS: foreign.bats
		ply_header 0 "${ply_names/$name/other}" >s.ply
		refused "element 'vertex' has no property '$name'"
	done
	ply_header 0 | sed 's/float opacity/list uchar float opacity/' >s.ply
	refused "property 'opacity' is a list"
}

@test "spherical harmonics that are not a full degree" {
	for count in 1 8 10 44 46; do
		ply_header 0 "$ply_names $(printf 'f_rest_%d ' $(seq 0 $((count - 1))))" >s.ply
		refused "$count f_rest properties, expected 0, 9, 24 or 45: harmonics of degree 0 to 3"
	done
	ply_header 0 "$ply_names $(printf 'f_rest_%d ' 0 1 2 3 4 5 6 7 9)" >s.ply
	refused "element 'vertex' has no property 'f_rest_8'"
}

@test "rows that are not there" {
	ply_header 3 "" binary_little_endian >s.ply
	size=$(wc -c <s.ply)
	head -c 167 /dev/zero >>s.ply
	refused "element 'vertex': 3 rows of 56 bytes from offset $size do not fit a file of $((size + 167))"
	ply_header 9999999999999 "" binary_little_endian >s.ply
	refused "element 'vertex': 9999999999999 rows of 56 bytes from offset $((size + 12)) do not fit a file of $((size + 12))"
	splats_ply s.ply '0 0 2 1 0.5 0 0 -3 -3 -3 1 0 0 '
	size=$(wc -c <s.ply)
	refused "element 'vertex': the file ends at offset $size, within row 0 of 1"
}

@test "values that are no numbers" {
	splats_ply s.ply '0 0 2 1 0.5 0 0 -3 -3 x 1 0 0 0'
	refused "element 'vertex', row 0: no number at offset $(($(ply_header 1 | wc -c) + 22))"
	splats_ply s.ply '0 0 2 1 0.5 0 0 -3 -3 -3 1 0 0 0,'
	refused "element 'vertex', row 0: no number at offset $(($(ply_header 1 | wc -c) + 31))"
}

@test "opacities that are no logits, scales that are no logarithms, colours that are no harmonics" {
	splats_ply s.ply '0 0 2 1 0.5 0 0 -3 -3 -3 1 0 0 0' '0 0 2 1 0.5 0 0.25 -3 -3 -3 1 0 0 0' '0 0 2 1 0.5 0 0.5 -3 -3 -3 1 0 0 0' '0 0 2 1 0.5 0 1 -3 -3 -3 1 0 0 0'
	refused "all its opacities are from 0 to 1: not logits, which 3DGS stores, log(o / (1 - o)) of o from 0 to 1"
	sed 's/0.5 0 1 -3/0.5 0 255 -3/' s.ply >t && mv t s.ply
	refused "all its opacities are from 0 to 255: not logits, which 3DGS stores, log(o / (1 - o)) of o from 0 to 1"
	sed 's/0 255 -3 -3 -3/0 -2 0.2 0.1 0.1/; s/-3 -3 -3/0.1 0.01 0.2/' s.ply >t && mv t s.ply
	refused "all its scales are above 0, most below 0.5: not logarithms of sizes, which 3DGS stores"
	for most in 1 255; do
		{ ply_header 1000; for ((i = 0; i < 1000; i++)); do echo 0 0 2 0.5 $((i % 2 * most)) 0.25 $((i % 7 - 3)) -3 -3 -3 1 0 0 0; done; } >s.ply
		refused "all its f_dc are from 0 to $most: colours, not harmonics, which 3DGS stores, (c - 0.5) / 0.28209 of c from 0 to 1"
	done
}

@test "lists of impossible lengths" {
	printf 'ply\nformat ascii 1.0\nelement face 1\nproperty list int int i\nelement vertex 0\n%s\nend_header\n%s\n' \
		"$(printf 'property float %s\n' $ply_names)" -1 >s.ply
	refused "element 'face', row 0: a list of -1 items, before offset $(($(wc -c <s.ply) - 1))"
}

@test "something after the last element" {
	splats_ply s.ply
	size=$(wc -c <s.ply)
	echo '1' >>s.ply
	refused "2 bytes after the last element, from offset $size"
	# but a line's end, or zeros
	splats_ply s.ply
	printf '\n\0' >>s.ply
	import s.ply
}

@test "blank space at the end of ascii, comments and CR LF are fine" {
	splats_ply s.ply
	sed 's/^element/comment a b\nobj_info c\nelement/; s/$/\r/' s.ply >crlf.ply
	printf ' \n\n' >>crlf.ply
	import crlf.ply
	"$BIN/gs-import" --cameras model -o other s.ply
	cmp scene/splats.safetensors other/splats.safetensors
}
