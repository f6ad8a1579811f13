#!/usr/bin/env bats
# Two kills of each tool, of the many that tests/kill.sh is for.
# Parts: libcommon/base/(file|temporary|finish|signals|overwrite).* libcommon/cli/.* formats/scene/checkpoint.*

@test "a tool that is killed leaves nothing in the way of the next run, which writes the same bytes" {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	if grep -q __asan_init "$BIN/gs-check"; then skip "slow with sanitizers, which find nothing more here"; fi
	cd "$BATS_TEST_TMPDIR"
	run "$BATS_TEST_DIRNAME/../kill.sh" "$BIN" 2
	echo "$output"
	[ "$status" = 0 ]
	[ "${lines[-1]}" = "7 passed, 0 failed" ]
}
