#!/usr/bin/env bats
# The variables of the pipelines: a change of one remakes what depends on it, and no value is more than a value.

load two-stage.bash

# remade VARIABLE=VALUE...: the tools that make would run, and how often.
remade() {
	two_stage -n predictions overlays scores "$@" | grep -oE "^(mkdir .*)?'[^ ]*/'[a-z-]+ " | sed "s/.*'//" | sort | uniq -c |
		awk '{ printf "%s%s %d", (NR > 1 ? ", " : ""), $2, $1 }'
}

@test "a changed variable remakes what depends on it, and nothing else" {
	[ -z "$(remade)" ]
	# Stage 2 is taught by lifted objects, which no training changes.
	training="miou-score 4, refer-render 6, refer-train 2"
	for variable in ITERATIONS=61 TRAIN='--batch 4'; do
		[ "$(remade "$variable")" = "$training" ]
	done
	[ "$(remade SEED=2)" = "miou-score 4, refer-render 6, refer-say 1, refer-train 2, text-encode 1" ]
	[ "$(remade TAUGHT=5)" = "miou-score 2, refer-render 3, refer-say 1, refer-train 1, text-encode 1" ]
	[ "$(remade TEACH=stage1)" = "miou-score 3, refer-render 4, refer-train 1" ]
	lifted="miou-score 5, pseudomask-select 1, refer-lift 1, refer-render 7, refer-say 1, refer-train 2, text-encode 1"
	for variable in SCALE=1 WEIGH='--precision f16'; do
		[ "$(remade "$variable")" = "gs-weigh 1, $lifted" ]
	done
	for variable in TEST_VIEWS=every:3 IMAGES=; do
		[ "$(remade "$variable")" = "gs-import 1, gs-weigh 1, $lifted" ]
	done
	[ "$(remade SELECT='--method top1')" = "miou-score 3, pseudomask-select 1, refer-render 3, refer-train 1" ]
	[ "$(remade LIFT='--names masks')" = "miou-score 3, refer-lift 1, refer-render 4, refer-say 1, refer-train 1, text-encode 1" ]
	cp -r "$ROOT/tests/golden/bert" "$BATS_TEST_TMPDIR/bert"
	[ "$(remade BERT="$BATS_TEST_TMPDIR/bert")" = "miou-score 5, refer-lift 1, refer-render 7, refer-say 1, refer-train 2, text-encode 2" ]
	cp -p "$DATA/truth.jsonl" "$BATS_TEST_TMPDIR/truth.jsonl"
	[ "$(remade TRUTH="$BATS_TEST_TMPDIR/truth.jsonl")" = "miou-score 6" ]
}

@test "a variable that was changed and changed back remakes as often as it changed" {
	WORK=$BATS_TEST_TMPDIR/work two_stage "$BATS_TEST_TMPDIR/work/weights/complete" >/dev/null
	WORK=$BATS_TEST_TMPDIR/work two_stage "$BATS_TEST_TMPDIR/work/weights/complete" SCALE=1 >/dev/null
	jq -Rn '[inputs][0]' <"$BATS_TEST_TMPDIR/work/log/weigh.command" | grep -q -- "--scale '1'"
	WORK=$BATS_TEST_TMPDIR/work run two_stage "$BATS_TEST_TMPDIR/work/weights/complete"
	grep -q gs-weigh <<<"$output"
	not grep -q gs-import <<<"$output"
	WORK=$BATS_TEST_TMPDIR/work run two_stage "$BATS_TEST_TMPDIR/work/weights/complete"
	not grep -q gs-weigh <<<"$output"
}

@test "cameras that gs-import finds by itself are a dependency, also those of the trained model's folder" {
	for at in point_cloud.ply point_cloud/iteration_7/point_cloud.ply; do
		rm -rf "$BATS_TEST_TMPDIR/data" "$BATS_TEST_TMPDIR/work"
		mkdir -p "$BATS_TEST_TMPDIR/data/$(dirname $at)"
		cp "$DATA/point_cloud.ply" "$BATS_TEST_TMPDIR/data/$at"
		cp -r "$DATA/sparse" "$BATS_TEST_TMPDIR/data"
		make_scene() {
			two_stage SCENE="$BATS_TEST_TMPDIR/work" SPLATS="$BATS_TEST_TMPDIR/data/$at" CAMERAS= \
				"$BATS_TEST_TMPDIR/work/scene/cameras.json"
		}
		make_scene >/dev/null
		run make_scene
		not grep -q gs-import <<<"$output"
		touch -d '+2 seconds' "$BATS_TEST_TMPDIR/data/sparse/0/images.txt"
		run make_scene
		grep -q gs-import <<<"$output"
	done
}

# cut_off ARGUMENT...: the workflow, killed in the training of stage 1 as soon as that has a checkpoint.
cut_off() {
	mkdir -p tools
	ln -sf "$BIN"/* tools
	rm tools/refer-train
	cat >tools/refer-train <<-END
		#!/bin/sh
		case "\$*" in *--help) exec "$BIN/refer-train" "\$@" ;; esac
		"$BIN/refer-train" "\$@" &
		while [ ! -e "$WORK/stage1/model.safetensors.checkpoint" ] && kill -0 \$!; do sleep 0.05; done
		kill -9 \$!
		exit 137
	END
	chmod +x tools/refer-train
	BIN=$PWD/tools run two_stage "$@"
	[ "$status" = 2 ]
	[ -e "$WORK/stage1/model.safetensors.checkpoint" ]
}

@test "a training that was cut off goes on, and starts anew where something that it learns from changed" {
	cd "$BATS_TEST_TMPDIR"
	cp -r "$DATA" data
	WORK=$PWD/work DATA=$PWD/data
	long=(ITERATIONS=2000 "TRAIN=--checkpoint 20")
	cut_off "${long[@]}"
	run two_stage -n "$WORK/stage1/model.safetensors" "${long[@]}"
	not grep -q pseudomask-select <<<"$output"
	# Another input, and another variable.
	sed -i '$d' data/candidates.jsonl
	touch -d '+2 seconds' data/candidates.jsonl
	two_stage "$WORK/stage1/model.safetensors" "${long[@]}" ITERATIONS=40
	rm "$WORK/stage1/model.safetensors"
	touch -d '1 hour ago' data/candidates.jsonl
	cut_off "${long[@]}"
	two_stage "$WORK/stage1/model.safetensors" ITERATIONS=40 SEED=3
	# The bytes are those of a training that nothing cut off.
	cp "$WORK/stage1/model.safetensors" first
	rm -r work
	two_stage "$WORK/stage1/model.safetensors" ITERATIONS=40 SEED=3
	cmp first "$WORK/stage1/model.safetensors"
	# Nothing changed: it goes on from the checkpoint.
	rm "$WORK/stage1/model.safetensors"
	cut_off ITERATIONS=2000 "TRAIN=--checkpoint 20"
	checkpoint=$(stat -c %Y "$WORK/stage1/model.safetensors.checkpoint")
	cut_off ITERATIONS=2000 "TRAIN=--checkpoint 20"
	grep -qE '^refer-train \(train1\): goes on after step [0-9]+ of an interrupted training$' <<<"$output"
	[ "$(stat -c %Y "$WORK/stage1/model.safetensors.checkpoint")" = "$checkpoint" ]
}

@test "names that make or the shell would take for something else are refused at once, and nothing in them is done" {
	cd "$BATS_TEST_TMPDIR"
	for name in 'a b' 'a:b' 'a$b' 'a$(shell touch done)' 'a$$(touch done)' "a'b" 'a"b' 'a;touch done' 'a&b' 'a(b)' 'a#b' 'a`touch done`' \
		'a*' 'a%b' 'a=b' 'a\b' '~' 'a|b' $'a\tb' $'a\ntouch done'; do
		for variable in SCENE SPLATS CAMERAS SENTENCES CANDIDATES TRUTH; do
			run two_stage "$variable=$name"
			[ "$status" = 2 ] || { echo "$variable=$name: $status $output"; false; }
			grep -qF ".mk: $variable has a " <<<"$output" || { echo "$variable=$name: $output"; false; }
			[ "${#lines[@]}" = 1 ] || { echo "$variable=$name: $output"; false; }
		done
	done
	SPLATS='a$(shell touch done)' run make -f "$ROOT/pipelines/two-stage.mk" SCENE=x SENTENCES=y CANDIDATES=z
	grep -qF '.mk: SPLATS has a ' <<<"$output"
	[ -z "$(ls)" ]
}

@test "other values reach the tools as they are, and nothing in them is done" {
	cd "$BATS_TEST_TMPDIR"
	for value in '$(shell touch done)' '$(touch done)' '`touch done`' "'; touch done; '" '"; touch done; "' '; touch done' '& touch done' '# x' '$x'; do
		WORK=$PWD/work run two_stage TEST_VIEWS="$value"
		[ "$status" = 2 ]
		grep -qF "gs-import: --test-views: no view '$value'" <<<"$output"
		WORK=$PWD/work run two_stage SCALE="$value"
		grep -qF "gs-weigh: --scale: '$value' is not" <<<"$output"
		WORK=$PWD/work run two_stage BERT="$PWD/$value"
		grep -qF "BERT: $PWD/$value: no language encoder there" <<<"$output"
		WORK=$PWD/work run two_stage SELECT="$value"
		grep -qE "pseudomask-select: |Try 'pseudomask-select" <<<"$output"
		[ "$(ls)" = work ] || { ls; echo "$value"; false; }
	done
	cp -r "$ROOT/tests/golden/bert" "it's a model; # (of words)"
	WORK=$PWD/work two_stage BERT="$PWD/it's a model; # (of words)" "$PWD/work/text.safetensors"
}

@test "names that begin with a dash are not taken for options" {
	cd "$BATS_TEST_TMPDIR"
	for variable in SCENE SPLATS CAMERAS SENTENCES CANDIDATES TRUTH; do
		run two_stage "$variable=-name"
		[ "$status" = 2 ]
		grep -qF ".mk: $variable begins with a dash; write ./-name" <<<"$output"
	done
}

# A folder of any name to work in, with names of things and sentences that are the shell's, make's, HTML's and paths.
@test "names of folders, encoders, objects and sentences are done nowhere, and lead nowhere" {
	name='$(touch done); `touch done` '"'"'" <b>&amp; ../../é -n'
	folder=$BATS_TEST_TMPDIR/up/'$(touch done);`touch done` "it'"'"'s" #'
	mkdir -p "$folder"
	cd "$folder"
	cp -r "$DATA" in
	cp -r "$ROOT/tests/golden/bert" '$(touch done)'
	object=$(jq -r .object in/sentences.jsonl | head -n 1)
	for file in sentences candidates truth; do
		jq -c --arg object "$object" --arg name "$name" 'if .object == $object then .object = $name else . end |
			if .ref then .ref = $name + .ref else . end' "$DATA/$file.jsonl" >in/$file.jsonl
	done
	make -s -f "$ROOT/pipelines/lift.mk" SCENE=work SPLATS=in/point_cloud.ply CAMERAS=in/sparse/0 IMAGES=in/images \
		SENTENCES=in/sentences.jsonl CANDIDATES=in/candidates.jsonl TRUTH=in/truth.jsonl BERT='$(touch done)' BIN="$BIN" \
		TEST_VIEWS="$(cat in/test-views)" lifted report >../said
	grep -qF -- "refer-ask --encoder '\$(touch done)' work 'where is the ...?'" ../said
	"$BIN/refer-locate" -q --scene work/scene --model work/lifted/model.safetensors --all --each each -o boxes.jsonl
	"$BIN/mask-export" -q --png masks in/truth.jsonl -o coco.json
	[ "$(ls each | wc -l)" = "$(jq -r .object in/sentences.jsonl | sort -u | wc -l)" ]
	[ "$(find masks -name '*.png' | wc -l)" = "$(wc -l <in/truth.jsonl)" ]
	BIN=$BIN "$ROOT/pipelines/worst.sh" 9 in/truth.jsonl in/sentences.jsonl work/lifted/predictions.test.jsonl >worst
	[ "$(wc -l <worst)" = "$(jq -r .ref work/lifted/predictions.test.jsonl | sort -u | wc -l)" ]
	[ -z "$(find "$BATS_TEST_TMPDIR" -name done)" ]
	[ "$(ls .. | wc -l)" = 2 ]
	not grep -qF '<b>' work/report.html
}

@test "the demo's and the desk's values are not done either" {
	cd "$BATS_TEST_TMPDIR"
	run make -f "$ROOT/pipelines/demo.mk" DEMO=demo BIN="$BIN" SEED='1; touch done'
	[ "$status" = 2 ]
	run make -f "$ROOT/pipelines/demo.mk" DEMO=demo BIN="$BIN" SYNTH='--objects 2 `touch done` $(touch done)'
	[ "$status" = 2 ]
	grep -qF '`touch' <<<"$output"
	for variable in DATA OUT ASK; do
		run make -f "$ROOT/pipelines/desk.mk" BIN="$BIN" DATA=x "$variable=a b"
		[ "$status" = 2 ]
		grep -qF ".mk: $variable has a blank" <<<"$output"
	done
	run env -u DATA make -f "$ROOT/pipelines/desk.mk"
	grep -qF "DATA not set" <<<"$output"
	run make -f "$ROOT/pipelines/demo.mk" DEMO='$(shell touch done)'
	grep -qF ".mk: DEMO has a" <<<"$output"
	[ ! -e done ]
}

# refused LINE ARGUMENT...: the workflow without training, on the scene, stops before it makes anything, and says so in a line that ends with LINE.
refused() {
	local line=$1
	shift
	rm -rf "$BATS_TEST_TMPDIR/new"
	run env PATH="$PWD:$PATH" make -f "$ROOT/pipelines/lift.mk" SCENE="$BATS_TEST_TMPDIR/new" SPLATS="$DATA/point_cloud.ply" CAMERAS="$DATA/sparse/0" \
		BERT="$ROOT/tests/golden/bert" BIN="$BIN" "${given[@]}" "$@"
	[ "$status" = 2 ] && [[ ${lines[0]} == *"lift.mk: $line"* ]] && [ ! -e "$BATS_TEST_TMPDIR/new" ] || { echo "$line: $output"; return 1; }
}

@test "a variable that the pipeline does not know is refused, with the one that it may be, where the command line sets it" {
	cd "$BATS_TEST_TMPDIR"
	given=()
	refused "MASK is none of its variables: did you mean MASKS?" MASK=x
	refused "masks is none of its variables: did you mean MASKS?" masks=x
	refused "SENTENCE is none of its variables: did you mean SENTENCES?" SENTENCE=x
	refused "CANDIADTES is none of its variables: did you mean CANDIDATES?" CANDIADTES=x
	refused "DATA is none of its variables; " DATA=x
	refused "SPLATS: none: no such file" SPLATS=none MASKS=none V=1 SHELL=/bin/sh OMP_NUM_THREADS=1
	for pipeline in two-stage demo desk lerf systems ablation parse; do
		run env MASK=x make -f "$ROOT/pipelines/$pipeline.mk" SEEEDS=1
		[ "$status" = 2 ]
		[[ $output == *"$pipeline.mk: SEEEDS is none of its variables"* ]]
		make -f "$ROOT/pipelines/$pipeline.mk" help | grep -qE '^#? ?[A-Z]'
	done
	MASK=x SEEEDS=1 make -n -f "$ROOT/pipelines/ablation.mk" cells SEEDS=1 BIN="$BIN" BERT="$ROOT/tests/golden/bert" run.mine="--lambda 0.1"
}

@test "what cannot be is said before any work: the pipeline, the variable, the file, and what is needed" {
	cd "$BATS_TEST_TMPDIR"
	mkdir empty painted
	touch none-in
	cp "$DATA/images/"*0.png picture.png
	cp picture.png "painted/a b.png"
	printf '\377\330\377\340' >photo.jpg
	echo '255 box' >names
	given=(SENTENCES="$DATA/sentences.jsonl" CANDIDATES="$DATA/candidates.jsonl")
	for variable in SPLATS CAMERAS SENTENCES CANDIDATES TRUTH ASK WHOLE BOXES IMAGES MASKS; do
		refused "$variable: away: no such f" "$variable=away"
	done
	for variable in SENTENCES CANDIDATES TRUTH ASK WHOLE BOXES; do
		refused "$variable: none-in: is empty" "$variable=none-in"
		refused "$variable: empty: is a folder, and a file is needed" "$variable=empty"
		refused "$variable: picture.png: is a PNG, and JSON Lines are needed" "$variable=picture.png"
	done
	refused "SPLATS: picture.png: is a PNG, and a trained 3DGS scene is needed" SPLATS=picture.png
	refused "SPLATS: $DATA/boxes.jsonl: is JSON Lines, and a trained" SPLATS="$DATA/boxes.jsonl"
	refused "CAMERAS: photo.jpg: is a JPEG, and cameras are needed" CAMERAS=photo.jpg
	refused "CANDIDATES: names: is not JSON Lines" CANDIDATES=names
	refused "IMAGES: names: is no folder" IMAGES=names
	refused "BERT: away: no language encoder there: 'make encoder'" BERT=away
	refused "BERT: empty: is no language encoder: no config.json in it" BERT=empty
	refused "BIN: no gs-import in away/: run 'make' in the checkout first" BIN=away
	refused "SCENE: names/work: names is no folder, so nothing can be written there" SCENE=names/work
	refused "LIFT: refer-lift: unknown option '--no-such'" LIFT=--no-such
	refused "SCALE: gs-weigh: --scale: 'x' is not a number" SCALE=x
	cp "$DATA/point_cloud.ply" alone.ply
	refused "CAMERAS not set, and no cameras beside alone.ply" CAMERAS= SPLATS=alone.ply
	given=()
	refused "MASKS: picture.png: is a painted photograph, so NAMES=FILE is needed" MASKS=picture.png
	refused "MASKS: photo.jpg: is a JPEG; paint over the photograph and save it as a PNG" MASKS=photo.jpg NAMES=names
	refused "MASKS: empty: has no *.png, *.json or NAME/*.png in it" MASKS=empty
	refused "MASKS: painted: has a file 'a b.png', whose name make cannot take" MASKS=painted NAMES=names
	refused "NAMES: names: names the colours of painted photographs" MASKS="$DATA/truth.jsonl" NAMES=names
	printf '#!/bin/sh\nprintf "head\\na 9 9 0 9 /\\n"\n' >df
	chmod +x df
	refused "SCENE: $PWD/new: the disk of $PWD is full: 0 kB are free" MASKS="$DATA/truth.jsonl"
}

@test "views that are not there, and records of another kind, are said after the import, before anything that takes long" {
	cd "$BATS_TEST_TMPDIR"
	jq -c '.view = "elsewhere"' "$DATA/truth.jsonl" >away.jsonl
	local few="; there are 6: view_000, view_001, view_002 ... view_005"
	WORK=$PWD/work
	run two_stage CANDIDATES=away.jsonl
	[[ $output == *"two-stage.mk: CANDIDATES: away.jsonl:1: view 'elsewhere' is not in the scene$few"* ]]
	run two_stage MASKS=away.jsonl
	[[ $output == *"two-stage.mk: MASKS: away.jsonl:1: view 'elsewhere' is not in the scene$few"* ]]
	run two_stage TRUTH="$DATA/boxes.jsonl"
	[[ $output == *"two-stage.mk: TRUTH: $DATA/boxes.jsonl: has boxes, "*", and masks are needed"* ]]
	cp "$DATA/images/view_000.png" elsewhere.png
	run two_stage MASKS=elsewhere.png NAMES=<(echo '0 box')
	[ "$(ls work)" = $'log\nscene' ]
	run two_stage TEST_VIEWS=elsewhere
	[[ $output == *"gs-import: --test-views: no view 'elsewhere'$few"* ]]
}
