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

# proposed FILE PARENT SCORE NODE [VERSION]: three regions, two Gaussians.
proposed() {
	local header='{"__metadata__":{"format":"refer.regions","version":"'${5:-1}'"},"parent":{"dtype":"I32","shape":[3],"data_offsets":[0,12]}'
	header+=',"score":{"dtype":"F32","shape":[3],"data_offsets":[12,24]},"node":{"dtype":"I32","shape":[2],"data_offsets":[24,32]}}'
	while (((8 + ${#header}) % 8)); do header+=' '; done
	st "$1" "$header" "$2$3$4"
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
	refuses 'refer.regions version 2 is newer than this program reads (1)' "$(ints -1 0 0)" $f1$fhalf$f0 "$(ints 2 -1)" 2
	refuses "tensor 'parent': node 2 is not below the one before it or one above that" "$(ints -1 -1 0)" $f1$f1$f1 "$(ints 0 0)"
	refuses "tensor 'parent': node 0 is not below the one before it or one above that" "$(ints 0 0 0)" $f1$f1$f1 "$(ints 0 0)"
	refuses "tensor 'score': item 1 is not finite" "$(ints -1 0 0)" $f1$fnan$f1 "$(ints 0 0)"
	refuses "tensor 'node': item 1 is 3, of 3 nodes" "$(ints -1 0 0)" $f1$f1$f1 "$(ints 0 3)"
}
