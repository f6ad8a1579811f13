#!/usr/bin/env bash
# Runs the readers' fuzz targets one after another. usage: tests/fuzz/run.sh BUILD SECONDS [TARGET...]
# Inputs that reach something new are kept in BUILD/corpus and begin the next run; those that crash are in BUILD/crashes. Prints for
# each target how many inputs were tried, by this run and by all since the build folder is there, how many places of the program they
# reached, and the crashes; at last how many all targets have tried in all, and "N passed, N failed". The status is 1 where anything crashed.
set -u
here=$(cd "$(dirname "$0")" && pwd)
build=$(cd "$1" && pwd)
seconds=$2
shift 2
export REFERSPLAT_FUZZ_RUN=$build/seeds.run OMP_NUM_THREADS=1 ASAN_OPTIONS=allocator_may_return_null=1:detect_leaks=1 UBSAN_OPTIONS=print_stacktrace=1
mkdir -p "$build/crashes" "$build/corpus" "$build/executions"
[ -e "$build/seeds/text.dict" ] || "$here/seeds.sh" "$build/seeds" "$build/bin" "$build/fuzz/reader-checkpoint" || exit 1
[ $# != 0 ] || set -- $(cd "$build/seeds" && printf '%s\n' */ | tr -d /)

# fuzz: runs the target, by libFuzzer or, where the program is without it, by a plain loop.
fuzz() {
	local most
	if ! "$build/fuzz/reader-$target" -help=1 2>&1 | grep -q max_total_time; then
		"$build/fuzz/reader-$target" "$seconds" "$build/seeds/$target"
		return
	fi
	# The largest seed bounds the inputs.
	most=$(find "$build/seeds/$target" -type f -printf '%s\n' | sort -n | tail -n 1)
	"$build/fuzz/reader-$target" -max_total_time="$seconds" -timeout=25 -rss_limit_mb=3000 -malloc_limit_mb=2500 -max_len=$((most + 4096)) -print_final_stats=1 \
		-dict="$build/seeds/$target.dict" -artifact_prefix="$build/crashes/$target-" "$build/corpus/$target" "$build/seeds/$target"
}

passed=0 failed=0
printf '%-16s %12s %12s %10s %8s %8s\n' target executions 'in all' places inputs crashes
for target; do
	log=$build/crashes/$target.log
	mkdir -p "$build/corpus/$target"
	fuzz >"$log" 2>&1 </dev/null
	status=$?
	crashes=$(find "$build/crashes" -name "$target-*" ! -name '*.log' ! -name '*slow-unit*' | wc -l)
	runs=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")
	places=$(grep -o 'cov: [0-9]*' "$log" | tail -n 1)
	inputs=$(find "$build/corpus/$target" -type f | wc -l)
	total=$(($(cat "$build/executions/$target" 2>/dev/null || echo 0) + ${runs:-0}))
	echo $total >"$build/executions/$target"
	printf '%-16s %12s %12s %10s %8s %8s\n' "$target" "${runs:-0}" $total "${places#cov: }" "$inputs" "$crashes"
	if [ $status = 0 ] && [ "$crashes" = 0 ] && [ "${runs:-0}" != 0 ]; then
		passed=$((passed + 1))
	else
		failed=$((failed + 1))
		grep -E 'ERROR: |runtime error|^SUMMARY' "$log" | head -n 3
	fi
done
printf '%-29s %12s\n' all $(($(cat "$build/executions"/* | paste -sd+)))
echo "$passed passed, $failed failed"
[ $failed = 0 ] && [ $passed != 0 ]
