#!/bin/sh
# Prints what two-stage.mk and lift.mk made in a folder: scores, times and memory; with --words in a line for each way, the best first.
# usage: report.sh [--words] SCENE
set -eu
words=
[ "$1" != --words ] || { words=1; shift; }
dir=$1

# The number at a key of a score file, as a percentage; the objects' own come after the scene's.
percent() {
	grep -o "\"$1\":[0-9.eE+-]*" "$2" | head -n 1 | awk -F: '{ printf "%6.1f", 100 * $2 }'
}

# row LABEL FILE
row() {
	[ -e "$2" ] || return 0
	printf '%-42s %s %s %s %s %s\n' "$1" "$(percent miou "$2")" "$(percent oiou "$2")" "$(percent p25 "$2")" \
		"$(percent p50 "$2")" "$(percent p75 "$2")"
}

# Seconds of steps together.
seconds() {
	for step; do
		[ ! -e "$dir/log/$step" ] || sed -n '$s/.*: \([0-9.]*\) s, peak memory.*/\1/p' "$dir/log/$step"
	done | awk '{ sum += $1 } END { printf "%.0f", sum }'
}

# answers HOW FILE SECONDS PICTURES: a line of words.
answers() {
	[ ! -e "$2" ] || echo "$1: $(percent p50 "$2" | tr -d ' ')% of the masks of test sentences are right by half or more, mIoU $(percent miou "$2" |
		tr -d ' '), in $3 s. Pictures: $4"
}

if [ "$words" ]; then
	answers "Without training" "$dir/lifted/predictions.test.score.json" "$(seconds weigh encode select3d lift render3.test)" "$dir/lifted/overlays"
	how="as in the paper" by=train1
	! grep -q -e '--query parses' "$dir/log/train2.command" 2>/dev/null || how="on what the scene says of itself" by="select3d lift say encode2"
	answers "Trained $how" "$dir/stage2/predictions.test.score.json" \
		"$(seconds weigh encode select $by teach train2 render2.test)" "$dir/stage2/overlays"
	exit
fi

[ -z "$(find "$dir" -maxdepth 2 -name '*.score.json')" ] || printf '%-42s %6s %6s %6s %6s %6s\n' "" mIoU oIoU P@25 P@50 P@75
row "selected masks, training views" "$dir/stage1/masks.score.json"
for stage in 1 2; do
	[ $stage = 1 ] || row "masks that teach stage 2, training views" "$dir/stage2/masks.score.json"
	row "stage $stage, test views, training sentences" "$dir/stage$stage/predictions.train.score.json"
	row "stage $stage, test views, test sentences" "$dir/stage$stage/predictions.test.score.json"
done
row "masks selected in 3D, training views" "$dir/lifted/masks.score.json"
row "lifted, test views, training sentences" "$dir/lifted/predictions.train.score.json"
row "lifted, test views, test sentences" "$dir/lifted/predictions.test.score.json"
row "lifted, test views, more sentences" "$dir/lifted/asked.score.json"
row "lifted, whole objects, test sentences" "$dir/lifted/whole.score.json"
echo
printf '%-12s %10s %12s\n' step seconds "peak MiB"
for step in import weigh paint encode select train1 teach say encode2 train2 render1.train render1.test render2.train render2.test overlay1 overlay2 \
	select3d lift encode3 render3.train render3.test render3.asked render3.whole locate overlay3; do
	[ -e "$dir/log/$step" ] || continue
	sed -n 's/.*: \([0-9.]*\) s, peak memory \([0-9.]*\) MiB$/\1 \2/p' "$dir/log/$step" | tail -n 1 |
		awk -v step="$step" '{ printf "%-12s %10s %12s\n", step, $1, $2 }'
done
