#!/usr/bin/env bats
# Each rule of formats/encoders/vocab.md broken once.

setup() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	load files
	cd "$BATS_TEST_TMPDIR"
	cp -r "$BATS_TEST_DIRNAME/../golden/bert" m
	cp m/tokenizer.json good.json
	echo '{"ref":"a","object":"o","text":"red cup"}' >s
}

# refuses STATUS REASON: text-encode on the folder m.
refuses() {
	says "$1" "text-encode: $2" "$BIN/text-encode" --model m -o out s
	[ ! -e out ]
}

# changed REASON FILTER: tokenizer.json after this jq filter.
changed() {
	jq "$2" good.json >m/tokenizer.json
	refuses 3 "m/tokenizer.json: $1"
}

@test "what may be null or absent" {
	jq 'del(.model.type, .model.unk_token, .model.continuing_subword_prefix, .model.max_input_chars_per_word,
		.truncation, .padding, .normalizer.clean_text) | .normalizer.lowercase = null' good.json >m/tokenizer.json
	"$BIN/text-encode" --model m -o out s
}

@test "no folder, no tokenizer" {
	rm m/tokenizer.json m/vocab.txt
	refuses 4 'm: has neither tokenizer.json nor vocab.txt'
	rm -r m
	refuses 4 'm: No such file or directory'
}

@test "tokenizers of other kinds" {
	only='only uncased BERT tokenizers are read'
	changed "normalizer: 'type' is not \"BertNormalizer\": $only" '.normalizer.type = "NFC"'
	changed "normalizer: 'type' is not \"BertNormalizer\": $only" '.normalizer = null'
	for flag in clean_text handle_chinese_chars strip_accents lowercase; do
		changed "normalizer: '$flag' is not true: $only" ".normalizer.$flag = false"
	done
	changed "pre_tokenizer: 'type' is not \"BertPreTokenizer\": $only" '.pre_tokenizer.type = "ByteLevel"'
	changed "model: 'type' is not \"WordPiece\": $only" '.model.type = "BPE"'
	changed "model: 'unk_token' is not \"[UNK]\": $only" '.model.unk_token = "<unk>"'
	changed "model: 'continuing_subword_prefix' is not \"##\": $only" '.model.continuing_subword_prefix = "@@"'
	changed "model: 'max_input_chars_per_word' is not 100" '.model.max_input_chars_per_word = 200'
	changed "model: 'max_input_chars_per_word' is not 100" '.model.max_input_chars_per_word = "100"'
}

@test "tokens" {
	changed "model: 'vocab' is not an object" 'del(.model.vocab)'
	changed "model: 'vocab' is not an object" '.model.vocab = ["a"]'
	for id in -1 1.5 '"7"' 2147483647 1e300; do
		changed "token 'red': its id is not a whole number from 0" ".model.vocab.red = $id"
	done
	for token in UNK CLS SEP; do changed "token '[$token]' is missing" "del(.model.vocab[\"[$token]\"])"; done
	sed 's/"##cup"\|"cup"/"red"/' good.json >m/tokenizer.json
	refuses 3 "m/tokenizer.json: token 'red' appears twice"
	sed 's/"red"/"r\xffd"/' good.json >m/tokenizer.json
	refuses 3 "m/tokenizer.json: token with id $(jq .model.vocab.red good.json) is not UTF-8"
}

@test "an id past the encoder's words" {
	jq '.model.vocab.red = 9999' good.json >m/tokenizer.json
	refuses 3 "m: token 'red' has id 9999, but vocab_size is $(jq .vocab_size m/config.json)"
}

@test "tokenizer.json cut short anywhere" {
	for n in $(seq 0 37 $(($(wc -c <good.json) - 2))); do
		head -c "$n" good.json >m/tokenizer.json
		status=0
		"$BIN/text-encode" --model m -o out s 2>err || status=$?
		[ $status = 3 ] && grep -qE '^text-encode: m/tokenizer.json: not JSON at offset [0-9]+$' err
	done
}

@test "vocab.txt" {
	rm m/tokenizer.json
	cp m/vocab.txt good.txt
	sed 's/$/\r/' good.txt >m/vocab.txt
	"$BIN/text-encode" --model m -o crlf s
	cp good.txt m/vocab.txt
	"$BIN/text-encode" --model m -o lf s
	cmp crlf lf
	n=$(wc -l <good.txt)
	echo red >>m/vocab.txt
	refuses 3 "m/vocab.txt:$((n + 1)): token 'red' appears twice"
	{ cat good.txt; printf 'a\xff\n'; } >m/vocab.txt
	refuses 3 "m/vocab.txt:$((n + 1)): not UTF-8"
	{ cat good.txt; printf 'a\0b\n'; } >m/vocab.txt
	refuses 3 "m/vocab.txt: a NUL byte at offset $(($(wc -c <good.txt) + 1))"
	grep -vF '[SEP]' good.txt >m/vocab.txt
	refuses 3 "m/vocab.txt: token '[SEP]' is missing"
	: >m/vocab.txt
	refuses 3 "m/vocab.txt: token '[UNK]' is missing"
}

@test "tokenizer_config.json beside vocab.txt" {
	rm m/tokenizer.json
	echo '{"do_lower_case":true,"strip_accents":null}' >m/tokenizer_config.json
	"$BIN/text-encode" --model m -o out s && rm out
	echo '{"do_lower_case":false}' >m/tokenizer_config.json
	refuses 3 "m/tokenizer_config.json: tokenizer: 'do_lower_case' is not true: only uncased BERT tokenizers are read"
	echo '{' >m/tokenizer_config.json
	refuses 3 'm/tokenizer_config.json: not JSON at offset 2'
}
