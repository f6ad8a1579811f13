#!/usr/bin/env bats
# Each rule of formats/scene/lifted.md broken once. Round trip: tests/unit/test_lifted.c. The container: safetensors.bats.

setup() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	load files
	cd "$BATS_TEST_TMPDIR"
}

# i64 N...: little-endian, hexadecimal; each N is 0 to 9 or -1.
i64() {
	local n
	for n; do [ "$n" = -1 ] && printf ffffffffffffffff || printf '%02x00000000000000' "$n"; done
}

# i32 N...
i32() {
	local n
	for n; do [ "$n" = -1 ] && printf ffffffff || printf '%02x000000' "$n"; done
}

# lifted FILE [NAME=VALUE]...: two objects of five Gaussians, with two shares and one; a sentence of two words and one
# of none. VALUE replaces a tensor's data (hexadecimal), its type (NAME_type) or its shape (NAME_shape), or a value of the
# metadata; an empty tensor or value is left out.
lifted() {
	local file=$1 assignment at=0 name header= data= hex meta= value
	local order="indptr offsets index object confidence words share"
	local indptr offsets index object confidence words share=ff3301 format=refer.lifted version=1
	local indptr_type=I64 offsets_type=I64 index_type=I32 object_type=I32 confidence_type=F32 words_type=F16 share_type=U8
	local indptr_shape='[3]' offsets_shape='[3]' index_shape='[3]' object_shape='[2]' confidence_shape='[2]'
	local words_shape='[2,2]' share_shape='[3]' gaussians=5
	local names='[\"cup\",\"pan\"]' texts='[\"red cup\",\"\"]' pieces='[\"red cup\",\"\"]'
	indptr=$(i64 0 2 3) offsets=$(i64 0 2 2) index=$(i32 1 3 0) object=$(i32 1 0) confidence=$f1$f0 words=003c0040004200c4
	shift
	for assignment; do local "${assignment%%=*}=${assignment#*=}"; done
	for name in $order; do
		hex=${!name}
		local type=${name}_type shape=${name}_shape
		[ "$hex" = none ] && continue
		header+=",\"$name\":{\"dtype\":\"${!type}\",\"shape\":${!shape},\"data_offsets\":[$at,$((at + ${#hex} / 2))]}"
		at=$((at + ${#hex} / 2)) data+=$hex
	done
	for name in format version gaussians names texts pieces; do
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
	lifted x "$@"
	says 1 "x: $reason" "$BIN/gs-check" x
}

@test "a good file" {
	lifted x
	says 0 'x: ok: refer.lifted, 2 objects, 3 shares, 2 sentences, 2 words, 2 columns, 5 gaussians of the scene' "$BIN/gs-check" x
}

@test "nothing at all is good" {
	lifted x indptr=$(i64 0) indptr_shape='[1]' index= index_shape='[0]' share= share_shape='[0]' confidence= \
		confidence_shape='[0]' object= object_shape='[0]' offsets=$(i64 0) offsets_shape='[1]' words= words_shape='[0,2]' \
		names='[]' texts='[]' pieces='[]' gaussians=0
	says 0 'x: ok: refer.lifted, 0 objects, 0 shares, 0 sentences, 0 words, 2 columns, 0 gaussians of the scene' "$BIN/gs-check" x
}

@test "version and Gaussians" {
	refuses 'refer.lifted version 2 is newer than this program reads (1)' version=2
	refuses "metadata 'gaussians' is 'many', not a whole number from 0 to 2147483647" gaussians=many
	refuses "metadata 'gaussians' is '', not a whole number from 0 to 2147483647" gaussians=
}

@test "tensors that are missing, or of another type or shape" {
	for name in indptr offsets index object confidence words share; do
		refuses "tensor '$name' is missing" $name=none
	done
	refuses "tensor 'share': is U8[2], expected U8[3]" share=ff33 share_shape='[2]'
	refuses "tensor 'confidence': is F32[1], expected F32[2]" confidence=$f1 confidence_shape='[1]'
	refuses "tensor 'object': is I32[1], expected I32[2]" object=$(i32 0) object_shape='[1]'
	refuses "tensor 'words': is F32[1,2], expected F16[*,*]" words=$f0$f0 words_type=F32 words_shape='[1,2]'
	refuses "tensor 'index': is F32[3], expected I32[*]" index_type=F32
	refuses "tensor 'indptr': has 0 entries, expected 1 more than objects" indptr= indptr_shape='[0]'
	refuses "tensor 'offsets': has 0 entries, expected 1 more than sentences" offsets= offsets_shape='[0]'
	refuses "tensor 'words': width 0 is not in 1 to 65536" words= words_shape='[2,0]'
}

@test "cut: one of each object, above 0 and below 1" {
	local order="indptr offsets index object confidence cut words share" half=0000003f
	lifted x "order=$order" cut=$half$half cut_type=F32 cut_shape='[2]'
	"$BIN/gs-check" x
	refuses "tensor 'cut': is F32[1], expected F32[2]" "order=$order" cut=$half cut_type=F32 cut_shape='[1]'
	refuses "tensor 'cut': item 1 is not above 0 and below 1" "order=$order" cut=$half$f1 cut_type=F32 cut_shape='[2]'
}

@test "middle: of the shape of words, and finite" {
	local order="indptr offsets index object confidence words middle share"
	lifted x "order=$order" middle=003c0040004200c4 middle_type=F16 middle_shape='[2,2]'
	says 0 'x: ok: refer.lifted, 2 objects, 3 shares, 2 sentences, 2 words, 2 columns, 5 gaussians of the scene' "$BIN/gs-check" x
	refuses "tensor 'middle': is F16[1,2], expected F16[2,2]" "order=$order" middle=003c0040 middle_type=F16 middle_shape='[1,2]'
	refuses "tensor 'middle': item 1 is not finite" "order=$order" middle=003c007e004200c4 middle_type=F16 middle_shape='[2,2]'
}

@test "indptr and offsets" {
	refuses "tensor 'indptr': begins with 1, expected 0" indptr=$(i64 1 2 3)
	refuses "tensor 'indptr': falls from 2 to 1 at entry 2" indptr=$(i64 0 2 1)
	refuses "tensor 'indptr': falls from 0 to -1 at entry 1" indptr=$(i64 0 -1 3)
	refuses "tensor 'indptr': ends with 2, but there are 3 shares" indptr=$(i64 0 2 2)
	refuses "tensor 'offsets': begins with 1, expected 0" offsets=$(i64 1 2 2)
	refuses "tensor 'offsets': falls from 2 to 1 at entry 2" offsets=$(i64 0 2 1)
	refuses "tensor 'offsets': ends with 1, but there are 2 words" offsets=$(i64 0 1 1)
}

@test "numbers" {
	refuses "tensor 'index': item 0 does not rise within 0 to 4, in object 0" index=$(i32 -1 3 0)
	refuses "tensor 'index': item 1 does not rise within 0 to 4, in object 0" index=$(i32 1 1 0)
	refuses "tensor 'index': item 2 does not rise within 0 to 4, in object 1" index=$(i32 1 3 5)
	refuses "tensor 'share': item 1 is 0" share=ff0001
	refuses "tensor 'confidence': item 1 is not in 0 to 1" confidence=$f1$fminus
	refuses "tensor 'confidence': item 0 is not in 0 to 1" confidence=$fnan$f0
	refuses "tensor 'object': item 0 is 2, of 2 objects" object=$(i32 2 0)
	refuses "tensor 'object': item 1 is -1, of 2 objects" object=$(i32 0 -1)
	refuses "tensor 'words': item 2 is not finite" words=003c0040007e00c4
}

@test "metadata lists" {
	refuses "metadata 'names' is not a JSON list" names=
	refuses "metadata 'names' has 1 entries for 2 objects" names='[\"cup\"]'
	refuses "metadata 'names': 'cup' appears twice" names='[\"cup\",\"cup\"]'
	refuses "metadata 'names': entry 0 is empty" names='[\"\",\"cup\"]'
	refuses "metadata 'names': entry 1 has a control character at byte 1" names='[\"cup\",\"\\n\"]'
	refuses "metadata 'texts' is not a JSON list" texts='{}'
	refuses "metadata 'texts' has 3 entries for 2 sentences" texts='[\"a\",\"b\",\"c\"]'
	refuses "metadata 'texts': entry 1 is not a UTF-8 string" texts='[\"a\",2]'
	refuses "metadata 'pieces' is not a JSON list" pieces=
	refuses "metadata 'pieces': entry 0 has 1 pieces for 2 words" pieces='[\"redcup\",\"\"]'
	for blanks in 'red  cup' ' red cup' 'red cup '; do
		refuses "metadata 'pieces': entry 0 does not have one space between pieces, and none around" \
			pieces="[\\\"$blanks\\\",\\\"\\\"]"
	done
	refuses "metadata 'pieces': entry 1 does not have one space between pieces, and none around" pieces='[\"red cup\",\" \"]'
}
