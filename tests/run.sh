#!/usr/bin/env bash
# Runs the unit tests and fuzz loops built in BUILD and every bats file, JOBS at a time, and goes on after a failure.
# usage: tests/run.sh BUILD JOBS [FILTER]; FILTER is a part of the wanted test files' names. SKIP=REGEX leaves files out.
# Of tests/release those run whose parts changed (tests/changed.sh); all of them with RELEASE=1.
# Prints a line for each test file, with its processor seconds, and for each failed test, and at last "N passed, N failed". What the tests printed is
# in BUILD/test/NAME.log. The status is 0 only when something ran and nothing failed.
set -u
cd "$(dirname "$0")/.." || exit 1
build=$1 jobs=$2 filter=${3:-}
logs=$build/test
export BIN=$PWD/$build/bin logs build
case $build in /*) BIN=$build/bin ;; esac
# Two test files at a time, each with threads of its own: a thread that waits must not keep a processor busy.
export OMP_WAIT_POLICY=${OMP_WAIT_POLICY:-passive}
export ASAN_OPTIONS=${ASAN_OPTIONS:-allocator_may_return_null=1} UBSAN_OPTIONS=${UBSAN_OPTIONS:-print_stacktrace=1}
# libomp keeps what its threads use.
export LSAN_OPTIONS=${LSAN_OPTIONS:-suppressions=$PWD/tests/leaks.supp:print_suppressions=0}
# A make that a test starts is nobody's child.
unset MAKEFLAGS MAKELEVEL MFLAGS
limit=${LIMIT:-300} # seconds a test file may take
export limit

# Runs one test file; leaves "passed failed" in NAME.count and what to print in NAME.lines.
run_one() {
	local file=$1 name=${1#tests/} passed=0 failed=0 status log
	name=${name%.*}
	log=$logs/${name//\//.}.log
	case $file in
	*.bats)
		timeout $limit bats --tap "$file" >"$log" 2>&1 </dev/null
		status=$?
		passed=$(grep -c '^ok ' "$log")
		failed=$(grep -c '^not ok ' "$log")
		sed -n 's/^not ok [0-9]* /FAILED '"${name//\//\\/}"': /p' "$log" >"$log.lines"
		[ "$(sed -n 's/^1\.\.//p' "$log")" = $((passed + failed)) ] || status=${status/#0/1}
		passed=$((passed - $(grep -c '^ok .* # skip' "$log")))
		;;
	*)
		timeout $limit "$build/$name" >"$log" 2>&1 </dev/null
		status=$?
		read -r passed failed < <(sed -n 's/^\([0-9]*\) passed, \([0-9]*\) failed$/\1 \2/p' "$log" | tail -n 1)
		passed=${passed:-0} failed=${failed:-0}
		sed -n 's/^\(.*: failed: .*\)/FAILED '"${name//\//\\/}"': \1/p' "$log" >"$log.lines"
		;;
	esac
	if [ $status != 0 ] && [ "$failed" = 0 ]; then
		failed=1
		echo "FAILED $name: exit status $status, see $log" >>"$log.lines"
	fi
	echo "$passed $failed" >"$log.count"
	times >"$log.times" # in a pipe they would be those of another shell
	printf '%-40s %4d passed, %d failed, %d s\n' "$name" "$passed" "$failed" \
		"$(awk 'NR == 2 { gsub(/[ms]/, " "); printf "%.0f", 60 * ($1 + $3) + $2 + $4 }' "$log.times")"
	cat "$log.lines"
}
export -f run_one

rm -rf "$logs"
mkdir -p "$logs"
programs=(tests/unit/test_*.c)
[ -d "$build/fuzz" ] && programs+=(tests/fuzz/fuzz_*.c)
release=(tests/release/*.bats)
[ -n "${RELEASE-}" ] || mapfile -t release < <(tests/changed.sh --release)
# The longest first, so that none is alone at the end.
printf '%s\n' "${release[@]}" tests/{pipeline,cli}/*.bats tests/unit/test_step.c tests/*.bats tests/format/*.bats "${programs[@]}" | awk '!seen[$0]++' | grep -v '\*' | grep -F -- "$filter" |
	grep -vE -- "${SKIP:-^$}" |
	xargs -P "$jobs" -I{} bash -c 'run_one {}'
cat "$logs"/*.count 2>/dev/null | awk '{p += $1; f += $2} END {
	printf "%d passed, %d failed\n", p, f
	exit f != 0 || p == 0
}'
