#!/usr/bin/env bash
# The tools' part of `make stability`: hard input, what the tool says of it, and whether every file that it leaves is well-formed,
# which includes that no number in it is NaN or infinite. usage: tests/stability/tools.sh BIN [quick]
# Prints a Markdown table; the status is 1 where an exit status is not the expected one or a file is bad.
set -u
here=$(cd "$(dirname "$0")/.." && pwd)
bin=$(cd "$1" && pwd)
largest=8192x8192 steps=100
[ "${2:-}" != quick ] || largest=512x512 steps=10
PATH=$bin:$PATH
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failed=0
"$here/cli/examples-setup.sh" "$work/from" "$bin" || exit 1
cd "$work" || exit 1

# new: a fresh copy of the examples as the working folder.
new() {
	cd "$work" && rm -rf case && cp -r from case && cd case || exit 1
}

# row STATUS CASE OUTPUT TOOL ARGUMENT...: runs the tool, which must end with that status, and checks its output where there is one.
row() {
	local want=$1 name=$2 output=$3 status=0 said files verdict=
	shift 3
	"$@" >/dev/null 2>said </dev/null || status=$?
	said=$(grep -v '^Try ' said | head -n 1 | sed 's/|/\\|/g')
	if [ ! -e "$output" ]; then
		files=none
	elif gs-check "$output" >/dev/null 2>bad; then
		files=well-formed
	else
		files="FAILED: $(head -n 1 bad)"
		verdict=bad
	fi
	[ $status = "$want" ] || { verdict=bad; status="FAILED: $status, not $want"; }
	[ -z "$verdict" ] || failed=1
	echo "| $name | \`$1\` | $status | ${said:-nothing} | $files |"
}

train_row() {
	local want=$1 name=$2
	shift 2
	row "$want" "$name" out refer-train --scene scene --weights weights --text text.safetensors --masks masks.jsonl \
		--iterations $steps -o out "$@"
}

# float OFFSET BYTES: writes them over the number at this offset of the first Gaussian of point_cloud.ply.
float() {
	local header
	header=$(head -c 2000 point_cloud.ply | grep -abo end_header | cut -d: -f1)
	printf "$2" | dd of=point_cloud.ply bs=1 seek=$((header + 11 + $1)) conv=notrunc status=none
}

# column NAME: the offset of a property.
column() {
	head -c 2000 point_cloud.ply | grep -a '^property float' | grep -an " $1$" | cut -d: -f1 | awk '{ print 4 * ($1 - 1) }'
}

echo "| case | tool | exit status | says | its output |"
echo "|---|---|---|---|---|"
nan='\0\0\300\177' inf='\0\0\200\177' huge='\0\0\172\104' # 1000
for property in x opacity scale_0 rot_0; do
	new && float "$(column $property)" "$nan"
	row 0 "NaN for $property" out gs-import --images images -o out point_cloud.ply
done
new && float "$(column y)" "$inf"
row 0 "infinity for y" out gs-import --images images -o out point_cloud.ply
new && float "$(column scale_1)" "$huge"
row 0 "a scale of e^1000" out gs-import --images images -o out point_cloud.ply
new && float "$(column opacity)" "$huge"
row 0 "an opacity of sigmoid(1000)" out gs-import --images images -o out point_cloud.ply
new && train_row 0 "learning rates times 100" --feature-rate 0.25 --mlp-rate 0.01
new && train_row 2 "learning rates times 10,000" --feature-rate 25 --mlp-rate 1
new && train_row 1 "learning rates of 10 and 1" --iterations 200 --feature-rate 10 --mlp-rate 1
new && train_row 1 "a contrast of raw products at temperature 1e-6, lambda 1e6" --contrast dot --temperature 1e-6 --lambda 1e6 --mlp-rate 10 \
	--iterations 200 --feature-rate 10
new && jq -c 'select(.ref == "brown-box-1")' sentences.jsonl >one.jsonl && text-encode -q --model encoder -o text.safetensors one.jsonl
train_row 0 "one sentence: no negative"
new && jq -c '.text = "the box"' sentences.jsonl >same.jsonl && text-encode -q --model encoder -o text.safetensors same.jsonl
train_row 0 "all sentences the same"
for kind in "all [0,3072]" "nothing [3072]"; do
	new && jq -c ".segmentation.counts = ${kind#* }" masks.jsonl >masks && mv masks masks.jsonl
	train_row 0 "masks that are ${kind% *}"
	row 0 "masks that are ${kind% *}" lifted refer-lift --scene scene --weights weights --text text.safetensors --masks masks.jsonl \
		-o lifted
done
new && jq -c '.score = 0.5' candidates.jsonl >same.jsonl
row 0 "candidates of one score" out pseudomask-select -q -o out same.jsonl
new && jq 'map(.world_to_camera[2][3] = -1000)' scene/cameras.json >moved && mv moved scene/cameras.json && rm -r weights
row 3 "views that see nothing" weights gs-weigh -o weights scene
row 0 "views that see nothing" out refer-render --scene scene --text text.safetensors --model model.safetensors -o out
new && jq 'map(.world_to_camera[2][3] = if .name == "view_000" then .world_to_camera[2][3] else -1000 end)' scene/cameras.json >moved &&
	mv moved scene/cameras.json && rm -r weights
row 0 "all views but one see nothing" weights gs-weigh -q -o weights scene
row 0 "all views but one see nothing" lifted refer-lift --scene scene --weights weights --text text.safetensors --masks masks.jsonl -o lifted
train_row 0 "all views but one see nothing"
new && rm -r weights && row 0 "nearly all weight dropped" weights gs-weigh -q --tolerance 0.99 -o weights scene
row 0 "nearly all weight dropped" lifted refer-lift --scene scene --weights weights --text text.safetensors --masks masks.jsonl -o lifted
for size in 1x1 $largest; do
	new && row 0 "a view of $size" out refer-render --scene scene --text text.safetensors --model model.safetensors --size $size \
		--views view_001 --refs brown-box-1 -o out
done
exit $failed
