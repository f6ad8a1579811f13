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
golden=$here/tests/golden

# The path of a file as a seed's name.
name() { echo "${1#"$golden"/}" | tr / _; }

# Without checksums, which would hide what comes after them.
plain() { LC_ALL=C sed 's/"crc32\./"crc33./g' "$1"; }

# seed TARGET FILE...: those that are not larger than 1 MB.
seed() {
	local target=$1 file
	shift
	mkdir -p "$dir/$target"
	for file; do
		[ -f "$file" ] && [ "$(wc -c <"$file")" -le 1000000 ] || continue
		plain "$file" >"$dir/$target/$(name "$file")"
	done
}

# A number as four bytes, the lowest first.
number() {
	local i
	for i in 0 8 16 24; do printf "\\$(printf %03o $(($1 >> i & 255)))"; done
}

# folder TARGET FILE...: the files in one, behind the lengths of all but the last.
folder() {
	local target=$1 file
	shift
	mkdir -p "$dir/$target"
	{
		for file in "${@:1:$#-1}"; do number "$(wc -c <"$file")"; done
		for file; do plain "$file"; done
	} >"$dir/$target/$(name "$1")"
}

# cut_short FILE KEEP: sets zeros to how many of the last bytes of a safetensors are left out of FILE.cut, which has KEEP bytes of data.
cut_short() {
	local keep=$(($(od -An -t u8 -N 8 "$1") + 8 + $2)) length
	length=$(wc -c <"$1")
	[ "$keep" -lt "$length" ] || keep=$length
	zeros=$((length - keep))
	head -c "$keep" "$1" >"$1.cut"
}

# seed_cut TARGET KEEP FILE: the file with zeros in place of all but KEEP bytes of data; folder_cut TARGET KEEP FIRST FILE: after another.
seed_cut() {
	cut_short "$3" "$2"
	mkdir -p "$dir/$1"
	{ number "$zeros"; plain "$3.cut"; } >"$dir/$1/${3##*/}"
}
folder_cut() {
	cut_short "$4" "$2"
	mkdir -p "$dir/$1"
	{ number "$zeros"; number "$(wc -c <"$3")"; cat "$3"; plain "$4.cut"; } >"$dir/$1/${4##*/}"
}

first() { head -n "$1" "$2" >"$3"; }
gs-synth -q --objects 2 --views 2 --size 24x16 --gaussians 1000 -o small
gs-import -q --cameras small/sparse/0 -o small/scene small/point_cloud.ply
# 40 of its Gaussians
{
	sed '/^end_header/q; s/^element vertex .*/element vertex 40/' small/point_cloud.ply
	tail -c 104000 small/point_cloud.ply | head -c 4160
} >few.ply
gs-import -q --cameras small/sparse/0 --images small/images -o few few.ply
gs-weigh -q --split all --scale 0.25 -o few/weights few
gs-weigh -q --split all --scale 0.25 --packed --tolerance 0.02 -o few/packed few
gs-weigh -q --split all --scale 0.25 --precision f16 -o few/f16 few
first 3 sentences.jsonl some.jsonl
first 3 masks.jsonl some-masks.jsonl
first 3 boxes.jsonl some-boxes.jsonl
text-encode -q --model encoder -o some.safetensors some.jsonl
refer-lift -q --scene scene --weights weights --text some.safetensors --masks masks.jsonl -o some-lifted.safetensors
gs-weigh -q --split all -o few/whole few
pseudomask-select -q -o few-masks.jsonl small/candidates.jsonl
first 4 small/sentences.jsonl few.jsonl
text-encode -q --model encoder -o few-text.safetensors few.jsonl
feature-lift -q --scene few --weights few/whole --masks few-masks.jsonl --text few-text.safetensors -o some-features.safetensors
feature-lift -q --scene few --weights few/whole --masks few-masks.jsonl -o some-labels.safetensors
refer-lift -q --scene few --weights few/whole --text few-text.safetensors --masks few-masks.jsonl -o few-lifted.safetensors
feature-query -q --text few-text.safetensors -o some-selection.safetensors some-features.safetensors
refer-train -q --scene scene --weights weights --text some.safetensors --masks masks.jsonl --iterations 1 -o some-model.safetensors
refer-locate -q --scene scene --text some.safetensors --model some-lifted.safetensors --ply shown.ply -o located.jsonl --refs "$(head -n 1 some.jsonl | jq -r .ref)"
refer-render -q --scene scene --text some.safetensors --model some-lifted.safetensors --size 8x6 --response response --response-type npy \
	--overlay overlay --png png --split all -o /dev/null
printf '{"images":[{"id":1,"file_name":"a.png","width":8,"height":6}],"categories":[{"id":1,"name":"cup"}],"annotations":[{"image_id":1,"category_id":1,"segmentation":[[1,1,5,1,5,4]]},{"image_id":1,"category_id":1,"segmentation":{"size":[6,8],"counts":[3,4,41]}}]}' >coco.json
printf '{"info":{"name":"a.png","width":8,"height":6},"objects":[{"category":"cup","group":1,"layer":1,"segmentation":[[1,1],[5,1],[5,4]]}]}' >isat.json
printf '{"image_path":"a.png","img_width":8,"img_height":6,"annotations":[{"class_name":"cup","score":[0.5],"ref":"r1","segmentation":{"size":[6,8],"counts":"3441"}},{"class_name":"pan","score":0.25,"segmentation":[[1,1,5,1,5,4]]}]}' >grounded.json
printf '{"imagePath":"a.png","imageHeight":6,"imageWidth":8,"shapes":[{"label":"cup","shape_type":"rectangle","points":[[1,1],[4,3]]},{"label":"pan","shape_type":"circle","points":[[4,3],[6,3]]}]}' >shapes.json
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

seed annotations labels.json coco.json isat.json ref-lerf.json grounded.json shapes.json
folder_cut bert 64 encoder/config.json encoder/model.safetensors
seed boxes some-boxes.jsonl located.jsonl
printf '{"view":"v","class":"cup","score":0.5,"size":[6,8],"box":[1,2,3,4]}\n' >detections.jsonl
seed detections detections.jsonl
seed camerafile cameras3dgs.json transforms.json lens.json rational.json fisheye.json
seed cameras small/scene/cameras.json lenses.json
REFERSPLAT_FUZZ_SEED=$work/checkpoint "$writer"
seed checkpoint checkpoint
folder colmap-text small/sparse/0/cameras.txt small/sparse/0/images.txt
printf '\1\0\0\0\0\0\0\0\1\0\0\0\1\0\0\0\4\0\0\0\0\0\0\0\3\0\0\0\0\0\0\0\0\0\0\0\0\0\24\100\0\0\0\0\0\0\24\100\0\0\0\0\0\0\0\100\0\0\0\0\0\0\370\77' >cameras.bin
{ printf '\1\0\0\0\0\0\0\0\1\0\0\0\0\0\0\0\0\0\360\77'; head -c 48 /dev/zero; printf '\1\0\0\0a.png\0'; head -c 8 /dev/zero; } >images.bin
folder colmap-binary cameras.bin images.bin
{ printf '\2\0\0\0\0\0\0\0'; head -c 43 /dev/zero; printf '\1\0\0\0\0\0\0\0'; head -c 67 /dev/zero; } >points3D.bin
printf '# points\n1 0.5 1 2 9 9 9 0.5 1 2\n' >points3D.txt
printf 'ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n1 2 3\n' >points3D.ply
folder points points3D.bin points3D.txt points3D.ply
cp -r "$golden/clip" "$golden/open-clip" .
folder_cut clip 64 clip/config.json clip/model.safetensors
folder_cut clip-open 64 open-clip/open_clip_config.json open-clip/open_clip_model.safetensors
folder merges-text clip/vocab.json clip/merges.txt
seed merges-gzip open-clip/bpe_simple_vocab_16e6.txt.gz
jq -Rs --slurpfile vocab clip/vocab.json '{normalizer: {type: "Sequence", normalizers: [{type: "NFC"}, {type: "Lowercase"}]},
	model: {type: "BPE", end_of_word_suffix: "</w>", vocab: $vocab[0], merges: (split("\n")[1:-1] | .[0] |= split(" "))}}' clip/merges.txt >merges.json
seed merges-json merges.json
seed dataparser dataparser.json
seed features some-features.safetensors some-labels.safetensors
refer-render -q --scene few --text few-text.safetensors --model few-lifted.safetensors --png few-png --split all -o /dev/null
refer-render -q --scene few --text few-text.safetensors --model few-lifted.safetensors --response grey --split all -o /dev/null
# Four colours of a palette; a grey JPEG.
printf '\211PNG\015\012\032\012\000\000\000\015IHDR\000\000\000\004\000\000\000\002\002\003\000\000\000\002\306\225\360\000\000\000\014PLTE\000\001\002\003\004\005\006\007\010\011\012\013\334L\070\234\000\000\000\014IDATx\234c\220fx\002\000\001\071\001\000Ed\221\233\000\000\000\000IEND\256B\140\202' >palette.png
printf '\377\330\377\333\000C\000\010\006\006\007\006\005\010\007\007\007\011\011\010\012\014\024\015\014\013\013\014\031\022\023\017\024\035\032\037\036\035\032\034\034\040\044\056\047\040\042\054\043\034\034\050\067\051\054\060\061\064\064\064\037\047\071\075\070\062\074\056\063\064\062\377\300\000\013\010\000\002\000\003\001\001\021\000\377\304\000\024\000\001\000\000\000\000\000\000\000\000\000\000\000\000\000\000\000\007\377\304\000\032\020\000\001\005\001\000\000\000\000\000\000\000\000\000\000\000\000\001\000\006\007\067t\261\377\332\000\010\001\001\000\000\077\000O\212\352\366\366A\322\277\377\331' >grey.jpg
seed image png/view_000/*.png overlay/view_000/*.png small/images/* few-png/*/*.png grey/*/*.png palette.png grey.jpg
seed lifted some-lifted.safetensors few-lifted.safetensors
pseudomask-propose -q --weights few/whole --regions regions.safetensors -o /dev/null few
seed regions regions.safetensors
rm -rf "$dir.run"
cp -r kitchen "$dir.run"
cp -r weights encoder "$dir.run"
pseudomask-propose -q --weights weights --regions "$dir.run/regions.safetensors" -o /dev/null scene
mkdir requests
box=$(jq -r '.object' sentences.jsonl | head -n 1)
(
	cd requests
	printf '{"do":"ask","question":"where is the %s?","from":"view_001","conversation":"a"}' "$box" >ask
	printf '{"do":"ask","question":"how many things are left of it?","from":[1,2,3],"conversation":"a"}' >again
	printf '{"do":"pick","view":"view_001","x":30,"y":20}' >pick
	printf '{"do":"pick","view":"view_001","box":[10,10,40,30]}' >box
	printf '{"do":"pick","origin":[0,-3,1],"direction":[0,1,-0.1]}' >ray
	printf '{"do":"label","points":[{"view":"view_001","x":30,"y":20}],"outside":[{"view":"view_002","x":1,"y":1}],"size":-1,"views":["view_001","view_002"]}' >label
	printf '{"do":"label","outline":{"view":"view_001","points":[[1,1],[20,1],[20,20.5]]}}' >outline
	printf '{"do":"label","box":{"view":"view_001","box":[1,1,20,20]},"name":"cup","rename":"mug","remove":"pan"}' >name
	printf '{"do":"mask","view":"view_001","thing":["%s"]}' "$box" >mask
	printf '{"do":"view","name":"view_001"}' >view
	printf '{"do":"things"}' >things
)
seed requests requests/*
seed masks some-masks.jsonl
seed_cut model 800 some-model.safetensors
gs-transform -q -o few.glb few.ply
seed glb few.glb "$golden/glb/eight.glb"
seed npy response/view_000/*.npy
seed npz "$golden"/npz/*.npz
cp "$here/formats/encoders/parser_default.safetensors" parser.safetensors
seed_cut parser 64 parser.safetensors
seed ply few.ply packed.ply
seed safetensors few-lifted.safetensors few/weights/view_000.safetensors "$golden/good/small.safetensors"
folder scene few/cameras.json few/splats.safetensors
mkdir -p frames && cp few.ply frames/1.ply && gs-transform -q --translate 0.1,0,0 -o frames/2.ply few.ply
gs-import -q --cameras small/sparse/0 -o moves frames
seed motion moves/motion.safetensors
seed selection some-selection.safetensors
seed sentences some.jsonl
# Its tables are shorter with rounded numbers.
mkdir sog
cp "$golden"/sog/*.webp sog
jq -c '(.. | .codebook? // empty) |= map(. * 4 | round / 4)' "$golden/sog/meta.json" >sog/meta.json
folder sog sog/meta.json sog/means_l.webp sog/means_u.webp sog/quats.webp sog/scales.webp sog/sh0.webp sog/shN_centroids.webp sog/shN_labels.webp
gs-transform -q -o few.sog few.ply
gs-transform -q -o few.splat few.ply
seed sog-zip few.sog
seed splat few.splat
seed splats few/splats.safetensors
for version in 2 3 4; do
	gs-transform -q --spz-version $version -o few$version.spz few.ply
done
seed spz few2.spz few3.spz few4.spz
seed text few-text.safetensors
seed vocab-json encoder/tokenizer.json
: >empty
folder vocab-text encoder/vocab.txt empty
seed weights few/weights/view_000.safetensors few/packed/view_000.safetensors few/f16/view_000.safetensors
for target in lifted features selection masks boxes sentences text weights splats motion ply image npy cameras; do
	mkdir -p "$dir/check" && for file in "$dir/$target"/*; do cp "$file" "$dir/check/$target-${file##*/}"; done
done

cd "$here/formats"
for target in "$dir"/*/; do
	target=$(basename "$target")
	case ${target%-*} in
	image) set -- png.c jpeg.c ;;
	camerafile) set -- camerafile.c transforms.c ;;
	cameras | splats | scene) set -- scene.c ;;
	bert) set -- bert_model.c pretrained.c ;;
	clip) set -- clip_model.c pretrained.c ;;
	merges) set -- merges.c vocab.c ;;
	npz) set -- npz.c npy.c ;;
	parser) set -- parser_weights.c ;;
	points) set -- colmap.c ;;
	regions) set -- proposed.c ;;
	ply) set -- ply.c plyfile.c plypacked.c ;;
	glb) set -- glb.c glb_container.c ;;
	colmap) set -- colmap.c colmap_text.c ;;
	sog) set -- sog.c archive.c ;;
	spz) set -- spz.c spz_container.c ;;
	check) set -- scene.c motion.c weights.c text.c lifted.c features.c selection.c masks.c boxes.c sentences.c ;;
	requests) set -- ../../cmd/serve/serve_ask.c ../../cmd/serve/serve_place.c ../../cmd/serve/serve_label.c ../../cmd/serve/serving.c ;;
	*) set -- "${target%-*}.c" ;;
	esac
	set -- "$@" safetensors.c json.c
	{
		grep -oh '"[A-Za-z_0-9.]\{2,24\}"' ${@/#/*\/} || true
		printf '%s\n' '"null"' '"true"' '"-1"' '"1e308"' '"99999999999999999999"' '"4294967296"' '"\xff\xff\xff\xff"' '"\x00\x00\x00\x80"' '"nan"' \
			'"[[[["' '"\x5cu0000"'
	} | sort -u >"$dir/$target.dict"
done
