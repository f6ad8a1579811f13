#!/usr/bin/env bats
# text-encode on the tiny text tower of tests/golden/clip and the same in OpenCLIP's layout, whose expected vectors
# tests/peers/clip.py made in float64; and what the tools make of its files.

setup() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	GOLDEN=$BATS_TEST_DIRNAME/../golden
	load ../format/files
	cd "$BATS_TEST_TMPDIR"
	export OMP_WAIT_POLICY=passive
	cp -r "$GOLDEN/clip" model
	mv model/sentences.jsonl .
	mkdir open
	cp -r "$GOLDEN/open-clip" open/model
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

# near NAME LEAST: a tensor of text is that of the float64 peer, and has more than LEAST numbers.
near() {
	paste <(tensor text "$1" f4 4) <(tensor "$GOLDEN/clip-expected.safetensors" "$1" f4 4) |
		awk -v least="$2" '{ d = $1 - $2; if (d < 0) d = -d; if (d > worst) worst = d }
			END { print NR, worst; exit !(NR > least && NF == 2 && worst < 1e-5) }'
}

# pieces TEXT: the word pieces that it has.
pieces() {
	printf '%s\n' "$1" | encode -o one
	header one | jq -r '.__metadata__.pieces | fromjson[0]'
}

# Fails where the command succeeds; a plain ! would let the test go on.
not() { ! "$@"; }

@test "words, offsets and sentences agree with float64" {
	encode -o text sentences.jsonl
	cmp <(tensor text offsets d8 8) <(tensor "$GOLDEN/clip-expected.safetensors" offsets d8 8)
	near words 10000
	near sentences 700
	[ "$(header text | jq -c '.words.shape[1], .sentences.shape[1]' | sort -u)" = 20 ]
	"$BIN/gs-check" text
}

@test "both layouts, stdin, one thread and two give the same bytes" {
	encode -o a sentences.jsonl
	"$BIN/text-encode" -q --model open/model -o b sentences.jsonl
	cmp a b
	encode --threads 1 - >c <sentences.jsonl
	encode --threads 2 -o d sentences.jsonl
	cmp a c
	cmp a d
}

@test "a sentence's vector is its end's: it does not depend on other sentences, and there is one without words" {
	printf '{"ref":"%s","object":"x","text":"%s"}\n' a "red cup" b " " >two
	encode -o two.safetensors two
	printf '{"ref":"%s","object":"x","text":"%s"}\n' a "red cup" >one
	encode -o one.safetensors one
	cmp <(tensor two.safetensors sentences x4 4 | head -n 20) <(tensor one.safetensors sentences x4 4)
	[ "$(tensor two.safetensors sentences f4 4 | tail -n 20 | sort -u | wc -l)" = 20 ]
	# no mean of the words
	not cmp -s <(tensor one.safetensors sentences x4 4) <(tensor one.safetensors words x4 4 | tail -n 20)
	# what comes after an end that is written out is not seen by it
	printf '{"ref":"a","object":"x","text":"red cup<|endoftext|> and more"}\n' >more
	encode -o more.safetensors more
	paste <(tensor more.safetensors sentences f4 4) <(tensor one.safetensors sentences f4 4) |
		awk '{ d = $1 - $2; if (d < -1e-5 || d > 1e-5) exit 1 }'
}

@test "without a projection vectors are the tower's own; gelu is another activation than quick_gelu" {
	encode -o projected sentences.jsonl
	jq '.text_config.hidden_act = "gelu"' model/config.json >c && mv c model/config.json
	encode -o gelu sentences.jsonl
	not cmp -s <(tensor projected words x4 4) <(tensor gelu words x4 4)
	jq '.text_config | .model_type = "clip_text_model"' "$GOLDEN/clip/config.json" >model/config.json
	encode -o flat sentences.jsonl
	cmp flat projected
	# as a file of CLIPTextModel: the projection is not there
	sed -i 's/"text_projection.weight"/"text_projection.absent"/' model/model.safetensors
	encode -o own sentences.jsonl
	[ "$(header own | jq .words.shape[1])" = 24 ]
	jq '.architectures = ["CLIPTextModelWithProjection"]' model/config.json >c && mv c model/config.json
	says 3 "text-encode: model/model.safetensors: tensor 'text_projection.weight' is missing" \
		"$BIN/text-encode" --model model -o none sentences.jsonl
	[ ! -e none ]
}

@test "--words static: the rows of the token table, of the tower's width" {
	printf '{"ref":"%s","object":"x","text":"%s"}\n' a "red cup" b "cup red" >two
	encode --words static -o static two
	[ "$(header static | jq .words.shape[1])" = 24 ]
	n=$(($(header static | jq .words.shape[0]) / 2))
	cmp <(tensor static words x4 4 | xargs -n 24 | sort) <(tensor static words x4 4 | xargs -n 24 | sort | uniq -d | sed p)
	[ "$(tensor static words x4 4 | xargs -n 24 | sort -u | wc -l)" = $n ]
	encode -o contextual two
	not cmp -s <(header static | jq .__metadata__.encoder) <(header contextual | jq .__metadata__.encoder)
}

@test "pieces read as a BERT's do: words begin without ##, letters are the text's" {
	[ "$(pieces 'the Cup')" = 'the cup' ]
	[ "$(pieces 'cups, zq' | tr -d ' #')" = 'cups,zq' ]
	[ "$(pieces zq)" = 'z ##q' ]
	[ "$(pieces "it's")" = "it 's" ]
	[ "$(pieces 'É')" = 'é' ]
}

@test "a sentence that is too long is cut to 75 tokens, with a warning that -q silences" {
	printf '{"ref":"long","object":"x","text":"%s"}\n' "$(printf 'the %.0s' {1..76})" >long
	says 0 "text-encode: warning: ref 'long': 76 word pieces, cut to the 75 that the encoder takes" \
		"$BIN/text-encode" --model model -o text long
	[ "$(header text | jq .words.shape[0])" = 75 ]
	says 0 '' "$BIN/text-encode" -q --model model -o text long
	# the tokens after the cut do not matter
	sed 's/the "/cup "/' long >other
	encode -o b other
	cmp <(tensor text sentences x4 4) <(tensor b sentences x4 4)
}

@test "other merges have another fingerprint" {
	encode -o a sentences.jsonl
	sed -i '$d' model/merges.txt
	encode -o b sentences.jsonl
	not cmp -s <(header a | jq .__metadata__.encoder) <(header b | jq .__metadata__.encoder)
}

@test "an output may not be a file of the encoder" {
	for part in config.json vocab.json merges.txt model.safetensors; do
		run "$BIN/text-encode" --model model -o model/$part sentences.jsonl
		[ "$status" = 2 ]
	done
	run "$BIN/text-encode" --model open/model -o open/model/bpe_simple_vocab_16e6.txt.gz sentences.jsonl
	[ "$status" = 2 ]
	encode -o text sentences.jsonl
}

@test "features and questions by CLIP: feature-lift, feature-query, refer-lift, refer-ask" {
	"$BIN/gs-synth" -q --objects 3 --views 5 --size 64x48 --gaussians 2000 -o .
	"$BIN/gs-import" -q --images images --test-views "$(cat test-views)" -o scene point_cloud.ply
	"$BIN/gs-weigh" -q -o weights scene
	jq -c --arg test "$(cat test-views)" 'select(.view as $v | $test | split(",") | index($v) | not)' truth.jsonl >masks.jsonl
	jq -c '.text = .object' sentences.jsonl >plain.jsonl
	encode -o text.safetensors plain.jsonl
	jq -c '.object as $o | {ref: $o, object: $o, text: $o, split: "train"}' sentences.jsonl | sort -u >names.jsonl
	encode -o names.safetensors names.jsonl
	"$BIN/feature-lift" -q --scene scene --weights weights --masks masks.jsonl --text names.safetensors --uncovered zero \
		--prune 0.5 -o features.safetensors
	printf '%s\n' object things stuff texture | encode -o canonical.safetensors
	"$BIN/feature-query" -q --text text.safetensors --rule relevancy --canonical canonical.safetensors -o relevant features.safetensors
	"$BIN/gs-check" relevant
	"$BIN/feature-query" -q --text text.safetensors -o selection features.safetensors
	"$BIN/refer-render" -q --scene scene --text text.safetensors --model selection --sentences test -o predicted.jsonl
	[ "$("$BIN/miou-score" --json -q --predicted-views --truth truth.jsonl predicted.jsonl | jq '.miou > 0.8')" = true ]
	"$BIN/refer-lift" -q --scene scene --weights weights --text names.safetensors --masks masks.jsonl -o lifted.safetensors
	mkdir run && ln -s ../scene run/scene && cp lifted.safetensors run/
	name=$(jq -r .object names.jsonl | head -n 1)
	"$BIN/refer-ask" --encoder model --scene scene --model lifted.safetensors run "where is the $name?" >answer
	grep -q "^$name: " answer
}
