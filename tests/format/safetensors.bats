#!/usr/bin/env bats
# Each rule of formats/arrays/safetensors.md broken once. The bytes that we write are held by tests/unit/test_safetensors.c.

setup() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	GOLDEN=$BATS_TEST_DIRNAME/../golden/good/small.safetensors
	load files
	cd "$BATS_TEST_TMPDIR"
}

# refuses REASON HEADER [HEX]
refuses() {
	st x "$2" "${3:-}"
	says 1 "x: $1" "$BIN/gs-check" x
}

# A tensor of two halves, four bytes of data.
half='{"dtype":"F16","shape":[2],"data_offsets":[0,4]}'

# Fails where the command succeeds; a plain ! would let the test go on.
not() { ! "$@"; }

@test "a good file" {
	st x "{\"a\":$half}" 003c00c1
	says 0 "x: ok: safetensors, 1 tensors
	a F16[2]" "$BIN/gs-check" x
	st x '{}'
	says 0 "x: ok: safetensors, 0 tensors" "$BIN/gs-check" x
	st x "{\"__metadata__\":{\"a\":\"b\"},\"a\":$half}  " 003c00c1
	"$BIN/gs-check" x
}

@test "every type of the field is known" {
	for row in BOOL:1 U8:1 I8:1 F8_E4M3:1 F8_E5M2:1 I16:2 U16:2 F16:2 BF16:2 I32:4 U32:4 F32:4 F64:8 I64:8 U64:8; do
		st x "{\"a\":{\"dtype\":\"${row%:*}\",\"shape\":[],\"data_offsets\":[0,${row#*:}]}}" "$(printf '%*s' $((2 * ${row#*:})) | tr ' ' 0)"
		"$BIN/gs-check" x
	done
}

@test "a file that begins like ours and ends too early, at every length" {
	size=$(wc -c <"$GOLDEN")
	for ((n = 0; n < size; n++)); do head -c $n "$GOLDEN" >cut.$(printf %04d $n); done
	status=0
	"$BIN/gs-check" cut.* >out 2>err || status=$?
	[ $status = 1 ]
	[ ! -s err ]
	[ "$(wc -l <out)" = "$size" ]
	not grep -F ': ok' out
	grep -Fx 'cut.0000: empty' out
	grep -Fx 'cut.0007: not a kind of file that the suite reads' out
	grep -Fx 'cut.0008: header of 568 bytes does not fit a file of 8: not safetensors, or cut short' out
	grep -Fx 'cut.0575: header of 568 bytes does not fit a file of 575: not safetensors, or cut short' out
	grep -Fx "cut.0576: tensor 'one': ends at data offset 8 but the file has 0 data bytes" out
	grep -Fx "cut.0614: tensor 'bytes': ends at data offset 39 but the file has 38 data bytes" out
}

@test "too short to hold the header's length" {
	mkdir scene && head -c 7 "$GOLDEN" >scene/splats.safetensors && echo '[]' >scene/cameras.json
	says 1 "scene/splats.safetensors: 7 bytes, too short for a safetensors file" "$BIN/gs-check" scene
}

@test "bytes after the last tensor" {
	{ cat "$GOLDEN"; printf xyz; } >x
	says 1 "x: 3 bytes after the last tensor" "$BIN/gs-check" x
}

@test "one byte changed in each tensor's data: the checksum" {
	for row in 'one 576' 'ids 584' 'matrix 600' 'bytes 614'; do
		set -- $row
		cp "$GOLDEN" x
		printf '\x99' | dd of=x bs=1 seek="$2" conv=notrunc status=none
		"$BIN/gs-check" x >out && return 1
		grep -xE "x: tensor '$1': crc32 is [0-9a-f]{8}, the header says [0-9a-f]{8}" out
	done
}

@test "headers that are not JSON objects" {
	refuses 'header is not JSON at offset 10' '{"a}'
	refuses 'header is not JSON at offset 13' '{"a":1'
	refuses 'header has something after its JSON at offset 10' '{}x'
	refuses 'header has something after its JSON at offset 11' '{} {}'
	mkdir scene # gs-check takes only what begins with { for safetensors
	st scene/splats.safetensors '[]'
	says 3 'gs-weigh: scene/splats.safetensors: header at offset 8 is not a JSON object' "$BIN/gs-weigh" -o weights scene
}

@test "metadata" {
	refuses '__metadata__ is not one object' '{"__metadata__":1}'
	refuses '__metadata__ is not one object' '{"__metadata__":{},"__metadata__":{}}'
	refuses "__metadata__ 'k' is not a string" '{"__metadata__":{"k":1}}'
}

@test "entries" {
	refuses "tensor 'a': needs dtype, shape and data_offsets" '{"a":1}'
	refuses "tensor 'a': needs dtype, shape and data_offsets" '{"a":{"shape":[2],"data_offsets":[0,4]}}' 00000000
	refuses "tensor 'a': needs dtype, shape and data_offsets" '{"a":{"dtype":"F16","data_offsets":[0,4]}}' 00000000
	refuses "tensor 'a': needs dtype, shape and data_offsets" '{"a":{"dtype":"F16","shape":[2]}}' 00000000
	refuses "tensor 'a': needs dtype, shape and data_offsets" '{"a":{"dtype":"F16","shape":[2],"data_offsets":[4]}}' 00000000
	refuses "tensor 'a': needs dtype, shape and data_offsets" \
		'{"a":{"dtype":"F16","shape":[2],"data_offsets":{"x":0,"y":4}}}' 00000000
	refuses "tensor 'a': dtype 'C64' is not supported" '{"a":{"dtype":"C64","shape":[],"data_offsets":[0,8]}}' 0000000000000000
	refuses "tensor 'a' appears twice" "{\"a\":$half,\"a\":$half}" 00000000
}

@test "shapes" {
	for shape in '[-1]' '[1.5]' '["2"]' '[1e300]' '[9007199254740994]' '[1,1,1,1,1,1,1,1,2]'; do
		refuses "tensor 'a': bad shape" "{\"a\":{\"dtype\":\"F16\",\"shape\":$shape,\"data_offsets\":[0,4]}}" 00000000
	done
	refuses "tensor 'a': shape overflows" \
		'{"a":{"dtype":"F16","shape":[9007199254740992,9007199254740992],"data_offsets":[0,4]}}' 00000000
	refuses "tensor 'a': 4 bytes of data do not fit its shape and type" \
		'{"a":{"dtype":"F16","shape":[3],"data_offsets":[0,4]}}' 00000000
	refuses "tensor 'a': 4 bytes of data do not fit its shape and type" \
		'{"a":{"dtype":"F64","shape":[2048,1125899906842624],"data_offsets":[0,4]}}' 00000000
}

@test "data offsets" {
	for range in '[-1,3]' '[4,0]' '[0.5,4.5]' '["0","4"]' '[0,null]'; do
		refuses "tensor 'a': bad data_offsets" "{\"a\":{\"dtype\":\"F16\",\"shape\":[2],\"data_offsets\":$range}}" 00000000
	done
	refuses "tensor 'a': ends at data offset 5 but the file has 4 data bytes" \
		'{"a":{"dtype":"F16","shape":[2],"data_offsets":[1,5]}}' 00000000
	refuses "tensor 'a': begins at data offset 1, expected 0" '{"a":{"dtype":"U8","shape":[3],"data_offsets":[1,4]}}' 00000000
	refuses "tensor 'b': begins at data offset 2, expected 4" \
		"{\"a\":$half,\"b\":{\"dtype\":\"U8\",\"shape\":[2],\"data_offsets\":[2,4]}}" 00000000
	refuses "tensor 'b': begins at data offset 5, expected 4" \
		"{\"a\":$half,\"b\":{\"dtype\":\"U8\",\"shape\":[1],\"data_offsets\":[5,6]}}" 000000000000
}

@test "versions of our own formats" {
	refuses "version is '', not a number from 1" '{"__metadata__":{"format":"refer.splats"}}'
	refuses "version is '0', not a number from 1" '{"__metadata__":{"format":"refer.splats","version":"0"}}'
	refuses "version is '1x', not a number from 1" '{"__metadata__":{"format":"refer.splats","version":"1x"}}'
	refuses "refer.splats version 99 is newer than this program reads (1)" \
		'{"__metadata__":{"format":"refer.splats","version":"99"}}'
}

@test "a tensor of ours at an odd offset is refused; a foreign one is fine" {
	header='"a":{"dtype":"F32","shape":[1],"data_offsets":[0,4]}}'
	st x "{$header" 00000000
	"$BIN/gs-check" x
	x='{"__metadata__":{"format":"refer.splats","version":"1"},'
	for pad in '' ' ' '  ' '   '; do
		st x "$x$header$pad" 00000000
		"$BIN/gs-check" x >>out || true
	done
	# One of the four is aligned, and is refused for what it lacks.
	[ "$(grep -c "tensor 'a': at offset [0-9]*, not aligned to its type" out)" = 3 ]
	[ "$(grep -c "tensor 'means' is missing" out)" = 1 ]
}

@test "names with control characters do not break the line" {
	st x '{"a\n":{"dtype":"U8","shape":[1],"data_offsets":[0,1]}}' 00
	says 0 "x: ok: safetensors, 1 tensors
	a? U8[1]" "$BIN/gs-check" x
	st x '{"a\n\u001b[31m":1}'
	says 1 "x: tensor 'a??[31m': needs dtype, shape and data_offsets" "$BIN/gs-check" x
}
