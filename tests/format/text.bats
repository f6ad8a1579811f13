#!/usr/bin/env bats
# Each rule of formats/scene/text.md broken once. Round trip: tests/unit/test_text.c. The container: safetensors.bats.

setup() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	load files
	cd "$BATS_TEST_TMPDIR"
	META='"format":"refer.text","version":"1","refs":"[\"r1\",\"r2\"]","objects":"[\"o\",\"o\"]","texts":"[\"t\",\"\"]","splits":"[\"train\",\"test\"]"'
	TENSORS='"offsets":{"dtype":"I64","shape":[3],"data_offsets":[0,24]},"words":{"dtype":"F32","shape":[2,2],"data_offsets":[24,40]},"sentences":{"dtype":"F32","shape":[2,2],"data_offsets":[40,56]}'
	OFFSETS=000000000000000002000000000000000200000000000000
	REST=0000803f0000004000004040000080c0000000400000803f0000000000000000
}

# text META TENSORS HEX: a file whose data begin at a multiple of 8.
text() {
	local header="{\"__metadata__\":{$1},$2}"
	while [ $((${#header} % 8)) != 0 ]; do header="$header "; done
	st x "$header" "$3"
}

# refuses REASON META TENSORS HEX
refuses() {
	text "$2" "$3" "$4"
	says 1 "x: $1" "$BIN/gs-check" x
}

@test "a good file" {
	text "$META" "$TENSORS" $OFFSETS$REST
	says 0 'x: ok: refer.text, 2 sentences, 2 words, 2 columns' "$BIN/gs-check" x
}

# with TEXT OLD NEW: TEXT with the first OLD, literally, replaced.
with() {
	local rest=${1#*"$2"}
	[ "$rest" != "$1" ]
	printf '%s' "${1%%"$2"*}$3$rest"
}

@test "tensors that are missing, or of another type or shape" {
	refuses "tensor 'words' is missing" "$META" "$(with "$TENSORS" words wards)" $OFFSETS$REST
	refuses "tensor 'words': is F16[4,2], expected F32[*,*]" "$META" \
		"$(with "$TENSORS" '"F32","shape":[2,2]' '"F16","shape":[4,2]')" $OFFSETS$REST
	refuses "tensor 'sentences': is F32[4], expected F32[2,2]" "$META" \
		"$(with "$TENSORS" '[2,2],"data_offsets":[40' '[4],"data_offsets":[40')" $OFFSETS$REST
	refuses "tensor 'offsets': has 0 entries, expected 1 more than sentences" "$META" \
		'"offsets":{"dtype":"I64","shape":[0],"data_offsets":[0,0]},"words":{"dtype":"F32","shape":[0,2],"data_offsets":[0,0]}' ''
	refuses "tensor 'words': width 0 is not in 1 to 65536" "$META" \
		'"offsets":{"dtype":"I64","shape":[1],"data_offsets":[0,8]},"words":{"dtype":"F32","shape":[2,0],"data_offsets":[8,8]}' 0000000000000000
}

@test "middle: of the shape of words, and finite" {
	local middle='"middle":{"dtype":"F32","shape":[2,2],"data_offsets":[56,72]}'
	text "$META" "$TENSORS,$middle" $OFFSETS$REST${REST:0:32}
	says 0 'x: ok: refer.text, 2 sentences, 2 words, 2 columns' "$BIN/gs-check" x
	refuses "tensor 'middle': item 2 is not finite" "$META" "$TENSORS,$middle" $OFFSETS${REST}0000803f000000400000807f000080c0
	refuses "tensor 'middle': is F32[1,2], expected F32[2,2]" "$META" \
		"$TENSORS,$(with "$(with "$middle" '[2,2]' '[1,2]')" 72 64)" $OFFSETS${REST}${REST:0:16}
}

@test "numbers that are not finite" {
	refuses "tensor 'words': item 1 is not finite" "$META" "$TENSORS" ${OFFSETS}${REST/00000040/0000807f}
	refuses "tensor 'sentences': item 3 is not finite" "$META" "$TENSORS" ${OFFSETS}${REST/%00000000/0000c07f}
}

@test "offsets" {
	refuses "tensor 'offsets': begins with 1, expected 0" "$META" "$TENSORS" ${OFFSETS/#00/01}$REST
	refuses "tensor 'offsets': falls from 2 to 1 at entry 2" "$META" "$TENSORS" 000000000000000002000000000000000100000000000000$REST
	refuses "tensor 'offsets': falls from 0 to -1 at entry 1" "$META" "$TENSORS" 0000000000000000ffffffffffffffff0200000000000000$REST
	refuses "tensor 'offsets': ends with 1, but there are 2 words" "$META" "$TENSORS" 000000000000000001000000000000000100000000000000$REST
}

@test "metadata lists" {
	refuses "metadata 'refs' is not a JSON list" "$(with "$META" refs rifs)" "$TENSORS" $OFFSETS$REST
	refuses "metadata 'objects' is not a JSON list" "$(with "$META" '[\"o\",\"o\"]' '{}')" "$TENSORS" $OFFSETS$REST
	refuses "metadata 'refs' has 1 entries for 2 sentences" "$(with "$META" ',\"r2\"' '')" "$TENSORS" $OFFSETS$REST
	refuses "metadata 'refs': entry 1 is not a UTF-8 string" "$(with "$META" '\"r2\"' 2)" "$TENSORS" $OFFSETS$REST
	refuses "metadata 'refs': entry 1 is empty" "$(with "$META" r2 '')" "$TENSORS" $OFFSETS$REST
	refuses "metadata 'refs': entry 1 has a control character at byte 1" "$(with "$META" r2 '\\n')" "$TENSORS" $OFFSETS$REST
	refuses "metadata 'objects': entry 0 has a control character at byte 2" \
		"$(with "$META" '[\"o\"' '[\"o\\t\"')" "$TENSORS" $OFFSETS$REST
	refuses "metadata 'refs': a NUL character (\\u0000) in a string" "$(with "$META" r2 '\\u0000')" "$TENSORS" $OFFSETS$REST
	refuses "metadata 'refs': 'r1' appears twice" "$(with "$META" r2 r1)" "$TENSORS" $OFFSETS$REST
	refuses "metadata 'splits': entry 0 is 'val', not 'train' or 'test'" "$(with "$META" train val)" "$TENSORS" $OFFSETS$REST
}

@test "pieces: as many as words" {
	text "$META,\"pieces\":\"[\\\"a ##b\\\",\\\"\\\"]\"" "$TENSORS" $OFFSETS$REST
	says 0 'x: ok: refer.text, 2 sentences, 2 words, 2 columns' "$BIN/gs-check" x
	refuses "metadata 'pieces': entry 0 has 1 pieces for 2 words" "$META,\"pieces\":\"[\\\"ab\\\",\\\"\\\"]\"" "$TENSORS" $OFFSETS$REST
	refuses "metadata 'pieces': entry 0 does not have one space between pieces, and none around" \
		"$META,\"pieces\":\"[\\\"a  ##b\\\",\\\"\\\"]\"" "$TENSORS" $OFFSETS$REST
	refuses "metadata 'pieces' has 1 entries for 2 sentences" "$META,\"pieces\":\"[\\\"a b\\\"]\"" "$TENSORS" $OFFSETS$REST
}

@test "what only some sentences say: objects, view and kind" {
	local lists='"object_lists":"[\"[\\\"a\\\",\\\"b\\\"]\",\"\"]"'
	text "$META,$lists,\"views\":\"[\\\"\\\",\\\"v\\\"]\",\"kinds\":\"[\\\"several\\\",\\\"\\\"]\"" "$TENSORS" $OFFSETS$REST
	says 0 'x: ok: refer.text, 2 sentences, 2 words, 2 columns' "$BIN/gs-check" x
	refuses "metadata 'object_lists': entry 1 is not a JSON list of names" "$META,\"object_lists\":\"[\\\"[]\\\",\\\"x\\\"]\"" "$TENSORS" $OFFSETS$REST
	refuses "metadata 'views' has 1 entries for 2 sentences" "$META,\"views\":\"[\\\"v\\\"]\"" "$TENSORS" $OFFSETS$REST
	refuses "metadata 'kinds' is not a JSON list" "$META,\"kinds\":\"plain\"" "$TENSORS" $OFFSETS$REST
}
