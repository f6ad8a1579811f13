#!/usr/bin/env bats
# Each rule of formats/records/sentences.md broken once.

setup() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	MODEL=$BATS_TEST_DIRNAME/../golden/bert
	load files
	cd "$BATS_TEST_TMPDIR"
}

# refuses REASON LINE...: after a good first line and an empty one, these lines are refused so, from line 3 on.
refuses() {
	local reason=$1
	shift
	printf '%s\n' '{"ref":"r1","object":"o","text":"t"}' '' "$@" >x
	says 3 "text-encode: x:$reason" "$BIN/text-encode" --model "$MODEL" -o out x
	[ ! -e out ]
}

@test "every key, and those that may be absent, null or unknown" {
	printf '%s\n' '{"ref":"a","object":"o","text":"t","split":"test","views":["v1","v2"],"more":[1]}' ' ' \
		'{"ref":"b","object":"o","text":"","split":null,"views":null}' '{"ref":"c","object":"é","text":"\u00e9","views":[]}' >x
	"$BIN/text-encode" --model "$MODEL" -o out x
	says 0 'out: ok: refer.text, 3 sentences, 2 words, 24 columns, encoder 6c0c28a4bc757d74' "$BIN/gs-check" out
}

@test "names that are whole numbers, and blanks around names" {
	echo '{"ref":1,"object":" 20\u00a0","text":"t","views":[3,"v"]}' >x
	"$BIN/text-encode" --model "$MODEL" -o out x
	[ "$(head -c 4000 out | strings | grep -c '"refs":"\[\\"1\\"\]".*"objects":"\[\\"20\\"\]"\|"objects":"\[\\"20\\"\]".*"refs":"\[\\"1\\"\]"')" = 1 ]
	rm out
	refuses "4: ref '1' is already on line 3" '{"ref":1,"object":"o","text":"t"}' '{"ref":"1 ","object":"o","text":"t"}'
	refuses "3: key 'object' is empty" '{"ref":1,"object":" ","text":"t"}'
}

@test "lines that are not objects" {
	refuses '3: not JSON at column 8' '{"ref":x}'
	refuses '3: not a JSON object' '["ref"]'
	printf '{"ref":"a","object":"o",\0"text":"t"}\n' >x
	says 3 'text-encode: x:1: a NUL byte at column 25' "$BIN/text-encode" --model "$MODEL" -o out x
	refuses '3: a NUL character (\u0000) in a string' '{"ref":"a","object":"o","text":"a\u0000b"}'
}

@test "an escaped backslash before u0000 is not a NUL" {
	echo '{"ref":"a","object":"o","text":"a\\u0000b"}' | "$BIN/text-encode" --model "$MODEL" -o out
}

@test "keys that are missing, or no strings, or empty" {
	refuses "3: key 'ref' is missing" '{"object":"o","text":"t"}'
	refuses "3: key 'object' is missing" '{"ref":"a","text":"t"}'
	refuses "3: key 'text' is missing" '{"ref":"a","object":"o","text":null}'
	refuses "3: key 'ref' is not a string" '{"ref":1.5,"object":"o","text":"t"}'
	refuses "3: key 'text' is not a string" '{"ref":"a","object":"o","text":["t"]}'
	refuses "3: key 'split' is not a string" '{"ref":"a","object":"o","text":"t","split":1}'
	refuses "3: key 'ref' is empty" '{"ref":"","object":"o","text":"t"}'
	refuses "3: key 'object' is empty" '{"ref":"a","object":"","text":"t"}'
}

@test "refs and objects: any text but control characters" {
	refuses "3: key 'ref' has a control character at byte 2" '{"ref":"a\nb","object":"o","text":"t"}'
	refuses "3: key 'object' has a control character at byte 1" '{"ref":"a","object":"\u007f","text":"t"}'
	refuses "3: key 'object' is not UTF-8 at byte 3" "$(printf '{"ref":"a","object":"ab\xff","text":"t"}')"
	echo '{"ref":"../a b%","object":"..","text":"t"}' | "$BIN/text-encode" --model "$MODEL" -o out
}

@test "UTF-8" {
	for bytes in '\xff' '\xc3' '\xc0\x80' '\xed\xa0\x80' '\xf4\x90\x80\x80' '\x80'; do
		refuses "3: key 'text' is not UTF-8 at byte 2" "$(printf "{\"ref\":\"a\",\"object\":\"o\",\"text\":\"a$bytes\"}")"
	done
	refuses "3: key 'ref' is not UTF-8 at byte 1" "$(printf '{"ref":"\xff","object":"o","text":"a"}')"
}

@test "split and views" {
	refuses "3: key 'split' is 'val', not 'train' or 'test'" '{"ref":"a","object":"o","text":"t","split":"val"}'
	refuses "3: key 'views' is not a list" '{"ref":"a","object":"o","text":"t","views":"v"}'
	refuses "3: key 'views' holds something other than strings" '{"ref":"a","object":"o","text":"t","views":["v",1.5]}'
	refuses "3: key 'views': item '' is empty" '{"ref":"a","object":"o","text":"t","views":[""]}'
	refuses "3: key 'views': item 'a/b' has a slash" '{"ref":"a","object":"o","text":"t","views":["v","a/b"]}'
	refuses "3: key 'views': item '..' is '.' or '..'" '{"ref":"a","object":"o","text":"t","views":[".."]}'
}

@test "several objects, one, or none, the view it is said of and its kind" {
	printf '%s\n' '{"ref":"a","objects":["cup","dish"],"text":"both","split":"test","kind":"several"}' \
		'{"ref":"b","objects":[],"text":"the fork","split":"test","view":"v1"}' '{"ref":"c","objects":["cup"],"text":"cup"}' \
		'{"ref":"d","object":"cup","objects":null,"text":"cup","view":null,"kind":null}' >x
	says 0 'x: ok: sentences, 2 training sentences, 2 test sentences, 2 objects' "$BIN/gs-check" x
	"$BIN/text-encode" --model "$MODEL" -o out x
	[ "$(head -c 4000 out | strings | grep -o '"objects":"[^ ]*\]","texts"' | head -n 1)" = \
		'"objects":"[\"\",\"\",\"cup\",\"cup\"]","texts"' ]
	[ "$(head -c 4000 out | strings | grep -c '"kinds":"\[\\"several')" = 1 ]
}

@test "sentences of one object and nothing more are encoded without a word of objects, views and kinds" {
	echo '{"ref":"a","object":"cup","text":"red cup","views":["v1"]}' >x
	"$BIN/text-encode" --model "$MODEL" -o out x
	[ "$(head -c 4000 out | strings | grep -c -e object_lists -e '"kinds"' -e '"views"')" = 0 ]
}

@test "objects, view and kind" {
	refuses "3: key 'objects' is not a list" '{"ref":"a","objects":"o","text":"t"}'
	refuses "3: key 'objects' holds something other than strings" '{"ref":"a","objects":[1e15],"text":"t"}'
	refuses "3: key 'objects': item '' is empty" '{"ref":"a","objects":[""],"text":"t"}'
	refuses "3: key 'objects' names 'o' twice" '{"ref":"a","objects":["o","p","o"],"text":"t"}'
	refuses "3: key 'object' is 'x', but the one of 'objects' 'o'" '{"ref":"a","object":"x","objects":["o"],"text":"t"}'
	refuses "3: key 'object' is missing" '{"ref":"a","objects":["o","p"],"text":"t","split":"train"}'
	"$BIN/text-encode" --model "$MODEL" -o - <<<'{"ref":"a","objects":[],"text":"t"}' | head -c 4000 | grep -qa '"objects":"\[\\"\\"\]"'
	refuses "3: key 'view' is not a string" '{"ref":"a","object":"o","text":"t","view":[]}'
	refuses "3: key 'view' is empty" '{"ref":"a","object":"o","text":"t","view":""}'
	refuses "3: key 'kind' is empty" '{"ref":"a","object":"o","text":"t","kind":""}'
	refuses "3: key 'kind' is not UTF-8 at byte 1" "$(printf '{"ref":"a","object":"o","text":"t","kind":"\xff"}')"
}

@test "a ref twice: the first line that repeats one is named" {
	refuses "4: ref 'r1' is already on line 1" '{"ref":"a","object":"o","text":"t"}' '{"ref":"r1","object":"o","text":"t"}' \
		'{"ref":"a","object":"o","text":"t"}'
}

@test "no sentence at all" {
	printf '\n \n' >x
	says 3 'text-encode: x: holds no sentences' "$BIN/text-encode" --model "$MODEL" -o out x
}
