#!/usr/bin/env bash
# What refer-lift and refer-train find of masks that are not where they belong: true masks of made scenes, as they are, mirrored, turned
# upside down, shifted by shares of the width, and each in the next view.
# usage: tests/moved-masks.sh BIN [SEED...]. Prints a Markdown table: how far each mask is what those of the other views lifted (the
# least and the most of all seeds; below 0.25 it is an error, below 0.35 a warning), and how many seeds' masks were told of.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
export PATH="$(cd "$1" && pwd):$PATH" OMP_WAIT_POLICY=passive LC_ALL=C
shift
[ $# != 0 ] || set -- 1 2 3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

# COCO's run lengths to foreground ranges [from,to) of pixels by columns, and back.
runs='def ranges: [foreach (explode[] - 48) as $c ({x: 0, m: 1}; (if .done then {x: 0, m: 1} else . end) | .x += $c % 32 * .m | .m *= 32 |
	if $c < 32 then .done = true | if $c >= 16 then .x -= .m else . end else . end; select(.done) | .x)] |
	reduce .[] as $x ([]; . + [if length > 2 then $x + .[length - 2] else $x end]) | . as $n | [foreach .[] as $r (0; . + $r)] as $to |
	[range(1; $n | length; 2) | [$to[. - 1], $to[.]] | select(.[0] < .[1])];
def counts($all): sort | reduce .[] as [$a, $b] ([[], 0]; if $a == .[1] and (.[0] | length) > 0 then [.[0][:-1] + [.[0][-1] + $b - $a], $b]
	else [.[0] + [$a - .[1], $b - $a], $b] end) | .[0] + [$all - .[1]];
def columns: [.[] | . as [$a, $b] | range($a / $h | floor; ($b - 1) / $h + 1 | floor) | [([$a, . * $h] | max), ([$b, (. + 1) * $h] | min)]];
def moved(f): .segmentation.counts |= (ranges | columns | map(f) | map([([.[0], 0] | max), ([.[1], $h * $w] | min)] |
	select(.[0] < .[1])) | counts($h * $w));'
mirrored='moved((.[0] / $h | floor) as $c | map(. + ($w - 1 - 2 * $c) * $h))'
down='moved((.[0] / $h | floor) as $c | [(2 * $c + 1) * $h - .[1], (2 * $c + 1) * $h - .[0]])'

for seed in "$@"; do
	gs-synth -q --seed "$seed" --objects 8 --views 12 --size 160x120 --gaussians 6000 -o "$seed"
	gs-import -q --cameras "$seed/sparse/0" --test-views "$(cat "$seed/test-views")" -o "$seed/scene" "$seed/point_cloud.ply"
	gs-weigh -q -o "$seed/weights" "$seed/scene"
	text-encode -q --model "$here/golden/bert" -o "$seed/text" "$seed/sentences.jsonl"
done

# row WHAT FILTER SEED...
row() {
	local what=$1 filter=$2 seed told=0
	shift 2
	for seed; do
		jq -c --argjson h 120 --argjson w 160 "$runs $filter" "$seed/truth.jsonl" >masks
		refer-lift -vv --scene "$seed/scene" --weights "$seed/weights" --text "$seed/text" --masks masks -o model 2>err || true
		sed -n 's/.*each of [0-9]* masks is by \([0-9.]*\).*/\1/p' err >>figures
		! grep -q 'where those of other views show it' err || told=$((told + 1))
	done
	printf '| %s | %s to %s | %d of %d |\n' "$what" "$(sort -n figures | head -n 1)" "$(sort -n figures | tail -n 1)" "$told" $#
	rm figures
}
echo '| masks | agreement | told |'
echo '|---|---|---|'
row 'as they are' . "$@"
row 'of the next view' '.view |= "view_\(((ltrimstr("view_") | tonumber) + 1) % 12 + 1000 | tostring | .[1:])"' "$@"
row mirrored "$mirrored" "$@"
row 'upside down' "$down" "$@"
for share in 5 10 20; do
	row "shifted by $share% of the width" "moved(map(. + ($share / 100 * \$w | round) * \$h))" "$@"
done
