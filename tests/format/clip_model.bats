#!/usr/bin/env bats
# Each rule of formats/encoders/clip_model.md broken once. Types and prefixes: tests/unit/test_clip.c.

setup() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	load files
	cd "$BATS_TEST_TMPDIR"
	cp -r "$BATS_TEST_DIRNAME/../golden/clip" m
	cp -r "$BATS_TEST_DIRNAME/../golden/open-clip" o
	cp m/config.json good.json
	cp o/open_clip_config.json open.json
	echo '{"ref":"a","object":"o","text":"red cup"}' >s
}

# refuses STATUS REASON: text-encode on the folder m.
refuses() {
	says "$1" "text-encode: $2" "$BIN/text-encode" --model "${3:-m}" -o out s
	[ ! -e out ]
}

# changed REASON FILTER: config.json after this jq filter.
changed() {
	jq "$2" good.json >m/config.json
	refuses 3 "m/config.json: $1"
}

# open_changed REASON FILTER: the same of OpenCLIP's.
open_changed() {
	jq "$2" open.json >o/open_clip_config.json
	refuses 3 "o/open_clip_config.json: $1" o
}

# renamed FILE FROM TO: a tensor with another name of the same length.
renamed() {
	[ ${#2} = ${#3} ] && LC_ALL=C sed -i "s/\"$2\"/\"$3\"/" "$1"
}

# tensor_at NAME: the offset of a tensor's data in the file.
tensor_at() {
	local length
	length=$(od -An -tu8 -N8 m/model.safetensors)
	echo $((8 + length + $(head -c $((8 + length)) m/model.safetensors | tail -c +9 | jq ".\"$1\".data_offsets[0]")))
}

@test "keys may be absent, or beside each other" {
	jq 'del(.text_config.hidden_act, .text_config.layer_norm_eps, .text_config.max_position_embeddings, .text_config.projection_dim)' good.json >m/config.json
	"$BIN/text-encode" --model m -o a s
	jq '.text_config + {model_type: "clip_text_model"}' good.json >m/config.json
	"$BIN/text-encode" --model m -o b s
	cmp a b
	jq '.model_cfg' open.json >o/open_clip_config.json
	mkdir x && mv o x/m
	"$BIN/text-encode" --model x/m -o c s
	cmp a c
	# a config.json of another program, and weights of HuggingFace's, are beside OpenCLIP's
	echo '{"architecture": "vit_base_patch32"}' >x/m/config.json
	cp "$BATS_TEST_DIRNAME/../golden/bert/model.safetensors" x/m
	"$BIN/text-encode" --model x/m -o d s
	cmp a d
}

@test "no JSON, no object" {
	echo '{"model_cfg":}' >o/open_clip_config.json
	refuses 3 'o/open_clip_config.json: not JSON at offset 13' o
	echo '[]' >o/open_clip_config.json
	refuses 3 'o/open_clip_config.json: not a JSON object' o
	rm o/open_clip_config.json
	refuses 4 'o: has neither tokenizer.json nor vocab.txt' o
}

@test "numbers out of range" {
	while read -r key max; do
		for value in 0 -1 1.5 '"5"' null $((max + 1)); do
			changed "key '$key' is not a whole number from 1 to $max" ".text_config.$key = $value | del(.projection_dim)"
		done
	done <<-END
		vocab_size 10000000
		hidden_size 65536
		num_hidden_layers 1000
		num_attention_heads 65536
		intermediate_size 1048576
		max_position_embeddings 1048576
		projection_dim 65536
	END
	for value in -1 2 '"x"'; do
		changed "key 'layer_norm_eps' is not a number from 0 to 1" ".text_config.layer_norm_eps = $value"
	done
	changed 'hidden_size 24 is not a multiple of num_attention_heads 5' '.text_config.num_attention_heads = 5'
	changed 'max_position_embeddings 2 leaves no room for words' '.text_config.max_position_embeddings = 2'
	for value in 0 null; do
		open_changed "key 'embed_dim' is not a whole number from 1 to 65536" ".model_cfg.embed_dim = $value"
		open_changed "key 'width' is not a whole number from 1 to 65536" ".model_cfg.text_cfg.width = $value"
	done
	open_changed 'width 24 is not a multiple of heads 7' '.model_cfg.text_cfg.heads = 7'
}

@test "towers of other kinds" {
	for act in '"silu"' '"gelu_new"'; do
		changed "key 'hidden_act' is '$(jq -r . <<<"$act")', not quick_gelu or gelu" ".text_config.hidden_act = $act"
	done
	changed "key 'hidden_act' is '', not quick_gelu or gelu" '.text_config.hidden_act = 1'
	open_changed "key 'text_cfg' is not an object" 'del(.model_cfg.text_cfg)'
	for key in hf_model_name hf_tokenizer_name embed_cls no_causal_mask pool_type mlp_ratio act_kwargs norm_kwargs; do
		open_changed "key '$key': text towers of this kind are not read" ".model_cfg.text_cfg.$key = \"x\""
	done
	# what is no CLIP is read as a BERT
	jq '.model_type = "siglip"' good.json >m/config.json
	refuses 4 'm: has neither tokenizer.json nor vocab.txt'
}

@test "sizes that are not the weights'" {
	words=$(jq .text_config.vocab_size good.json)
	table=text_model.embeddings.token_embedding.weight
	jq '.text_config.vocab_size += 1' good.json >m/config.json
	refuses 3 "m/model.safetensors: tensor '$table': is F16[$words,24], expected F16[$((words + 1)),24]"
	jq '.text_config |= (.vocab_size = 10000000 | .hidden_size = 65536 | .num_attention_heads = 1)' good.json >m/config.json
	refuses 3 "m/model.safetensors: tensor '$table': is F16[$words,24], expected F16[10000000,65536]"
	jq '.text_config.num_hidden_layers = 3' good.json >m/config.json
	refuses 3 "m/model.safetensors: tensor 'text_model.encoder.layers.2.layer_norm1.weight' is missing"
	jq '.text_config.intermediate_size = 95' good.json >m/config.json
	refuses 3 "m/model.safetensors: tensor 'text_model.encoder.layers.0.mlp.fc1.weight': is F16[96,24], expected F16[95,24]"
	jq '.projection_dim = 21' good.json >m/config.json
	refuses 3 "m/model.safetensors: tensor 'text_projection.weight': is F16[20,24], expected F16[21,24]"
	jq '.text_config.max_position_embeddings = 76' good.json >m/config.json
	refuses 3 "m/model.safetensors: tensor 'text_model.embeddings.position_embedding.weight': is F16[77,24], expected F16[76,24]"
	jq '.model_cfg.embed_dim = 21' open.json >o/open_clip_config.json
	refuses 3 "o/open_clip_model.safetensors: tensor 'text_projection': is F16[24,20], expected F16[24,21]" o
}

@test "tensors that are missing, in both layouts" {
	for name in self_attn.k_proj.bias layer_norm2.weight mlp.fc2.weight; do
		cp m/model.safetensors good
		renamed m/model.safetensors "text_model.encoder.layers.1.$name" "text_model.encoder.layers.9.$name"
		refuses 3 "m/model.safetensors: tensor 'text_model.encoder.layers.1.$name' is missing"
		mv good m/model.safetensors
	done
	for name in transformer.resblocks.1.attn.in_proj_weight transformer.resblocks.0.attn.in_proj_bias ln_final.bias positional_embedding; do
		cp o/open_clip_model.safetensors good
		renamed o/open_clip_model.safetensors "$name" "x${name#?}"
		refuses 3 "o/open_clip_model.safetensors: tensor '$name' is missing" o
		mv good o/open_clip_model.safetensors
	done
	renamed m/model.safetensors text_projection.weight text_projection.absent
	refuses 3 "m/model.safetensors: tensor 'text_projection.weight' is missing"
	cp "$BATS_TEST_DIRNAME/../golden/bert/model.safetensors" m
	refuses 3 "m/model.safetensors: tensor 'text_model.embeddings.token_embedding.weight' is missing"
	rm m/model.safetensors
	refuses 4 'm: has no *.safetensors file'
}

@test "a weight that is not finite" {
	printf '\x00\x7c' | dd of=m/model.safetensors bs=1 conv=notrunc status=none \
		seek=$(($(tensor_at text_model.encoder.layers.1.mlp.fc2.bias) + 6))
	refuses 3 "m/model.safetensors: tensor 'text_model.encoder.layers.1.mlp.fc2.bias': item 3 is not finite"
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
