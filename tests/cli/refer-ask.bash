# A small scene whose truth is known, lifted, for the tests of refer-ask. The encoder is tiny and knows nothing: answers go by
# the names of the things, the grammar and where the things are.

# lift RUN SENTENCES MASKS
lift() {
	"$BIN/text-encode" -q --model encoder -o text.safetensors "$2"
	"$BIN/refer-lift" -q --names masks --scene "$1/scene" --weights weights --text text.safetensors --masks "$3" \
		-o "$1/lifted/model.safetensors"
}

# In the folder of the test file: run, its things, and the encoder.
make_run() {
	cd "$BATS_FILE_TMPDIR"
	cp -r "$BATS_TEST_DIRNAME/../golden/bert" encoder
	"$BIN/gs-synth" -q --objects 3 --views 6 --size 96x72 --gaussians 2000 -o .
	mkdir -p run/lifted
	"$BIN/gs-import" -q --images images --test-views "$(cat test-views)" -o run/scene point_cloud.ply
	"$BIN/gs-weigh" -q -o weights run/scene
	lift run sentences.jsonl truth.jsonl
	jq -r .object sentences.jsonl | sort -u >things
}

ask() { "$BIN/refer-ask" --encoder encoder "$@"; }

# Fails where the command succeeds; a plain ! would let the test go on.
not() { ! "$@"; }
