#!/usr/bin/env bats
# Each rule of formats/scene/features.md broken once. What feature-lift reads: cli/feature-lift.bats. The container: safetensors.bats.

setup() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	load files
	cd "$BATS_TEST_TMPDIR"
}

# features FILE [NAME=VALUE]...: two Gaussians with two channels. VALUE replaces a tensor's data (hexadecimal), its type
# (NAME_type) or its shape (NAME_shape), or a value of the metadata; "none" leaves a tensor out.
features() {
	local file=$1 assignment at=0 name header= data= hex meta= value
	local features=003c0000003800b8 labels=none reliability=$f1$fhalf weight=$f1$f0 format=refer.features version=1 gaussians=2
	local features_type=F16 labels_type=I32 reliability_type=F32 weight_type=F32
	local features_shape='[2,2]' labels_shape='[2]' reliability_shape='[2]' weight_shape='[2]'
	shift
	for assignment; do local "${assignment%%=*}=${assignment#*=}"; done
	for name in labels reliability weight features; do
		hex=${!name}
		local type=${name}_type shape=${name}_shape
		[ "$hex" = none ] && continue
		header+=",\"$name\":{\"dtype\":\"${!type}\",\"shape\":${!shape},\"data_offsets\":[$at,$((at + ${#hex} / 2))]}"
		at=$((at + ${#hex} / 2)) data+=$hex
	done
	for name in format version gaussians; do
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
	features x "$@"
	says 1 "x: $reason" "$BIN/gs-check" x
}

@test "good files" {
	features x
	says 0 'x: ok: refer.features, f16, 2 gaussians, 2 channels, 1 seen' "$BIN/gs-check" x
	features x features=$f1$f0 features_type=F32 features_shape='[2,1]'
	says 0 'x: ok: refer.features, f32, 2 gaussians, 1 channels, 1 seen' "$BIN/gs-check" x
	features x features=none labels=07000000ffffffff
	says 0 'x: ok: refer.features, 2 gaussians, 1 seen, 1 labels' "$BIN/gs-check" x
	features x features= features_shape='[0,2]' reliability= reliability_shape='[0]' weight= weight_shape='[0]' gaussians=0
	says 0 'x: ok: refer.features, f16, 0 gaussians, 2 channels, 0 seen' "$BIN/gs-check" x
}

@test "version and Gaussians" {
	refuses 'refer.features version 2 is newer than this program reads (1)' version=2
	refuses "metadata 'gaussians' is 'many', not a whole number from 0 to 2147483647" gaussians=many
	refuses "tensor 'reliability': is F32[2], expected F32[3]" gaussians=3
}

@test "tensors that are missing, or of another type or shape" {
	refuses "tensor 'features' or 'labels' is missing" features=none
	refuses "tensor 'reliability' is missing" reliability=none
	refuses "tensor 'weight' is missing" weight=none
	refuses "tensor 'weight': is F32[1], expected F32[2]" weight=$f1 weight_shape='[1]'
	refuses "tensor 'features': is U8[2,4], expected F32[2,*]" features_type=U8 features_shape='[2,4]'
	refuses "tensor 'features': is F16[4], expected F16[2,*]" features_shape='[4]'
	refuses "tensor 'features': 0 channels, not 1 to 65536" features= features_shape='[2,0]'
	refuses "tensor 'labels': is F32[2], expected I32[2]" features=none labels=$f1$f0 labels_type=F32
}

@test "numbers" {
	refuses "tensor 'features': item 2 is not finite" features=003c0000007c00b8
	refuses "tensor 'features': item 1 is not finite" features=$f1$fnan features_type=F32 features_shape='[2,1]'
	refuses "tensor 'reliability': item 1 is not in 0 to 1" reliability=$f1$fminus
	refuses "tensor 'reliability': item 0 is not in 0 to 1" reliability=$fnan$f0
	refuses "tensor 'weight': item 0 is not a number from 0" weight=$finf$f0
	refuses "tensor 'weight': item 1 is not a number from 0" weight=$f1$fminus
	refuses "tensor 'labels': item 0 is -2, below -1" features=none labels=feffffffffffffff
	refuses "tensor 'labels': item 1 is 16777216, above 16777215" features=none labels=ffffff0000000001
}
