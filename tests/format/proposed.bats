#!/usr/bin/env bats
# Each rule of formats/scene/proposed.md broken once. The container: safetensors.bats.

setup() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	load files
	cd "$BATS_TEST_TMPDIR"
}

# ints N...: 32 bits each, little-endian, hexadecimal; each N is 0 to 9 or -1.
ints() {
	local n
	for n; do [ "$n" = -1 ] && printf ffffffff || printf '0%d000000' "$n"; done
}

# proposed FILE PARENT SCORE NODE [VERSION [CHOSEN [CLASSES]]]: three regions, two Gaussians, a likely thing with two votes.
proposed() {
	local header='{"__metadata__":{"format":"refer.regions","version":"'${5:-2}'","classes":"'${7:-'[\"cup\",\"jar\"]'}'"},"parent":{"dtype":"I32","shape":[3],"data_offsets":[0,12]}'
	header+=',"score":{"dtype":"F32","shape":[3],"data_offsets":[12,24]},"node":{"dtype":"I32","shape":[2],"data_offsets":[24,32]}'
	header+=',"chosen":{"dtype":"I32","shape":[1],"data_offsets":[32,36]},"votes":{"dtype":"F32","shape":[1,2],"data_offsets":[36,44]}}'
	while (((8 + ${#header}) % 8)); do header+=' '; done
	st "$1" "$header" "$2$3$4${6:-$(ints 0)}$f1$fhalf"
}

refuses() {
	local reason=$1
	shift
	proposed x "$@"
	says 1 "x: $reason" "$BIN/gs-check" x
}

@test "good and bad files" {
	proposed x "$(ints -1 0 0)" $f1$fhalf$f0 "$(ints 2 -1)"
	says 0 'x: ok: refer.regions, 3 regions, 2 gaussians of the scene' "$BIN/gs-check" x
	refuses 'refer.regions version 3 is newer than this program reads (2)' "$(ints -1 0 0)" $f1$fhalf$f0 "$(ints 2 -1)" 3
	refuses "tensor 'parent': node 2 is not below the one before it or one above that" "$(ints -1 -1 0)" $f1$f1$f1 "$(ints 0 0)"
	refuses "tensor 'parent': node 0 is not below the one before it or one above that" "$(ints 0 0 0)" $f1$f1$f1 "$(ints 0 0)"
	refuses "tensor 'score': item 1 is not finite" "$(ints -1 0 0)" $f1$fnan$f1 "$(ints 0 0)"
	refuses "tensor 'node': item 1 is 3, of 3 nodes" "$(ints -1 0 0)" $f1$f1$f1 "$(ints 0 3)"
	refuses "tensor 'chosen': item 0 is 3, of 3 nodes" "$(ints -1 0 0)" $f1$f1$f1 "$(ints 0 0)" 2 "$(ints 3)"
	refuses "metadata 'classes' has 1 entries for 2 columns of 'votes'" "$(ints -1 0 0)" $f1$f1$f1 "$(ints 0 0)" 2 "$(ints 0)" '[\"cup\"]'
}
