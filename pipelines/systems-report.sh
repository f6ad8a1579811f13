#!/bin/sh
# Prints the table of systems.mk as Markdown. usage: CELLS="DIR..." PUBLISHED=FILE [BIN=DIR/] systems-report.sh <ROWS
# A row is NAME, the file of its field in a cell, and the steps in a cell's log that it needs, with tabs between; both are empty where there is no field.
set -eu
bin=${BIN:-}
# shellcheck disable=SC2086 # folders
set -- $CELLS

# mean FORMAT: of the numbers on stdin, "-" of none.
mean() { awk -v format="$1" '$1 != "" && $1 != "null" { sum += $1; n++ } END { if (n) printf format, sum / n; else printf "-" }'; }

# score ROW SPLIT: mean mIoU over the cells.
score() { for cell in $CELLS; do jq '.miou * 100' "$cell/answers/$1.$2.score.json"; done | mean %.1f; }

# The seconds and the MiB that a tool's -v ends with: seconds CELL STEP..., memory CELL STEP...
logs() { cell=$1; shift; for step; do sed -n 's/.*: \([0-9.]*\) s, peak memory \([0-9.]*\) MiB$/\1 \2/p' "$cell/log/$step" | tail -n 1; done; }
seconds() { logs "$@" | awk '{ sum += $1 } END { print sum }'; }
memory() { logs "$@" | awk '$2 > most { most = $2 } END { print most }'; }
gaussians() { "${bin}gs-check" --json "$1/scene" | jq .gaussians; }

label() { awk -F'\t' -v run="$1" '$1 == "row" && $2 == "systems" && $3 == run { print $4 }' "$PUBLISHED"; }
published() { awk -F'\t' -v run="$1" '$1 == "row" && $2 == "systems" && $3 == run { print $5 != "" ? $5 : "-" }' "$PUBLISHED"; }
stand_in() {
	case $1 in
	truth-identity) echo "stand-in: numbers of true masks" ;;
	detector-identity) echo "stand-in: numbers of a detector's masks" ;;
	truth-*) echo "stand-in: names of true masks" ;;
	detector-*) echo "stand-in: names of a detector's masks" ;;
	views-*) echo "stand-in: a synthetic detector's masks of the test view itself" ;;
	carried-*) echo "a detector's masks of the first view" ;;
	*) echo "a detector's masks" ;;
	esac
}

printf '### The systems that the paper compares with\n\n'
printf '%s scenes (%s), on one machine (%s processors).\n\n' "$#" "$(cat "$1/data/made-by")$([ $# = 1 ] || echo ' and so on')" "$(nproc)"
printf '| system | published, Ref-LERF | what it sees | test sentences | training sentences | seconds | peak MiB | bytes a Gaussian |\n'
printf '|---|---|---|---|---|---|---|---|\n'
while IFS='	' read -r row field steps; do
	time=- most=- bytes=-
	if [ -n "$steps" ]; then
		# shellcheck disable=SC2086 # steps
		time=$(for cell in $CELLS; do seconds "$cell" $steps; done | mean %.2f)
		# shellcheck disable=SC2086
		most=$(for cell in $CELLS; do memory "$cell" $steps; done | mean %.0f)
		bytes=$(for cell in $CELLS; do echo $(($(wc -c <"$cell/$field.safetensors") / $(gaussians "$cell"))); done | mean %.0f)
	fi
	printf '| %s | %s | %s | %s | %s | %s | %s | %s |\n' "$(label "${row#*-}")" "$(published "${row#*-}")" "$(stand_in "$row")" \
		"$(score "$row" test)" "$(score "$row" train)" "$time" "$most" "$bytes"
done
printf '\nmIoU in test views. Seconds and memory are of all steps from weighed views and encoded sentences to what is rendered.\n'
