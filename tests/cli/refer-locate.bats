#!/usr/bin/env bats
# refer-locate. Options that every tool has are in common.bats; what its lines say in format/boxes.bats.

setup_file() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	export OMP_WAIT_POLICY=passive
	"$BATS_TEST_DIRNAME/examples-setup.sh" "$BATS_FILE_TMPDIR" "$BIN"
	cd "$BATS_FILE_TMPDIR"
	# A training sentence of each object, a test sentence, and one without words. Trained until it finds something.
	jq -c 'select(.ref | test("-1$|bowl-5"))' sentences.jsonl >some.jsonl
	echo '{"ref":"silent","object":"nothing","text":"","split":"test"}' >>some.jsonl
	"$BIN/text-encode" -q --model encoder -o text.safetensors some.jsonl
	"$BIN/refer-train" --scene scene --weights weights --text text.safetensors --masks masks.jsonl --iterations 400 \
		-o model.safetensors
	# True masks for each training sentence in the training views.
	grep -v -F -f <(tr , '\n' <test-views) truth.jsonl >train.jsonl
	jq -c --slurpfile s <(grep '"train"' sentences.jsonl) '. as $m | $s[] | select(.object == $m.object) | $m + {ref, score: 1}' \
		train.jsonl >lift-masks.jsonl
	"$BIN/text-encode" -q --model encoder -o all.safetensors sentences.jsonl
}

setup() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	load ../format/files
	cd "$BATS_TEST_TMPDIR"
	export OMP_WAIT_POLICY=passive
	made=$BATS_FILE_TMPDIR
	cp -r "$made/scene" "$made/text.safetensors" "$made/model.safetensors" .
}

locate() {
	"$BIN/refer-locate" --scene scene --text text.safetensors --model model.safetensors "$@"
}

# refuses STATUS MESSAGE [OPTION]...: it fails so, and leaves nothing.
refuses() {
	local status=$1 message=$2
	shift 2
	rm -rf out
	mkdir out
	says "$status" "refer-locate: $message" locate -o out/boxes.jsonl "$@" && [ -z "$(ls -A out)" ]
}

# means FILE COUNT: the means of a scene's Gaussians, its first tensor, a line each.
means() {
	local header
	header=$(od -An -t u8 -N 8 "$1" | tr -d ' ')
	tail -c +$((9 + header)) "$1" | head -c $((12 * $2)) | od -An -v -w12 -t x4
}

# vertices FILE: how many Gaussians a .ply says that it has.
vertices() {
	grep -a -m 1 '^element vertex' "$1" | cut -d ' ' -f 3
}

@test "a line for each sentence, in the order of the file" {
	locate -o boxes.jsonl >printed 2>&1
	[ ! -s printed ]
	[ "$(jq -r '[.ref, .object] | join(" ")' boxes.jsonl)" = "brown-box-1 brown box
pink-cone-1 pink cone
yellow-bowl-1 yellow bowl
yellow-bowl-5 yellow bowl
silent nothing" ]
	[ "$(jq -r 'keys_unsorted | join(" ")' boxes.jsonl | sort -u)" = \
		"ref object score count centre min max oriented gaussians" ]
	"$BIN/gs-check" boxes.jsonl
}

@test "what was learned by training is about where it is" {
	locate --sentences train -o boxes.jsonl
	"$BIN/miou-score" --json --boxes --truth "$made/boxes.jsonl" boxes.jsonl >score.json
	jq -e '.objects["brown box"].aligned > 0.05 and .missing == 0' score.json
	jq -se 'all(.[]; .score > 0.5 and .score <= 1 and .count == (.gaussians | length) and .count > 0)' boxes.jsonl
	jq -se 'all(.[]; . as $r | all(range(3); $r.min[.] < $r.centre[.] and $r.centre[.] < $r.max[.]))' boxes.jsonl
	jq -se 'all(.[].gaussians; . == (sort | unique) and .[0] >= 0 and .[-1] < 1000)' boxes.jsonl
}

@test "objects lifted from true masks are where they are" {
	"$BIN/refer-lift" -q --scene scene --weights "$made/weights" --text "$made/all.safetensors" --masks "$made/lift-masks.jsonl" \
		-o lifted.safetensors
	"$BIN/refer-locate" --scene scene --text "$made/all.safetensors" --model lifted.safetensors --sentences train -o boxes.jsonl
	"$BIN/miou-score" --json --boxes --truth "$made/boxes.jsonl" boxes.jsonl >score.json
	jq -e '.pairs == 12 and .aligned.p25 == 1 and .aligned.miou > 0.6 and .oriented.miou > 0.5 and .centre_relative < 0.15' score.json
	jq -se 'all(.[]; .score > 0 and .score <= 1)' boxes.jsonl
}

@test "of several things each has boxes of its own" {
	"$BIN/refer-lift" -q --scene scene --weights "$made/weights" --text "$made/all.safetensors" --masks "$made/lift-masks.jsonl" \
		-o lifted.safetensors
	printf '%s\n' 'the brown box and the yellow bowl' 'the brown box' 'the yellow bowl' >asked.txt
	"$BIN/text-encode" -q --model "$made/encoder" -o asked.safetensors asked.txt
	"$BIN/refer-locate" --scene scene --text asked.safetensors --model lifted.safetensors -o boxes.jsonl
	"$BIN/gs-check" boxes.jsonl
	[ "$(jq -c '[.parts[]?.object]' boxes.jsonl | head -n 1)" = '["brown box","yellow bowl"]' ]
	[ "$(jq -c 'has("parts")' boxes.jsonl | tr '\n' ' ')" = "true false false " ]
	jq -se '.[0].parts as $p | . as $all | all(range(2); . as $k | all("min", "max", "oriented"; $p[$k][.] == $all[$k + 1][.]))' \
		boxes.jsonl
	jq -se '.[0] as $r | all($r.parts[]; . as $p | all(range(3); $r.min[.] <= $p.max[.] and $p.min[.] <= $r.max[.]))' boxes.jsonl
}

@test "a sentence without words is nowhere" {
	says 0 '{"ref":"silent","object":"nothing","score":0,"count":0,"centre":null,"min":null,"max":null,"oriented":null,"gaussians":[]}' \
		locate --refs silent
}

@test "which sentences" {
	[ "$(locate --sentences train | jq -r .ref | tr '\n' ' ')" = "brown-box-1 pink-cone-1 yellow-bowl-1 " ]
	[ "$(locate --sentences test | jq -r .ref | tr '\n' ' ')" = "yellow-bowl-5 silent " ]
	[ "$(locate --refs silent,pink-cone-1 | jq -r .ref | tr '\n' ' ')" = "pink-cone-1 silent " ]
	refuses 2 "--refs: no sentence 'none'; there are 5: brown-box-1, pink-cone-1, silent, yellow-bowl-1, yellow-bowl-5
Try 'refer-locate --help'." --refs pink-cone-1,none
}

@test "the same bytes for any number of threads" {
	locate --threads 1 --refs brown-box-1 --ply 1.ply --splat 1.splat -o 1.jsonl
	locate --threads 2 --refs brown-box-1 --ply 2.ply --splat 2.splat -o 2.jsonl
	cmp 1.ply 2.ply
	cmp 1.splat 2.splat
	locate --threads 1 -o 1.jsonl
	locate --threads 2 -o 2.jsonl
	cmp 1.jsonl 2.jsonl
}

@test "text and model from stdin" {
	locate -o expected
	locate --text - <text.safetensors | cmp - expected
	locate --model - <model.safetensors | cmp - expected
}

@test "a scene far away: boxes and files are where it was" {
	locate --refs brown-box-1 --ply near.ply -o near.jsonl
	# The same with everything moved by a million.
	# The offset's text is two bytes longer, for which two of the blanks that pad the header go.
	header=$(od -An -t u8 -N 8 scene/splats.safetensors | tr -d ' ')
	{
		head -c 8 scene/splats.safetensors
		head -c $((8 + header)) scene/splats.safetensors | tail -c +9 |
			sed 's/"offset":"\[0,0,0\]"/"offset":"[1e6,0,0]"/; s/  $//' | head -c "$header"
		tail -c +$((9 + header)) scene/splats.safetensors
	} >moved
	mv moved scene/splats.safetensors
	locate --refs brown-box-1 --ply far.ply -o far.jsonl
	jq -se '.[0] as $n | .[1] as $f | ($f.min[0] - $n.min[0] - 1e6 | fabs) < 1e-4 and ($f.max[1] - $n.max[1] | fabs) < 1e-9 and
		($f.oriented.centre[0] - $n.oriented.centre[0] - 1e6 | fabs) < 1e-4 and $f.gaussians == $n.gaussians' near.jsonl far.jsonl
	grep -a -q '^property double x' far.ply
	grep -a -q '^property float x' near.ply
}

@test "--ply: isolated has what the line names and what is inside it, removed nothing of that, coloured all; gs-import reads them back" {
	for show in coloured isolated removed; do
		locate --refs brown-box-1 --show $show --ply $show.ply -o boxes.jsonl
	done
	count=$(jq .count boxes.jsonl)
	[ "$(vertices coloured.ply)" = 1000 ]
	[ "$(vertices isolated.ply)" -ge "$count" ]
	[ "$(vertices removed.ply)" -le $((1000 - count)) ]
	for show in coloured isolated removed; do
		"$BIN/gs-import" -q --cameras "$made/sparse/0" --images "$made/images" -o $show $show.ply
		[[ $("$BIN/gs-check" $show/splats.safetensors) == *": ok: refer.splats, $(vertices $show.ply) gaussians, 4 harmonics, scene "* ]]
	done
	means scene/splats.safetensors 1000 >all
	means coloured/splats.safetensors 1000 | cmp - all
	jq -r '.gaussians[] + 1' boxes.jsonl | sed 's/$/p/' | sed -n -f - all | sort >own
	means isolated/splats.safetensors "$(vertices isolated.ply)" | sort >alone
	means removed/splats.safetensors "$(vertices removed.ply)" | sort >rest
	[ -z "$(comm -23 own alone)" ]
	[ -z "$(comm -12 alone rest)" ]
	[ -z "$(sort -u alone rest | comm -23 - <(sort all))" ]
}

@test "--splat: 32 bytes for each Gaussian, the largest first" {
	locate --refs brown-box-1 --show isolated --splat x.splat -o boxes.jsonl
	count=$(jq .count boxes.jsonl)
	[ "$(wc -c <x.splat)" -ge $((32 * count)) ] && [ $(($(wc -c <x.splat) % 32)) = 0 ]
	od -An -v -w32 -t f4 x.splat | awk '{ print $4 * $5 * $6 }' >volumes
	od -An -v -w32 -t u1 x.splat | awk '{ print $28 }' | paste volumes - |
		awk '$2 > 25 { size = $1 * $2; bad = bad || (n++ && size > last * 1.04); last = size } END { exit bad || n < 20 }'
	# Means of the object lie around its box.
	jq -r '[.centre[], (.max[0] - .min[0])] | @tsv' boxes.jsonl >centre
	od -An -v -w32 -t f4 x.splat | awk 'NR == FNR { split($0, c); next } { x += $1; n++ }
		END { exit !((x / n - c[1]) ^ 2 < (c[4] / 2) ^ 2) }' centre -
}

@test "of a folder of lift.mk: one question and what is done with the thing" {
	mkdir -p run/lifted
	cp -r scene run/scene
	"$BIN/refer-lift" -q --scene scene --weights "$made/weights" --text "$made/all.safetensors" --masks "$made/lift-masks.jsonl" \
		-o run/lifted/model.safetensors
	of() { "$BIN/refer-locate" run --encoder "$made/encoder" "$@"; }
	"$BIN/refer-locate" --scene scene --text "$made/all.safetensors" --model run/lifted/model.safetensors --refs brown-box-1 \
		--show removed --ply expected.ply -o /dev/null
	of "the brown box" --remove -o rest.ply >said
	grep -qE '^brown box [0-9]+%: [0-9]+ of 1000 Gaussians$' said
	[ "$(sed 's/.*: //; s/ of.*//' said)" = $((1000 - $(vertices rest.ply))) ]
	cmp rest.ply expected.ply
	of "the brown box" --alone --threads 1 -o alone.ply >one
	of "the brown box" --alone --threads 2 -o two.ply | cmp - one
	cmp alone.ply two.ply
	of "the brown box" --colour -o coloured.splat >said
	[ "$(wc -c <coloured.splat)" = 32000 ]
	mkdir out
	says 1 "refer-locate: nothing here is that: it does not say which thing is meant" of "..." --remove -o out/x.ply
	says 4 "refer-locate: no/x.ply: No such file or directory" of "the brown box" --remove --encoder none -o no/x.ply
	usage() { says 2 "refer-locate: $1
Try 'refer-locate --help'." "${@:2}"; }
	usage "RUN goes with a QUESTION and one of --colour, --alone and --remove" of "the brown box" -o out/x.ply
	usage "RUN goes with a QUESTION and one of --colour, --alone and --remove" of --remove -o out/x.ply
	usage "RUN goes with a QUESTION and one of --colour, --alone and --remove" of "the brown box" --remove --alone -o out/x.ply
	usage "-o out/x.jsonl: not .ply, .splat, .spz, .glb or .sog: it is for the scene" of "the brown box" --remove -o out/x.jsonl
	usage "RUN QUESTION goes with --scene, --model, --encoder, --viewpoint, --time and -o only: it needs no sentences" \
		of "the brown box" --remove --text text.safetensors -o out/x.ply
	usage "--colour, --alone, --remove and --encoder are for RUN QUESTION" locate --remove -o out/x.ply
	[ -z "$(ls -A out)" ]
}

@test "scenes are of one sentence" {
	for option in --ply --splat; do
		refuses 2 "--ply and --splat show the object of one sentence, not of 5: choose it with --refs
Try 'refer-locate --help'." $option out/x
		refuses 2 "--ply and --splat must name a file
Try 'refer-locate --help'." $option - --refs silent
	done
	refuses 2 "--show is for --ply and --splat
Try 'refer-locate --help'." --show removed
	refuses 2 "--show: 'all' is not one of coloured|isolated|removed
Try 'refer-locate --help'." --show all
}

@test "nothing to isolate is an empty scene" {
	locate --refs silent --show isolated --ply x.ply --splat x.splat -o boxes.jsonl
	[ "$(vertices x.ply)" = 0 ]
	[ -e x.splat ] && [ ! -s x.splat ]
}

# last_property FILE: each Gaussian's value of the last property, an int.
last_property() {
	local bytes
	bytes=$(LC_ALL=C sed -n '/^property/s/property \(double\|float\|int\) .*/\1/p; /^end_header/q' "$1" |
		awk '{ n += $1 == "double" ? 8 : 4 } END { print n }')
	tail -c $(($(vertices "$1") * bytes)) "$1" | od -An -v -w"$bytes" -t d4 | awk '{ print $NF }'
}

@test "--all: a line and a .ply for each object, and the scene with its labels" {
	"$BIN/refer-lift" -q --scene scene --weights "$made/weights" --text "$made/all.safetensors" --masks "$made/lift-masks.jsonl" \
		-o lifted.safetensors
	all() { "$BIN/refer-locate" --all --scene scene --model lifted.safetensors "$@"; }
	all --ply labelled.ply --each objects -o labels.jsonl >printed 2>&1
	[ ! -s printed ]
	"$BIN/gs-check" labels.jsonl
	[ "$(jq -c '[.object, .label]' labels.jsonl)" = '["brown box",1]
["pink cone",2]
["yellow bowl",3]' ]
	[ "$(jq -r 'keys_unsorted | join(" ")' labels.jsonl | sort -u)" = \
		"object label colour score count centre min max oriented gaussians" ]
	jq -se '(map(.colour) | unique | length) == 3 and all(.[].colour[]; . >= 0 and . <= 255)' labels.jsonl
	# as good as by sentences
	"$BIN/miou-score" --json --boxes --truth "$made/boxes.jsonl" labels.jsonl >score.json
	jq -e '.pairs == 3 and .missing == 0 and .aligned.miou > 0.6' score.json
	# each label is that of an object that has the Gaussian, and 0 is of none
	last_property labelled.ply >labels
	[ "$(wc -l <labels)" = 1000 ]
	jq -se --rawfile labels labels '($labels | split("\n") | map(select(. != "") | tonumber)) as $of | . as $objects |
		(map(.gaussians[]) | unique) as $any |
		all(range(1000); . as $i | if $of[$i] == 0 then ($any | bsearch($i)) < 0 else ($objects[$of[$i] - 1].gaussians | bsearch($i)) >= 0 end)' \
		labels.jsonl
	[ "$(sort -n labels | uniq | tr '\n' ' ')" = "0 1 2 3 " ]
	# a scene as any other, with everything where it was
	"$BIN/gs-import" -q --cameras "$made/sparse/0" --images "$made/images" -o again labelled.ply
	means again/splats.safetensors 1000 | cmp - <(means scene/splats.safetensors 1000)
	# each object alone, as by a sentence
	[ "$(ls objects)" = "brown box.ply
pink cone.ply
yellow bowl.ply" ]
	for n in 1 2 3; do
		[ "$(vertices "objects/$(jq -r "select(.label == $n).object" labels.jsonl).ply")" -ge "$(jq "select(.label == $n).count" labels.jsonl)" ]
	done
	"$BIN/refer-locate" --scene scene --text "$made/all.safetensors" --model lifted.safetensors --refs brown-box-1 \
		--show isolated --ply alone.ply -o /dev/null
	cmp alone.ply "objects/brown box.ply"
	all --threads 1 --ply 1.ply | cmp - labels.jsonl
	cmp 1.ply labelled.ply
	all --model - <lifted.safetensors | cmp - labels.jsonl
}

@test "the page's lines for Python read the labels" {
	local python
	for python in python3 /usr/bin/python3 ""; do "$python" -c 'import numpy' 2>/dev/null && break; done
	[ -n "$python" ] || skip "no python3 with NumPy"
	"$BIN/refer-locate" --all --scene scene --model "$made/kitchen/lifted/model.safetensors" --ply labelled.ply -o /dev/null
	{
		sed -n '/^    import numpy/,/^$/s/^    //p' "$BATS_TEST_DIRNAME/../../formats/splats/ply.md"
		echo 'print(len(scene), " ".join(str(x) for x in scene["label"]))'
	} >read.py
	[ "$("$python" read.py)" = "1000 $(last_property labelled.ply | tr '\n' ' ' | sed 's/ $//')" ]
}

@test "--all: what does not go with it" {
	refuses 2 "--each is for --all
Try 'refer-locate --help'." --each out/dir
	for option in "--text text.safetensors" "--refs silent" "--sentences train" "--viewpoint 0,0,0" "--splat out/x --ply out/y" "--ply out/x --show removed"; do
		rm -rf out
		mkdir out
		says 2 "refer-locate: --all goes with --scene, --model, --ply and --each only: it needs no sentences
Try 'refer-locate --help'." "$BIN/refer-locate" --all --scene scene --model "$made/kitchen/lifted/model.safetensors" $option
		[ -z "$(ls -A out)" ]
	done
	says 3 "refer-locate: model.safetensors: is a trained model; --all needs one of refer-lift" \
		"$BIN/refer-locate" --all --scene scene --model model.safetensors --each each
	[ ! -e each ]
	says 4 "refer-locate: model.safetensors: Not a directory" "$BIN/refer-locate" --all --scene scene \
		--model "$made/kitchen/lifted/model.safetensors" --each model.safetensors/each -o none
	[ ! -e none ]
}

@test "missing, empty, truncated and other files" {
	refuses 4 "none: No such file or directory" --model none
	: >empty
	refuses 3 "empty: 0 bytes, too short for a safetensors file" --model empty
	head -c 1000 model.safetensors >cut
	run locate --model cut -o out.jsonl
	[ "$status" = 3 ] && [ ! -e out.jsonl ]
	refuses 3 "text.safetensors: format is 'refer.text', expected 'refer.model', 'refer.lifted' or 'refer.selection'" --model text.safetensors
}

@test "files that do not belong together" {
	jq -c . "$made/sentences.jsonl" | head -n 1 >one.jsonl
	"$BIN/gs-synth" -q --objects 3 --views 5 --size 64x48 --gaussians 1200 -o other
	"$BIN/gs-import" -q --images other/images -o other/scene other/point_cloud.ply
	refuses 3 "model.safetensors: is of a scene of 1000 Gaussians, other/scene has 1200" --scene other/scene
}

@test "what cannot be written leaves nothing" {
	refuses 4 "no/x.ply: No such file or directory" --refs silent --ply no/x.ply
	run locate --refs brown-box-1 -o no/x.jsonl
	[ "$status" = 4 ]
}

@test "required options" {
	says 2 "refer-locate: --scene, --model and --text (or --all) are required
Try 'refer-locate --help'." "$BIN/refer-locate" --scene scene
	refuses 2 "--text and --model cannot both be stdin
Try 'refer-locate --help'." --text - --model -
}
