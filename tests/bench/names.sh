#!/usr/bin/env bash
# Usage: [BIN=build/bin] tests/bench/names.sh RUN...
#
# Asks each RUN, a folder with a lifted model, for "the X", where X is the first name of each line of libcommon/lang/things.tsv:
# 1,945 kinds of things, of which a scene has few. Prints how many were answered, and how many by two words of one kind
# ("tea bag"), with the mean of what was believed.
set -euo pipefail
export LC_ALL=C
here=$(cd "$(dirname "$0")/../.." && pwd)
BIN=${BIN:-build/bin}
[ $# -ge 1 ] || { sed -n 's/^# Usage: //p' "$0" >&2; exit 2; }
names=$(mktemp)
trap 'rm -f "$names"' EXIT
cut -f1 "$here/libcommon/lang/things.tsv" | cut -d, -f1 | sed 's/^/the /' >"$names"
printf 'run\tasked\tanswered\tof two words\tmean belief\n'
for run; do
	{ "$BIN/refer-ask" -q --json "$run" <"$names" || [ $? = 1 ]; } | jq -r --arg run "$(basename "$run")" -n --rawfile names "$names" '
		[inputs] as $x | ($names | split("\n")) as $n | [range($x | length) | select($x[.].answered)] as $found
		| [$run, ($x | length), ($found | length), ($found | map(select($n[.] | test(" .* "))) | length),
		   ($found | map($x[.].things[0].probability) | add / length * 100 | round / 100)] | @tsv'
done
