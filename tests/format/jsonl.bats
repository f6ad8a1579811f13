#!/usr/bin/env bats
# What formats/records/jsonl.md says of every file of records. The keys have tests of their own: sentences.bats, masks.bats and
# boxes.bats. The limit of a line is in many.bats.

setup() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	load files
	cd "$BATS_TEST_TMPDIR"
}

one='{"ref":"r1","object":"cup","text":"the red cup"}'
two='{"ref":"r2","object":"cup","text":"the cup"}'
fine='ok: sentences, 2 training sentences, 0 test sentences, 1 objects'

# Fails where the command succeeds; a plain ! would let the test go on.
not() { ! "$@"; }

@test "a record is a line; the last may lack its end" {
	printf '%s\n%s\n' "$one" "$two" >x
	says 0 "x: $fine" "$BIN/gs-check" x
	printf '%s\n%s' "$one" "$two" >x
	says 0 "x: $fine" "$BIN/gs-check" x
}

@test "blank lines, carriage returns, blanks and a byte order mark are skipped" {
	printf '\n  \t\r\n \t%s\r\n\r\n%s  \n\n' "$one" "$two" >x
	says 0 "x: $fine" "$BIN/gs-check" x
	printf '\xef\xbb\xbf%s\n%s\n' "$one" "$two" >x
	says 0 "x: $fine" "$BIN/gs-check" x
}

@test "UTF-16 of either order, with its mark or without, is read as the same in UTF-8" {
	printf '%s\r\n\r\n%s\r\n' "${one/red/rouge \\u00e9 é 😀}" "$two" >x
	for code in UTF-16LE UTF-16BE; do
		iconv -f UTF-8 -t $code x >bare
		{ [ $code = UTF-16LE ] && printf '\xff\xfe' || printf '\xfe\xff'; cat bare; } >marked
		for file in bare marked; do
			says 0 "$file: $fine" "$BIN/gs-check" $file
			head -c -5 $file >cut
			says 1 "cut: UTF-16 that is cut within a character at offset $(($(wc -c <cut) - 1)): save it as UTF-8" "$BIN/gs-check" cut
		done
	done
	printf '{"w":40,"h":30,"fl_x":50,"frames":[]}' | iconv -t UTF-16 >t.json
	says 1 "t.json: no views: a COLMAP model has them in images.bin or images.txt, a transforms.json in its frames (read as UTF-16)" "$BIN/gs-check" t.json
}

@test "a key twice in an object" {
	printf '%s\n' "${one/\"text\"/\"ref\":\"r3\",\"text\"}" >x
	says 1 "x:1: key 'ref' is there twice" "$BIN/gs-check" x
	echo '{"w":40,"h":30,"fl_x":50,"frames":[{"a":1,"a":2}]}' >t.json
	says 1 "t.json:1: key 'a' is there twice" "$BIN/gs-check" t.json
	says 3 "gs-import: t.json: key 'a' is there twice in one object" "$BIN/gs-import" --cameras t.json -o none /dev/null
}

@test "lines are counted with the blank ones" {
	printf '\n%s\n\n\n{}\n' "$one" >x
	says 1 "x:5: key 'ref' is missing" "$BIN/gs-check" x
}

@test "a line longer than any buffer" {
	long=$(printf '%*s' 300000 | tr ' ' y)
	printf '%s\n{"ref":"r2","object":"cup","text":"%s"}\n' "$one" "$long" >x
	says 0 "x: $fine" "$BIN/gs-check" x
}

@test "not JSON, and where" {
	printf '%s\n{"ref":}\n' "$one" >x
	says 1 "x:2: not JSON at column 8" "$BIN/gs-check" x
	printf '%s\n%s %s\n' "$one" "$two" "$two" >x
	says 1 "x:2: not JSON at column 46" "$BIN/gs-check" x
	printf '{"ref":"r1",\n"object":"cup"}\n' >x
	says 1 "x: an object over several lines, not one on each line: 'jq -c . x' writes it so" "$BIN/gs-check" x
	printf '%s,\n' "$one" "$two" >x
	says 1 "x:1: not JSON at column $((${#one} + 1)): a comma too many" "$BIN/gs-check" x
	printf "%s\n{'ref':'r2'}\n" "$one" >x
	says 1 "x:2: not JSON at column 3: it is as Python prints it: json.dump writes JSON" "$BIN/gs-check" x
	printf '%s\n{"ref":"r2","object":"cup","text":"a NaN","x":NaN,"y":[-Infinity, Infinity]}\n' "$one" >x
	says 0 "x: $fine" "$BIN/gs-check" x
	printf '{"view":"v","object":"cup","score":NaN,"path":"x"}\n' >x
	says 1 "x:1: key 'score' is not a number" "$BIN/gs-check" x
}

@test "JSON that is no object" {
	for value in '[]' 1 '"a"' null true; do
		printf '%s\n%s\n' "$one" "$value" >x
		says 1 "x:2: not a JSON object" "$BIN/gs-check" x
	done
}

@test "a zero byte" {
	printf '%s\n{"ref":\0"r2"}\n' "$one" >x
	says 1 "x:2: a NUL byte at column 8" "$BIN/gs-check" x
}

@test "nesting without end does not exhaust the stack" {
	{ printf '%s\n{"ref":' "$one"; printf '%*s' 100000 | tr ' ' '['; } >x
	"$BIN/gs-check" x >out && return 1
	grep -E '^x:2: not JSON at column [0-9]+$' out
}

@test "no records" {
	printf '\n \n' >x
	says 1 "x: not a kind of file that the suite reads" "$BIN/gs-check" x
	: >x
	says 1 "x: empty" "$BIN/gs-check" x
}

@test "records that are neither sentences nor masks" {
	echo '{"a":1}' >x
	says 1 "x:1: neither a sentence (key 'text') nor a mask (key 'segmentation' or 'path')" "$BIN/gs-check" x
}

@test "cut at every length: fine at a record's end, else malformed" {
	printf '%s\n%s\n' "$one" "$two" >x
	for ((n = 1; n < $(wc -c <x); n++)); do head -c $n x >cut.$(printf %03d $n); done
	status=0
	"$BIN/gs-check" cut.* >out 2>err || status=$?
	[ $status = 1 ] && [ ! -s err ]
	[ "$(wc -l <out)" = $((n - 1)) ]
	[ "$(grep -c ': ok: ' out)" = 3 ]
	not grep -v -e ': ok: ' -e '^cut\.[0-9]*:[12]: not JSON at column [0-9]*$' out
}

@test "gs-check says so where the first record has an escaped NUL" {
	printf '%s\n' '{"ref":"a\u0000b","text":"t"}' >nul.jsonl
	says 1 "nul.jsonl:1: a NUL character (\\u0000) in a string" "$BIN/gs-check" nul.jsonl
}
