#!/usr/bin/env bats
# Each rule of formats/scene/weights.md broken once.

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

# weights FILE [NAME=VALUE]...: a view of two pixels and three weights. VALUE replaces a tensor's data (hexadecimal), its
# type (NAME_type) or its shape (NAME_shape), or a number of the metadata.
weights() {
	local file=$1 assignment at=0 name header= data= hex
	local width=2 height=1 gaussians=5 order="indptr index dropped weight"
	local indptr index indptr_type=I64 index_type=I32 dropped_type=F32 weight_type=F32
	local indptr_shape='[3]' index_shape='[3]' dropped_shape='[2]' weight_shape='[3]'
	local dropped=$f0$fhalf weight=$fhalf$fhalf$f1
	indptr=$(i64 0 2 3)
	index=$(i32 4 0 2)
	shift
	for assignment; do local "${assignment%%=*}=${assignment#*=}"; done
	for name in $order; do
		hex=${!name}
		local type=${name}_type shape=${name}_shape
		header+=",\"$name\":{\"dtype\":\"${!type}\",\"shape\":${!shape},\"data_offsets\":[$at,$((at + ${#hex} / 2))]}"
		at=$((at + ${#hex} / 2))
		data+=$hex
	done
	header="{\"__metadata__\":{\"format\":\"refer.weights\",\"version\":\"1\",\"width\":\"$width\",\"height\":\"$height\",\"gaussians\":\"$gaussians\"}$header}"
	while (((8 + ${#header}) % 64)); do header+=' '; done
	st "$file" "$header" "$data"
}

# bad REASON [NAME=VALUE]...: the file with those changes is refused.
bad() {
	local reason=$1
	shift
	weights w "$@"
	says 1 "w: $reason" "$BIN/gs-check" w
}

@test "a file made by hand is fine, with single, half and byte weights" {
	weights w
	says 0 "w: ok: refer.weights, f32, 2x1, 3 weights, 5 gaussians of the scene" "$BIN/gs-check" w
	weights w weight=00380038003c weight_type=F16
	says 0 "w: ok: refer.weights, f16, 2x1, 3 weights, 5 gaussians of the scene" "$BIN/gs-check" w
	weights w weight=0080ff weight_type=U8
	says 0 "w: ok: refer.weights, u8, 2x1, 3 weights, 5 gaussians of the scene" "$BIN/gs-check" w
}

@test "size and number of Gaussians" {
	bad "metadata 'width' is '0', not a whole number from 1 to 65536" width=0
	bad "metadata 'width' is '65537', not a whole number from 1 to 65536" width=65537
	bad "metadata 'height' is '1x', not a whole number from 1 to 65536" height=1x
	bad "metadata 'height' is '', not a whole number from 1 to 65536" height=
	bad "metadata 'gaussians' is '-1', not a whole number from 0 to 2147483647" gaussians=-1
	bad "metadata 'gaussians' is '2147483648', not a whole number from 0 to 2147483647" gaussians=2147483648
}

@test "tensors that are missing or of another type or shape" {
	bad "tensor 'indptr' is missing" order="index dropped weight"
	bad "tensor 'index' is missing" order="indptr dropped weight"
	bad "tensor 'dropped' is missing" order="indptr index weight"
	bad "tensor 'weight' is missing" order="indptr index dropped"
	bad "tensor 'indptr': is I64[3], expected I64[5]" height=2
	bad "tensor 'indptr': is F64[3], expected I64[3]" indptr_type=F64
	bad "tensor 'index': is F32[3], expected I32[*]" index_type=F32
	bad "tensor 'dropped': is F32[1], expected F32[2]" dropped=$f0 dropped_shape='[1]'
	bad "tensor 'weight': is F32[2], expected F32[3]" weight=$f0$f0 weight_shape='[2]'
	bad "tensor 'weight': is F16[2], expected F16[3]" weight=00000000 weight_shape='[2]' weight_type=F16
	bad "tensor 'weight': is U8[2], expected U8[3]" weight=0000 weight_shape='[2]' weight_type=U8
	bad "tensor 'weight': is I32[3], expected F32[3]" weight_type=I32
}

@test "the ends of the range are fine: -0, 1, the last Gaussian, no Gaussian" {
	weights w weight=00000080$f1$f0 dropped=${f1}00000080 index=$(i32 4 0 4)
	says 0 "w: ok: refer.weights, f32, 2x1, 3 weights, 5 gaussians of the scene" "$BIN/gs-check" w
	bad "tensor 'index': entry 0 is 4, not in 0 to 3" gaussians=4
	bad "tensor 'index': entry 0 is 4, not in 0 to -1" gaussians=0
	weights w gaussians=0 index= weight= index_shape='[0]' weight_shape='[0]' indptr=$(i64 0 0 0)
	says 0 "w: ok: refer.weights, f32, 2x1, 0 weights, 0 gaussians of the scene" "$BIN/gs-check" w
}

@test "rows that do not tile the weights" {
	bad "tensor 'indptr': begins with 1, not 0" indptr=$(i64 1 2 3)
	bad "tensor 'indptr': begins with -1, not 0" indptr=$(i64 -1 2 3)
	bad "tensor 'indptr': falls after pixel 0" indptr=$(i64 0 -1 3)
	bad "tensor 'indptr': falls after pixel 1" indptr=$(i64 0 4 3)
	bad "tensor 'indptr': ends with 2, but there are 3 weights" indptr=$(i64 0 2 2)
	bad "tensor 'indptr': ends with 9, but there are 3 weights" indptr=$(i64 0 2 9)
}

@test "values out of range" {
	bad "tensor 'index': entry 1 is 5, not in 0 to 4" index=$(i32 4 5 0)
	bad "tensor 'index': entry 2 is -1, not in 0 to 4" index=$(i32 4 0 -1)
	bad "tensor 'weight': entry 0 is -1, not in 0 to 1" weight=$fminus$f0$f0
	bad "tensor 'weight': entry 2 is nan, not in 0 to 1" weight=$f0$f0$fnan
	bad "tensor 'weight': entry 1 is inf, not in 0 to 1" weight=$f0$finf$f0
	bad "tensor 'weight': entry 1 is 2, not in 0 to 1" weight=003800400038 weight_type=F16
	bad "tensor 'weight': entry 1 is nan, not in 0 to 1" weight=0038007e0038 weight_type=F16
	bad "tensor 'weight': entry 2 is -inf, not in 0 to 1" weight=0038003800fc weight_type=F16
	bad "tensor 'weight': entry 0 is 1, not in 0 to 1" weight=0100803f$f0$f0 # one step above 1
	bad "tensor 'dropped': pixel 1 has nan, not in 0 to 1" dropped=$f0$fnan
	bad "tensor 'dropped': pixel 0 has -1, not in 0 to 1" dropped=$fminus$f0
}

@test "a file cut short anywhere is refused" {
	weights w
	local size length
	size=$(wc -c <w)
	for ((length = size - 1; length > 0; length -= length > size - 60 ? 1 : 37)); do
		head -c "$length" w >cut
		run "$BIN/gs-check" cut
		[ "$status" = 1 ] || { echo "length $length: $output"; return 1; }
	done
}

@test "a changed bit is found by the checksum" {
	scene scene
	"$BIN/gs-weigh" -o out scene
	size=$(wc -c <out/v1.safetensors)
	printf '\x3e' | dd of=out/v1.safetensors bs=1 seek=$((size - 2)) conv=notrunc status=none
	run "$BIN/gs-check" out/v1.safetensors
	[ "$status" = 1 ]
	[[ $output == "out/v1.safetensors: tensor 'weight': crc32 is "*", the header says "* ]]
}

@test "packed: tensors that are missing or of another type, and sizes that cannot be" {
	mkdir made
	scene made
	"$BIN/gs-weigh" -q --packed -o w made
	file=$(ls w/*.safetensors)
	"$BIN/gs-check" "$file" | grep -q ': ok: refer.weights, packed, '
	# the header with one thing changed, of the same length, without the checksums of data, which stay
	for change in 's/"levels":/"levelx":/;tensor .levels. is missing' 's/"sizes":{"dtype":"I64"/"sizes":{"dtype":"F64"/;tensor .sizes.: is F64' \
		's/"version":"3"/"version":"4"/;version 4 is newer than this program reads' \
		's/"version":"3"/"version":"2"/;packed, version 2 is older than this program reads' 's/"ids":{"dtype":"U8"/"ids":{"dtype":"I8"/;tensor .ids.: is I8'; do
		sed "${change%%;*}" "$file" >broken
		run "$BIN/gs-check" broken
		[ "$status" = 1 ]
		grep -qE "${change#*;}" <<<"$output" || { echo "$output"; false; }
	done
}
