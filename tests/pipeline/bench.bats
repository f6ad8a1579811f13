#!/usr/bin/env bats
# What make bench draws and fits with.

setup() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	bench=$BATS_TEST_DIRNAME/../bench
	tab=$'\t'
}

@test "frames of made scenes are timed, and of a part of one" {
	bench_render=$BIN/../bench/bench_render
	[ -x "$bench_render" ] || skip "make benches was not run"
	cd "$BATS_TEST_TMPDIR"
	"$bench_render" -n 2000,3000 -s 64x48 -r 1 >all.jsonl
	"$bench_render" -n 2000 -s 64x48 -r 1 -l 0.05 >part.jsonl
	jq -se 'map(.gaussians) | unique == [2000, 3000]' all.jsonl
	[ "$(jq -s '.[0].pairs' part.jsonl)" -lt "$(jq -s '.[0].pairs' all.jsonl)" ]
}

@test "a power law is fitted" {
	run awk -f "$bench/fit.awk" -v name=cubes < <(for x in 1 2 4 8; do echo "$x $((5 * x * x * x))"; done)
	[ "$status" = 0 ]
	[ "$(cut -f 5,6 <<<"$output")" = "3.00${tab}1.0000" ]
}

@test "a line with a constant part is fitted, and its exponent only where the constant does not dominate" {
	run awk -f "$bench/fit.awk" -v name=line < <(for x in 1 10 200 400 800; do echo "$x $((100 + 2 * x))"; done)
	[ "$(cut -f 1-4,7,8 <<<"$output")" = "line${tab}3${tab}200${tab}800${tab}100${tab}2" ]
	[ "$(cut -f 9 <<<"$output")" = "20 %" ]
	run awk -f "$bench/fit.awk" -v name=flat < <(for x in 1 2 3 4; do echo "$x $((1000 + x))"; done)
	[ "$(cut -f 2,5 <<<"$output")" = "0${tab}-" ]
}

@test "a plot has every series, point, label and level, escaped" {
	printf '%s\n' "#title${tab}a < b & c" "#xlog" "#ref${tab}3${tab}goal" "#style${tab}two${tab}points" \
		"one${tab}1${tab}2" "one${tab}10${tab}4${tab}3${tab}5" "two${tab}100${tab}1${tab}${tab}${tab}${tab}${tab}here" \
		"two${tab}0${tab}1" >"$BATS_TEST_TMPDIR/data.tsv"
	run awk -f "$bench/plot.awk" "$BATS_TEST_TMPDIR/data.tsv"
	[ "$status" = 0 ]
	[ "${lines[0]:0:4}" = "<svg" ]
	[ "${lines[-1]}" = "</svg>" ]
	[[ $output == *'a &lt; b &amp; c</text>'* ]]
	[[ $output == *'>one</text>'* && $output == *'>two</text>'* && $output == *'>here</text>'* && $output == *'>goal</text>'* ]]
	# "two" is named first: one point, for 0 has no logarithm, and its mark in the legend; two of "one", and its mark.
	[ "$(grep -c '<circle' <<<"$output")" = 2 ]
	[ "$(grep -c '<rect x' <<<"$output")" = 3 ]
	[[ $output != *nan* && $output != *inf* ]]
}

@test "one point on linear axes, negative and zero, makes a plot" {
	for y in 0 -3 5e-7; do
		run awk -f "$bench/plot.awk" <<<"a${tab}0${tab}$y"
		[ "$status" = 0 ]
		[ "$(grep -c '<circle' <<<"$output")" = 1 ]
		[[ $output != *nan* && $output != *inf* ]]
	done
}

@test "nothing to plot is an error" {
	run awk -f "$bench/plot.awk" <<<"#title${tab}empty"
	[ "$status" = 1 ]
	[ "$output" = "plot.awk: no points" ]
}
