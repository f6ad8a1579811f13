#!/usr/bin/env bash
# Makes the folder in which the EXAMPLES of the manual pages run. usage: examples-setup.sh DIR BIN
# It holds a small synthetic scene (formats/scene/synth.md) and what each tool makes of it, under the names that the manual pages
# use: scene, weights, text.safetensors, masks.jsonl, model.safetensors, pred.jsonl, whole.jsonl; kitchen, laid out as
# pipelines/lift.mk does; view_001.png, a painted photograph; new-camera.json, a camera of its own; labels.json; encoder, a tiny BERT, clip, a tiny CLIP, detector, weights that find the same in every picture, clip-features.safetensors, features of its width, and cache, which has encoder and detector where `make` would put them.
set -eu
mkdir -p "$1"
golden=$(cd "$(dirname "$0")/../golden" && pwd)
PATH=$(cd "$2" && pwd):$PATH
cd "$1"

cp -r "$golden/bert" encoder
cp -r "$golden/clip" clip
"$golden/../cli/detector.sh" detector
gs-synth -q --objects 3 --views 5 --size 64x48 --gaussians 1000 -o .
gs-import -q --images images --test-views "$(cat test-views)" -o scene point_cloud.ply
gs-weigh -q -o weights scene
text-encode -q --model encoder -o text.safetensors sentences.jsonl
text-encode -q --model clip -o clip-text.safetensors sentences.jsonl
feature-lift -q --scene scene --weights weights --masks candidates.jsonl --text clip-text.safetensors -o clip-features.safetensors
rm clip-text.safetensors
pseudomask-select -q -o masks.jsonl candidates.jsonl
refer-train -q --scene scene --weights weights --text text.safetensors --masks masks.jsonl --iterations 20 \
	-o model.safetensors
mkdir -p kitchen/lifted cache/refersplat
cp -r scene kitchen/scene
cp text.safetensors kitchen/text.safetensors
cp -r encoder detector cache/refersplat
refer-lift -q --scene scene --weights weights --text text.safetensors --masks masks.jsonl -o kitchen/lifted/model.safetensors
# A painted photograph: the first sentence's object, white on black.
refer-render -q --scene scene --text text.safetensors --model kitchen/lifted/model.safetensors --split all \
	--refs "$(jq -r .ref sentences.jsonl | head -n 1)" --png painted -o /dev/null
cp painted/view_001/*.png view_001.png
rm -r painted
# A photograph that was labelled with LabelMe.
printf '{"imagePath":"view_001.png","imageHeight":48,"imageWidth":64,"shapes":[{"label":"brown box","points":[[5,15],[15,15],[15,25]]}]}\n' >labels.json
# A camera that is not in the scene, as 3DGS writes them: the first view's, moved aside.
jq '.[0] | .world_to_camera as $m | [{img_name: "new", width, height, fx, fy,
	rotation: [range(3) as $i | [range(3) as $k | $m[$k][$i]]],
	position: [range(3) as $i | 0.05 - ([range(3) as $k | $m[$k][$i] * $m[$k][3]] | add)]}]' scene/cameras.json >new-camera.json
# Perfect, so that examples that demand a score go on.
cp truth.jsonl pred.jsonl
