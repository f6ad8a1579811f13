#!/usr/bin/env bats
# refer-lift. Options that every tool has are in common.bats; what makes a model malformed in format/lifted.bats; whether
# the shares are right in unit/test_lift_objects.c.

setup_file() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	export OMP_WAIT_POLICY=passive
	cd "$BATS_FILE_TMPDIR"
	cp -r "$BATS_TEST_DIRNAME/../golden/bert" encoder
	"$BIN/gs-synth" -q --objects 3 --views 6 --size 64x48 --gaussians 2000 -o .
	"$BIN/gs-import" -q --images images --test-views "$(cat test-views)" -o scene point_cloud.ply
	"$BIN/gs-weigh" -q -o weights scene
	"$BIN/text-encode" -q --model encoder -o text.safetensors sentences.jsonl
	jq -r .object sentences.jsonl | uniq | sort -u >objects
	# the truth as a detector would have found it: of training views, of objects that are seen
	jq -c --arg test "$(cat test-views)" 'select(.view as $v | $test | split(",") | index($v) | not)' truth.jsonl >masks.jsonl
}

setup() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	load ../format/files
	cd "$BATS_TEST_TMPDIR"
	export OMP_WAIT_POLICY=passive
	made=$BATS_FILE_TMPDIR
	cp -r "$made/scene" "$made/text.safetensors" "$made/masks.jsonl" .
	object=$(head -n 1 "$made/objects")
}

lift() {
	"$BIN/refer-lift" --scene scene --weights "$made/weights" --text text.safetensors --masks masks.jsonl "$@"
}

# meta FILE KEY
meta() {
	head -c $((8 + $(od -An -t d8 -N 8 "$1"))) "$1" | tail -c +9 | jq -r ".__metadata__[\"$2\"]"
}

# tensor FILE NAME TYPE: a tensor's numbers on one line; TYPE as od has it (d8, d4, f4).
tensor() {
	local length begin end
	length=$(od -An -t d8 -N 8 "$1" | tr -d ' ')
	read -r begin end < <(head -c $((8 + length)) "$1" | tail -c +9 | jq -r ".[\"$2\"].data_offsets | @tsv")
	tail -c +$((9 + length + begin)) "$1" | head -c $((end - begin)) | od -An -v -t "$3" | tr -s ' \n' ' ' | sed 's/^ //; s/ $//'
}

# refuses STATUS MESSAGE [OPTION]...: lifting fails so, and leaves nothing.
refuses() {
	local status=$1 message=$2
	shift 2
	rm -rf out
	mkdir out
	says "$status" "refer-lift: $message" lift -o out/model "$@" && [ -z "$(ls -A out)" ]
}

# Fails where the command succeeds; a plain ! would let the test go on.
not() { ! "$@"; }

@test "sentences of the parser's own encoder without its middle layer are refused" {
	own=$(meta "$BATS_TEST_DIRNAME/../../formats/encoders/parser_default.safetensors" encoder)
	"$BIN/text-encode" -q --words static --model "$made/encoder" -o text.safetensors "$made/sentences.jsonl"
	lift -o model # another encoder's may lack it
	sed -i "s/$(meta text.safetensors encoder)/$own/" text.safetensors
	refuses 3 "text.safetensors: tensor 'middle' is missing, by which sentences are taken apart: make the file anew"
}

@test "regions in place of masks: each object gets one, and no Gaussian is of two" {
	"$BIN/pseudomask-propose" --weights "$made/weights" --regions regions -o /dev/null "$made/scene"
	named() { "$BIN/refer-lift" --scene scene --text text.safetensors --regions regions "$@"; }
	named -v -o model 2>log
	[ "$(grep -c "is region-" log)" = 3 ]
	"$BIN/gs-check" model
	[ "$(meta model options)" = --regions ]
	[ "$(meta model names | jq -r '.[]' | sort)" = "$(cat "$made/objects")" ]
	[ -z "$(tensor model index d4 | tr ' ' '\n' | sort | uniq -d)" ]
	named --threads 1 >one
	cmp one model
	run named --masks masks.jsonl -o x
	[ "$status" = 2 ]
	[ "${lines[0]}" = "refer-lift: --regions are in place of --weights, --masks, --spare and --names masks" ]
	"$BIN/gs-synth" -q --seed 2 --objects 3 --views 6 --size 64x48 --gaussians 2000 -o other
	"$BIN/gs-import" -q --cameras other/sparse/0 -o scene2 other/point_cloud.ply
	run "$BIN/refer-lift" --scene scene2 --text text.safetensors --regions regions -o x
	[ "$status" = 3 ]
	[[ "$output" == "refer-lift: regions: "* ]]
	[ ! -e x ]
}

@test "the option that changes the model is recorded in it" {
	lift -o model
	[ "$(meta model options)" = "--names sentences" ]
	lift --names masks -o model
	[ "$(meta model options)" = "--names masks" ]
}

@test "objects and training sentences, and nothing printed" {
	lift -o model >printed 2>&1
	[ ! -s printed ]
	"$BIN/gs-check" model
	[ "$(meta model names | jq -r '.[]' | sort)" = "$(cat "$made/objects")" ]
	[ "$(meta model texts | jq -r '.[]')" = "$(jq -r 'select(.split == "train").text' "$made/sentences.jsonl")" ]
	[ "$(meta model gaussians)" = 2000 ]
	# each object has Gaussians, and true masks agree
	read -r -a indptr <<<"$(tensor model indptr d8)"
	for k in 1 2 3; do [ "${indptr[k]}" -gt $((indptr[k - 1] + 20)) ]; done
	tensor model confidence f4 | tr ' ' '\n' | awk '$1 < 0.6 { exit 1 }'
	# the sentences' objects are their own
	[ "$(jq -r --argjson names "$(meta model names)" 'select(.split == "train") | .object as $o | $names | index($o)' \
		"$made/sentences.jsonl" | paste -sd' ')" = "$(tensor model object d4)" ]
}

@test "a mask of one object's sentence that says it is of another is refused" {
	jq -c --arg r "$(jq -r .ref "$made/sentences.jsonl" | head -n 1)" '.ref = $r | .object = "another"' masks.jsonl | head -n 1 >both
	says="both: a mask of view 'view_00"?"' is of object 'another', but its ref '"*"' is a sentence of '"*"': leave out the key that is wrong"
	for tool in refer-lift refer-train feature-lift; do
		run "$BIN/$tool" --scene scene --weights "$made/weights" --text text.safetensors --masks both -o model
		[ "$status" = 3 ] && [[ "$output" == "$tool: "$says ]] || { echo "$output"; false; }
	done
	# nor is a name spelt in two ways, in masks, or in masks and sentences
	local one two
	one=$(jq -r .object masks.jsonl | head -n 1)
	two=$(sed 's/.*/\U&/; s/ /_/g' <<<"$one")
	for which in '.view == $v and .object == $o' '.object == $o'; do
		jq -c --arg o "$one" --arg t "$two" --arg v "$(jq -r .view masks.jsonl | head -n 1)" "if $which then .object = \$t | del(.ref) else . end" masks.jsonl >spelt
		for tool in refer-lift refer-train feature-lift; do
			says 3 "$tool: spelt: '$two' and '$one' are one name in two spellings, and would be two things: write them alike, in masks and sentences" \
				"$BIN/$tool" --scene scene --weights "$made/weights" --text text.safetensors --masks spelt -o model
		done
	done
	[ ! -e model ]
}

@test "masks of other views are refused" {
	jq -c '.view |= "view_00\((ltrimstr("view_00") | tonumber + 2) % 6)"' masks.jsonl >next
	run lift -q --masks next -o model
	[ "$status" = 3 ]
	[[ "$output" == "refer-lift: next: what masks show in one view is not where those of other views show it (by 0."*", at least 0.35 is right): are they of other views, "* ]]
	[ ! -e model ]
}

@test "cameras in another frame than the splats: a warning, as masks do not meet" {
	"$BIN/gs-transform" --translate 0.3,-0.2,0.1 --rotate 0.9,0.2,0.3,0.1 --scale 0.4 -o s.ply "$made/point_cloud.ply"
	"$BIN/gs-import" -q --cameras "$made/sparse/0" --test-views "$(cat "$made/test-views")" -o scene s.ply
	"$BIN/gs-weigh" -q -o weights scene
	"$BIN/refer-lift" --scene scene --weights weights --text text.safetensors --masks masks.jsonl -o model 2>err
	grep -qE '^refer-lift: (warning: )?masks.jsonl: what masks show in one view is not where .* are the cameras of scene in another frame than its splats\? gsplat trains' err
}

@test "pipes, stdin, stdout and any number of threads give the same" {
	lift -o expected
	lift --threads 1 >one
	lift --threads 2 >two
	cat masks.jsonl | lift --masks - --threads 7 -o - >three
	lift --text - <text.safetensors >four
	for file in one two three four; do cmp expected $file; done
}

@test "the order of the masks does not matter" {
	lift -o expected
	tac masks.jsonl >backwards
	lift --masks backwards | cmp expected
}

@test "a third of one object's masks show another object: the rest outvote them" {
	lift -o right
	# the last of its masks gets that of the second object
	jq -sc --arg a "$object" --arg b "$(sed -n 2p "$made/objects")" '
		(map(select(.object == $a).view) | .[-1]) as $view
		| (map(select(.view == $view and .object == $b).segmentation) | .[0]) as $wrong
		| .[] | if .object == $a and .view == $view then .segmentation = $wrong else . end' masks.jsonl >wrong.jsonl
	not cmp -s masks.jsonl wrong.jsonl
	lift --masks wrong.jsonl -o wrong
	# as many Gaussians above the cut as before, within a fifth
	count() {
		local begin end
		read -r begin end < <(tensor "$1" indptr d8 | cut -d' ' -f "$2,$(($2 + 1))")
		tensor "$1" share u1 | tr ' ' '\n' | sed -n "$((begin + 1)),${end}p" | awk '$1 > 0.45 * 255' | wc -l
	}
	at=$(($(meta right names | jq --arg a "$object" 'index($a)') + 1))
	[ "$(meta right names)" = "$(meta wrong names)" ]
	before=$(count right $at) after=$(count wrong $at)
	echo "$before, then $after"
	[ $((before * 4)) -lt $((after * 5)) ]
	[ $((after * 4)) -lt $((before * 5)) ]
}

@test "a record of a training sentence is of its object, one of a test sentence does not count" {
	lift -o expected
	train=$(jq -r --arg o "$object" 'select(.object == $o and .split == "train").ref' "$made/sentences.jsonl" | head -n 1)
	jq -c --arg o "$object" --arg r "$train" 'if .object == $o then del(.object) | .ref = $r else . end' masks.jsonl >by-ref
	lift --masks by-ref | cmp expected
	test=$(jq -r --arg o "$object" 'select(.object == $o and .split == "test").ref' "$made/sentences.jsonl" | head -n 1)
	jq -c --arg o "$object" --arg r "$test" 'if .object == $o then .ref = $r else . end' masks.jsonl >by-test
	count=$(grep -c "\"ref\":\"$test\"" by-test)
	says 0 "refer-lift: warning: by-test: '$object' has no mask in a training view, and is left out
refer-lift: warning: by-test: $count masks are of no training sentence's object" lift --masks by-test -o model
	[ "$(meta model names | jq length)" = 2 ]
	# those of another text are by their object
	jq -c '.ref = "unknown"' masks.jsonl >unknown
	lift --masks unknown | cmp expected
}

@test "an object without a mask, or without a sentence, is left out with a warning" {
	jq -c --arg o "$object" 'select(.object != $o)' masks.jsonl >two
	says 0 "refer-lift: warning: two: '$object' has no mask in a training view, and is left out" lift --masks two -o model
	[ "$(meta model names | jq length)" = 2 ]
	[ "$(meta model texts | jq length)" = "$(jq -r --arg o "$object" 'select(.object != $o and .split == "train").ref' \
		"$made/sentences.jsonl" | wc -l)" ]
	says 0 "" lift -q --masks two -o quiet
	cmp model quiet
	jq -c --arg o "$object" 'if .object == $o then .object = "nobody" else . end' masks.jsonl >unknown
	says 0 "refer-lift: warning: unknown: '$object' has no mask in a training view, and is left out
refer-lift: warning: unknown: $(grep -c nobody unknown) masks are of no training sentence's object" lift --masks unknown -o model
}

@test "masks, but none of a sentence's object" {
	jq -c '.object |= "the " + . | del(.ref)' masks.jsonl >other
	says 3 "refer-lift: other: no mask of a training view is of a training sentence's object of text.safetensors" lift -q --masks other -o none
	[ ! -e none ]
	jq -c '.segmentation |= (.counts = [0, .size[0] * .size[1]])' masks.jsonl >full
	n=$(wc -l <full)
	lift --masks full -o odd 2>err || true
	grep -q "^refer-lift: warning: full: $n of $n masks cover more than half of their view: are they inverted, black where the thing is?$" err
}

@test "no masks: an empty model, and a warning for each object" {
	[ "$(lift --masks /dev/null -o model 2>&1 | grep -c "has no mask in a training view")" = 3 ]
	says 0 "model: ok: refer.lifted, 0 objects, 0 shares, 0 sentences, 0 words, 24 columns, 2000 gaussians of the scene, scene $(
		meta scene/splats.safetensors scene), encoder $(meta text.safetensors encoder)" "$BIN/gs-check" model
}

@test "an object that has another's masks gets its own, which are spare" {
	other=$(sed -n 2p "$made/objects")
	jq -c --arg a "$object" 'select(.object == $a) | .object = "a region"' masks.jsonl >spare
	jq -c --arg a "$object" --arg b "$other" 'if .object == $a then empty else . end
		| ., select(.object == $b) + {object: $a}' masks.jsonl >wrong
	# a person's masks, which have no score, keep their names
	lift -v --masks wrong --spare spare -o drawn 2>said
	grep -q "3 objects, .*; 0 changed places" said
	not grep -q "a detector found" said
	jq -c '.score = 0.9' wrong >scored
	mv scored wrong
	lift -v --masks wrong --spare spare -o model 2>said
	grep -q "3 objects, .*; [12] changed places" said
	grep -qE "^refer-lift: warning: wrong: [12] objects have masks that a detector found for others, as their sentences say: '.*' has those of .*, by '.*' \([0-9.]+ against [0-9.]+\); --names masks keeps them$" said
	[ "$(meta model names | jq -r '.[]' | sort)" = "$(cat "$made/objects")" ]
	# one of the two has the Gaussians of the right model
	lift -o right
	of() {
		local at begin end
		at=$(($(meta "$1" names | jq --arg a "$2" 'index($a)') + 1))
		read -r begin end < <(tensor "$1" indptr d8 | cut -d' ' -f "$at,$((at + 1))")
		tensor "$1" index d4 | tr ' ' '\n' | sed -n "$((begin + 1)),${end}p" | sort
	}
	of right "$object" >own
	for name in "$object" "$other"; do of model "$name" | comm -12 - own | wc -l; done | sort -n | tail -n 1 >most
	[ $(($(cat most) * 5)) -gt $(($(wc -l <own) * 4)) ]
	# whatever it is called, in any order, and by any number of threads
	jq -c --arg b "$other" '.object = $b' spare | tac >called
	lift -q --masks wrong --spare called | cmp model
	for threads in 1 2 7; do lift -q --masks wrong --spare - --threads $threads <spare | cmp model; done
	# where masks say which object is which they are not looked at
	lift --names masks --masks wrong -o as-masked
	lift --names masks --masks wrong --spare none | cmp as-masked
}

@test "without a spare region, or with one that no view with weights shows, nothing changes" {
	lift -o expected
	: >none
	lift --spare none | cmp expected
	jq -c --arg v "$(cut -d, -f1 "$made/test-views")" 'select(.view == $v)' "$made/truth.jsonl" >unseen
	[ -s unseen ]
	lift --spare unseen | cmp expected
	jq -c 'del(.object) | .ref = "a sentence"' masks.jsonl >nobody
	lift --spare nobody | cmp expected
}

@test "views without weights do not count, nor test views" {
	mkdir some
	view=$(jq -r .view masks.jsonl | sort -u | head -n 1)
	cp "$made/weights/"* some
	rm "some/$view.safetensors"
	jq -c --arg v "$view" 'select(.view != $v)' masks.jsonl >rest
	lift --masks rest -o expected
	says 0 "refer-lift: warning: some: 1 training views have no weights, and their masks do not count" \
		lift --weights some -o model
	cmp expected model
	mkdir none
	says 4 "refer-lift: none: has no weights of a training view" lift --weights none -o no-model
	[ ! -e no-model ]
	jq -c --arg v "$(head -n 1 "$made/test-views" | cut -d, -f1)" '.view = $v' masks.jsonl >test
	[ "$(lift --masks test -o model 2>&1 | grep -c "has no mask in a training view")" = 3 ]
}

@test "masks of another size" {
	lift -o expected
	# one of all of its view, in one pixel
	{ cat masks.jsonl; head -n 1 masks.jsonl | jq -c '.segmentation = {size: [1, 1], counts: [0, 1]}'; } >more
	lift --masks more -o model
	not cmp -s expected model
}

@test "-v says what was found" {
	lift -v -o model 2>said
	grep -qE '^refer-lift: 3 objects, [0-9]+ Gaussians with a share in one; agreement of the masks 0\.[0-9]{3}; 0 changed places$' said
	[ "$(wc -l <said)" = 2 ]
}

@test "text without word pieces" {
	# the key under another name of the same length
	LC_ALL=C sed 's/"pieces"/"piecez"/' text.safetensors >old
	refuses 3 "old: has no word pieces: encode the sentences anew" --text old
}

@test "masks of photographs by folder and file, some of a folder that the scene lacks" {
	mkdir model
	cp "$made/sparse/0/"* model
	sed -i 's,view_[0-9]*\.png,left/&,' model/images.txt
	"$BIN/gs-import" -q --cameras model --test-views "$(cat "$made/test-views")" -o scene "$made/point_cloud.ply"
	jq -e '.[0] | .name == "view_000" and .source == "left/view_000.png"' scene/cameras.json
	lift -q -o plain
	jq -c '.view = "left_" + .view' masks.jsonl >folder.jsonl
	{ jq -c '.view = "right_" + .view' masks.jsonl; cat folder.jsonl; } >both.jsonl
	lift -q --masks folder.jsonl -o folder
	cmp plain folder
	jq -c '.view = "3f2a1b4c-" + .view + ".JPG"' masks.jsonl >label-studio.jsonl
	lift -q --masks label-studio.jsonl -o named
	cmp plain named
	lift --masks both.jsonl -o both 2>said
	cmp plain both
	n=$(wc -l <masks.jsonl)
	grep -q "^refer-lift: warning: both.jsonl:1: the scene has no view 'right_view_00.': $n of $((2 * n)) masks, of views that it lacks, are left out$" said
}

@test "input that does not belong together, or is of another kind" {
	jq -c '.view = "elsewhere"' masks.jsonl | head -n 1 >away
	refuses 3 "away:1: key 'view': the scene has no view 'elsewhere'; there are 6: view_000, view_001, view_002 ... view_005" --masks away
	refuses 3 "away:1: key 'view': the scene has no view 'elsewhere'; there are 6: view_000, view_001, view_002 ... view_005" --spare away
	jq -c '.object = "view_001"' away >swapped
	refuses 3 "swapped:1: key 'view': the scene has no view 'elsewhere'; there are 6: view_000, view_001, view_002 ... view_005: 'object' names one: are the two exchanged?" --masks swapped
	jq -c '.segmentation.counts = [.segmentation.size[0] * .segmentation.size[1]]' masks.jsonl >nothing
	lift --masks nothing -o none 2>&1 | grep -q "^refer-lift: warning: nothing: none of its $(wc -l <nothing) masks has a pixel$"
	jq -c '.view += "_png.rf.0a1b2c"' masks.jsonl | head -n 1 >away
	refuses 3 "away:1: key 'view': the scene has no view 'view_000_png.rf.0a1b2c'; there are 6: view_000, view_001, view_002 ... view_005: Roboflow renames pictures, and may stretch and turn them: export without that, and rename the views" --masks away
	refuses 3 "scene/splats.safetensors: format is 'refer.splats', expected 'refer.text'" --text scene/splats.safetensors
	refuses 3 "scene/cameras.json: the cameras of a scene folder: name the folder in its place where a scene is wanted" --masks scene/cameras.json
}

@test "missing, empty and truncated files" {
	refuses 4 "none: No such file or directory" --text none
	refuses 4 "none: No such file or directory" --masks none
	refuses 4 "none: No such file or directory" --spare none
	refuses 4 "none/splats.safetensors: No such file or directory" --scene none
	refuses 3 "empty: 0 bytes, too short for a safetensors file" --text empty 3<>empty
	head -c 2000 text.safetensors >cut
	refuses 3 "cut: header of $(od -An -t d8 -N 8 cut | tr -d ' ') bytes does not fit a file of 2000: not safetensors, or cut short" --text cut
	head -c 300 masks.jsonl >cut
	rm -rf out && mkdir out
	run lift --masks cut -o out/model
	[ "$status" = 3 ]
	[[ "$output" == "refer-lift: cut:"*": not JSON at column "* ]]
	[ -z "$(ls -A out)" ]
}

@test "usage" {
	run "$BIN/refer-lift" --scene scene --weights weights --text text
	[ "$status" = 2 ]
	[ "${lines[0]}" = "refer-lift: --scene, --weights, --text and --masks are required" ]
	[ "${lines[1]}" = "Try 'refer-lift --help'." ]
	run lift --text - --masks -
	[ "$status" = 2 ]
	[ "${lines[0]}" = "refer-lift: --text and --masks cannot both be stdin" ]
	run lift --masks - --spare -
	[ "$status" = 2 ]
	[ "${lines[0]}" = "refer-lift: --masks and --spare cannot both be stdin" ]
}

@test "an output that cannot be written leaves what was there" {
	echo before >out
	run lift --text none -o out
	[ "$(cat out)" = before ]
	refuses 4 "nowhere/model: No such file or directory" -o nowhere/model
}
