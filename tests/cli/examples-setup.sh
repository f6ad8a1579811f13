#!/usr/bin/env bash
# Makes the folder in which the EXAMPLES of the manual pages run. usage: examples-setup.sh DIR BIN
# It holds one small file of each kind, under the names that the manual pages use: sentences.jsonl, candidates.jsonl,
# scene/ and so on.
set -eu
dir=$1
mkdir -p "$dir"
golden=$(cd "$(dirname "$0")/../golden" && pwd)
BIN=$(cd "$2" && pwd)
cd "$dir"
PATH=$BIN:$PATH

printf '%s\n' '{"ref":"r1","object":"cup","text":"the red cup","split":"train"}' \
	'{"ref":"r2","object":"cup","text":"the cup on the left","split":"test"}' >sentences.jsonl
# A 3x2 mask with its first column set.
printf '{"view":"v%d","object":"cup","score":0.9,"segmentation":{"size":[2,3],"counts":[0,2,4]}}\n' 1 2 >candidates.jsonl
cp candidates.jsonl truth.jsonl
cp candidates.jsonl pred.jsonl
cp -r "$golden/bert" encoder
