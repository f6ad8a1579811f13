#!/usr/bin/env bats
# refer-render. Options that every tool has are in common.bats; what makes a model malformed in format/model.bats.

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
}

setup() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	load ../format/files
	cd "$BATS_TEST_TMPDIR"
	export OMP_WAIT_POLICY=passive
	made=$BATS_FILE_TMPDIR
	cp -r "$made/scene" "$made/text.safetensors" "$made/model.safetensors" .
	test_view=$(cat "$made/test-views")
}

render() {
	"$BIN/refer-render" --scene scene --text text.safetensors --model model.safetensors "$@"
}

# picture FILE: its width, height, bits and colour type.
picture() {
	od -An -t u1 -j 16 -N 10 "$1" | awk '{ print $3 * 256 + $4, $7 * 256 + $8, $9, $10 }'
}

# The number of foreground pixels of each record on stdin.
areas() {
	jq '.segmentation.counts | explode | map(. - 48) | reduce .[] as $c ({n: [], x: 0, k: 1};
		.x += ($c % 32) * .k | .k *= 32 | if $c >= 32 then . else
			(if $c % 32 >= 16 then .x -= .k else . end)
			| .n += [.x + (if (.n | length) > 2 then .n[(.n | length) - 2] else 0 end)] | .x = 0 | .k = 1 end)
		| [.n[range(1; .n | length; 2)]] | add // 0'
}

# refuses STATUS MESSAGE [OPTION]...: rendering fails so, and leaves nothing.
refuses() {
	local status=$1 message=$2
	shift 2
	rm -rf out
	mkdir out
	says "$status" "refer-render: $message" render -o out/pred.jsonl "$@" && [ -z "$(ls -A out)" ]
}

# lifted: two objects of 300 of the scene's Gaussians each in lifted.safetensors, and in asked.safetensors sentences that
# mean the first, the second, again the first, any cups, and nothing for want of words. Word vectors have two columns.
lifted() {
	local header one=003c zero=0000 index share
	header='{"__metadata__":{"format":"refer.lifted","version":"1","gaussians":"1000","names":"[\"cup\",\"box\"]","texts":"[\"cup\",\"box\"]","pieces":"[\"cup\",\"box\"]"},"indptr":{"dtype":"I64","shape":[3],"data_offsets":[0,24]},"offsets":{"dtype":"I64","shape":[3],"data_offsets":[24,48]},"index":{"dtype":"I32","shape":[600],"data_offsets":[48,2448]},"object":{"dtype":"I32","shape":[2],"data_offsets":[2448,2456]},"confidence":{"dtype":"F32","shape":[2],"data_offsets":[2456,2464]},"words":{"dtype":"F16","shape":[2,2],"data_offsets":[2464,2472]},"share":{"dtype":"U8","shape":[600],"data_offsets":[2472,3072]}}'
	while (((8 + ${#header}) % 8)); do header+=' '; done
	index=$(seq 400 999 | awk '{ printf "%02x%02x0000", $1 % 256, $1 / 256 }')
	share=$(printf 'ff%.0s' $(seq 600))
	st lifted.safetensors "$header" "$(printf '%s' 0000000000000000 2c01000000000000 5802000000000000 \
		0000000000000000 0100000000000000 0200000000000000 "$index" 00000000 01000000 $f1 $fhalf \
		$one$zero $zero$one "$share")"
	header='{"__metadata__":{"format":"refer.text","version":"1","refs":"[\"first\",\"second\",\"again\",\"any\",\"none\"]","objects":"[\"cup\",\"box\",\"cup\",\"?\",\"?\"]","texts":"[\"cup\",\"box\",\"cup\",\"cups\",\"\"]","pieces":"[\"cup\",\"box\",\"cup\",\"cups\",\"\"]","splits":"[\"test\",\"test\",\"test\",\"test\",\"test\"]"},"offsets":{"dtype":"I64","shape":[6],"data_offsets":[0,48]},"words":{"dtype":"F32","shape":[4,2],"data_offsets":[48,80]},"sentences":{"dtype":"F32","shape":[5,2],"data_offsets":[80,120]}}'
	while (((8 + ${#header}) % 8)); do header+=' '; done
	st asked.safetensors "$header" "$(printf '%02x00000000000000' 0 1 2 3 4 4)$f1$f0$f0$f1$f1$f0$f1$f1$f1$f0$f0$f1$f1$f0$f1$f1$f0$f0"
	"$BIN/gs-check" lifted.safetensors asked.safetensors >/dev/null
}

# ask [OPTION]...: renders from the lifted model.
ask() {
	"$BIN/refer-render" --scene scene --text asked.safetensors --model lifted.safetensors "$@"
}

# Fails where the command succeeds; a plain ! would let the test go on.
not() { ! "$@"; }

@test "a record for every test view and sentence, in the order of the files" {
	render -o pred.jsonl >printed 2>&1
	[ ! -s printed ]
	[ "$(jq -r '[.view, .ref, .object] | join(" ")' pred.jsonl)" = "$test_view brown-box-1 brown box
$test_view pink-cone-1 pink cone
$test_view yellow-bowl-1 yellow bowl
$test_view yellow-bowl-5 yellow bowl
$test_view silent nothing" ]
	jq -se 'all(.[]; .segmentation.size == [48, 64] and .score >= 0 and .score <= 1)' pred.jsonl
	"$BIN/gs-check" pred.jsonl
	[ "$(ls | tr '\n' ' ')" = "model.safetensors pred.jsonl printed scene text.safetensors " ]
}

@test "what was learned is found, and how sure it is" {
	render --split train --refs brown-box-1 -o pred.jsonl
	"$BIN/miou-score" --json -q --predicted-views --truth "$made/masks.jsonl" pred.jsonl >score.json
	jq -e '.objects["brown box"].miou > 0.3' score.json
	jq -se 'all(.[]; .score > 0.5 and .score <= 1)' pred.jsonl
}

@test "a sentence without words has an empty mask" {
	render --refs silent -o pred.jsonl
	[ "$(areas <pred.jsonl)" = 0 ]
	[ "$(jq .score pred.jsonl)" = 0 ]
}

@test "--calibration lifts what is below 0, and leaves scores as they were learned" {
	# A model that has hardly begun answers nearly nothing.
	"$BIN/refer-train" --scene scene --weights "$made/weights" --text text.safetensors --masks "$made/masks.jsonl" \
		--iterations 60 -o model.safetensors
	render --split all --response p --response-type npy -o peak.jsonl
	render --split all --response n --response-type npy --calibration none -o none.jsonl
	[ "$(areas <peak.jsonl | awk '{ n += $1 } END { print n }')" -gt "$(areas <none.jsonl | awk '{ n += $1 } END { print n }')" ]
	render --split all --calibration peak | cmp - peak.jsonl
	# Where nothing is seen there is nothing to lift: the least difference of a picture is not negative.
	values() { tail -c $((64 * 48 * 4)) "$1/$test_view/brown-box-1.npy" | od -An -v -t f4 -w4; }
	paste <(values p) <(values n) | awk '$1 < $2 - 1e-6 { bad = 1 } $1 > $2 { more = 1 } END { exit bad || !more }'
}

@test "--threads 1, 2 and 3 give the same bytes" {
	for n in 1 2 3; do
		mkdir $n
		render --threads $n --png $n/png --response $n/response --overlay $n/overlay -o $n/pred.jsonl
	done
	diff -r 1 2
	diff -r 1 3
}

@test "stdout and stdin equal files" {
	render -o pred.jsonl
	render | cmp - pred.jsonl
	"$BIN/refer-render" --scene scene --text - --model model.safetensors <text.safetensors | cmp - pred.jsonl
	"$BIN/refer-render" --scene scene --text text.safetensors --model - <model.safetensors | cmp - pred.jsonl
}

@test "--split and --views choose views, in the scene's order" {
	views() { render --refs silent "$@" | jq -r .view | tr '\n' ' '; }
	all=$(jq -r '.[].name' scene/cameras.json | tr '\n' ' ')
	[ "$(views)" = "$test_view " ]
	[ "$(views --split all)" = "$all" ]
	[ "$(views --split train)" = "$(jq -r '.[] | select(.split == "train").name' scene/cameras.json | tr '\n' ' ')" ]
	[ "$(views --views view_003,view_001,view_003 --split test)" = "view_001 view_003 " ]
}

@test "--sentences and --refs choose sentences, in the text's order" {
	refs() { render "$@" | jq -r .ref | tr '\n' ' '; }
	[ "$(refs --sentences train)" = "brown-box-1 pink-cone-1 yellow-bowl-1 " ]
	[ "$(refs --sentences test)" = "yellow-bowl-5 silent " ]
	[ "$(refs --refs silent,pink-cone-1 --sentences train)" = "pink-cone-1 silent " ]
}

@test "the choice does not change a mask" {
	render --split all -o all.jsonl
	render --views view_001 --refs pink-cone-1 -o one.jsonl
	grep '"view_001","ref":"pink-cone-1"' all.jsonl | cmp - one.jsonl
}

@test "--png is the record's mask" {
	render --png png --sentences train -o pred.jsonl
	[ "$(find png -type f | sort | tr '\n' ' ')" = "png/$test_view/brown-box-1.png png/$test_view/pink-cone-1.png \
png/$test_view/yellow-bowl-1.png " ]
	[ "$(picture png/$test_view/pink-cone-1.png)" = "64 48 8 0" ]
	[ "$(areas <pred.jsonl | head -n 1)" -gt 0 ]
	# The pictures as records: the same masks where every overlap is whole.
	jq -c '{view, ref, object, path: "png/\(.view)/\(.ref).png"}' pred.jsonl >pictures.jsonl
	"$BIN/miou-score" --json -q --truth pred.jsonl pictures.jsonl | jq -e '.miou == 1 and .oiou == 1'
	"$BIN/miou-score" --json -q --truth pictures.jsonl pred.jsonl | jq -e '.miou == 1 and .oiou == 1'
}

@test "--response npy is M, and positive where the mask is" {
	render --response r --response-type npy --sentences train -o pred.jsonl
	"$BIN/gs-check" r/$test_view/brown-box-1.npy
	for ref in brown-box-1 pink-cone-1 yellow-bowl-1; do
		positive=$(tail -c $((64 * 48 * 4)) r/$test_view/$ref.npy | od -An -v -t f4 -w4 | awk '$1 > 0 { n++ } END { print n + 0 }')
		[ "$positive" = "$(grep "\"$ref\"" pred.jsonl | areas)" ]
	done
}

@test "--response png has 16 bits, and 32768 where there is no answer" {
	render --response r -o pred.jsonl
	[ "$(picture r/$test_view/silent.png)" = "64 48 16 0" ]
	[ "$(ls r/$test_view | wc -l)" = 5 ]
	# The whole picture is one value, sigmoid(0): as small as pictures get.
	[ "$(wc -c <r/$test_view/silent.png)" -lt 150 ]
	[ "$(wc -c <r/$test_view/brown-box-1.png)" -gt 500 ]
}

@test "--overlay draws over the scene's colours" {
	render --overlay o --refs brown-box-1,silent -o pred.jsonl
	# two lines of words stand below the picture
	[ "$(picture o/$test_view/silent.png)" = "64 72 8 2" ]
	not cmp -s o/$test_view/silent.png o/$test_view/brown-box-1.png
	"$BIN/gs-check" o/$test_view/brown-box-1.png
}

@test "an overlay says what was asked, what was answered, and whether that is right" {
	"$BIN/refer-lift" -q --scene scene --weights "$made/weights" --text "$made/text.safetensors" --masks "$made/masks.jsonl" -o lifted
	# the same sentence and answer, but the record means another thing, or one that the model does not know
	for object in "brown box" "yellow bowl" "zeppelin"; do
		printf '{"ref":"%s","object":"%s","text":"the brown box"}\n' "${object/ /-}" "$object"
	done >three.jsonl
	"$BIN/text-encode" -q --model "$made/encoder" -o three three.jsonl
	"$BIN/refer-render" -q --scene scene --text three --model lifted --sentences all --views "$test_view" --size 640x480 \
		--overlay o -o three.masks
	not cmp -s o/$test_view/brown-box.png o/$test_view/yellow-bowl.png
	not cmp -s o/$test_view/brown-box.png o/$test_view/zeppelin.png
	not cmp -s o/$test_view/yellow-bowl.png o/$test_view/zeppelin.png
}

@test "--parts: of several things each has a mask of its own, and all else stays" {
	"$BIN/refer-lift" -q --scene scene --weights "$made/weights" --text "$made/text.safetensors" --masks "$made/masks.jsonl" -o lifted
	for text in "the brown box and the yellow bowl" "the brown box" "the yellow bowl" "the zeppelin"; do
		printf '{"ref":"%s","object":"any","text":"%s"}\n' "${text// /-}" "$text"
	done >some.jsonl
	"$BIN/text-encode" -q --model "$made/encoder" -o some some.jsonl
	"$BIN/refer-render" -q --scene scene --text some --model lifted --sentences all -o whole.jsonl
	"$BIN/refer-render" -q --scene scene --text some --model lifted --sentences all --parts -o parts.jsonl
	"$BIN/gs-check" parts.jsonl
	jq -c 'del(.parts)' parts.jsonl | cmp - <(jq -c . whole.jsonl)
	[ "$(jq -c '[.parts[]?.object]' parts.jsonl | head -n 4 | tr '\n' ' ')" = '["brown box","yellow bowl"] [] [] [] ' ]
	# a part is what a sentence about it alone gets, in every view
	jq -se 'group_by(.view) | length > 0 and all(.[]; (.[0].parts | map(.segmentation)) == [.[1].segmentation, .[2].segmentation])' \
		parts.jsonl
	jq -se 'all(.[]; all(.parts[]?; .score >= 0 and .score <= 1))' parts.jsonl
}

@test "--peak: the pixel with the largest response, or mean around it, and all else stays" {
	lifted
	ask --response r --response-type npy -o whole.jsonl
	ask --peak 1 -o one.jsonl
	ask --peak 30 -o wide.jsonl
	"$BIN/gs-check" one.jsonl wide.jsonl
	for file in one wide; do jq -c 'del(.peak)' $file.jsonl | cmp - <(jq -c . whole.jsonl); done
	for ref in first second again any; do
		largest=$(tail -c $((64 * 48 * 4)) r/$test_view/$ref.npy | od -An -v -t f4 -w4 |
			awk '$1 > most { most = $1; at = NR - 1 } END { print "[" at % 64 "," int(at / 64) "]" }')
		[ "$(jq -c "select(.ref == \"$ref\").peak" one.jsonl)" = "$largest" ]
	done
	# the mean is elsewhere, but in the mask's box; an empty mask has none
	not cmp -s one.jsonl wide.jsonl
	"$BIN/miou-score" --json -q --truth whole.jsonl wide.jsonl | jq -e '.peak_in_box == 1'
	[ "$(jq -c 'select(.ref == "none") | has("peak")' wide.jsonl)" = false ]
	ask --threads 1 --peak 30 | cmp - wide.jsonl
}

@test "refs that differ only in a slash or percent have pictures of their own" {
	printf '{"ref":"%s","object":"cup","text":"the cup"}\n' a/b a%2Fb a_b ../x >refs.jsonl
	"$BIN/text-encode" --model "$made/encoder" -o text.safetensors refs.jsonl
	render --png png -o pred.jsonl
	[ "$(ls -A png/$test_view | sort | tr '\n' ' ')" = "$(printf '%s\n' ..%2Fx.png a%252Fb.png a%2Fb.png a_b.png | sort | tr '\n' ' ')" ]
	[ "$(ls png)" = "$test_view" ]
}

@test "a view that is called .. is refused, and nothing is written outside the folder of pictures" {
	mkdir in
	for name in .. . a/b ''; do
		jq -c --arg name "$name" '.[0].name = $name' "$made/scene/cameras.json" >scene/cameras.json
		run render --split all --png in/png --overlay in/overlay -o in/pred.jsonl
		[ "$status" = 3 ]
		[[ $output == "refer-render: scene/cameras.json: view 0: key 'name' "* ]]
		[ -z "$(ls -A in)" ]
	done
}

@test "--size and --scale are the sizes of records and pictures" {
	size() { rm -rf png; render --refs silent --png png "$@" | jq -c .segmentation.size; picture png/$test_view/silent.png; }
	[ "$(size --size 20x10)" = "[10,20]
20 10 8 0" ]
	[ "$(size --scale 0.5)" = "[24,32]
32 24 8 0" ]
	[ "$(size --scale 2)" = "[96,128]
128 96 8 0" ]
	[ "$(size --scale 0.0001)" = "[1,1]
1 1 8 0" ]
	says 3 "refer-render: $test_view: size 65536x65536 (width x height) has more than 4294967295 pixels" \
		render --size 65536x65536
}

@test "masks of training views teach again" {
	render --split train --sentences train --scale 0.5 -o masks2.jsonl
	"$BIN/gs-weigh" -q --scale 0.5 -o half scene
	"$BIN/refer-train" -v --scene scene --weights half --text text.safetensors --masks masks2.jsonl --iterations 20 \
		-o model2.safetensors 2>err
	grep -q '4 views, 3 sentences, 12 pairs$' err
	"$BIN/refer-render" --scene scene --text text.safetensors --model model2.safetensors -o pred.jsonl
	"$BIN/gs-check" pred.jsonl
}

@test "names that are not there" {
	try=$'\n'"Try 'refer-render --help'."
	refuses 2 "--views: no view 'view_99'; there are 5: view_000, view_001, view_002, view_003, view_004$try" --views view_001,view_99
	refuses 2 "--views: no view ''; there are 5: view_000, view_001, view_002, view_003, view_004$try" --views view_001,
	refuses 2 "--refs: no sentence 'pink-cone'; there are 5: brown-box-1, pink-cone-1, silent, yellow-bowl-1, yellow-bowl-5$try" --refs pink-cone-1,pink-cone
}

@test "a split without views or sentences has no records" {
	sed 's/"split":"test"/"split":"train"/' scene/cameras.json >all && mv all scene/cameras.json
	says 0 "refer-render: warning: scene: no view in this split" render
	says 0 "" render -q
	grep train "$made/some.jsonl" | "$BIN/text-encode" --model "$made/encoder" -o text.safetensors
	says 0 "refer-render: warning: text.safetensors: no sentence in this split" render --split all --sentences test
}

@test "a model of another scene, and text of another width" {
	splats scene/splats.safetensors
	refuses 3 "model.safetensors: is of a scene of 1000 Gaussians, scene has 1"
	cp "$made/scene/splats.safetensors" scene
	# Two sentences of two columns.
	header='{"__metadata__":{"format":"refer.text","version":"1","refs":"[\"r1\"]","objects":"[\"cup\"]","texts":"[\"cup\"]","splits":"[\"test\"]"},"offsets":{"dtype":"I64","shape":[2],"data_offsets":[0,16]},"words":{"dtype":"F32","shape":[1,2],"data_offsets":[16,24]},"sentences":{"dtype":"F32","shape":[1,2],"data_offsets":[24,32]}}'
	while (((8 + ${#header}) % 8)); do header+=' '; done
	st text.safetensors "$header" "00000000000000000100000000000000$f1$f1$f1$f1"
	refuses 3 "model.safetensors: is of sentences of width 24, text.safetensors has 2"
}

@test "inputs that are missing, empty, cut short or of another kind" {
	refuses 4 "none/splats.safetensors: No such file or directory" --scene none
	refuses 4 "none: No such file or directory" --text none
	refuses 4 "none: No such file or directory" --model none
	: >empty
	refuses 3 "empty: 0 bytes, too short for a safetensors file" --text empty
	refuses 3 "empty: 0 bytes, too short for a safetensors file" --model empty
	refuses 3 "text.safetensors: format is 'refer.text', expected 'refer.model', 'refer.lifted' or 'refer.selection'" --model text.safetensors
	refuses 3 "model.safetensors: format is 'refer.model', expected 'refer.text'" --text model.safetensors
	truncate -s -1 model.safetensors
	run render -o pred.jsonl
	[ "$status" = 3 ]
	[[ $output == "refer-render: model.safetensors: tensor '"*"': ends at data offset "* ]]
	[ ! -e pred.jsonl ]
	: >scene/cameras.json
	run render -o pred.jsonl
	[ "$status" = 3 ]
	[[ $output == "refer-render: scene/cameras.json: "* ]]
}

@test "a folder of pictures that cannot be made, and a full disk: exit 4" {
	: >file
	for option in png response overlay; do
		refuses 4 "file: Not a directory" --$option file/pictures
	done
	[ -e /dev/full ] || skip "no /dev/full"
	says 4 "refer-render: /dev/full: No space left on device" render -o /dev/full
}

@test "a lifted model: the most probable object, as sure as it is probable and its masks are good" {
	lifted
	ask -o pred.jsonl
	[ "$(jq -r '[.ref, .object] | join(" ")' pred.jsonl | tr '\n' ,)" = "first cup,second box,again cup,any ?,none ?," ]
	mask() { jq -r "select(.ref == \"$1\").segmentation.counts" pred.jsonl; }
	[ "$(mask first)" = "$(mask again)" ]
	[ "$(mask first)" != "$(mask second)" ]
	[ "$(areas <pred.jsonl | awk '{ print ($1 > 20) }' | tr -d '\n')" = 11110 ]
	# The second object's confidence is a half.
	jq -se 'map({(.ref): .score}) | add | .first > 0.6 and .first <= 1 and .second > 0.3 and .second <= 0.5 and .none == 0' pred.jsonl
	"$BIN/refer-render" --scene scene --text asked.safetensors --model - <lifted.safetensors | cmp - pred.jsonl
	ask --calibration none | cmp - pred.jsonl
}

@test "sentences that mean one object have a picture each" {
	lifted
	ask --png png -o pred.jsonl
	[ "$(ls png/$test_view | tr '\n' ' ')" = "again.png any.png first.png none.png second.png " ]
	cmp png/$test_view/first.png png/$test_view/again.png
	not cmp -s png/$test_view/first.png png/$test_view/second.png
}

@test "--min-probability: what means nothing that was lifted has an empty mask and score 0" {
	lifted
	# A sentence that no training sentence says is a match.
	ask --min-probability 0.999 --refs any,first -o pred.jsonl
	[ "$(areas <pred.jsonl | awk '{ print ($1 > 0) }' | tr -d '\n')" = 10 ]
	[ "$(jq 'select(.ref == "any").score' pred.jsonl)" = 0 ]
	# A trained model has no such probabilities.
	render -o none.jsonl
	render --min-probability 1 | cmp - none.jsonl
}

@test "--without leaves parts of the choice out, and knows their names" {
	lifted
	ask --without names,colours,sizes,relations,sentence --refs first -o pred.jsonl
	ask --refs first -o all.jsonl
	[ "$(areas <pred.jsonl)" = "$(areas <all.jsonl)" ]
	not cmp -s pred.jsonl all.jsonl
	says 2 "refer-render: --without: no part 'word'
Try 'refer-render --help'." ask --without words,word
}

@test "--amodal: outlines hold what is in sight, and say how much that is" {
	lifted
	ask --split all -o seen.jsonl
	ask --split all --amodal --png whole -o whole.jsonl
	jq -se 'all(.[]; has("visible") | not)' seen.jsonl
	jq -se 'all(.[]; .visible >= 0 and .visible <= 1) and any(.[]; .visible > 0.1 and .visible < 0.9)' whole.jsonl
	[ "$(jq -c 'select(.ref == "none").visible' whole.jsonl | sort -u)" = 0 ]
	[ "$(areas <whole.jsonl | awk '{ n += $1 } END { print n }')" -gt 0 ]
	"$BIN/gs-check" whole.jsonl whole/view_001/first.png
	"$BIN/pseudomask-select" --method top1 whole.jsonl | jq -se 'all(.[]; has("visible"))'
}

@test "--amodal of a trained model" {
	render --split train --refs brown-box-1 --amodal -o whole.jsonl
	jq -se 'all(.[]; .visible >= 0 and .visible <= 1) and any(.[]; .visible > 0.3)' whole.jsonl
	"$BIN/miou-score" --json -q --predicted-views --truth "$made/whole.jsonl" whole.jsonl |
		jq -e '.objects["brown box"].miou > 0.2'
}

@test "as many pictures at a time as there are threads" {
	lifted
	# All views are rendered side by side only where there are as many as threads.
	jq -c '[.[0] as $v | range(128) | . as $i | $v | .name = "v\($i)"]' "$made/scene/cameras.json" >scene/cameras.json
	ask --threads 64 --split all --png 64/png --response 64/response --overlay 64/overlay -o 64.jsonl
	ask --threads 1 --split all --png 1/png --response 1/response --overlay 1/overlay -o 1.jsonl
	cmp 1.jsonl 64.jsonl
	diff -r 1 64
}

@test "lifted models, too: --threads 1, 2 and 3 give the same bytes" {
	lifted
	for n in 1 2 3; do
		mkdir $n
		ask --threads $n --split all --amodal --png $n/png --response $n/response --overlay $n/overlay -o $n/pred.jsonl
	done
	diff -r 1 2
	diff -r 1 3
}

@test "a lifted model that does not fit" {
	lifted
	fails() { says 3 "refer-render: $1" "$BIN/refer-render" --scene scene "${@:2}" -o pred.jsonl && [ ! -e pred.jsonl ]; }
	fails "lifted.safetensors: is of sentences of width 2, text.safetensors has 24" --text text.safetensors --model lifted.safetensors
	sed 's/"pieces":/"pieced":/' asked.safetensors >other.safetensors
	fails "other.safetensors: no word pieces, which lifted.safetensors asks for: encode its sentences again" \
		--text other.safetensors --model lifted.safetensors
	truncate -s -1 lifted.safetensors
	run ask -o pred.jsonl
	[ "$status" = 3 ] && [ ! -e pred.jsonl ]
	lifted
	splats scene/splats.safetensors
	fails "lifted.safetensors: is of a scene of 1000 Gaussians, scene has 1" --text asked.safetensors --model lifted.safetensors
}

@test "usage errors" {
	try=$'\n'"Try 'refer-render --help'."
	says 2 "refer-render: --scene, --text and --model are required$try" "$BIN/refer-render" --scene scene
	says 2 "refer-render: --text and --model cannot both be stdin$try" render --text - --model -
	says 2 "refer-render: --peak and --amodal do not go together$try" render --peak 1 --amodal
	says 2 "refer-render: --peak: '0' is not a whole number from 1 to 1024$try" render --peak 0
	says 2 "refer-render: --size and --scale do not go together$try" render --size 4x3 --scale 1
	says 2 "refer-render: --size: '0x3' is not WIDTHxHEIGHT with both from 1 to 65536$try" render --size 0x3
	says 2 "refer-render: --scale: '0' is not a number from 0.0001 to 16$try" render --scale 0
	says 2 "refer-render: --min-probability: '2' is not a number from 0 to 1$try" render --min-probability 2
	says 2 "refer-render: --response-type: 'jpg' is not one of png|npy$try" render --response-type jpg
	says 2 "refer-render: unexpected operand 'more'$try" render more
}

@test "-v ends with time and memory" {
	render -v -o pred.jsonl 2>err
	tail -n 1 err | grep -qE '^refer-render: [0-9.]+ s, peak memory [0-9.]+ MiB$'
}

@test "weights that are finite but so large that responses are not: the model and the sentence are named" {
	local length begin
	"$BIN/refer-train" -q --scene "$made/scene" --weights "$made/weights" --text "$made/text.safetensors" \
		--masks "$made/masks.jsonl" --iterations 2 --precision f32 -o huge
	length=$(od -An -t d8 -N 8 huge | tr -d ' ')
	begin=$(head -c $((8 + length)) huge | tail -c +9 | jq '.["feature.2.weight"].data_offsets[0]')
	for ((i = 0; i < 64 * 128; i++)); do printf '\xff\xff\x7f\x7f'; done | # the largest float
		dd of=huge bs=1 seek=$((8 + length + begin)) conv=notrunc 2>/dev/null
	LC_ALL=C sed -i 's/crc32.feature.2.weight/crc3_.feature.2.weight/' huge
	"$BIN/gs-check" huge
	mkdir out
	for tool in refer-render refer-locate; do
		status=0
		"$BIN/$tool" --scene "$made/scene" --text "$made/text.safetensors" --model huge -o out/x 2>line || status=$?
		[ $status = 3 ]
		grep -qE "^$tool: huge: the responses to ref '[^']+' are not finite: its weights are too large$" line
		[ "$(wc -l <line)" = 1 ]
		[ -z "$(ls -A out)" ]
	done
}
