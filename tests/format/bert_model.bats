#!/usr/bin/env bats
# Each rule of formats/encoders/bert_model.md broken once. Types, prefixes, old names and shapes: tests/unit/test_bert.c.

setup() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	load files
	cd "$BATS_TEST_TMPDIR"
	cp -r "$BATS_TEST_DIRNAME/../golden/bert" m
	cp m/config.json good.json
	echo '{"ref":"a","object":"o","text":"red cup"}' >s
}

refuses() {
	says "$1" "text-encode: $2" "$BIN/text-encode" --model m -o out s
	[ ! -e out ]
}

# changed REASON FILTER: config.json after this jq filter.
changed() {
	jq "$2" good.json >m/config.json
	refuses 3 "m/config.json: $1"
}

# tensor_at NAME: the offset of a tensor's data in the file.
tensor_at() {
	local length
	length=$(od -An -tu8 -N8 m/model.safetensors)
	echo $((8 + length + $(head -c $((8 + length)) m/model.safetensors | tail -c +9 | jq ".\"$1\".data_offsets[0]")))
}

# Fails where the command succeeds; a plain ! would let the test go on.
not() { ! "$@"; }

@test "what may be absent" {
	jq 'del(.model_type, .layer_norm_eps) | .position_embedding_type = "absolute"' good.json >m/config.json
	"$BIN/text-encode" --model m -o out s
}

@test "config.json missing, no JSON, no object" {
	rm m/config.json
	refuses 4 'm/config.json: No such file or directory'
	echo '{"vocab_size":}' >m/config.json
	refuses 3 'm/config.json: not JSON at offset 14'
	echo '[]' >m/config.json
	refuses 3 'm/config.json: not a JSON object'
}

@test "numbers out of range" {
	while read -r key max; do
		for value in 0 -1 1.5 '"5"' null $((max + 1)); do
			changed "key '$key' is not a whole number from 1 to $max" ".$key = $value"
		done
	done <<-END
		vocab_size 10000000
		hidden_size 65536
		num_hidden_layers 1000
		num_attention_heads 65536
		intermediate_size 1048576
		max_position_embeddings 1048576
		type_vocab_size 65536
	END
	for value in -1 2 '"x"'; do
		changed "key 'layer_norm_eps' is not a number from 0 to 1" ".layer_norm_eps = $value"
	done
	changed 'hidden_size 24 is not a multiple of num_attention_heads 5' '.num_attention_heads = 5'
	changed 'max_position_embeddings 2 leaves no room for words' '.max_position_embeddings = 2'
}

@test "models of other kinds" {
	changed "key 'model_type' is not \"bert\"" '.model_type = "roberta"'
	changed "key 'position_embedding_type' is not \"absolute\"" '.position_embedding_type = "relative_key"'
	changed "key 'hidden_act' is 'silu', not gelu, gelu_new, gelu_pytorch_tanh or relu" '.hidden_act = "silu"'
	changed "key 'hidden_act' is '', not gelu, gelu_new, gelu_pytorch_tanh or relu" 'del(.hidden_act)'
}

@test "each activation gives vectors of its own" {
	for name in gelu gelu_new gelu_pytorch_tanh relu; do
		jq ".hidden_act = \"$name\"" good.json >m/config.json
		"$BIN/text-encode" --model m -o $name s
	done
	not cmp -s gelu gelu_new
	not cmp -s gelu relu
	cmp gelu_new gelu_pytorch_tanh
}

@test "no weights, or two files of them" {
	mv m/model.safetensors m/a.safetensors
	"$BIN/text-encode" --model m -o out s && rm out
	cp m/a.safetensors m/b.safetensors
	refuses 3 'm: has 2 *.safetensors files and none is model.safetensors'
	rm m/?.safetensors
	refuses 4 'm: has no *.safetensors file'
}

@test "sizes that are not the weights'" {
	words=$(jq .vocab_size good.json)
	jq '.vocab_size += 1' good.json >m/config.json
	refuses 3 "m/model.safetensors: tensor 'embeddings.word_embeddings.weight': is F16[$words,24], expected F16[$((words + 1)),24]"
	jq '.vocab_size = 10000000 | .hidden_size = 65536 | .num_attention_heads = 1' good.json >m/config.json
	refuses 3 "m/model.safetensors: tensor 'embeddings.word_embeddings.weight': is F16[$words,24], expected F16[10000000,65536]"
	jq '.num_hidden_layers = 3' good.json >m/config.json
	refuses 3 "m/model.safetensors: tensor 'encoder.layer.2.attention.self.query.weight' is missing"
	jq '.intermediate_size = 41' good.json >m/config.json
	refuses 3 "m/model.safetensors: tensor 'encoder.layer.0.intermediate.dense.weight': is F16[40,24], expected F16[41,24]"
}

@test "a weight that is not finite" {
	printf '\x00\x7c' | dd of=m/model.safetensors bs=1 conv=notrunc status=none \
		seek=$(($(tensor_at encoder.layer.1.output.dense.bias) + 6))
	refuses 3 "m/model.safetensors: tensor 'encoder.layer.1.output.dense.bias': item 3 is not finite"
}

@test "weights cut short" {
	cp m/model.safetensors whole
	for n in 0 7 8 100 3000 20000 $(($(wc -c <whole) - 1)); do
		head -c "$n" whole >m/model.safetensors
		status=0
		"$BIN/text-encode" --model m -o out s 2>err || status=$?
		[ $status = 3 ] && [ "$(wc -l <err)" = 1 ] && grep -q '^text-encode: m/model.safetensors: ' err
	done
}
