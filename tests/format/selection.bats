#!/usr/bin/env bats
# Each rule of formats/scene/selection.md broken once. Round trip: tests/unit/test_selection.c. The container: safetensors.bats.

setup() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	load files
	cd "$BATS_TEST_TMPDIR"
}

# numbers BYTES N...: little-endian, hexadecimal; each N is 0 to 9 or -1.
numbers() {
	local bytes=$1 n digits
	shift
	for n; do
		[ "$n" = -1 ] && printf "%0$((2 * bytes))d" 0 | tr 0 f || { printf '%02x' "$n"; printf "%0$((2 * bytes - 2))d" 0; }
	done
}

# selection FILE [NAME=VALUE]...: two sentences of four Gaussians. VALUE replaces a tensor's data (hexadecimal), its type
# (NAME_type) or its shape (NAME_shape), or a value of the metadata; "none" leaves a tensor out.
selection() {
	local file=$1 assignment at=0 name header= data= hex meta= value
	local indptr index format=refer.selection version=1 gaussians=4 refs='[\"a\",\"b\"]'
	local indptr_type=I64 index_type=I32 indptr_shape='[3]' index_shape='[3]'
	indptr=$(numbers 8 0 2 3) index=$(numbers 4 1 3 0)
	shift
	for assignment; do local "${assignment%%=*}=${assignment#*=}"; done
	for name in indptr index; do
		hex=${!name}
		local type=${name}_type shape=${name}_shape
		[ "$hex" = none ] && continue
		header+=",\"$name\":{\"dtype\":\"${!type}\",\"shape\":${!shape},\"data_offsets\":[$at,$((at + ${#hex} / 2))]}"
		at=$((at + ${#hex} / 2)) data+=$hex
	done
	for name in format version gaussians refs; do
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
	selection x "$@"
	says 1 "x: $reason" "$BIN/gs-check" x
}

@test "good files" {
	selection x
	says 0 'x: ok: refer.selection, 2 sentences, 3 items, 4 gaussians of the scene' "$BIN/gs-check" x
	selection x indptr=$(numbers 8 0) indptr_shape='[1]' index= index_shape='[0]' refs='[]' gaussians=0
	says 0 'x: ok: refer.selection, 0 sentences, 0 items, 0 gaussians of the scene' "$BIN/gs-check" x
}

@test "version, Gaussians and tensors" {
	refuses 'refer.selection version 2 is newer than this program reads (1)' version=2
	refuses "metadata 'gaussians' is 'many', not a whole number from 0 to 2147483647" gaussians=many
	refuses "tensor 'indptr' is missing" indptr=none
	refuses "tensor 'index' is missing" index=none
	refuses "tensor 'index': is F32[3], expected I32[*]" index_type=F32
	refuses "tensor 'indptr': has 0 entries, expected 1 more than sentences" indptr= indptr_shape='[0]'
}

@test "numbers" {
	refuses "tensor 'indptr': begins with 1, expected 0" indptr=$(numbers 8 1 2 3)
	refuses "tensor 'indptr': falls from 2 to 1 at entry 2" indptr=$(numbers 8 0 2 1)
	refuses "tensor 'indptr': ends with 2, but there are 3 items" indptr=$(numbers 8 0 1 2)
	refuses "tensor 'index': item 1 does not rise within 0 to 3, in sentence 0" index=$(numbers 4 1 1 0)
	refuses "tensor 'index': item 2 does not rise within 0 to 3, in sentence 1" index=$(numbers 4 1 3 4)
	refuses "tensor 'index': item 0 does not rise within 0 to 3, in sentence 0" index=$(numbers 4 -1 3 0)
}

@test "refs" {
	refuses "metadata 'refs' is not a JSON list" refs=
	refuses "metadata 'refs' has 1 entries for 2 sentences" refs='[\"a\"]'
	refuses "metadata 'refs': 'a' appears twice" refs='[\"a\",\"a\"]'
	refuses "metadata 'refs': entry 1 is empty" refs='[\"a\",\"\"]'
}
