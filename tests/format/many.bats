#!/usr/bin/env bats
# Files of 100,000 entries are read in seconds: no reader compares each entry with every other. The limit is of processor
# time, which other programs do not use up; comparing all would take minutes.

setup() {
	load many.bash
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	work=$BATS_TEST_TMPDIR
	cd "$work"
}

# within SECONDS COMMAND...: fails where it takes more processor time.
within() {
	(
		ulimit -t "$1"
		shift
		"$@"
	)
}

# reads KIND TEXT: gs-check reads 100,000 entries and says so.
reads() {
	"make_$1" 100000 file
	within 25 "$BIN/gs-check" file | grep -qF "$2"
}

@test "tensors, each with its checksum" { reads tensors "100000 tensors"; }
@test "views of a scene" { reads views "100000 training views"; }
@test "views of other programs" {
	reads cameras3dgs "100000 training views"
	reads transforms "100000 test views"
	rm -rf file
	reads colmap "100000 training views"
}
@test "sentences, each of another object" { reads sentences "100000 training sentences"; }
@test "masks, each of another view and object" { reads masks "100000 masks"; }
@test "boxes, each of another object" { reads boxes "100000 boxes"; }

@test "twice the same name among many is found" {
	{ lines 50000 '{"ref":"r@","object":"o","text":"a"}'; lines 7 '{"ref":"r@","object":"o","text":"a"}'; } >file
	run within 25 "$BIN/gs-check" file
	[ "$status" = 1 ]
	[ "$output" = "file:50001: ref 'r1' is already on line 1" ]
	{ echo '['; listed 50000 '{"name":"v@",'"$view"'}'; echo ',{"name":"v7",'"$view"'}]'; } >file
	run within 25 "$BIN/gs-check" file
	[ "$status" = 1 ]
	[ "$output" = "file: view name 'v7' appears twice" ]
}

@test "a file whose header has many properties, and two of one name" {
	make_properties 100000 file
	within 25 "$BIN/gs-check" file
	sed -i '0,/^property char 49999$/s//property char 3/' file
	run within 25 "$BIN/gs-check" file
	[ "$status" = 1 ]
	[ "$output" = "file:50016: property '3' appears twice" ]
}

@test "a line of JSON Lines has a limit" {
	{ printf '{"ref":"r1","object":"o","text":"a","more":"'; head -c 67108900 /dev/zero | tr '\0' a; echo '"}'; } >file
	run "$BIN/gs-check" file
	[ "$status" = 1 ]
	[ "$output" = "file:1: a line of more than 67108864 bytes" ]
}
