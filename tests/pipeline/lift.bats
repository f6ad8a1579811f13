#!/usr/bin/env bats
# The workflow without training, on a small scene.

setup_file() {
	export BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	BIN=$(cd "$BIN" && pwd)
	export ROOT=$BATS_TEST_DIRNAME/../..
	cd "$BATS_FILE_TMPDIR"
	"$BIN/gs-synth" --objects 3 --views 6 --size 96x72 --gaussians 2000 -o data
	export DATA=$BATS_FILE_TMPDIR/data WORK=$BATS_FILE_TMPDIR/work
	jq -c 'select(.split == "test") | .ref += "-again"' data/sentences.jsonl >more.jsonl
	lift >first.log 2>&1
}

# lift ARGUMENT...: the workflow on the scene, all outputs under WORK.
lift() {
	make -f "$ROOT/pipelines/lift.mk" V=1 SCENE="$WORK" SPLATS="$DATA/point_cloud.ply" CAMERAS="$DATA/sparse/0" \
		IMAGES="$DATA/images" TEST_VIEWS="$(cat "$DATA/test-views")" SENTENCES="$DATA/sentences.jsonl" \
		CANDIDATES="$DATA/candidates.jsonl" TRUTH="$DATA/truth.jsonl" BERT="$ROOT/tests/golden/bert" BIN="$BIN" SCALE=1 \
		ASK="$BATS_FILE_TMPDIR/more.jsonl" WHOLE="$DATA/whole.jsonl" BOXES="$DATA/boxes.jsonl" "$@"
}

# Fails where the command succeeds; a plain ! would let the test go on.
not() { ! "$@"; }

@test "it makes a model, answers, outlines, boxes, overlays and scores" {
	"$BIN/gs-check" "$WORK"/lifted/{model.safetensors,masks.jsonl,predictions.test.jsonl,predictions.train.jsonl,asked.jsonl,whole.jsonl,boxes.jsonl}
	[ "$(jq -s length "$WORK/lifted/predictions.test.jsonl")" = 3 ]
	[ "$(jq -s length "$WORK/lifted/asked.jsonl")" = 3 ]
	[ "$(find "$WORK/lifted/overlays" -name '*.png' | wc -l)" = 3 ]
	for made in masks predictions.test predictions.train asked whole; do
		jq -e '.miou >= 0 and .pairs > 0' "$WORK/lifted/$made.score.json"
	done
	jq -e '.pairs == 3' "$WORK/lifted/boxes.score.json"
}

@test "training sentences find their objects where the candidates are right" {
	jq -e '.miou > 0.5' "$WORK/lifted/predictions.train.score.json"
}

@test "it ends with a table" {
	grep -qE '^lifted, test views, test sentences +[0-9.]+ ' "$BATS_FILE_TMPDIR/first.log"
	grep -qE '^lifted, test views, more sentences +[0-9.]+ ' "$BATS_FILE_TMPDIR/first.log"
	grep -qE '^lift +[0-9.]+ +[0-9.]+$' "$BATS_FILE_TMPDIR/first.log"
}

@test "a second make does nothing but print the table" {
	run lift
	[ "$status" = 0 ]
	not grep -qE "$BIN/'" <<<"$output"
}

@test "report makes the page of it, trains nothing, and says where it is" {
	run lift report
	[ "$status" = 0 ]
	[ "${lines[-1]}" = "open in a browser: file://$WORK/report.html" ]
	page=$(sed -n 's,^<script type="application/json" id="data">\(.*\)</script>$,\1,p' "$WORK/report.html")
	[ "$(jq -r '[.sets[].name] | join(",")' <<<"$page")" = test,asked,train ]
	jq -e '.steps | map(select(.step == "lift")) | .[0].seconds > 0 and (.[0].command | startswith("refer-lift "))' <<<"$page"
	[ ! -e "$WORK/stage1" ]
	rm "$WORK/report.html"
}

@test "nothing is asked, scored or trained that was not wanted" {
	WORK=$BATS_TEST_TMPDIR/plain lift ASK= WHOLE= BOXES= TRUTH= >log 2>&1
	[ ! -e "$BATS_TEST_TMPDIR/plain/lifted/asked.jsonl" ]
	[ ! -e "$BATS_TEST_TMPDIR/plain/lifted/whole.jsonl" ]
	[ -e "$BATS_TEST_TMPDIR/plain/lifted/boxes.jsonl" ]
	[ -z "$(find "$BATS_TEST_TMPDIR/plain" -name '*.score.json' -o -name 'stage*')" ]
	cmp "$BATS_TEST_TMPDIR/plain/lifted/model.safetensors" "$WORK/lifted/model.safetensors"
}

@test "one photograph that a person painted: a model, boxes, and answers, from names alone" {
	cd "$BATS_TEST_TMPDIR"
	view=$(jq -r .view "$WORK/lifted/masks.jsonl" | sort | uniq -c | sort -rn | awk 'NR == 1 { print $2 }')
	jq -c --arg view "$view" 'select(.view == $view) | del(.ref)' "$WORK/lifted/masks.jsonl" | sort -u >painted.jsonl
	jq -r .object painted.jsonl | sort -u >things
	[ -s things ]
	painted() { WORK=$PWD/painted lift MASKS="$PWD/painted.jsonl" SENTENCES= CANDIDATES= ASK= WHOLE= BOXES= TRUTH= TEST_VIEWS= "$@"; }
	painted >log 2>&1
	"$BIN/gs-check" painted/lifted/model.safetensors painted/lifted/boxes.jsonl
	[ "$(jq -r .object painted/lifted/boxes.jsonl | sort)" = "$(cat things)" ]
	[ "$(ls painted/lifted)" = $'boxes.jsonl\nmodel.safetensors' ]
	not grep -q mIoU log
	# the command that the workflow ends with answers
	tail -n 1 log | grep -qF "to ask it: $BIN/refer-ask --encoder $ROOT/tests/golden/bert $PWD/painted '"
	while read -r thing; do
		command=$(tail -n 1 log | sed 's/^to ask it: //')
		[ "$(eval "${command/the .../the $thing}" | cut -d: -f1)" = "$thing" ]
	done <things
	# nothing is done twice, and another painting is lifted anew
	painted >again 2>&1
	not grep -qE "$BIN/'" again
	head -n 1 painted.jsonl >fewer && mv fewer painted.jsonl && touch -d '+2 seconds' painted.jsonl
	painted -n | grep -oE "'(text-encode|refer-lift|gs-weigh) " | sort -u >remade
	[ "$(paste -sd, <remade)" = "'refer-lift ,'text-encode " ]
	# with test views there are answers in them too
	painted TEST_VIEWS="$(cat "$DATA/test-views")" >log 2>&1
	[ "$(jq -s length painted/lifted/predictions.train.jsonl)" -ge 1 ]
	[ ! -e painted/lifted/predictions.test.jsonl ]
}

@test "MASKS with sentences: in place of candidates" {
	cd "$BATS_TEST_TMPDIR"
	WORK=$PWD/masks lift MASKS="$WORK/lifted/masks.jsonl" CANDIDATES= >log 2>&1
	# they keep their names
	"$BIN/refer-lift" -q --scene "$WORK/scene" --weights "$WORK/weights" --text "$WORK/text.safetensors" \
		--masks "$WORK/lifted/masks.jsonl" --names masks -o kept
	cmp masks/lifted/model.safetensors kept
	cmp masks/lifted/predictions.test.jsonl "$WORK/lifted/predictions.test.jsonl"
	not grep -q pseudomask-select log
	run lift CANDIDATES= IMAGES=
	[ "$status" = 2 ]
	grep -qF "CANDIDATES not set" <<<"$output"
}

@test "sentences and photographs without candidates: regions that the sentences name" {
	cd "$BATS_TEST_TMPDIR"
	WORK=$PWD/alone lift CANDIDATES= DETECTOR= >log 2>&1
	not grep -q pseudomask-select log
	"$BIN/gs-check" alone/lifted/{model.safetensors,predictions.test.jsonl}
	jq -e '.pairs == 3' alone/lifted/predictions.test.score.json
}

@test "painted photographs and what their colours mean, in one command" {
	cd "$BATS_TEST_TMPDIR"
	view=$(jq -r .view "$WORK/lifted/masks.jsonl" | head -n 1)
	thing=$(jq -r --arg view "$view" 'select(.view == $view).object' "$WORK/lifted/masks.jsonl" | head -n 1)
	ref=$(jq -r --arg thing "$thing" 'select(.object == $thing).ref' "$DATA/sentences.jsonl" | head -n 1)
	"$BIN/refer-render" --scene "$WORK/scene" --text "$WORK/text.safetensors" --model "$WORK/lifted/model.safetensors" --views "$view" \
		--refs "$ref" --png drawn -o drawn.jsonl
	mkdir painted
	cp "drawn/$view/$ref.png" "painted/$view.png"
	echo "255 $thing" >names
	for masks in "$PWD/painted/$view.png" "$PWD/painted"; do
		rm -rf work
		paint() { WORK=$PWD/work lift MASKS="$masks" NAMES="$PWD/names" SENTENCES= CANDIDATES= ASK= WHOLE= BOXES= TRUTH= TEST_VIEWS= "$@"; }
		paint >log 2>&1
		"$BIN/miou-score" --json --truth <(jq -c 'del(.ref, .score)' drawn.jsonl) work/painted.jsonl | jq -e '.miou == 1 and .pairs == 1'
		"$BIN/refer-ask" --encoder "$ROOT/tests/golden/bert" work "where is the $thing?" | grep -q "^$thing: "
		paint >again 2>&1
		not grep -qE "$BIN/'" again
	done
	echo "255 other $thing" >names
	touch -d '+2 seconds' names
	paint -n | grep -q "'mask-import "
}

@test "all missing variables are named at once, by the pipeline that was called, and its help says what they are" {
	run make -f "$ROOT/pipelines/lift.mk"
	[ "$status" = 2 ]
	[[ $output == *"$ROOT/pipelines/lift.mk: SCENE SPLATS MASKS not set; the things to find are named in one of four ways:"* ]]
	[[ $output == *"'make -f $ROOT/pipelines/lift.mk help' says what they are."* ]]
	grep -q '^  MASKS=frame_00041.png NAMES=names.txt ' <<<"$output"
	grep -q '^  SENTENCES=.* CANDIDATES=' <<<"$output"
	make -f "$ROOT/pipelines/lift.mk" help | grep -q '^SCALE '
	make -f "$ROOT/pipelines/desk.mk" help | grep -q '^DATA '
	make -f "$ROOT/pipelines/demo.mk" help | grep -q '^DEMO '
}

@test "SPLATS is the folder that 3DGS wrote: its last iteration is imported, and watched" {
	cd "$BATS_TEST_TMPDIR"
	for n in 7000 30000; do
		mkdir -p trained/point_cloud/iteration_$n
		cp "$DATA/point_cloud.ply" trained/point_cloud/iteration_$n
	done
	cp -r "$DATA/sparse" trained
	imported() { lift SCENE="$PWD/work" SPLATS="$PWD/trained" CAMERAS= IMAGES= "$PWD/work/scene/cameras.json" "$@"; }
	imported >log 2>&1
	grep -q "trained/point_cloud/iteration_30000/point_cloud.ply" work/log/import.command
	cmp work/scene/splats.safetensors "$WORK/scene/splats.safetensors"
	imported >again 2>&1
	not grep -q "gs-import" again
	touch -d '+2 seconds' trained/point_cloud/iteration_30000/point_cloud.ply
	imported -n | grep -q "gs-import"
}

@test "photographs labelled with another program: names come from the labels" {
	cd "$BATS_TEST_TMPDIR"
	mkdir labels
	view=$(jq -r .view "$WORK/lifted/masks.jsonl" | head -n 1)
	jq -c --arg view "$view" 'select(.view == $view) | {view, object, segmentation}' "$WORK/lifted/masks.jsonl" | sort -u >masks.jsonl
	jq -s '{images: [{id: 1, file_name: (.[0].view + ".png"), height: .[0].segmentation.size[0], width: .[0].segmentation.size[1]}],
		categories: [to_entries[] | {id: .key, name: .value.object}],
		annotations: [to_entries[] | {image_id: 1, category_id: .key, segmentation: .value.segmentation}]}' masks.jsonl >labels/coco.json
	for masks in "$PWD/labels" "$PWD/labels/coco.json"; do
		rm -rf work
		label() { WORK=$PWD/work lift MASKS="$masks" SENTENCES= CANDIDATES= ASK= WHOLE= BOXES= TRUTH= TEST_VIEWS= "$@"; }
		label >log 2>&1
		"$BIN/miou-score" --json --truth masks.jsonl work/painted.jsonl | jq -e '.miou == 1 and .missing == 0'
		thing=$(jq -r .object masks.jsonl | head -n 1)
		"$BIN/refer-ask" --encoder "$ROOT/tests/golden/bert" work "where is the $thing?" | grep -q "^$thing: "
		label >again 2>&1
		not grep -qE "$BIN/'" again
	done
	touch -d '+2 seconds' labels/coco.json
	label -n | grep -q "'mask-import "
}

@test "WORDS: a line for each way, the best first, and how to ask; the figures are those of the scores" {
	lift WORDS=1 | grep -v "^'" >said
	[ "$(wc -l <said)" = 2 ]
	percent() { jq -r "100 * .$1" "$WORK/lifted/predictions.test.score.json" | xargs printf %.1f; }
	grep -qxE "Without training: $(percent p50)% of the masks of test sentences are right by half or more, mIoU $(percent miou), in [0-9]+ s\. Pictures: $WORK/lifted/overlays" said
	grep -q "^to ask it: .*(all figures: .*report.sh $WORK)" said
}

@test "a step says its name and its time as it ends, and its warnings; V=1 its command" {
	rm -rf "$BATS_TEST_TMPDIR/w"
	imported() { lift SCENE="$BATS_TEST_TMPDIR/w" "$BATS_TEST_TMPDIR/w/scene/cameras.json" "$@"; }
	mkdir "$BATS_TEST_TMPDIR/none"
	imported V= IMAGES="$BATS_TEST_TMPDIR/none" >out 2>err
	[ "$(wc -l <out)" = 1 ]
	grep -qxE 'gs-import \(import\): [0-9]+\.[0-9]+ s' out
	grep -q "^gs-import: warning: .*no photograph for 6 of 6 views" err
	imported V=1 | grep -q "'gs-import --cameras"
}

@test "regions: without masks it says how to name what may be things, and then lifts what was named" {
	cd "$BATS_TEST_TMPDIR"
	common=(SCENE=clicked SPLATS="$DATA/point_cloud.ply" CAMERAS="$DATA/sparse/0" IMAGES="$DATA/images" BIN="$BIN" BERT="$ROOT/tests/golden/bert")
	make -f "$ROOT/pipelines/lift.mk" regions "${common[@]}" DETECTOR= >said
	grep -qxF "to lift what is named: make -f $ROOT/pipelines/lift.mk SCENE=clicked SPLATS=$DATA/point_cloud.ply CAMERAS=$DATA/sparse/0 IMAGES=$DATA/images MASKS=clicked/labels.jsonl" said
	pick=$(sed -n 's/^to name a thing: //p' said)
	view=$(jq -r '.[0].name' clicked/scene/cameras.json)
	pick=${pick/VIEW:x,y/$view:48,36}
	eval "${pick/NAME/thing}"
	"$BIN/gs-check" clicked/labels.jsonl
	made=$(stat -c %y clicked/weights/complete)
	make -f "$ROOT/pipelines/lift.mk" "${common[@]}" MASKS=clicked/labels.jsonl >said
	# nothing that takes long is done again
	[ "$(stat -c %y clicked/weights/complete)" = "$made" ]
	"$BIN/refer-ask" --encoder "$ROOT/tests/golden/bert" clicked "where is the thing?" | grep -q "^thing: "
}
