#!/usr/bin/env bats
# Each rule of formats/encoders/merges.md broken once. How texts are cut: tests/unit/test_bpe.c.

setup() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	load files
	cd "$BATS_TEST_TMPDIR"
	cp -r "$BATS_TEST_DIRNAME/../golden/clip" m
	cp -r "$BATS_TEST_DIRNAME/../golden/open-clip" o
	cp m/vocab.json good.json
	cp m/merges.txt good.txt
	lines=$(wc -l <good.txt)
	echo '{"ref":"a","object":"o","text":"the red cups, it'"'"'s 10 é"}' >s
}

# refuses STATUS REASON [FOLDER]: text-encode on the folder m.
refuses() {
	says "$1" "text-encode: $2" "$BIN/text-encode" --model "${3:-m}" -o out s
	[ ! -e out ]
}

# tokenizer FILTER: m/tokenizer.json of the golden files, after this jq filter, in place of them.
tokenizer() {
	rm -f m/vocab.json m/merges.txt
	tail -n +2 good.txt | jq -R . | jq -s --slurpfile vocab good.json '{normalizer: {type: "Sequence", normalizers: [{type: "NFC"},
		{type: "Lowercase"}]}, model: {type: "BPE", end_of_word_suffix: "</w>", continuing_subword_prefix: "", vocab: $vocab[0], merges: .}}' |
		jq "$1" >m/tokenizer.json
}

# changed REASON FILTER: tokenizer.json after this jq filter.
changed() {
	tokenizer "$2"
	refuses 3 "m/tokenizer.json: $1"
}

# added LINE REASON: merges.txt with one more line.
added() {
	{ cat good.txt; printf "$1"; } >m/merges.txt
	refuses 3 "m/merges.txt:$((lines + 1)): $2"
}

@test "the four ways to store them give the same bytes" {
	"$BIN/text-encode" --model m -o a s
	sed 's/$/\r/' good.txt >m/merges.txt
	"$BIN/text-encode" --model m -o b s
	tail -n +2 good.txt >m/merges.txt
	"$BIN/text-encode" --model m -o c s
	tokenizer .
	"$BIN/text-encode" --model m -o d s
	tokenizer '.normalizer = {type: "Lowercase"} | del(.model.type, .model.continuing_subword_prefix) | .model.merges |= map(split(" "))'
	"$BIN/text-encode" --model m -o e s
	rm m/tokenizer.json
	cp good.txt m/merges.txt
	"$BIN/text-encode" --model m -o f s
	rm m/merges.txt
	cp o/*.gz m
	"$BIN/text-encode" --model m -o g s
	for other in b c d e f g; do cmp a $other; done
}

@test "none of them, or one without the other" {
	rm m/merges.txt
	refuses 3 'm: has vocab.json, but no merges.txt'
	rm m/vocab.json
	refuses 4 'm: has no merges.txt, tokenizer.json or bpe_simple_vocab_16e6.txt.gz'
}

@test "tokenizers of other kinds" {
	only="only CLIP's tokenizers are read"
	changed "model: 'type' is not \"BPE\": $only" '.model.type = "WordPiece"'
	changed "model: 'end_of_word_suffix' is not \"</w>\": $only" 'del(.model.end_of_word_suffix)'
	changed "model: 'continuing_subword_prefix' is not \"\": $only" '.model.continuing_subword_prefix = "##"'
	changed "normalizer: no 'Lowercase': $only" '.normalizer.normalizers |= map(select(.type != "Lowercase"))'
	changed "normalizer: no 'Lowercase': $only" '.normalizer = null'
	changed "model: 'vocab' is not an object" '.model.vocab = []'
	changed "model: 'merges' is not a list" 'del(.model.merges)'
	changed 'merge 1: not two symbols with a space between' '.model.merges[1] = ["a"]'
	changed 'merge 1: not two symbols with a space between' '.model.merges[1] = ["a", 2]'
	changed 'merge 1: not two symbols with a space between' '.model.merges[1] = "ab"'
	changed "merge 2: the vocabulary lacks 'zz', 'q' or the two in one" '.model.merges[2] = ["zz", "q"]'
}

@test "tokens" {
	for id in -1 1.5 '"7"' 2147483647; do
		jq ".a = $id" good.json >m/vocab.json
		refuses 3 "m/vocab.json: token 'a': its id is not a whole number from 0"
	done
	for token in a 'a</w>' Ń 'Ā</w>' '<|startoftext|>' '<|endoftext|>'; do
		jq --arg token "$token" 'del(.[$token])' good.json >m/vocab.json
		refuses 3 "m/vocab.json: token '$token' is missing"
	done
	sed 's/"b"/"a"/' good.json >m/vocab.json
	refuses 3 "m/vocab.json: token 'a' appears twice"
	echo '["a"]' >m/vocab.json
	refuses 3 'm/vocab.json: not a JSON object'
	jq '.more = 9999' good.json >m/vocab.json
	refuses 3 "m: token 'more' has id 9999, but vocab_size is $(jq .text_config.vocab_size m/config.json)"
}

@test "merges" {
	for line in 'a\n' 'a \n' ' a\n' 'a b c\n' '\n' 'a  b\n'; do added "$line" 'not two symbols with a space between'; done
	added 'a\xff b\n' 'not UTF-8'
	added 'q zz\n' "the vocabulary lacks 'q', 'zz' or the two in one"
	added '7 q\n' "the vocabulary lacks '7', 'q' or the two in one"
	added "$(sed -n 2p good.txt)\n" "the merge '$(sed -n 2p good.txt)' appears twice"
	{ cat good.txt; printf 'a\0b\n'; } >m/merges.txt
	refuses 3 "m/merges.txt: a NUL byte at offset $(($(wc -c <good.txt) + 1))"
	: >m/merges.txt
	"$BIN/text-encode" --model m -o out s
}

@test "merges without a vocabulary" {
	rm m/vocab.json
	# more than the vocabulary has room for are not looked at, fewer leave ids that are too small for a tower
	{ cat good.txt; echo 'not a merge'; } >m/merges.txt
	"$BIN/text-encode" --model m -o a s
	{ sed -n 1,2p good.txt; sed -n '2p;4,$p' good.txt; } >m/merges.txt
	first=$(sed -n 2p good.txt)
	refuses 3 "m/merges.txt:3: token '${first/ /}' appears twice"
	{ head -n 1 good.txt; printf '%0600d b\n' 0; tail -n +3 good.txt; } >m/merges.txt
	refuses 3 'm/merges.txt:2: a symbol of 601 bytes'
	{ head -n 1 good.txt; echo 'jjj b'; tail -n +3 good.txt; } >m/merges.txt
	refuses 3 "m/merges.txt:2: the vocabulary lacks 'jjj', 'b' or the two in one"
}

@test "gzip that is damaged, cut short or not gzip" {
	list=o/bpe_simple_vocab_16e6.txt.gz
	cp $list whole
	head -c $(($(wc -c <whole) - 20)) whole >$list
	refuses 3 "$list: the gzip stream is damaged" o
	{ head -c 100 whole; printf 'xxxxxxxxxxxx'; tail -c +113 whole; } >$list
	refuses 3 "$list: the gzip stream is damaged" o
	head -c 70000000 /dev/zero | tr '\0' a | gzip -1 >$list
	refuses 3 "$list: more than 67108864 bytes of merges" o
	cp good.txt $list
	"$BIN/text-encode" --model o -o out s
}

@test "files cut short anywhere: one line, or fewer merges, never a crash" {
	for n in $(seq 0 97 "$(wc -c <good.txt)"); do
		head -c "$n" good.txt >m/merges.txt
		status=0
		"$BIN/text-encode" --model m -o out s 2>err || status=$?
		[ $status = 0 ] || { [ $status = 3 ] && [ "$(wc -l <err)" = 1 ]; }
	done
	cp good.txt m/merges.txt
	for n in $(seq 0 371 $(($(wc -c <good.json) - 3))); do
		head -c "$n" good.json >m/vocab.json
		status=0
		"$BIN/text-encode" --model m -o out s 2>err || status=$?
		[ $status = 3 ] && grep -qE '^text-encode: m/vocab.json: not JSON at offset [0-9]+$' err
	done
}
