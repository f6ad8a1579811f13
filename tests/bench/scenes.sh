# For said.sh and questions.sh, which set BIN, BERT, DATA, ROOM, SPLATS and scenes.

# make_scene NAME: $scenes/NAME, lifted; what is made of sentences is made again
make_scene() {
	local raw=$scenes/raw.$1 scale=0.3333 splats masks
	if [ "$1" = desk ]; then
		raw=$DATA scale=0.5
	elif [ "$1" = room ]; then
		raw=$ROOM scale=1
	elif [ ! -d "$raw" ]; then
		"$BIN/gs-synth" -q --scene "${1%-*}" --seed "${1#*-}" -o "$raw"
	fi
	splats=$raw/point_cloud.ply masks=(CANDIDATES="$raw/candidates.jsonl" TEST_VIEWS="$(cat "$raw/test-views" 2>/dev/null || echo input_0001,input_0009,input_0017,input_0025)")
	[ "$1" != room ] || splats=$SPLATS masks=(MASKS="$raw/truth.jsonl")
	rm -f "$scenes/$1/lifted/model.safetensors"
	make -s -f "$here/../../pipelines/lift.mk" BIN="$BIN" BERT="$BERT" SCENE="$scenes/$1" SPLATS="$splats" CAMERAS="$raw/sparse/0" \
		IMAGES="$raw/images" SENTENCES="$raw/sentences.jsonl" SCALE=$scale "${masks[@]}" \
		"$scenes/$1/lifted/model.safetensors" >/dev/null
}
