#!/usr/bin/env bats
# The tree keeps its shape: dependencies point one way (tests/floors), all below the tools neither
# prints nor exits, and every tool and format has its pages and tests.

setup() {
	cd "$BATS_TEST_DIRNAME/.."
}

# none PATTERN FOLDER...: fails, and shows the lines, where a C file there has the pattern.
none() {
	local pattern=$1
	shift
	find "$@" -name '*.[ch]' -exec grep -nE -e "$pattern" {} + && return 1
	return 0
}

# The rooms of the library, but for those named.
rooms() {
	local but=" $* " room
	for room in libcommon/*/; do
		room=$(basename "$room")
		[[ $but == *" $room "* ]] || echo "libcommon/$room"
	done
}

# Fails, and names them, for the files on stdin that do not exist.
all_exist() {
	local file missing=0
	while read -r file; do
		[ -e "$file" ] || { echo "missing: $file"; missing=1; }
	done
	[ $missing = 0 ]
}

# Fails, and names them, for files over $1 lines.
no_longer_than() {
	local limit=$1
	shift
	wc -l "$@" | awk -v limit="$limit" '$2 != "total" && $1 > limit { print; bad = 1 } END { exit bad }'
}

# Fails where the command succeeds; a plain ! would let the test go on.
not() { ! "$@"; }

# A copy of the tree, so that it can be broken.
copy_tree() {
	cp -r cmd formats libcommon "$BATS_TEST_TMPDIR"
	cd "$BATS_TEST_TMPDIR"
}

# breaks REASON: the map of this folder is broken, for this reason.
breaks() {
	run "$BATS_TEST_DIRNAME/map.sh" --check .
	[ "$status" = 1 ]
	[ "$output" = "$1" ] || { echo "$output"; return 1; }
}

@test "rooms include only what tests/floors has below them, and no two have files of one name" {
	tests/map.sh --check
}

@test "the map is broken by an include of a higher floor" {
	copy_tree
	echo '#include "train/step.h"' >>libcommon/field/fold.c
	breaks 'libcommon/field/fold.c: includes "train/step.h", which is not on a lower floor'
}

@test "the map is broken by a file in no room" {
	copy_tree
	mkdir libcommon/attic
	touch libcommon/attic/old.c
	breaks 'libcommon/attic/old.c: in no room of tests/floors'
}

@test "the map is broken by an include of no room" {
	copy_tree
	echo '#include "png.h"' >>libcommon/base/mem.c
	breaks 'libcommon/base/mem.c: includes "png.h", which is in no room of tests/floors'
}

@test "the map is broken by two files of one name in different rooms" {
	copy_tree
	touch libcommon/mask/octree.h
	breaks 'libcommon/mask/octree.h: the room field has a file of this name too'
}

@test "the map is broken by a floor that is above" {
	mkdir "$BATS_TEST_TMPDIR/tests"
	cp tests/map.sh "$BATS_TEST_TMPDIR/tests"
	sed 's/^splat .*/& field/' tests/floors >"$BATS_TEST_TMPDIR/tests/floors"
	run "$BATS_TEST_TMPDIR/tests/map.sh" --check .
	[ "$status" = 1 ]
	[ "$output" = 'tests/floors: splat may include field, which is on no lower floor' ]
}

@test "the map shows what files include" {
	mkdir -p "$BATS_TEST_TMPDIR/libcommon/"{base,geom} "$BATS_TEST_TMPDIR/"{cmd,formats}
	cd "$BATS_TEST_TMPDIR"
	printf '#include "base/err.h"\n#include <math.h>\n#include "base/mem.h"\n' >libcommon/geom/box.c
	echo >libcommon/base/err.h
	"$BATS_TEST_DIRNAME/map.sh" . >map
	grep -E '^geom +3 +75\.0%  base 2$' map
	grep -E '^base +1 +25\.0%$' map
}

@test "the rooms of libcommon, but for base and cli, know nothing of files" {
	none 'FILE \*|fopen|fread|fwrite|base/file\.h|cJSON|png\.h|jpeglib\.h' $(rooms base cli)
}

@test "what tools do, formats and the library never print or exit" {
	none '\b(printf|vprintf|puts|putchar|perror|exit|_exit|abort|assert)[[:space:]]*\(|\bstderr\b' cmd/*/ formats $(rooms cli)
}

@test "stdout is named only where file outputs are made" {
	none '^([^"/*]|\*[a-z])*\bstdout\b' cmd/*/ formats $(rooms cli base)
}

@test "no structure is hidden behind a typedef" {
	none '^[[:space:]]*typedef[[:space:]]+(struct|union|enum)' cmd formats libcommon
}

@test "results cannot depend on the number of threads: no atomics, no reductions over threads" {
	none 'omp (parallel|for).*reduction\([+*-]|omp atomic' libcommon formats cmd
}

@test "nothing is built with fast-math" {
	none 'fast-math|Ofast|unsafe-math' cmd formats libcommon
	not grep -nE 'fast-math|Ofast|unsafe-math' Makefile pipelines/*.mk
}

@test "every format's header names its page, and every page that is named exists" {
	for header in formats/*/*.h; do
		grep -qE 'formats/[a-z0-9_/-]+\.md' "$header" || { echo "names no page: $header"; false; }
	done
	grep -ohE 'formats/[a-z0-9_/-]+\.md' formats/*/*.h cmd/*/*.h man/* | sort -u | all_exist
}

@test "every tool has a manual page and tests" {
	ls cmd/*.c | sed 's,^cmd/\(.*\)\.c$,man/\1.1\ntests/cli/\1.bats,' | all_exist
}

@test "every manual page belongs to a tool" {
	ls man/*.1 | sed 's,^man/\(.*\)\.1$,cmd/\1.c,' | all_exist
}

@test "no file is above 600 lines, no tool above 200" {
	no_longer_than 600 $(find libcommon formats cmd/*/ tests -name '*.[ch]' -o -name '*.bats')
	no_longer_than 200 cmd/*.c
}

@test "pages outside formats and man are short: 150 lines each, 70 kB in all, and no commit in them" {
	local pages=(README.md libcommon/README.md tests/*.md tests/*/*.md pipelines/*.md)
	no_longer_than 150 "${pages[@]}"
	[ "$(cat "${pages[@]}" | wc -c)" -lt 70000 ]
	not grep -nE '[Cc]ommit [0-9a-f]{7}' "${pages[@]}" man/*
}

@test "what a header declares is used beyond the file that makes it" {
	find cmd formats libcommon tests -name '*.[ch]' | xargs awk -v but=libcommon/places '
		FNR == 1 { file++ }
		FILENAME ~ /\.h$/ && FILENAME !~ /^tests/ && index(FILENAME, but) != 1 &&
			!/^(static|typedef)/ && match($0, /^[a-z][a-z0-9_ *]*[ *][a-z0-9_]+\(/) {
			name = substr($0, 1, RLENGTH - 1)
			sub(/.*[ *]/, "", name)
			header[name] = FILENAME
		}
		{
			gsub(/[^A-Za-z0-9_]+/, " ")
			for (i = 1; i <= NF; i++) {
				files[$i] += last[$i] != file
				own[FILENAME, $i]++
				last[$i] = file
			}
		}
		END {
			for (name in header)
				if (files[name] < 3 && own[header[name], name] < 2) {
					print header[name] ": " name
					bad = 1
				}
			exit bad
		}'
}

@test "no loose ends" {
	none 'TODO|FIXME|HACK' cmd formats libcommon tests
	not grep -nE 'TODO|FIXME|HACK' Makefile pipelines/* man/*
}
