#!/usr/bin/env bats
# The tree keeps its shape: dependencies point one way (cmd -> cmd/jobs -> formats -> libcommon), all below the tools neither
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

@test "libcommon includes nothing of formats or cmd" {
	none '^[[:space:]]*#[[:space:]]*include[[:space:]]+"(\.\./)*(formats|cmd)/' libcommon
}

@test "formats include nothing of cmd" {
	none '^[[:space:]]*#[[:space:]]*include[[:space:]]+"(\.\./)*cmd/' formats
}

@test "jobs include of cmd only jobs" {
	none '^[[:space:]]*#[[:space:]]*include[[:space:]]+"(\.|cmd/([^j]|j[^o]|jo[^b]|job[^s]|jobs[^/]))' cmd/jobs
}

@test "only tools include cli" {
	none '^[[:space:]]*#[[:space:]]*include[[:space:]]+"cli/' cmd/jobs formats $(rooms cli)
}

@test "the rooms of libcommon include only base, and the rooms below them" {
	# What each room may include besides itself.
	declare -A below=([base]= [cli]=base [geom]=base [mask]=base [nn]=base [splat]='base|geom'
		[lang]='base|nn' [ask]='base|geom|lang|refer|splat' [field]="base|mask|nn|splat" [refer]="ask|base|field|geom|lang|mask|nn|splat" [synth]='base|geom|lang|mask|splat')
	for dir in libcommon/*/; do
		room=$(basename "$dir")
		[ -n "${below[$room]+set}" ] || { echo "unknown room: $room"; return 1; }
		if grep -rnE --include='*.[ch]' '^[[:space:]]*#[[:space:]]*include[[:space:]]+"' "$dir" |
			grep -vE "include[[:space:]]+\"($room${below[$room]:+|${below[$room]}})/"; then
			return 1
		fi
	done
}

@test "splat, nn, refer, mask, geom and synth know nothing of files" {
	none 'FILE \*|fopen|fread|fwrite|base/file\.h|cJSON|png\.h|jpeglib\.h' $(rooms base cli)
}

@test "jobs, formats and the library never print or exit" {
	none '\b(printf|vprintf|puts|putchar|perror|exit|_exit|abort|assert)[[:space:]]*\(|\bstderr\b' cmd/jobs formats $(rooms cli)
}

@test "stdout is named only where file outputs are made" {
	none '^([^"/*]|\*[a-z])*\bstdout\b' cmd/jobs formats $(rooms cli base)
}

# boxes, lifted ... are a format and what it holds; the others wait for better names.
@test "no two rooms have files of one base name, but for those known" {
	local known='boxes lifted model readings relations scene sentences sight words' found
	found=$(ls -d libcommon/*/*.[ch] formats/*.[ch] cmd/jobs/*.[ch] | sed 's,\.[ch]$,,' | sort -u | sed 's,.*/,,' | sort | uniq -d | xargs)
	[ "$found" = "$known" ] || { echo "found: $found"; return 1; }
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
	for header in formats/*.h; do
		grep -qE 'formats/[a-z0-9_-]+\.md' "$header" || { echo "names no page: $header"; false; }
	done
	grep -ohE 'formats/[a-z0-9_-]+\.md' formats/*.h cmd/jobs/*.h man/* | sort -u | all_exist
}

@test "every tool has a manual page and tests" {
	ls cmd/*.c | sed 's,^cmd/\(.*\)\.c$,man/\1.1\ntests/cli/\1.bats,' | all_exist
}

@test "every manual page belongs to a tool" {
	ls man/*.1 | sed 's,^man/\(.*\)\.1$,cmd/\1.c,' | all_exist
}

@test "no file is above 600 lines, no tool above 200" {
	no_longer_than 600 $(find libcommon formats cmd/jobs tests -name '*.[ch]' -o -name '*.bats')
	no_longer_than 200 cmd/*.c
}

@test "no loose ends" {
	none 'TODO|FIXME|HACK' cmd formats libcommon tests
	not grep -nE 'TODO|FIXME|HACK' Makefile pipelines/* man/*
}
