# What refer-train.bats and refer-train-init.bats share; loaded by both.

setup_file() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	"$BATS_TEST_DIRNAME/examples-setup.sh" "$BATS_FILE_TMPDIR" "$BIN"
	cd "$BATS_FILE_TMPDIR"
	# A training sentence of each object, and a test sentence.
	jq -c 'select(.ref | test("-1$|bowl-5"))' sentences.jsonl >some.jsonl
	"$BIN/text-encode" --model encoder -o text.safetensors some.jsonl
}

setup() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	load ../format/files
	cd "$BATS_TEST_TMPDIR"
	export OMP_WAIT_POLICY=passive # tests run beside each other
	made=$BATS_FILE_TMPDIR
	cp -r "$made/scene" "$made/weights" "$made/text.safetensors" "$made/masks.jsonl" .
}

# train [OPTION]...: eight steps, unless the options say otherwise; few, since sanitizers make them slow.
train() {
	"$BIN/refer-train" --scene scene --weights weights --text text.safetensors --masks masks.jsonl --iterations 8 "$@"
}

# meta FILE KEY
meta() {
	head -c $((8 + $(od -An -t d8 -N 8 "$1"))) "$1" | tail -c +9 | jq -r ".__metadata__[\"$2\"]"
}

# refuses STATUS MESSAGE [OPTION]...: training fails so, and leaves nothing.
refuses() {
	local status=$1 message=$2
	shift 2
	rm -rf out
	mkdir out
	says "$status" "refer-train: $message" train -q -o out/m "$@" && [ -z "$(ls -A out)" ]
}

# Fails where the command succeeds; a plain ! would let the test go on.
not() { ! "$@"; }
