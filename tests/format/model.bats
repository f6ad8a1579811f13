#!/usr/bin/env bats
# formats/scene/model.md: what a model of a scene holds. Rules of every safetensors file are in safetensors.bats.

setup() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	load files
	cd "$BATS_TEST_TMPDIR"
}

# model FILE [NAME=VALUE]...: the smallest model, without interaction, of one of three Gaussians and texts of one column; all
# numbers are 0. VALUE replaces a metadata value (an empty one leaves it out) or, with dots written _, a tensor's shape
# (text_0_weight='[512,2]'), its type (_type) or one item's bytes (_item=3:0000c07f). without=NAME leaves a tensor out.
# Without precision=, a file of version 1.
model() {
	local file=$1 assignment at=0 name shape type width bytes key items header= sep= patches=() without=
	local interaction=none similarity=dot query= blend= gaussians=3 bounds='[[-1,-1,-1],[1,1,1]]' precision= root= version=1
	local -A shapes=([ids]='[1]' [features]='[1,16]' [text_0_weight]='[512,1]' [text_0_bias]='[512]'
		[text_1_weight]='[256,512]' [text_1_bias]='[256]' [text_2_weight]='[128,256]' [text_2_bias]='[128]'
		[feature_0_weight]='[32,16]' [feature_0_bias]='[32]' [feature_1_weight]='[64,32]' [feature_1_bias]='[64]'
		[feature_2_weight]='[128,64]' [feature_2_bias]='[128]') types=([ids]=I32 [leaves]=I64) patch=()
	shift
	for assignment; do [[ $assignment != precision=* ]] || precision=${assignment#*=}; done
	[ -z "$precision" ] || version=2
	for name in features "${!shapes[@]}"; do
		[[ $name == features || $name == *_weight ]] || continue
		case $precision in
		u8)
			types[$name]=U8
			shape=${shapes[$name]#[}
			[ $name = features ] && shape='[1,16]' || shape="[${shape%,*},1]"
			shapes[${name}_low]=$shape
			shapes[${name}_step]=$shape
			;;
		f16) types[$name]=F16 ;;
		esac
	done
	for assignment; do
		key=${assignment%%=*}
		case $key in
		*_type) types[${key%_type}]=${assignment#*=} ;;
		*_item) patch[${key%_item}]=${assignment#*=} ;;
		interaction | similarity | query | blend | gaussians | bounds | precision | root | without) local "$key=${assignment#*=}" ;;
		*) shapes[$key]=${assignment#*=} ;;
		esac
	done
	for width in 8 4 2 1; do
		for name in "${!shapes[@]}"; do
			[ "$name" != "$without" ] || continue
			type=${types[$name]:-F32}
			case $type in U8) bytes=1 ;; F16) bytes=2 ;; I64 | F64) bytes=8 ;; *) bytes=4 ;; esac
			[ $width = $bytes ] || continue
			shape=${shapes[$name]}
			items=$((1${shape//[\[\],]/*}1))
			[ -z "${patch[$name]:-}" ] || patches+=("$((at + width * ${patch[$name]%%:*})):${patch[$name]#*:}")
			header+=",\"${name//_/.}\":{\"dtype\":\"$type\",\"shape\":$shape,\"data_offsets\":[$at,$((at + width * items))]}"
			at=$((at + width * items))
		done
	done
	for name in interaction similarity query blend gaussians bounds precision root; do
		[ -z "${!name}" ] || sep+=",\"$name\":\"${!name}\""
	done
	header="{\"__metadata__\":{\"format\":\"refer.model\",\"version\":\"$version\"$sep}$header}"
	while (((8 + ${#header}) % 64)); do header+=' '; done
	st "$file" "$header"
	truncate -s +$at "$file"
	for assignment in "${patches[@]}"; do
		printf '%s' "${assignment#*:}" | xxd -r -p |
			dd of="$file" bs=1 seek=$((8 + ${#header} + ${assignment%%:*})) conv=notrunc status=none
	done
}

# bad REASON [NAME=VALUE]...: the model with those changes is refused.
bad() {
	local reason=$1
	shift
	model m "$@"
	says 1 "m: $reason" "$BIN/gs-check" m
}

@test "a model made by hand is fine" {
	model m
	says 0 "m: ok: refer.model, f32, 1 features, 16 columns, 3 gaussians of the scene, 176224 parameters" "$BIN/gs-check" m
	model m ids='[2]' features='[2,16]' ids_item=1:02000000 similarity=cosine interaction=attention
	says 0 "m: ok: refer.model, f32, 2 features, 16 columns, 3 gaussians of the scene, 176224 parameters" "$BIN/gs-check" m
}

@test "numbers of version 2 are f32, f16 or u8" {
	for precision in f32 f16 u8; do
		model m precision=$precision
		says 0 "m: ok: refer.model, $precision, 1 features, 16 columns, 3 gaussians of the scene, 176224 parameters" "$BIN/gs-check" m
		[ "$("$BIN/gs-check" --json m | jq -r .precision)" = $precision ]
	done
	bad "metadata 'precision' is 'u4'" precision=u4
	bad "tensor 'text.0.weight': is U8[512,1], expected F16[512,*]" precision=f16 text_0_weight_type=U8
	bad "tensor 'features': is F32[1,16], expected U8[1,16]" precision=u8 features_type=F32
	bad "tensor 'feature.0.weight': is U8[32,16], expected F32[32,*]" feature_0_weight_type=U8
	bad "tensor 'feature.0.weight': is F32[32,16], expected F16[32,*]" precision=f16 feature_0_weight_type=F32
	bad "tensor 'text.0.bias': is F16[512], expected F32[512]" precision=f16 text_0_bias_type=F16
}

@test "low and step of u8" {
	bad "tensor 'features.low' is missing" precision=u8 without=features_low
	bad "tensor 'features.step' is missing" precision=u8 without=features_step
	bad "tensor 'text.1.weight.step' is missing" precision=u8 without=text_1_weight_step
	bad "tensor 'features.low': is F32[16,1], expected F32[1,16]" precision=u8 features_low='[16,1]'
	bad "tensor 'text.1.weight.low': is F32[1,512], expected F32[256,1]" precision=u8 text_1_weight_low='[1,512]'
	bad "tensor 'features.step': item 3 is not finite" precision=u8 features_step_item=3:$finf
	bad "tensor 'text.1.weight.low': item 255 is not finite" precision=u8 text_1_weight_low_item=255:$fnan
	# 2^127 and 255 times that
	bad "tensor 'feature.0.weight': item 17 is not finite" precision=u8 feature_0_weight_step_item=1:0000007f \
		feature_0_weight_item=17:ff
	bad "tensor 'features': item 2 is not finite" precision=f16 features_item=2:007c
}

# leaves ITEM... -- ARGUMENT...: a model of cubes, whose location codes are ITEM (one byte each, in hexadecimal).
leaves() {
	local -a codes=() args=()
	while [ "$1" != -- ]; do
		codes+=("$1")
		shift
	done
	shift
	model m without=ids leaves="[${#codes[@]}]" features="[${#codes[@]},16]" root='[[-1,0,2.5],4]' "$@"
	local at=$((8 + $(od -An -t u8 -N 8 m)))
	for code in "${codes[@]}"; do
		printf %s "$code" | xxd -r -p | dd of=m bs=1 seek=$at conv=notrunc status=none
		at=$((at + 8))
	done
}

@test "cubes that share a row" {
	leaves 01 --
	says 0 "m: ok: refer.model, f32, 1 features, 16 columns, 3 gaussians of the scene, 176224 parameters" "$BIN/gs-check" m
	leaves 08 09 0f --
	says 0 "m: ok: refer.model, f32, 3 features, 16 columns, 3 gaussians of the scene, 176224 parameters" "$BIN/gs-check" m
	leaves 40 09 0f --
	says 0 "m: ok: refer.model, f32, 3 features, 16 columns, 3 gaussians of the scene, 176224 parameters" "$BIN/gs-check" m
	leaves -- gaussians=0
	says 0 "m: ok: refer.model, f32, 0 features, 16 columns, 0 gaussians of the scene, 176224 parameters" "$BIN/gs-check" m
	local reason="is not a leaf after the one before"
	leaves 00 --
	says 1 "m: tensor 'leaves': item 0 $reason" "$BIN/gs-check" m
	leaves 08 02 --
	says 1 "m: tensor 'leaves': item 1 $reason" "$BIN/gs-check" m
	leaves 09 08 --
	says 1 "m: tensor 'leaves': item 1 $reason" "$BIN/gs-check" m
	leaves 08 41 --
	says 1 "m: tensor 'leaves': item 1 $reason" "$BIN/gs-check" m
	leaves 01 -- "learning=[1]" learning_type=U8 learning_item=0:05
	says 0 "m: ok: refer.model, f32, 1 features, 16 columns, 3 gaussians of the scene, 176224 parameters" "$BIN/gs-check" m
	leaves 01 -- "learning=[1]" learning_type=U8 learning_item=0:0d
	says 1 "m: tensor 'learning': bit 3 is set, of 3 Gaussians" "$BIN/gs-check" m
	leaves 01 -- "learning=[2]" learning_type=U8
	says 1 "m: tensor 'learning': is U8[2], expected U8[1]" "$BIN/gs-check" m
	leaves 01 -- leaves_type=F64
	says 1 "m: tensor 'leaves': is F64[1], expected I64[*]" "$BIN/gs-check" m
	leaves 01 -- features='[2,16]'
	says 1 "m: tensor 'features': is F32[2,16], expected F32[1,16]" "$BIN/gs-check" m
	for root in '' '[[1,2,3]]' '[[1,2,3],4]]' '[[1,2,x],4]'; do
		leaves 01 -- "root=$root"
		says 1 "m: metadata 'root' is not a corner and an edge" "$BIN/gs-check" m
	done
	for root in '[[1,2,3],0]' '[[1,2,3],-1]' '[[nan,2,3],1]' '[[1,2,3],inf]'; do
		leaves 01 -- "root=$root"
		says 1 "m: metadata 'root' is not finite with an edge above 0" "$BIN/gs-check" m
	done
}

@test "it may be of no Gaussian, and then answers nothing" {
	model m ids='[0]' features='[0,16]' gaussians=1 interaction=none
	says 0 "m: ok: refer.model, f32, 0 features, 16 columns, 1 gaussians of the scene, 176224 parameters" "$BIN/gs-check" m
	scene scene
	header='{"__metadata__":{"format":"refer.text","version":"1","refs":"[\"r1\"]","objects":"[\"cup\"]","texts":"[\"cup\"]","splits":"[\"test\"]"},"offsets":{"dtype":"I64","shape":[2],"data_offsets":[0,16]},"words":{"dtype":"F32","shape":[1,1],"data_offsets":[16,20]},"sentences":{"dtype":"F32","shape":[1,1],"data_offsets":[20,24]}}'
	while (((8 + ${#header}) % 8)); do header+=' '; done
	st text "$header" "00000000000000000100000000000000$f1$f1"
	says 0 '{"view":"v1","ref":"r1","object":"cup","score":0,"segmentation":{"size":[3,4],"counts":"<"}}' \
		"$BIN/refer-render" --scene scene --text text --model m --split train
}

@test "a feature has 1 to 32 numbers" {
	for width in 1 4 5 32; do
		model m feature_0_weight="[32,$width]" features="[1,$width]"
		says 0 "m: ok: refer.model, f32, 1 features, $width columns, 3 gaussians of the scene, $((175712 + 32 * width)) parameters" \
			"$BIN/gs-check" m
		model m precision=u8 feature_0_weight="[32,$width]" features="[1,$width]" features_low="[1,$width]" features_step="[1,$width]"
		[ "$("$BIN/gs-check" --json m | jq -c '[.precision, .columns]')" = "[\"u8\",$width]" ]
	done
	bad "tensor 'feature.0.weight': 0 columns, expected 1 to 32" feature_0_weight='[32,0]' features='[1,0]'
	bad "tensor 'feature.0.weight': 33 columns, expected 1 to 32" feature_0_weight='[32,33]' features='[1,33]'
	bad "tensor 'feature.0.weight': is F32[31,16], expected F32[32,*]" feature_0_weight='[31,16]'
	bad "tensor 'feature.0.weight': is F32[512], expected F32[32,*]" feature_0_weight='[512]'
	bad "tensor 'features': is F32[1,16], expected F32[1,5]" feature_0_weight='[32,5]'
	bad "tensor 'features': is F32[5], expected F32[1,5]" feature_0_weight='[32,5]' features='[5]'
	bad "tensor 'features.low': is F32[1,16], expected F32[1,5]" precision=u8 feature_0_weight='[32,5]' features='[1,5]'
	bad "tensor 'features': item 4 is not finite" feature_0_weight='[32,5]' features='[1,5]' features_item=4:$fnan
}

@test "how it answers" {
	bad "metadata 'interaction' is 'all'" interaction=all
	bad "metadata 'interaction' is ''" interaction=
	bad "metadata 'similarity' is 'dots'" similarity=dots
	bad "metadata 'similarity' is ''" similarity=
	bad "metadata 'query' is 'parse'" query=parse
	bad "metadata 'blend' is 'share'" blend=share
}

@test "the scene's Gaussians" {
	bad "metadata 'gaussians' is '', not a whole number from 0 to 2147483647" gaussians=
	bad "metadata 'gaussians' is '-1', not a whole number from 0 to 2147483647" gaussians=-1
	bad "metadata 'gaussians' is '3x', not a whole number from 0 to 2147483647" gaussians=3x
	bad "metadata 'gaussians' is ' 3', not a whole number from 0 to 2147483647" gaussians=' 3'
	bad "metadata 'gaussians' is '2147483648', not a whole number from 0 to 2147483647" gaussians=2147483648
}

@test "bounds" {
	for bounds in '' '[]' '[[-1,-1,-1],[1,1]]' '[[-1,-1,-1],[1,1,1]' '[[-1,-1,-1],[1,1,1]]]' '[[-1,-1,x],[1,1,1]]'; do
		bad "metadata 'bounds' is not two corners" bounds="$bounds"
	done
	for bounds in '[[-1,1,-1],[1,1,1]]' '[[-1,-1,-1],[1,1,-2]]' '[[nan,-1,-1],[1,1,1]]' '[[-1,-1,-1],[1,inf,1]]'; do
		bad "metadata 'bounds' is not low < high" bounds="$bounds"
	done
}

@test "tensors that are missing or of another type or shape" {
	bad "tensor 'ids' is missing" without=ids
	bad "tensor 'features' is missing" without=features
	bad "tensor 'text.0.weight' is missing" without=text_0_weight
	bad "tensor 'feature.2.bias' is missing" without=feature_2_bias
	bad "tensor 'position.0.weight' is missing" interaction=pcmi
	bad "tensor 'ids': is F32[1], expected I32[*]" ids_type=F32
	bad "tensor 'features': is F32[2,16], expected F32[1,16]" features='[2,16]'
	bad "tensor 'features': is F32[1,8], expected F32[1,16]" features='[1,8]'
	bad "tensor 'text.0.weight': is F32[256,1], expected F32[512,*]" text_0_weight='[256,1]'
	bad "tensor 'text.0.weight': 0 columns, expected 1 to 65536" text_0_weight='[512,0]'
	bad "tensor 'text.0.weight': 65537 columns, expected 1 to 65536" text_0_weight='[512,65537]'
	bad "tensor 'text.0.bias': is F32[512,1], expected F32[512]" text_0_bias='[512,1]'
	bad "tensor 'text.1.weight': is I32[256,512], expected F32[256,512]" text_1_weight_type=I32
	bad "tensor 'feature.1.weight': is F32[32,64], expected F32[64,32]" feature_1_weight='[32,64]'
}

@test "values" {
	bad "tensor 'ids': item 0 does not rise within 0 to 2" ids_item=0:03000000
	bad "tensor 'ids': item 0 does not rise within 0 to 2" ids_item=0:ffffffff
	bad "tensor 'ids': item 1 does not rise within 0 to 2" ids='[2]' features='[2,16]'
	bad "tensor 'features': item 15 is not finite" features_item=15:$fnan
	bad "tensor 'text.1.weight': item 131071 is not finite" text_1_weight_item=131071:$finf
	bad "tensor 'feature.2.bias': item 0 is not finite" feature_2_bias_item=0:000080ff
}

@test "a file cut short anywhere is refused" {
	model m
	size=$(wc -c <m)
	for length in $((size - 1)) $((size - 4)) $((size / 2)) 4000 2000 1000 100 9 8 7 1; do
		head -c "$length" m >cut
		run "$BIN/gs-check" cut
		[ "$status" = 1 ] || { echo "length $length: $output"; return 1; }
	done
}

@test "a changed bit is found by the checksum" {
	"$BATS_TEST_DIRNAME/../cli/examples-setup.sh" made "$BIN"
	cd made
	size=$(wc -c <model.safetensors)
	printf '\x3e' | dd of=model.safetensors bs=1 seek=$((size - 2)) conv=notrunc status=none
	run "$BIN/gs-check" model.safetensors
	[ "$status" = 1 ]
	[[ $output == "model.safetensors: tensor '"*"': crc32 is "*", the header says "* ]]
}
