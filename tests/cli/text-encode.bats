#!/usr/bin/env bats
# text-encode on the tiny encoder of tests/golden/bert, whose expected vectors tests/peers/bert.py made in float64.

setup() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	GOLDEN=$BATS_TEST_DIRNAME/../golden
	load ../format/files
	cd "$BATS_TEST_TMPDIR"
	cp -r "$GOLDEN/bert" model
	mv model/sentences.jsonl .
}

encode() {
	"$BIN/text-encode" -q --model model "$@"
}

# header FILE: the JSON of a safetensors file.
header() {
	head -c $((8 + $(od -An -tu8 -N8 "$1"))) "$1" | tail -c +9
}

# tensor FILE NAME TYPE WIDTH: the numbers of a tensor, one a line; TYPE and WIDTH (bytes) as od has them.
tensor() {
	local begin end
	read -r begin end < <(header "$1" | jq -r ".\"$2\".data_offsets | \"\(.[0]) \(.[1])\"")
	od -An -v -t "$3" -w"$4" -j $((8 + $(od -An -tu8 -N8 "$1") + begin)) -N $((end - begin)) "$1"
}

# Fails where the command succeeds; a plain ! would let the test go on.
not() { ! "$@"; }

@test "words and offsets agree with float64" {
	encode -o text sentences.jsonl
	cmp <(tensor text offsets d8 8) <(tensor "$GOLDEN/bert-expected.safetensors" offsets d8 8)
	paste <(tensor text words f4 4) <(tensor "$GOLDEN/bert-expected.safetensors" words f4 4) |
		awk '{ d = $1 - $2; if (d < 0) d = -d; if (d > worst) worst = d }
			END { print NR, worst; exit !(NR > 10000 && worst < 1e-5) }'
}

@test "a sentence's vector is the mean of its words, and zero where it has none" {
	printf '%s\n' '{"ref":"a","object":"x","text":"red cup"}' '{"ref":"b","object":"x","text":" "}' | encode -o text
	[ "$(header text | jq -c '[.words.shape, .sentences.shape]')" = '[[2,24],[2,24]]' ]
	paste <(tensor text words f4 4 | head -n 24) <(tensor text words f4 4 | tail -n 24) <(tensor text sentences f4 4 | head -n 24) |
		awk '{ d = ($1 + $2) / 2 - $3; if (d < -1e-6 || d > 1e-6) exit 1 }'
	[ "$(tensor text sentences f4 4 | tail -n 24 | sort -u | tr -d ' ')" = 0 ]
}

# rows FILE: its word vectors, a line each.
rows() {
	tensor "$1" words x4 4 | xargs -n 24
}

@test "--words static: the vocabulary's rows, the same for a word in any sentence; contextual ones are not" {
	printf '{"ref":"%s","object":"x","text":"%s"}\n' a "red cup" b "cup red cup unbelievable" c "cup" d " " >few
	encode --words static -o static few
	encode --words contextual -o contextual few
	encode -o default few
	cmp contextual default
	cmp <(tensor static offsets d8 8) <(tensor default offsets d8 8)
	[ "$(header static | jq -c .words.shape)" = "$(header default | jq -c .words.shape)" ]
	rows static >s
	rows default >c
	at() { sed -n "$2p" "$1"; }
	[ "$(at s 2)" = "$(at s 3)" ] && [ "$(at s 2)" = "$(at s 5)" ] && [ "$(at s 1)" = "$(at s 4)" ]
	[ "$(at s 1)" != "$(at s 2)" ]
	[ "$(at c 2)" != "$(at c 3)" ] && [ "$(at c 3)" != "$(at c 5)" ] && [ "$(at c 1)" != "$(at c 4)" ]
	# Row 2 is the very row of "cup" in the encoder's table, halves in its file.
	id=$(($(grep -nxF cup model/vocab.txt | cut -d: -f1) - 1))
	begin=$(header model/model.safetensors | jq '."embeddings.word_embeddings.weight".data_offsets[0]')
	start=$((8 + $(od -An -tu8 -N8 model/model.safetensors) + begin + id * 48))
	paste <(tensor static words f4 4 | sed -n 25,48p) <(od -An -v -t u2 -w2 -j $start -N 48 model/model.safetensors) | awk '
		{ e = int($2 / 1024) % 32; m = $2 % 1024; v = e ? (1 + m / 1024) * 2 ^ (e - 15) : m * 2 ^ -24
		if ($2 >= 32768) v = -v
		if ($1 - v > 1e-6 || v - $1 > 1e-6) exit 1 } END { exit NR != 24 }'
	# The mean is of these.
	paste <(tensor static words f4 4 | head -n 24) <(tensor static words f4 4 | sed -n 25,48p) <(tensor static sentences f4 4 | head -n 24) |
		awk '{ d = ($1 + $2) / 2 - $3; if (d < -1e-6 || d > 1e-6) exit 1 }'
	[ "$(header static | jq -r .__metadata__.options)" = '--model model --words static' ]
	[ "$(header contextual | jq -r .__metadata__.options)" = '--model model' ]
	"$BIN/gs-check" static
}

@test "--words static: many sentences, one or two threads, and a sentence that is cut" {
	encode --words static -o a sentences.jsonl
	encode --words static --threads 1 -o b sentences.jsonl
	cmp a b
	encode -o c sentences.jsonl
	cmp <(tensor a offsets d8 8) <(tensor c offsets d8 8)
	for i in 1 2 3; do sed "s/\"ref\": \"/&$i/" sentences.jsonl; done >thrice
	encode --words static -o three thrice
	for i in 1 2 3; do tensor a words x4 4; done | cmp - <(tensor three words x4 4)
	printf '{"ref":"long","object":"x","text":"%s"}\n' "$(printf 'cup %.0s' {1..63})" >long
	says 0 "text-encode: warning: ref 'long': 63 word pieces, cut to the 62 that the encoder takes" \
		"$BIN/text-encode" --words static --model model -o text long
	[ "$(header text | jq .words.shape[0])" = 62 ]
}

@test "--words: a third way is refused" {
	says 2 "text-encode: --words: 'mean' is not one of contextual|static
Try 'text-encode --help'." "$BIN/text-encode" --model model --words mean sentences.jsonl
}

@test "names, splits and texts come along" {
	LC_ALL=C sed -i '/[\x80-\xff]\|\\u/d' sentences.jsonl # whose blanks and accents may change
	encode -o text sentences.jsonl
	for key in ref object text split; do
		cmp <(header text | jq -r ".__metadata__.${key}s | fromjson[] | tojson") <(jq ".$key | tojson | fromjson | tojson" -r sentences.jsonl)
	done
	[ "$(header text | jq -r '.__metadata__ | "\(.format) \(.version) \(.tool) \(.options) \(.seed)"')" = \
		'refer.text 1 text-encode --model model 0' ]
	"$BIN/gs-check" text
}

@test "stdin, - and a file give the same bytes; so do 1 and 2 threads, and stdout" {
	encode -o a sentences.jsonl
	encode -o b <sentences.jsonl
	encode - >c <sentences.jsonl
	encode --threads 1 -o d sentences.jsonl
	encode --threads 2 -o e sentences.jsonl
	encode --model ./model/ -o f sentences.jsonl
	for other in b c d e f; do cmp a $other; done
}

@test "what a sentence gives does not depend on the others" {
	for i in 1 2 3; do sed "s/\"ref\": \"/&$i/" sentences.jsonl; done >thrice
	encode -o one sentences.jsonl
	encode -o three thrice
	[ "$(header three | jq .words.shape[0])" -gt 2048 ] # more than two passes
	for i in 1 2 3; do tensor one words x4 4; done | cmp - <(tensor three words x4 4)
}

@test "vocab.txt does as well as tokenizer.json" {
	encode -o a sentences.jsonl
	rm model/tokenizer.json
	encode -o b sentences.jsonl
	cmp a b
}

@test "weights under another name" {
	encode -o a sentences.jsonl
	mv model/model.safetensors model/weights.fp16.safetensors
	encode -o b sentences.jsonl
	cmp a b
}

@test "a sentence that is too long is cut, with a warning that -q silences" {
	printf '{"ref":"long","object":"x","text":"%s"}\n' "$(printf 'cup %.0s' {1..63})" >long
	says 0 "text-encode: warning: ref 'long': 63 word pieces, cut to the 62 that the encoder takes" \
		"$BIN/text-encode" --model model -o text long
	[ "$(header text | jq .words.shape[0])" = 62 ]
	says 0 '' "$BIN/text-encode" -q --model model -o text long
	sed -i 's/cup cup/cup/' long
	says 0 '' "$BIN/text-encode" --model model -o text long
	[ "$(header text | jq .words.shape[0])" = 62 ]
}

@test "-v tells sentences, words, time and memory" {
	"$BIN/text-encode" -qv --model model -o text sentences.jsonl 2>err
	grep -x 'text-encode: 38 sentences, 843 words of width 24' err
	grep -xE 'text-encode: [0-9.]+ s, peak memory [0-9.]+ MiB' err
}

@test "without --model, the encoder is where make encoder puts it, or is missed by name" {
	encode -o expected sentences.jsonl
	mkdir -p cache/refersplat home/.cache
	says 4 "text-encode: $PWD/cache/refersplat/encoder: no encoder there: 'refersplat-encoder' fetches one, in a checkout 'make encoder'" \
		env XDG_CACHE_HOME="$PWD/cache" "$BIN/text-encode" -o text sentences.jsonl
	says 4 "text-encode: $PWD/home/.cache/refersplat/encoder: no encoder there: 'refersplat-encoder' fetches one, in a checkout 'make encoder'" \
		env -u XDG_CACHE_HOME HOME="$PWD/home" "$BIN/text-encode" -o text sentences.jsonl
	says 2 "text-encode: no encoder is named, and HOME is not set
Try 'text-encode --help'." env -u XDG_CACHE_HOME -u HOME "$BIN/text-encode" -o text sentences.jsonl
	[ ! -e text ]
	mv model cache/refersplat/encoder
	ln -s ../../cache/refersplat home/.cache/refersplat
	XDG_CACHE_HOME=$PWD/cache "$BIN/text-encode" -q -o one sentences.jsonl
	env -u XDG_CACHE_HOME HOME="$PWD/home" "$BIN/text-encode" -q -o two sentences.jsonl
	cmp one two
	cmp <(tensor one words x4 4) <(tensor expected words x4 4)
}

@test "plain text: a test sentence a line, its number for a ref" {
	printf 'the red cup\n\n  \r\nthe big mug\r\ntasse à café' | encode -o text
	[ "$(header text | jq -c '.__metadata__ | [.texts, .refs, .objects, .splits | fromjson]')" = \
		'[["the red cup","the big mug","tasse à café"],["1","4","5"],["?","?","?"],["test","test","test"]]' ]
	printf '{"ref":"%s","object":"?","text":"%s","split":"test"}\n' 1 "the red cup" 4 "the big mug" 5 "tasse à café" | encode -o json
	cmp text json
	printf 'the red cup\n\n  \r\nthe big mug\r\ntasse à café' >plain
	encode plain | cmp - text
	{ printf '\xef\xbb\xbf'; cat plain; } | encode - | cmp - text
	iconv -f UTF-8 -t UTF-16 plain | encode - | cmp - text
	printf '{"ref":"%s","object":"?","text":"%s","split":"test"}\n' 1 "the red cup" 4 "the big mug" 5 "tasse à café" |
		iconv -f UTF-8 -t UTF-16 | encode - | cmp - text
	"$BIN/gs-check" text
	printf '\xef\xbd\x94he\xe2\x80\x89red\xe3\x80\x80cup\n\n\nthe\xc2\xa0b\xc2\xadig \xe2\x80\x8bmug\ntasse à cafe\xcc\x81' | encode - | cmp - text
	printf '1. the red cup\r\r\r4)\tthe big mug\r7\ttasse à café' | encode - >numbers # of old programs, numbered
	[ "$(header numbers | jq -c '.__metadata__.texts | fromjson')" = '["the red cup","the big mug","tasse à café"]' ]
	printf '# mine\n- the red cup\n"the big mug"\n\xe2\x80\xa2 3: tasse à café\n##\n' | encode - >marks
	[ "$(header marks | jq -c '.__metadata__ | [.texts, .refs] | map(fromjson)')" = '[["the red cup","the big mug","tasse à café"],["2","3","4"]]' ]
	printf '# mine\n' >none.txt
	says 3 'text-encode: none.txt: holds no sentences' "$BIN/text-encode" --model model -o none none.txt
	printf 'PK\3' >zip
	says 3 'text-encode: zip:1: a sentence that has a control character at byte 3: is the file text?' "$BIN/text-encode" --model model -o none zip
	printf 'cup\ncaf\xe9\n' >latin
	says 3 'text-encode: latin:2: not UTF-8 at byte 4: save the file as UTF-8' "$BIN/text-encode" --model model -o none latin
	printf 'cup\nc\0p\n' >nul
	says 3 'text-encode: nul:2: a NUL byte at column 2' "$BIN/text-encode" --model model -o none nul
	printf 'the cup, on the left\nthe mug,red\n' | encode - >commas
	printf 'object,text\ncup,the red cup\n' >table.csv
	printf '1\tcup\tthe red cup\n' >table
	printf 'object;"text"\ncup;the red cup\n' >table.txt
	printf '1,cup,the red cup\n2,"mug","the mug"\n' >rows
	printf 'cup | the red cup\nmug|the mug\n' >bars
	printf "text: the red cup\n" >x.yml
	for file in table.csv table table.txt rows bars x.yml; do
		says 3 "text-encode: $file: a table: write a sentence on each line, or JSON Lines" "$BIN/text-encode" --model model -o none $file
	done
	says 3 'text-parse: latin: text, not safetensors: of sentences text-encode makes them' "$BIN/text-parse" -o none latin
	# what begins as JSON may is JSON
	for first in '[' ' {' $'\xef\xbb\xbf{'; do
		echo "$first" >odd
		not "$BIN/text-encode" --model model -o none odd 2>err
		grep -qE '^text-encode: odd:1: not (JSON|a JSON object)' err
	done
	[ ! -e none ]
}

@test "--names: a training sentence for each object that has a mask" {
	for object in 'red cup' mug 'red cup' plate; do
		printf '{"view":"v1","object":"%s","segmentation":{"size":[2,3],"counts":"221O"}}\n' "$object"
	done >masks
	encode --names -o text masks
	printf '{"ref":"%s","object":"%s","text":"%s"}\n' 'red cup' 'red cup' 'red cup' mug mug mug plate plate plate | encode | cmp - text
	echo '{"view":"v1","ref":"r","segmentation":{"size":[2,3],"counts":"221O"}}' >nameless
	says 3 'text-encode: nameless: names no objects' "$BIN/text-encode" --names --model model -o none nameless
	says 3 "text-encode: sentences.jsonl:1: key 'view' is missing" "$BIN/text-encode" --names --model model -o none sentences.jsonl
	[ ! -e none ]
}

@test "a second operand is refused" {
	says 2 "text-encode: unexpected operand 'b'
Try 'text-encode --help'." "$BIN/text-encode" --model model a b
}

@test "missing and empty sentences, and none that can be written: exact messages, no file left" {
	mkdir empty && cd empty
	says 4 'text-encode: none: No such file or directory' "$BIN/text-encode" --model ../model -o text none
	says 3 'text-encode: /dev/null: holds no sentences' "$BIN/text-encode" --model ../model -o text /dev/null
	says 4 'text-encode: no/text: No such file or directory' "$BIN/text-encode" -q --model ../model -o no/text ../sentences.jsonl
	says 4 'text-encode: ..: Is a directory' "$BIN/text-encode" --model ../model -o text ..
	[ -z "$(ls -A)" ]
}

@test "an old output stays when a new one fails" {
	echo old >text
	not encode -o text /dev/null
	[ "$(cat text)" = old ]
}

@test "sentences cut short anywhere give an error or fewer sentences, never a crash" {
	head -n 2 sentences.jsonl >two
	for ((n = 0; n < $(wc -c <two); n++)); do
		status=0
		head -c $n two | encode -o text 2>/dev/null || status=$?
		[ $status = 3 ] || { [ $status = 0 ] && [ $n -ge "$(head -n 1 two | wc -c)" ] || [ $n = $(($(head -n 1 two | wc -c) - 1)) ]; }
	done
}
