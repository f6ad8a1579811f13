#!/usr/bin/env bash
# Seeds and dictionaries for the readers' fuzz targets, from small real files. usage: tests/fuzz/seeds.sh DIR BIN READER-CHECKPOINT
# DIR/NAME is made for each target that has seeds, and DIR/NAME.dict for each: the words that the reader's source has in quotes.
set -eu
here=$(cd "$(dirname "$0")/../.." && pwd)
bin=$(cd "$2" && pwd)
writer=$(cd "$(dirname "$3")" && pwd)/$(basename "$3")
mkdir -p "$1"
dir=$(cd "$1" && pwd)
PATH=$bin:$PATH
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export OMP_NUM_THREADS=1
"$here/tests/cli/examples-setup.sh" "$work" "$bin"
cd "$work"

# seed TARGET FILE...: the files without checksums, which would hide what comes after them, and not larger than 1 MB.
seed() {
	local target=$1 file
	shift
	mkdir -p "$dir/$target"
	for file; do
		[ -f "$file" ] && [ "$(wc -c <"$file")" -le 1000000 ] || continue
		LC_ALL=C sed 's/"crc32\./"crc33./g' "$file" >"$dir/$target/$(echo "$file" | tr / _)"
	done
}

# folder TARGET A B: the two files in one, behind the first one's length.
folder() {
	local length i
	mkdir -p "$dir/$1"
	length=$(wc -c <"$2")
	{
		for i in 0 8 16 24; do printf "\\$(printf %03o $((length >> i & 255)))"; done
		cat "$2" "$3"
	} >"$dir/$1/$(echo "$2" | tr / _)"
}

first() { head -n "$1" "$2" >"$3"; }
gs-synth -q --objects 2 --views 2 --size 24x16 --gaussians 1000 -o small
gs-import -q --cameras small/sparse/0 -o small/scene small/point_cloud.ply
gs-weigh -q --split all -o small/weights small/scene
gs-weigh -q --split all --packed --tolerance 0.02 -o small/packed small/scene
gs-weigh -q --split all --precision f16 -o small/f16 small/scene
# 40 of its Gaussians
{
	sed '/^end_header/q; s/^element vertex .*/element vertex 40/' small/point_cloud.ply
	tail -c 104000 small/point_cloud.ply | head -c 4160
} >few.ply
gs-import -q --cameras small/sparse/0 -o few few.ply
first 3 sentences.jsonl some.jsonl
first 3 masks.jsonl some-masks.jsonl
first 3 boxes.jsonl some-boxes.jsonl
text-encode -q --model encoder -o some.safetensors some.jsonl
text-parse -q -o some-parses.jsonl some.safetensors
parse-train -q --write 5 -o some-readings.jsonl
refer-lift -q --scene scene --weights weights --text some.safetensors --masks masks.jsonl -o some-lifted.safetensors
feature-lift -q --scene scene --weights weights --masks masks.jsonl --text some.safetensors -o some-features.safetensors
feature-lift -q --scene scene --weights weights --masks masks.jsonl -o some-labels.safetensors
feature-query -q --text some.safetensors -o some-selection.safetensors some-features.safetensors
refer-train -q --scene scene --weights weights --text some.safetensors --masks masks.jsonl --iterations 1 -o some-model.safetensors
refer-locate -q --scene scene --text some.safetensors --model some-lifted.safetensors --ply shown.ply -o located.jsonl --refs "$(head -n 1 some.jsonl | jq -r .ref)"
refer-render -q --scene scene --text some.safetensors --model some-lifted.safetensors --size 8x6 --response response --response-type npy \
	--overlay overlay --png png --split all -o /dev/null
printf '{"images":[{"id":1,"file_name":"a.png","width":8,"height":6}],"categories":[{"id":1,"name":"cup"}],"annotations":[{"image_id":1,"category_id":1,"segmentation":[[1,1,5,1,5,4]]},{"image_id":1,"category_id":1,"segmentation":{"size":[6,8],"counts":[3,4,41]}}]}' >coco.json
printf '{"info":{"name":"a.png","width":8,"height":6},"objects":[{"category":"cup","group":1,"layer":1,"segmentation":[[1,1],[5,1],[5,4]]}]}' >isat.json
printf '[{"id":0,"img_name":"a","width":4,"height":3,"position":[0,0,0],"rotation":[[1,0,0],[0,1,0],[0,0,1]],"fx":5,"fy":5}]' >cameras3dgs.json
printf '{"fl_x":5,"fl_y":5,"cx":2,"cy":1.5,"w":4,"h":3,"k1":0,"test_filenames":["a.png"],"frames":[{"file_path":"a.png","transform_matrix":[[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]}]}' >transforms.json
sed 's/"k1":0/"k1":0.1,"k2":-0.02,"p1":0.001/' transforms.json >lens.json
sed 's/"k1":0/"k1":0.1,"k4":0.01,"camera_model":"FULL_OPENCV"/' transforms.json >rational.json
sed 's/"k1":0/"k1":0.1,"is_fisheye":true/' transforms.json >fisheye.json
jq -c 'map(.lens = {model: "RADIAL", width: 24, height: 16, parameters: [20, 12, 8, 0.1, -0.01]})' small/scene/cameras.json >lenses.json
printf '{"info":{"name":"a.png","width":8,"height":6},"object":[{"category":"cup","segmentation":"a.png"}]}' >ref-lerf.json
printf '{"transform":[[1,0,0,0],[0,1,0,0],[0,0,1,0]],"scale":0.5}' >dataparser.json
{
	printf 'ply\nformat binary_little_endian 1.0\nelement chunk 1\n'
	for k in min_x min_y min_z max_x max_y max_z min_scale_x min_scale_y min_scale_z max_scale_x max_scale_y max_scale_z; do
		echo "property float $k"
	done
	printf 'element vertex 2\n'
	for k in position rotation scale color; do echo "property uint packed_$k"; done
	echo end_header
	head -c 24 /dev/zero; printf '\0\0\200\77\0\0\200\77\0\0\200\77'; head -c 12 /dev/zero
	printf '\1\2\3\4\1\2\3\200\1\2\3\4\1\2\3\4\5\6\7\10\5\6\7\10\5\6\7\10\5\6\7\10'
} >packed.ply

seed annotations labels.json coco.json isat.json ref-lerf.json
folder bert encoder/config.json encoder/model.safetensors
seed boxes some-boxes.jsonl located.jsonl
seed camerafile cameras3dgs.json transforms.json lens.json rational.json fisheye.json
seed cameras small/scene/cameras.json lenses.json
REFERSPLAT_FUZZ_SEED=$work/checkpoint "$writer"
seed checkpoint checkpoint
folder colmap-text small/sparse/0/cameras.txt small/sparse/0/images.txt
printf '\1\0\0\0\0\0\0\0\1\0\0\0\1\0\0\0\4\0\0\0\0\0\0\0\3\0\0\0\0\0\0\0\0\0\0\0\0\0\24\100\0\0\0\0\0\0\24\100\0\0\0\0\0\0\0\100\0\0\0\0\0\0\370\77' >cameras.bin
{ printf '\1\0\0\0\0\0\0\0\1\0\0\0\0\0\0\0\0\0\360\77'; head -c 48 /dev/zero; printf '\1\0\0\0a.png\0'; head -c 8 /dev/zero; } >images.bin
folder colmap-binary cameras.bin images.bin
golden=$here/tests/golden
cp -r "$golden/clip" "$golden/open-clip" .
folder clip clip/config.json clip/model.safetensors
folder clip-open open-clip/open_clip_config.json open-clip/open_clip_model.safetensors
folder merges-text clip/vocab.json clip/merges.txt
seed merges-gzip open-clip/bpe_simple_vocab_16e6.txt.gz
jq -Rs --slurpfile vocab clip/vocab.json '{normalizer: {type: "Sequence", normalizers: [{type: "NFC"}, {type: "Lowercase"}]},
	model: {type: "BPE", end_of_word_suffix: "</w>", vocab: $vocab[0], merges: (split("\n")[1:-1] | .[0] |= split(" "))}}' clip/merges.txt >merges.json
seed merges-json merges.json
seed dataparser dataparser.json
seed features some-features.safetensors some-labels.safetensors
seed image png/*/*.png overlay/*/*.* overlay/*.* small/images/*
seed lifted some-lifted.safetensors
seed masks some-masks.jsonl
seed model some-model.safetensors
gs-transform -q -o few.glb few.ply
seed glb few.glb "$here/tests/golden/glb/eight.glb"
seed npy response/*/*.npy response/*.npy
seed npz "$golden"/npz/*.npz
seed parser "$here/formats/parser_default.safetensors"
seed parses some-parses.jsonl
seed ply few.ply packed.ply
seed readings some-readings.jsonl
seed safetensors some.safetensors small/weights/view_000.safetensors "$here/tests/golden/good/small.safetensors"
seed selection some-selection.safetensors
seed sentences some.jsonl
seed splats few/splats.safetensors
for version in 2 3 4; do
	gs-transform -q --spz-version $version -o few$version.spz few.ply
done
seed spz few2.spz few3.spz few4.spz
seed text some.safetensors
seed vocab-json encoder/tokenizer.json
: >empty
folder vocab-text encoder/vocab.txt empty
seed weights small/weights/view_000.safetensors small/packed/view_000.safetensors small/f16/view_000.safetensors
for target in lifted features selection masks boxes sentences text weights splats ply image npy cameras; do
	mkdir -p "$dir/check" && for file in "$dir/$target"/*; do cp "$file" "$dir/check/$target-${file##*/}"; done
done

cd "$here/formats"
for target in "$dir"/*/; do
	target=$(basename "$target")
	case ${target%-*} in
	image) set -- png.c jpeg.c ;;
	camerafile) set -- camerafile.c cameras3dgs.c transforms.c ;;
	cameras | splats) set -- scene.c ;;
	bert) set -- bert_model.c pretrained.c ;;
	clip) set -- clip_model.c pretrained.c ;;
	merges) set -- merges.c vocab.c ;;
	npz) set -- npz.c npy.c ;;
	parser) set -- parser_weights.c ;;
	parses) set -- parses_read.c ;;
	ply) set -- ply.c plyfile.c plypacked.c ;;
	glb) set -- glb.c glb_container.c ;;
	spz) set -- spz.c spz_container.c ;;
	weights) set -- weights.c weights_pack.c ;;
	check) set -- scene.c weights.c text.c lifted.c features.c selection.c masks.c boxes.c sentences.c ;;
	*) set -- "${target%-*}.c" ;;
	esac
	{
		grep -oh '"[A-Za-z_0-9.]\{2,24\}"' "$@" safetensors.c json.c || true
		printf '%s\n' '"null"' '"true"' '"-1"' '"1e308"' '"99999999999999999999"' '"4294967296"' '"\xff\xff\xff\xff"' '"\x00\x00\x00\x80"' '"nan"' \
			'"[[[["' '"\x5cu0000"'
	} | sort -u >"$dir/$target.dict"
done
