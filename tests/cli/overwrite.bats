#!/usr/bin/env bats
# No tool writes over what it reads, or one output over another: refused before any work, with everything as it was.

setup_file() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	export OMP_WAIT_POLICY=passive
	"$BATS_TEST_DIRNAME/examples-setup.sh" "$BATS_FILE_TMPDIR" "$BIN"
	cd "$BATS_FILE_TMPDIR"
	"$BIN/refer-lift" -q --scene scene --weights weights --text text.safetensors --masks masks.jsonl -o lifted.safetensors
}

setup() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	load ../format/files
	cp -r "$BATS_FILE_TMPDIR" "$BATS_TEST_TMPDIR/in"
	cd "$BATS_TEST_TMPDIR/in"
	before=$(state)
}

# Every file with its checksum.
state() { find . -type f -exec cksum {} + | sort; find . | sort; }

# refuses MESSAGE TOOL [ARGUMENT]...
refuses() {
	local tool=$2
	says 2 "$tool: $1
Try '$tool --help'." "$BIN/$tool" "${@:3}" && [ "$(state)" = "$before" ]
}

train() { refuses "$1" refer-train --scene scene --weights weights --text text.safetensors --masks masks.jsonl "${@:2}"; }
render() { refuses "$1" refer-render --scene scene --text text.safetensors --model model.safetensors "${@:2}"; }
locate() { refuses "$1" refer-locate --scene scene --text text.safetensors --model model.safetensors "${@:2}"; }

@test "refer-train" {
	train "-o text.safetensors would overwrite --text text.safetensors" -o text.safetensors
	train "--log text.safetensors would overwrite --text text.safetensors" --log text.safetensors -o m
	train "--log ./masks.jsonl would overwrite --masks masks.jsonl" --log ./masks.jsonl -o m
	train "-o m and --log ./m are the same" --log ./m -o m
	train "--log m.checkpoint and checkpoint m.checkpoint are the same" --log m.checkpoint -o m
	train "-o scene/splats.safetensors would be among the files of --scene scene" -o scene/splats.safetensors
	train "--log scene/cameras.json would be among the files of --scene scene" -o m --log scene/cameras.json
	train "-o lifted.safetensors would overwrite --init lifted.safetensors" --init lifted.safetensors -o lifted.safetensors
	view=$(ls weights | head -n 1)
	train "-o weights/$view would be among the files of --weights weights" -o "weights/$view"
}

@test "through symbolic links, hard links and folders with another name" {
	ln -s text.safetensors soft
	ln masks.jsonl hard
	ln scene/splats.safetensors splats
	ln -s "$PWD" here
	ln -s "$PWD/absent" dangling
	before=$(state)
	train "-o soft would overwrite --text text.safetensors" -o soft
	train "--log hard would overwrite --masks masks.jsonl" -o m --log hard
	train "-o splats would be among the files of --scene scene" -o splats
	train "-o here/scene/cameras.json would be among the files of --scene scene" -o here/scene/cameras.json
	train "-o dangling and --log here/absent are the same" -o dangling --log here/absent
	[ ! -e absent ]
}

@test "refer-render" {
	render "-o model.safetensors would overwrite --model model.safetensors" -o model.safetensors
	render "-o text.safetensors would overwrite --text text.safetensors" -o text.safetensors
	render "-o scene/cameras.json would be among the files of --scene scene" -o scene/cameras.json
	render "--png p and --response ./p/ are the same" --png p --response ./p/
	render "--png p and --overlay p are the same" --png p --overlay p
}

@test "refer-locate" {
	ref=$(jq -r .ref sentences.jsonl | head -n 1)
	locate "--ply scene/splats.safetensors would be among the files of --scene scene" --refs "$ref" --ply scene/splats.safetensors
	locate "--splat model.safetensors would overwrite --model model.safetensors" --refs "$ref" --splat model.safetensors
	locate "--ply x and --splat x are the same" --refs "$ref" --ply x --splat x
	locate "-o x and --ply x are the same" --refs "$ref" --ply x -o x
	locate "-o text.safetensors would overwrite --text text.safetensors" -o text.safetensors
}

@test "refer-lift, pseudomask-select, text-encode, miou-score" {
	refuses "-o masks.jsonl would overwrite --masks masks.jsonl" refer-lift --scene scene --weights weights \
		--text text.safetensors --masks masks.jsonl -o masks.jsonl
	refuses "-o spare.jsonl would overwrite --spare spare.jsonl" refer-lift --scene scene --weights weights \
		--text text.safetensors --masks masks.jsonl --spare spare.jsonl -o spare.jsonl
	refuses "-o candidates.jsonl would overwrite CANDIDATES candidates.jsonl" pseudomask-select -o candidates.jsonl candidates.jsonl
	refuses "-o scene/cameras.json would be among the files of --scene scene" pseudomask-select --scene scene \
		--weights weights -o scene/cameras.json candidates.jsonl
	refuses "--spare candidates.jsonl would overwrite CANDIDATES candidates.jsonl" pseudomask-select --scene scene \
		--weights weights --spare candidates.jsonl -o masks candidates.jsonl
	refuses "-o boxes.jsonl would overwrite --boxes boxes.jsonl" pseudomask-propose --weights weights --boxes boxes.jsonl \
		-o boxes.jsonl scene
	refuses "-o sentences.jsonl would overwrite SENTENCES sentences.jsonl" text-encode --model encoder -o sentences.jsonl sentences.jsonl
	refuses "-o encoder/vocab.txt would be among the files of --model encoder" text-encode --model encoder -o encoder/vocab.txt sentences.jsonl
	for option in --truth --compare --sentences --parses --whole; do
		cp truth.jsonl other.jsonl
		before=$(state)
		args=(--truth truth.jsonl)
		[ $option != --sentences ] || args+=(--answers)
		[ $option != --truth ] || args=()
		refuses "-o other.jsonl would overwrite $option other.jsonl" miou-score "${args[@]}" $option other.jsonl -o other.jsonl pred.jsonl
	done
	refuses "-o pred.jsonl would overwrite PREDICTIONS pred.jsonl" miou-score --truth truth.jsonl -o pred.jsonl pred.jsonl
}

@test "text-parse, parse-train, refer-ask, refer-say, mask-import, box-detect, mask-export, gs-transform, feature-lift, feature-query, refer-report" {
	refuses "-o text.safetensors would overwrite TEXT text.safetensors" text-parse -o text.safetensors text.safetensors
	refuses "-o encoder/vocab.txt would overwrite --parser encoder/vocab.txt" text-parse --parser encoder/vocab.txt \
		-o encoder/vocab.txt text.safetensors
	refuses "-o sentences.jsonl would overwrite MARKED sentences.jsonl" parse-train --text text.safetensors \
		-o sentences.jsonl sentences.jsonl
	refuses "-o text.safetensors would overwrite --text text.safetensors" parse-train --text text.safetensors \
		-o text.safetensors sentences.jsonl
	for file in text.safetensors scene/splats.safetensors lifted/model.safetensors; do
		refuses "--picture kitchen/$file would be among the files of RUN kitchen" refer-ask --encoder encoder -o kitchen/$file kitchen box
	done
	refuses "-o kitchen/lifted/model.safetensors would be among the files of RUN kitchen" refer-say --encoder encoder \
		-o kitchen/lifted/model.safetensors kitchen
	refuses "-o labels.json would overwrite picture labels.json" mask-import -o labels.json labels.json
	refuses "-o images/view_001.png would overwrite photograph images/view_001.png" box-detect --model detector -o images/view_001.png \
		$(printf 'images/view_000.png %.0s' {1..20}) images/view_001.png # more files than a table of options has
	refuses "-o detector/model.safetensors would be among the files of --model detector" box-detect --model detector \
		-o detector/model.safetensors --scene scene
	refuses "-o scene/cameras.json would be among the files of --scene scene" box-detect --model detector -o scene/cameras.json --scene scene
	refuses "-o truth.jsonl would overwrite MASKS truth.jsonl" mask-export -o truth.jsonl truth.jsonl
	refuses "-o point_cloud.ply would overwrite SPLATS point_cloud.ply" gs-transform --format ply -o point_cloud.ply point_cloud.ply
	refuses "-o masks.jsonl would overwrite --masks masks.jsonl" feature-lift --scene scene --weights weights --masks masks.jsonl -o masks.jsonl
	refuses "-o lifted.safetensors would overwrite --positives lifted.safetensors" feature-query --text text.safetensors \
		--rule identity --positives lifted.safetensors -o lifted.safetensors model.safetensors
	refuses "the page kitchen/scene/cameras.json would be among the files of RUN kitchen" refer-report -o kitchen/scene/cameras.json kitchen
	refuses "the page kitchen/text.safetensors would be among the files of RUN kitchen" refer-report -o kitchen/text.safetensors kitchen
}

@test "what is on stdin or stdout" {
	status=0
	"$BIN/text-encode" --model encoder -o sentences.jsonl <sentences.jsonl 2>../err || status=$?
	[ $status = 2 ]
	[ "$(head -n 1 ../err)" = "text-encode: -o sentences.jsonl would overwrite SENTENCES -" ]
	status=0
	"$BIN/miou-score" --truth truth.jsonl pred.jsonl >>truth.jsonl 2>../err || status=$?
	[ $status = 2 ]
	[ "$(head -n 1 ../err)" = "miou-score: -o - would overwrite --truth truth.jsonl" ]
	[ "$(state)" = "$before" ]
}

@test "gs-weigh into the scene's folder, gs-import over its cameras and splats" {
	refuses "-o ./scene would overwrite SCENE scene" gs-weigh -o ./scene scene
	mkdir new && cp point_cloud.ply new/splats.safetensors
	before=$(state)
	refuses "-o new would overwrite SPLATS new/splats.safetensors" gs-import --cameras sparse/0 -o new new/splats.safetensors
}

@test "devices and pipes can be read and written at once" {
	"$BIN/refer-train" -q --scene scene --weights weights --text text.safetensors --masks masks.jsonl --iterations 1 \
		--log /dev/null -o /dev/null
	"$BIN/text-encode" --model encoder - <sentences.jsonl | "$BIN/gs-check" - >/dev/null
	cat sentences.jsonl | "$BIN/text-encode" --model encoder - | cmp - text.safetensors
}
