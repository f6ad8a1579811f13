#!/usr/bin/env bash
# gs-train on hard photographs, a table: PSNR and SSIM of the test views, every eighth, of a synthetic scene whose training photographs
# or points were spoilt. The test views' photographs never are. usage: tests/bench/fit_cases.sh BIN FIT_GAIN [STEPS]
# FIT_GAIN is build/bench/fit_gain. The status is 1 where a training fails or a number that it writes is not finite.
set -u
here=$(cd "$(dirname "$0")" && pwd) bin=$(cd "$1" && pwd) gain=$(realpath "$2") steps=${3:-600}
PATH=$bin:$PATH
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
for seed in 1 9; do
	gs-synth -q --seed $seed --objects 6 --views 41 --size 160x120 --gaussians 6000 -o from$seed || exit 1
done
"$here/points.sh" from1
training=($(ls from1/images | awk 'NR % 8 != 1'))
failed=0

# new: a fresh copy as the working folder.
new() { cd "$work" && rm -rf case && cp -r from1 case && cd case || exit 1; }

# row NAME OPTION...
row() {
	local name=$1
	shift
	if gs-train -v --cameras sparse/0 --images images --test-views every:8 --gaussians 8000 --iterations "$steps" "$@" -o out.ply 2>said && gs-check out.ply >/dev/null; then
		printf '| %s | %s | %s | %s |\n' "$name" "$(sed -n 's/.*test views: PSNR \(.*\) dB, SSIM \(.*\)/\1 | \2/p' said)" \
			"$(sed -n 's/.*, of which \([0-9]*\) are.*/\1/p' said)" "$(sed -n 's/.*exposures are \(.*\)/\1/p' said)"
	else
		printf '| %s | %s |\n' "$name" "$(tail -n 1 said)"
		failed=1
	fi
}

echo '| case | PSNR, dB | SSIM | Gaussians | exposures |'
echo '|---|---|---|---|---|'
new
row 'as it is'
new
for name in "${training[@]:3}"; do rm "images/$name"; done
row '3 photographs'
new
gains=(0.5 0.7 1 1.4 2)
for i in "${!training[@]}"; do "$gain" "${gains[i % 5]}" "images/${training[i]}" made.png; mv made.png "images/${training[i]}"; done
row 'exposures 0.5 to 2, --exposure never' --exposure never
row 'exposures 0.5 to 2' --exposure auto
new
cp "$work/from9/images/${training[4]}" "$work/from9/images/${training[20]}" images
row '5% of the photographs of another room'
new
awk 'BEGIN { srand(1) } !/^#/ && rand() < 0.5 { for (k = 2; k <= 4; k++) $k += 2 * rand() - 1 } { print }' sparse/0/points3D.txt >moved && mv moved sparse/0/points3D.txt
row 'half of the points moved by up to 1 m'
[ $failed = 0 ]
