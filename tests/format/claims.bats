#!/usr/bin/env bats
# Small files that claim to be huge: what they claim is compared with the file before memory is taken for it (formats/limits.md).
# So each is refused for what is wrong with it, and not because memory was out, in an address space of 1.5 GB.

setup() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	GOLDEN=$BATS_TEST_DIRNAME/../golden
	load files
	cd "$BATS_TEST_TMPDIR"
	export OMP_NUM_THREADS=2
}

# confined STATUS LINE TOOL [ARGUMENT]...: as `says`, in little memory, and the output `out` is not made. A sanitizer
# takes terabytes of addresses for itself, which are no memory.
confined() {
	local status=$1 line=$2 tool=$3
	shift 3
	(
		grep -q __asan_init "$BIN/$tool" || ulimit -v 1500000
		says "$status" "$line" "$BIN/$tool" "$@"
	) && [ ! -e out ]
}

# REASON FILE [ARGUMENT]: of splats, or of any file; the message begins with the file's name.
splats_refused() { confined 3 "gs-transform: $2: $1" gs-transform --format ply -o out "${3:-$2}"; }
refuses() { confined 1 "$2: $1" gs-check "$2"; }

# little VALUE BYTES: a whole number, the lowest byte first.
little() {
	local i
	for ((i = 0; i < $2; i++)); do printf "\\x$(printf %02x $(($1 >> 8 * i & 255)))"; done
}

# hex WORD...: bytes.
hex() { printf %s "$@" | xxd -r -p; }

ply() { # FORMAT ROWS [LINE OF HEADER]...
	printf 'ply\nformat %s 1.0\n' "$1"
	[ $# = 2 ] || printf '%s\n' "${@:3}"
	printf 'element vertex %s\n' "$2"
	printf 'property float %s\n' x y z f_dc_0 f_dc_1 f_dc_2 opacity scale_0 scale_1 scale_2 rot_0 rot_1 rot_2 rot_3
	echo end_header
}

@test "ply: rows, and entries of a list" {
	ply binary_little_endian 1099511627776 >x
	splats_refused "element 'vertex': 1099511627776 rows of 56 bytes from offset 369 do not fit a file of 369" x
	ply ascii 1099511627776 >x
	splats_refused "element 'vertex': 1099511627776 rows of at least 28 bytes from offset 354 do not fit a file of 354" x
	ply ascii 99999999999999999999 >x
	confined 3 "gs-transform: x:3: element 'vertex': 99999999999999999999 rows do not fit in memory" gs-transform --format ply -o out x
	{ ply binary_little_endian 1 'element more 1' 'property list uint double a'; printf '\xff\xff\xff\xff'; } >x
	splats_refused "element 'more': the file ends at offset 404, within row 0 of 1" x
}

@test "compressed ply: chunks, Gaussians" {
	local bounds=(min_x min_y min_z max_x max_y max_z min_scale_x min_scale_y min_scale_z max_scale_x max_scale_y max_scale_z)
	packed() { # CHUNKS GAUSSIANS
		printf 'ply\nformat binary_little_endian 1.0\nelement chunk %s\n' "$1"
		printf 'property float %s\n' "${bounds[@]}"
		echo "element vertex $2"
		printf 'property uint packed_%s\n' position rotation scale color
		echo end_header
	}
	packed 1099511627776 281474976710656 >x
	splats_refused "element 'chunk': 1099511627776 rows of 48 bytes from offset 508 do not fit a file of 508" x
	{ packed 1 1099511627776; head -c 48 /dev/zero; } >x
	splats_refused "element 'vertex': 1099511627776 rows of 16 bytes from offset 542 do not fit a file of 542" x
}

@test "spz: Gaussians in gzip and in zstd" {
	{ printf NGSP; little 2 4; little 4294967295 4; little 0 4; } | gzip -nc >x.spz
	splats_refused "4294967295 Gaussians of 19 bytes do not fit $(wc -c <x.spz) packed bytes" x.spz
	{ printf NGSP; little 4 4; little 4294967295 4; hex 000c0005; little 32 4; head -c 12 /dev/zero
		for i in 1 2 3 4 5; do little 1 8; little 1099511627776 8; done; } >x.spz
	splats_refused "4294967295 Gaussians of 20 bytes do not fit 112 packed bytes" x.spz
}

@test "glb: accessors and chunks" {
	json='{"meshes":[{"primitives":[{"mode":0,"attributes":{"POSITION":0},"extensions":{"KHR_gaussian_splatting":{}}}]}],
		"accessors":[{"bufferView":0,"componentType":5126,"count":1099511627776,"type":"VEC3"}],
		"bufferViews":[{"buffer":0,"byteLength":1099511627776}],"buffers":[{"byteLength":1099511627776}]}'
	{ printf glTF; little 2 4; little $((20 + ${#json})) 4; little ${#json} 4; printf 'JSON%s' "$json"; } >x
	splats_refused "POSITION: 1099511627776 bytes from offset 0 do not fit a binary chunk of 0" x
	{ printf glTF; little 2 4; little 24 4; little 4294967295 4; printf 'JSON{}  '; } >x
	splats_refused "a chunk of 4294967295 from offset 12 does not fit a file of 24" x
}

@test "sog: Gaussians" {
	cp -r "$GOLDEN/sog" s
	jq -c '.count = 4294967295' "$GOLDEN/sog/meta.json" >s/meta.json
	splats_refused "4294967295 Gaussians do not fit $(wc -c <s/means_l.webp) packed bytes of means" s s/meta.json
	jq -c '.count = 1e300' "$GOLDEN/sog/meta.json" >s/meta.json
	splats_refused "meta.json: key 'count' is not a whole number from 0 to 4294967295" s s/meta.json
}

@test "safetensors: header, tensors, and the counts of metadata" {
	st x '{"a":{"dtype":"F32","shape":[1099511627776],"data_offsets":[0,4398046511104]}}'
	refuses "tensor 'a': ends at data offset 4398046511104 but the file has 0 data bytes" x
	st x '{"a":{"dtype":"F32","shape":[9007199254740992,9007199254740992],"data_offsets":[0,0]}}'
	refuses "tensor 'a': shape overflows" x
	{ little 100000000 8; echo '{}'; } >x
	scene s
	confined 3 "refer-lift: x: header of 100000000 bytes does not fit a file of 11: not safetensors, or cut short" \
		refer-lift --scene s --weights . --text x --masks . -o out
}

@test "npy: values and header" {
	npy() { printf '\x93NUMPY\1\0'; little ${#1} 2; printf %s "$1"; }
	npy "{'descr': '<f4', 'fortran_order': False, 'shape': (1099511627776, 1024), }" >x
	refuses "offset 84: 0 bytes of data, the shape has 1125899906842624 values of 4" x
	{ printf '\x93NUMPY\2\0'; little 4294967295 4; } >x
	refuses "offset 12: the file ends inside the header" x
}

# png WIDTH HEIGHT BITS: of colours, without data.
png() {
	chunk() {
		local sum
		sum=$(hex "$1$2" | gzip -nc | tail -c 8 | head -c 4 | xxd -p | fold -w 2 | tac | tr -d '\n')
		hex "$(printf %08x $((${#2} / 2)))" "$1" "$2" "$sum"
	}
	printf '\x89PNG\r\n\x1a\n'
	chunk 49484452 "$(printf %08x%08x%02x02000000 "$1" "$2" "$3")"
	chunk 49444154 789c030000000001
	chunk 49454e44 ''
}

@test "png: pixels" {
	png 65536 65536 8 >x
	refuses "PNG: 65536x65536 pixels, more than 268435456 altogether" x
	png 16384 16384 16 >x
	refuses "PNG: 16384x16384 pixels do not fit a file of 65 bytes" x
	echo '{"view":"v","object":"o","path":"x"}' >m.jsonl
	refuses "./x: PNG: 16384x16384 pixels do not fit a file of 65 bytes" m.jsonl
}

@test "jpeg: pixels, baseline and progressive" {
	jpeg() { hex ffd8 "ff$3" 001108 "$(printf %04x%04x "$2" "$1")" 03012200021101031101 ffda000c03010002110311003f00 616263 ffd9; }
	jpeg 65500 65500 c0 >x
	refuses "JPEG: 65500x65500 pixels, more than 268435456 altogether" x
	for kind in c0 c2; do
		jpeg 16384 16384 $kind >x
		refuses "JPEG: 16384x16384 pixels do not fit a file of 40 bytes" x
	done
}

@test "COLMAP: entries and points" {
	mkdir m
	little 1099511627776 8 | tee m/cameras.bin >m/images.bin
	confined 1 "m/cameras.bin: 1099511627776 entries at offset 0 do not fit a file of 8 bytes" gs-check m
	{ little 1 8; little 1 4; little 1 4; little 64 8; little 64 8; head -c 32 /dev/zero; } >m/cameras.bin
	{ little 1 8; little 1 4; hex 000000000000f03f; head -c 48 /dev/zero; little 1 4; printf 'a.png\0'; little 1099511627776 8; } >m/images.bin
	confined 1 "m/images.bin: the file ends at offset 86, within image entry 0" gs-check m
}

@test "JSON: depth" {
	head -c 100000 /dev/zero | tr '\0' '[' >x.json
	refuses "not JSON at offset 1000" x.json
	{ printf '{"ref":"a","object":"o","text":"t","x":'; head -c 100000 /dev/zero | tr '\0' '['; echo; } >x.jsonl
	confined 1 "x.jsonl:1: not JSON at column 1039" gs-check x.jsonl
}

@test "masks: what is drawn of them, and labels" {
	echo '{"view":"v","object":"o","segmentation":{"size":[65536,65535],"counts":[0,4294901760]}}' >x
	confined 0 "x: ok: masks, 65535x65536, 1 masks, 1 views, 1 objects" gs-check x
	confined 3 "mask-export: x: o: 65535x65536 pixels, more than 268435456 altogether" mask-export --png out x
	labels() {
		printf '{"imagePath":"v.png","imageHeight":%d,"imageWidth":%d,"shapes":[' "$1" "$2"
		for i in 1 2 3 4 5 6 7 8; do printf '{"label":"box %d","points":[[5,15],[15,15],[15,25]]},' $i; done
		echo '{"label":"box","points":[[5,15],[15,15],[15,25]]}]}'
	}
	labels 65536 65535 >x.json
	confined 3 "mask-import: x.json: the picture: 65535x65536 pixels, more than 268435456 altogether" mask-import -o out x.json
	# A picture as large as may be takes its memory once, not once for each label.
	labels 16384 16384 >x.json
	(grep -q __asan_init "$BIN/mask-import" || ulimit -v 1500000; "$BIN/mask-import" -o masks.jsonl x.json)
	[ "$(wc -l <masks.jsonl)" = 9 ]
}

@test "encoder: layers and widths" {
	cp -r "$GOLDEN/bert" m
	jq '.num_hidden_layers = 1000 | .intermediate_size = 1048576' "$GOLDEN/bert/config.json" >m/config.json
	echo '{"ref":"a","object":"o","text":"red cup"}' >s
	confined 3 "text-encode: m/model.safetensors: tensor 'encoder.layer.0.intermediate.dense.weight': is F16[40,24], expected F16[1048576,24]" \
		text-encode --model m -o out s
}
