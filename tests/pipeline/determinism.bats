#!/usr/bin/env bats
# make determinism, on a smaller scene.

@test "bytes do not depend on the number of threads, and kernels are as close as is promised" {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	if grep -q __asan_init "$BIN/gs-check"; then skip "slow with sanitizers, which find nothing more here"; fi
	cd "$BATS_TEST_TMPDIR"
	"$BATS_TEST_DIRNAME/../determinism.sh" "$BIN" quick >out 2>err || { cat out err; false; }
	[ ! -s err ]
	[ "$(grep -c '| equal | equal |$' out)" = 12 ]
	grep -q '^| plain | ' out
}
