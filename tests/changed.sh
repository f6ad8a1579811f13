#!/usr/bin/env bash
# Files that the newest commits changed: those of the SINCE (default: 4 hours) before the last commit. All files where that cannot be known.
# usage: tests/changed.sh [--release]: with --release the files of tests/release whose parts (their line "# Parts:") are among them.
set -eu
cd "$(dirname "$0")/.."
newest=$(git log -1 --format=%ct 2>/dev/null) && base=$(git rev-list -1 --before=$((newest - ${SINCE:-14400})) HEAD) && [ -n "$base" ] ||
	base=$(git hash-object -t tree /dev/null)
changed=$(git diff --name-only --diff-filter=d "$base" HEAD)
if [ "${1-}" != --release ]; then
	printf '%s\n' "$changed"
	exit
fi
for test in tests/release/*.bats; do
	parts=$(sed -n 's/^# Parts: //p' "$test")
	grep -qxE "${parts// /|}|$test" <<<"$changed" && echo "$test"
done
exit 0
