#!/usr/bin/env bats
# tests/invariance.sh: the same scene in another unit, place, naming or order has the same answers.

@test "answers do not depend on unit, place, names and order" {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	if grep -q __asan_init "$BIN/gs-check"; then skip "slow with sanitizers, which find nothing more here"; fi
	cd "$BATS_TEST_TMPDIR"
	"$BATS_TEST_DIRNAME/../invariance.sh" "$BIN" >out 2>err || { cat out err; false; }
	[ ! -s err ] || { cat err; false; }
	[ "$(grep -c ' of 200 ' out)" = 15 ]
}
