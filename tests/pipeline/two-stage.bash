# The workflow on the smallest scene there is. Sourced by two-stage.bats and variables.bats.

setup_file() {
	export BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	BIN=$(cd "$BIN" && pwd)
	export ROOT=$BATS_TEST_DIRNAME/../..
	cd "$BATS_FILE_TMPDIR"
	"$BIN/gs-synth" --objects 2 --views 6 --size 64x48 --gaussians 1200 -o data
	export DATA=$BATS_FILE_TMPDIR/data WORK=$BATS_FILE_TMPDIR/work
	two_stage >first.log 2>&1
}

# two_stage ARGUMENT...: the workflow on the scene, all outputs under WORK.
two_stage() {
	make -f "$ROOT/pipelines/two-stage.mk" V=1 SCENE="$WORK" SPLATS="$DATA/point_cloud.ply" CAMERAS="$DATA/sparse/0" \
		IMAGES="$DATA/images" TEST_VIEWS="$(cat "$DATA/test-views")" SENTENCES="$DATA/sentences.jsonl" \
		CANDIDATES="$DATA/candidates.jsonl" TRUTH="$DATA/truth.jsonl" BERT="$ROOT/tests/golden/bert" BIN="$BIN" SCALE=0.5 \
		ITERATIONS=60 TAUGHT=4 "$@"
}

# Fails where the command succeeds; a plain ! would let the test go on.
not() { ! "$@"; }
