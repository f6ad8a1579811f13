#!/usr/bin/env bats
# The tables of make stability, without the largest cases.

setup() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	cd "$BATS_TEST_TMPDIR"
}

# rows MINIMUM: out is a table of at least so many rows, without a NaN, an infinity or a failure.
rows() {
	[ "$(grep -c '^|' out)" -ge $(($1 + 2)) ] && ! grep -nE '[|] *-?(nan|inf) *[|]|FAILED' out
}

@test "the fast paths are within the bounds that stand in their rows" {
	"$BIN/../stability" quick >out
	rows 50
	awk -F ' [|] ' 'NR > 2 && !($3 + 0 <= $4 + 0 && $4 + 0 > 0) { print; bad = 1 } END { exit bad }' out
}

@test "hard input ends with the status and the files that are expected of it" {
	"$BATS_TEST_DIRNAME/../stability/tools.sh" "$BIN" quick >out
	rows 20
}
