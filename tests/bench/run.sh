#!/usr/bin/env bash
# Measures speed, memory, and what speed costs in accuracy: tables on stdout, plots and their data in BUILD/bench.
# usage: tests/bench/run.sh BUILD [PART...], at the root of the tree; README.md here says what each part measures.
set -u
cd "$(dirname "$0")/../.." || exit 1
export BUILD=$1
shift
parts=${*:-peer step render threads memory chain features readers formats views splats knobs moving}
failed=0
echo "$(sed -n 's/^model name[[:space:]]*: //p' /proc/cpuinfo | head -n 1), $(nproc) processors; load $(cut -d ' ' -f 1-3 /proc/loadavg)"
awk '{ exit !($1 > 0.5) }' /proc/loadavg && echo "This machine is busy with something else: times of several threads will be too long."
for part in $parts; do
	script=tests/bench/$part.sh
	case $part in run | common) script= ;; esac
	[ -f "$script" ] || { echo "bench: no part '$part'; there are: peer step render threads memory chain features readers formats views splats knobs moving rules" >&2; exit 2; }
	started=$SECONDS
	bash "$script" || failed=1
	echo "($part: $((SECONDS - started)) s)"
done
exit $failed
