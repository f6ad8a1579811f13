#!/usr/bin/env bats
# pipelines/lerf.mk on miniatures in the layouts of Ref-LERF, LERF-OVS and 3D-OVS, made from a small synthetic scene.
# Parts: pipelines/(lerf|ref-lerf|lift|two-stage|common).* formats/records/annotations.*

setup_file() {
	export BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	BIN=$(cd "$BIN" && pwd)
	export ROOT=$BATS_TEST_DIRNAME/../..
	cd "$BATS_FILE_TMPDIR"
	"$BIN/gs-synth" -q --objects 3 --views 6 --size 64x48 --gaussians 1500 -o made
	made_truth
	ref_lerf made/mini
	lerf_ovs
	threed_ovs
}

# Masks as pictures: those of the objects that are lifted from the true ones, with the name of the object as ref.
made_truth() {
	cd made
	"$BIN/gs-import" -q --images images --test-views "$(cat test-views)" -o scene point_cloud.ply
	"$BIN/gs-weigh" -q -o weights scene
	jq -c '{ref: .object, object, text: .object, split: "train"}' sentences.jsonl | sort -u >names.jsonl
	"$BIN/text-encode" -q --model "$ROOT/tests/golden/bert" -o names.safetensors names.jsonl
	"$BIN/feature-lift" -q --scene scene --weights weights --masks truth.jsonl -o labels.safetensors
	"$BIN/refer-lift" -q --names masks --scene scene --weights weights --text names.safetensors --masks truth.jsonl -o lifted.safetensors
	"$BIN/feature-query" -q --rule identity --threshold 0.5 --positives lifted.safetensors --text names.safetensors -o selection labels.safetensors
	"$BIN/refer-render" -q --scene scene --text names.safetensors --model selection --split all --png png -o shown.jsonl
	cd ..
}

# ref_lerf DIR: json/VIEW.json has all objects, their masks in gt_mask, and their sentences of the view's split.
ref_lerf() {
	local view object split
	mkdir -p "$1/json" "$1/gt_mask" "$1/sparse"
	cp -r made/sparse/0 "$1/sparse/0"
	cp -r made/images "$1/images"
	for view in made/png/*/; do
		view=$(basename "$view")
		split=train
		[[ ,$(cat made/test-views), != *,$view,* ]] || split=test
		while read -r object; do
			cp "made/png/$view/$object.png" "$1/gt_mask/${object}_$view.png"
		done < <(jq -r .ref made/names.jsonl)
		jq -s --arg view "$view" --arg split "$split" '{info: {name: "\($view).jpg", width: 64, height: 48},
			object: (group_by(.object) | map({segmentation: "\(.[0].object)_\($view).png",
				sentence: map(select(.split == $split).text), category: .[0].object}))}' made/sentences.jsonl >"$1/json/$view.json"
	done
}

# Labels of the test views: the boxes around two objects, that of the first in two halves, which are two shapes of one category.
lerf_ovs() {
	local view
	mkdir -p label/mini
	"$BIN/mask-export" -q -o made/coco.json made/truth.jsonl
	for view in $(tr , ' ' <made/test-views); do
		jq --arg view "$view" '
			def shape($name; $l; $t; $r; $b): {category: $name, group: 1, segmentation: [[$l, $t], [$r, $t], [$r, $b], [$l, $b]], bbox: [$l, $t, $r, $b]};
			([.images[] | select(.file_name == "\($view).png").id][0]) as $image | .categories as $names
			| [.annotations[] | select(.image_id == $image) | .category_id as $id | {name: ($names[] | select(.id == $id).name), bbox}][:2]
			| {info: {name: "\($view).jpg", width: 64, height: 48, depth: 3, note: ""}, objects: [to_entries[] | .key as $k | .value
				| .name as $name | .bbox as [$x, $y, $w, $h]
				| if $k == 0 then shape($name; $x; $y; $x + $w / 2; $y + $h), shape($name; $x + $w / 2; $y; $x + $w; $y + $h)
					else shape($name; $x; $y; $x + $w; $y + $h) end]}' made/coco.json >"label/mini/$view.json"
	done
}

# The test views' true masks, by classes with blanks around them; and a picture of a class that is in no list.
threed_ovs() {
	local view object
	mkdir -p ovs3d/mini/segmentations ovs3d/mini/sparse
	cp -r made/sparse/0 ovs3d/mini/sparse/0
	cp -r made/images ovs3d/mini/images
	jq -r '" \(.ref)\t"' made/names.jsonl | sed 's/$/\r/' >ovs3d/mini/segmentations/classes.txt
	for view in $(tr , ' ' <made/test-views); do
		mkdir -p "ovs3d/mini/segmentations/$view"
		while read -r object; do
			cp "made/png/$view/$object.png" "ovs3d/mini/segmentations/$view/$object.png"
		done < <(jq -r .ref made/names.jsonl)
		cp "made/png/$view/$(jq -r .ref made/names.jsonl | sed -n 1p).png" "ovs3d/mini/segmentations/$view/nothing.png"
	done
}

setup() {
	cd "$BATS_FILE_TMPDIR"
	load ../format/files
	test_views=$(cat made/test-views)
}

not() { ! "$@"; }

lerf() {
	make -s -f "$ROOT/pipelines/lerf.mk" BIN="$BIN" BERT="$ROOT/tests/golden/bert" SPLATS=made/point_cloud.ply SCALE=1 "$@" 2>&1
}

@test "Ref-LERF: sentences, masks and truth of the folder" {
	lerf ref-lerf DATA=made/mini TEST_VIEWS="$test_views" OUT=ref >ref.out || { cat ref.out; false; }
	# each training sentence once, each test sentence once, with refs of their own
	[ "$(jq -r 'select(.split == "train").text' ref/benchmark/sentences.jsonl | sort)" = \
		"$(jq -r 'select(.split == "train").text' made/sentences.jsonl | sort -u)" ]
	[ "$(jq -r 'select(.split == "test") | [.object, .text] | @tsv' ref/benchmark/sentences.jsonl | sort)" = \
		"$(jq -r 'select(.split == "test") | [.object, .text] | @tsv' made/sentences.jsonl | sort)" ]
	[ "$(jq -r .ref ref/benchmark/sentences.jsonl | sort | uniq -d | wc -l)" = 0 ]
	# the truth is of test views and by sentence, the masks are of the others and by object
	views=$(tr , '\n' <made/test-views | wc -l)
	[ "$(wc -l <ref/benchmark/truth.jsonl)" = $((3 * views)) ]
	jq -e 'has("ref") and (has("object") | not)' ref/benchmark/truth.jsonl >/dev/null
	[ "$(jq -r .view ref/benchmark/truth.jsonl | sort -u | paste -sd,)" = "$test_views" ]
	[ "$(wc -l <ref/benchmark/masks.jsonl)" = $((3 * (6 - views))) ]
	"$BIN/gs-check" ref/benchmark/*.jsonl
}

@test "Ref-LERF: scores of test sentences, and the published figures" {
	lerf ref-lerf DATA=made/mini TEST_VIEWS="$test_views" OUT=ref >again
	jq -e '.pairs > 0 and .missing == 0 and .miou >= 0' ref/score.json
	grep -qx "mini: mIoU $(printf %.1f "$(jq '100 * .miou' ref/score.json)") in test views (ref/score.json)" again
	grep -q '^Published mIoU on Ref-LERF' again
	grep -qE '^  ReferSplat +29.2$' again
	# another split makes other files
	first=$(cut -d, -f1 made/test-views)
	[ "$first" = "$test_views" ] || lerf ref-lerf DATA=made/mini TEST_VIEWS="$first" OUT=ref >/dev/null
	[ "$(jq -r .view ref/benchmark/truth.jsonl | sort -u)" = "$first" ]
}

@test "LERF-OVS: labels are the truth of their views, names the sentences" {
	lerf lerf-ovs DATA=made/mini LABELS=label/mini CANDIDATES=made/candidates.jsonl PEAK=3 OUT=ovs >ovs.out || { cat ovs.out; false; }
	views=$(tr , '\n' <made/test-views | wc -l)
	[ "$(wc -l <ovs/benchmark/truth.jsonl)" = $((2 * views)) ]
	[ "$(jq -r .text ovs/benchmark/sentences.jsonl | sort | uniq -c | awk '{ print $1 }' | sort -u)" = 2 ]
	[ "$(jq -r '.[] | select(.split == "test").name' ovs/scene/cameras.json | paste -sd,)" = "$test_views" ]
	jq -e --argjson n $((2 * views)) '.pairs == $n and .missing == 0' ovs/score.json
	grep -q '^Published mIoU on LERF-OVS' ovs.out
	grep -qE '^  LangSplat +51.4$' ovs.out
	grep -q '^Published mIoU on LERF-OVS (3D' ovs.out
	grep -qE '^  LangSplat +9.7$' ovs.out
	grep -qE '^  LangSplat +84.3$' ovs.out
	# localisation: of every label, in the boxes that it has
	jq -se 'all(.[]; .boxes | length > 0)' ovs/benchmark/truth.jsonl
	jq -se 'any(.[]; has("peak")) and all(.[]; has("peak") == (.score > 0))' ovs/lifted/predictions.test.jsonl
	jq -se '[.[].boxes | length] | max == 2' ovs/benchmark/truth.jsonl
	jq -e '.miou > 0.3 and .peak_in_box == 1 and .peak_in_mask == 1' ovs/score.json
	grep -qx "localisation: in a box 100, in the mask 100" ovs.out
	not grep -q questions ovs.out
	jq -Rr . ovs/log/render3.test.command | grep -q -- "'--peak' '3'"
}

# asked NAME...: questions that mean all of them, the first, and none.
asked() {
	jq -n -c --args '{ref: "all", objects: $ARGS.positional, text: "the \($ARGS.positional | join(" and the "))", split: "test"},
		{ref: "one", objects: $ARGS.positional[:1], text: "the \($ARGS.positional[0])", split: "test"},
		{ref: "none", objects: [], text: "the green zeppelin above the lighthouse", split: "test"}' "$@"
}

@test "questions of one, several and no objects" {
	asked $(jq -r .ref made/names.jsonl | head -n 2 | sed 's/ /_/g') | sed 's/_/ /g' >questions.jsonl
	lerf 3d-ovs DATA=ovs3d/mini CANDIDATES=made/candidates.jsonl OUT=asked/ovs QUESTIONS=questions.jsonl >asked.out || { cat asked.out; false; }
	views=$(tr , '\n' <made/test-views | wc -l)
	jq -e --argjson n "$views" '.none.pairs == $n and .all.missing == 0 and .out_of_sight + .all.pairs == 3 * $n' asked/ovs/questions.json
	jq -e '.one.right > 0 and .several.miou > 0.3' asked/ovs/questions.json
	# the figures are those of the file
	row() { sed -n "s/^  $1  *//p" asked.out | tr -s ' '; }
	for means in one several none; do
		[ "$(row $means | awk '{ print $1, $3 }')" = "$(jq -r --arg of $means '.[$of] | "\(.pairs) \(.miou * 1000 | round / 10)"' asked/ovs/questions.json |
			awk '{ printf "%d %.1f", $1, $2 }')" ]
	done
	grep -qE "^  gIoU [0-9.]+, cIoU [0-9.]+, N-acc $(jq '.n_acc * 100' asked/ovs/questions.json | xargs printf %.1f), T-acc [0-9.]+$" asked.out
	# of Ref-LERF, against the masks of objects
	lerf ref-lerf DATA=made/mini TEST_VIEWS="$test_views" OUT=ref QUESTIONS=questions.jsonl >asked.ref || { cat asked.ref; false; }
	[ "$(jq -r .view ref/benchmark/objects.jsonl | sort -u | paste -sd,)" = "$test_views" ]
	jq -e --argjson n "$views" '.none.pairs == $n and .all.missing == 0 and .one.right > 0' ref/questions.json
	grep -q '^  gIoU ' asked.ref
}

@test "3D-OVS: pictures of classes are the truth of their views, classes the sentences" {
	lerf 3d-ovs DATA=ovs3d/mini CANDIDATES=made/candidates.jsonl OUT=ovs3d/out >3d.out || { cat 3d.out; false; }
	views=$(tr , '\n' <made/test-views | wc -l)
	[ "$(jq -r .view ovs3d/out/benchmark/truth.jsonl | sort -u | paste -sd,)" = "$test_views" ]
	[ "$(jq -r .object ovs3d/out/benchmark/truth.jsonl | sort -u)" = "$(jq -r .ref made/names.jsonl | sort -u)" ]
	[ "$(jq -r .text ovs3d/out/benchmark/sentences.jsonl | sort | uniq -c | awk '{ print $1 }' | sort -u)" = 2 ]
	# the same truth as of Ref-LERF's pictures, which are the same
	"$BIN/mask-import" -q -o again.jsonl made/mini/json/*.json
	"$BIN/miou-score" --json --quiet --truth ovs3d/out/benchmark/truth.jsonl again.jsonl | jq -e '.miou == 1 and .missing == 0'
	jq -e '.pairs > 0 and .missing == 0 and .miou > 0.3' ovs3d/out/score.json
	grep -qx "mini: mIoU $(printf %.1f "$(jq '100 * .miou' ovs3d/out/score.json)") in test views (ovs3d/out/score.json)" 3d.out
	grep -q '^Published mIoU on 3D-OVS' 3d.out
	grep -qE '^  LangSplat +93.4$' 3d.out
	# a changed picture makes the truth again
	again() { lerf 3d-ovs DATA=ovs3d/mini CANDIDATES=made/candidates.jsonl OUT=ovs3d/out >/dev/null; }
	touch stamp
	again
	[ ! ovs3d/out/benchmark/truth.jsonl -nt stamp ]
	touch -d '+2 seconds' ovs3d/mini/segmentations/*/nothing.png
	again
	[ ovs3d/out/benchmark/truth.jsonl -nt stamp ]
}

@test "what is not given, or not there" {
	run lerf 3d-ovs DATA=made/mini CANDIDATES=made/candidates.jsonl
	[ "$status" = 2 ]
	[[ $output == *"made/mini/segmentations has no classes.txt"* ]]
	run lerf 3d-ovs DATA=ovs3d/mini
	[ "$status" = 2 ]
	[[ $output == *"lerf.mk: CANDIDATES not set; "* ]]
	run lerf ref-lerf DATA=made/mini
	[ "$status" = 2 ]
	[[ $output == *"lerf.mk: TEST_VIEWS not set; "* ]]
	run lerf lerf-ovs DATA=made/mini LABELS=label/mini
	[ "$status" = 2 ]
	[[ $output == *"lerf.mk: CANDIDATES not set; "* ]]
	run lerf ref-lerf DATA=made TEST_VIEWS=a
	[ "$status" = 2 ]
	[[ $output == *"made has no json/VIEW.json"* ]]
	run lerf lerf-ovs DATA=made/mini LABELS=made/images CANDIDATES=made/candidates.jsonl
	[ "$status" = 2 ]
	[[ $output == *"made/images has no labels VIEW.json"* ]]
	make -f "$ROOT/pipelines/lerf.mk" help | grep -q '^LABELS '
}
