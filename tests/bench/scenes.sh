# For said.sh and questions.sh, which set BIN, BERT, DATA and scenes.

# make_scene NAME: $scenes/NAME, lifted; what is made of sentences is made again
make_scene() {
	local raw=$scenes/raw.$1 scale=0.3333
	if [ "$1" = desk ]; then
		raw=$DATA scale=0.5
	elif [ ! -d "$raw" ]; then
		"$BIN/gs-synth" -q --scene "${1%-*}" --seed "${1#*-}" -o "$raw"
	fi
	rm -f "$scenes/$1/lifted/model.safetensors"
	make -s -f "$here/../../pipelines/lift.mk" BIN="$BIN" BERT="$BERT" SCENE="$scenes/$1" SPLATS="$raw/point_cloud.ply" CAMERAS="$raw/sparse/0" \
		IMAGES="$raw/images" SENTENCES="$raw/sentences.jsonl" CANDIDATES="$raw/candidates.jsonl" SCALE=$scale \
		TEST_VIEWS="$(cat "$raw/test-views" 2>/dev/null || echo input_0001,input_0009,input_0017,input_0025)" \
		"$scenes/$1/lifted/model.safetensors" >/dev/null
}
