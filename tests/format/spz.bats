#!/usr/bin/env bats
# Each rule of formats/splats/spz.md broken once, in files that are put together here byte by byte. Round trips and cuts at every byte are in
# tests/unit/test_spz.c.

setup() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	load files
	load foreign
	cd "$BATS_TEST_TMPDIR"
	colmap model
}

# The page's example: header, then the arrays of one Gaussian.
header='4e475350 03000000 01000000 000c0000'
arrays='001000 00e0ff 00d0ff  ff  80ff00  a09080  000000c0'

# packed HEX...: s.spz, these bytes in gzip.
packed() { printf '%s' "$*" | xxd -r -p | gzip -n >s.spz; }

# plain HEX...: s.spz, these bytes.
plain() { printf '%s' "$*" | xxd -r -p >s.spz; }

import() { "$BIN/gs-import" --cameras model -o scene "$@"; }

# refused REASON
refused() { says 3 "gs-import: s.spz: $1" import s.spz && [ ! -e scene ]; }

# values NAME: the tensor's numbers.
values() {
	local at
	at=$(head -c 4000 scene/splats.safetensors | tail -c +9 | grep -ao '{.*}}' | jq -r ".$1.data_offsets | @tsv")
	read -r from to <<<"$at"
	local begin=$((8 + 16#$(xxd -p -l 8 scene/splats.safetensors | fold -w2 | tac | tr -d '\n') + from))
	od -An -tf4 -v -j $begin -N $((to - from)) scene/splats.safetensors | tr -s ' \n' ' ' | sed 's/^ //; s/ $//'
}

@test "the page's example, whatever its name, and from a pipe" {
	packed "$header$arrays"
	import s.spz
	[ "$(values means)" = "1 2 3" ]
	[ "$(values opacities)" = "1" ]
	[ "$(values scales)" = "1 0.36787945 0.13533528" ]
	[ "$(values quats)" = "1 0 0 0" ] || [ "$(values quats)" = "1 0 -0 -0" ]
	[ "$(values sh)" = "0.013071896 3.3333333 -3.3333333" ]
	cp scene/splats.safetensors first
	mv s.spz anything
	import anything
	cmp first scene/splats.safetensors
	cat anything | "$BIN/gs-import" --cameras model -o scene -
	cmp first scene/splats.safetensors
	says 0 "anything: ok: spz, 1 gaussians, 1 harmonics" "$BIN/gs-check" anything
}

@test "version 2: rotations of three bytes; axes of an extension" {
	packed "4e475350 02000000 01000000 000c0000 001000 00e0ff 00d0ff ff 80ff00 a09080 7fff7f"
	import s.spz
	# (0, 1, 0, 0) of the file: a half turn about y, which is -y here
	read -r w x y z <<<"$(values quats)"
	[ "$y" = -1 ] && [ "$w" = 0 ]
	# 6: right, down, front, as a .ply
	packed "4e475350 03000000 01000000 000c0200$arrays 0300bead 04000000 06000000"
	import s.spz
	[ "$(values means)" = "1 -2 -3" ]
	packed "4e475350 03000000 01000000 000c0200$arrays 0300bead 04000000 09000000"
	rm -r scene
	refused "coordinate system 9 of an extension is not 1 to 8"
	packed "4e475350 03000000 01000000 000c0200$arrays 0300bead 05000000 06000000"
	refused "an extension is cut off"
	packed "4e475350 03000000 01000000 000c0200$arrays 0200bead 02000000 0600"
	import s.spz
}

@test "headers" {
	plain 6162636465666768
	refused "8 bytes, the header has 32"
	plain "$(printf '61%.0s' {1..32})"
	refused "not an .spz file: it does not begin with 'NGSP'"
	packed 4e47535003000000010000
	refused "11 bytes of contents, the header has 16"
	packed "61${header:2}$arrays"
	refused "not an .spz file: it does not begin with 'NGSP'"
	packed "${header/ 03/ 01}$arrays"
	refused "version 1 of .spz, expected 2 to 4"
	packed "${header/ 03/ 04}$arrays"
	refused "version 4 of .spz in gzip"
	packed "${header/000c0000/040c0000}$arrays"
	refused "spherical harmonics of degree 4, expected 0 to 3"
	packed "${header/000c0000/00190000}$arrays"
	refused "25 fraction bits in coordinates of 24"
	packed "${header/000c0000/000c0100}$arrays"
	refused "trained for another way of rendering (antialiased, as Mip-Splatting), which would be wrong here: train it without that mode"
}

@test "counts that disagree with the file" {
	packed "${header/ 01000000/ 02000000}$arrays"
	refused "36 bytes of contents, 2 Gaussians have 56"
	packed "$header$arrays 00"
	refused "more than 1 Gaussians"
	packed "${header/ 01000000/ ffffffff}$arrays"
	refused "4294967295 Gaussians of 20 bytes do not fit $(wc -c <s.spz) packed bytes"
	packed "$header$arrays"
	size=$(wc -c <s.spz)
	truncate -s $((size - 5)) s.spz
	refused "the gzip stream is cut off, after 36 bytes of contents"
	packed "$header$arrays"
	printf '\xff' | dd of=s.spz bs=1 seek=$((size - 6)) conv=notrunc status=none
	refused "the gzip stream is damaged, after 36 bytes of contents"
}

# 32 bytes of version 4 for N Gaussians: their count, streams, offset of the table
header4() { printf '4e475350 04000000 %s 000c00%s %s 000000000000000000000000' "$1" "$2" "$3"; }

@test "version 4: table and streams" {
	plain "4e475350 03000000 $(header4 01000000 05 20000000 | cut -c 19-)"
	refused "version 3 of .spz without gzip"
	plain "$(header4 01000000 06 20000000)"
	refused "6 streams, expected 5"
	plain "$(header4 01000000 05 20000000)"
	refused "a table of 5 streams at offset 32 does not fit a file of 32"
	plain "$(header4 01000000 05 1f000000)"
	refused "a table of 5 streams at offset 31 does not fit a file of 32"
	plain "$(header4 ffffffff 05 20000000) $(printf '00%.0s' {1..80})"
	refused "4294967295 Gaussians of 20 bytes do not fit 112 packed bytes"
	plain "$(header4 01000000 05 20000000) $(printf '00%.0s' {1..80})"
	refused "stream 0 has 0 bytes, 1 Gaussians have 9"
	plain "$(header4 01000000 05 20000000) 0100000000000000 0900000000000000 $(printf '00%.0s' {1..64})"
	refused "stream 0 of 1 bytes from offset 112 does not fit a file of 112"
	plain "$(header4 01000000 05 20000000) 0100000000000000 0900000000000000 $(printf '00%.0s' {1..65})"
	refused "stream 0 is damaged: Src size is incorrect"
	plain "$(header4 00000000 00 20000000) 00"
	refused "1 bytes after the last stream, from offset 32"
}
