#!/usr/bin/env bash
# How long the readers take with many entries: each kind of file with 10,000 and with 100,000 of them (SIZES="N N" for others),
# read by gs-check, or by the tool that looks names up in it. The ratio is ten where the time is proportional to the size; a
# hundred means a reader that compares every entry with every other.
. "$(dirname "$0")/common.sh"
sizes=${SIZES:-10000 100000}
limit=${LIMIT:-300} # seconds a reader may take
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT

. tests/format/many.bash

read_with() {
	case $1 in
	truth) "$bin/miou-score" -q --truth "$2" -o "$work/out" "$2" ;;
	pool) "$bin/pseudomask-select" -q -o "$work/out" "$2" ;;
	box_truth) "$bin/miou-score" -q --boxes --truth "$2" -o "$work/out" "$2" ;;
	*) "$bin/gs-check" "$2" ;;
	esac
}
export -f read_with
export bin work

# Of the processor, so that other programs do not count.
TIMEFORMAT="%U %S"
heading "readers: seconds for files of $sizes entries"
{
	printf 'entries'
	printf '\t%s' $sizes
	printf '\tratio\n'
	for kind in ${KINDS:-tensors views cameras3dgs transforms colmap sentences masks boxes properties elements truth pool box_truth}; do
		printf '%s' "$kind"
		first=
		for n in $sizes; do
			"make_$kind" "$n" file
			{ time timeout "$limit" bash -c 'read_with "$@"' read "$kind" "$work/file" >"$work/log" 2>&1; } 2>"$work/took"
			status=$?
			took=$(awk '{ printf "%.2f", $1 + $2 }' "$work/took")
			rm -rf "$work/file"
			[ $status = 124 ] && took=">$limit"
			[ $status = 0 ] || [ $status = 124 ] || { head -n 1 "$work/log" >&2; took=failed; }
			printf '\t%s' "$took"
			: "${first:=$took}"
		done
		awk -v a="$first" -v b="$took" 'BEGIN { if (a + 0 > 0 && b + 0 > 0) printf "\t%.0f", b / a; print "" }'
	done
} | table
