#!/usr/bin/env bats
# A second for each of the readers' fuzz targets, where they are built: with the sanitizers. make fuzz runs them for long.

@test "every reader takes broken files" {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	[ -x "$BIN/../fuzz/reader" ] || skip "the targets are not built"
	run "$BATS_TEST_DIRNAME/../fuzz/run.sh" "$BIN/.." 1
	echo "$output"
	[ "$status" = 0 ]
	[ "${lines[-1]}" = "$(sed -n 's/^	{"[a-z-]*", try_.*/./p' "$BATS_TEST_DIRNAME/../fuzz/reader.c" | wc -l) passed, 0 failed" ]
}
