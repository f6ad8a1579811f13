#!/usr/bin/env bats
# refer-train. Options that every tool has are in common.bats; what makes a model or a checkpoint malformed in
# format/model.bats and format/checkpoint.bats; the step, the order and the state in unit/test_step.c and unit/test_train.c.

load refer-train

@test "a model, and nothing else" {
	train -o out.safetensors >printed 2>&1
	[ ! -s printed ]
	[ "$(ls | tr '\n' ' ')" = "masks.jsonl out.safetensors printed scene text.safetensors weights " ]
	"$BIN/gs-check" out.safetensors
	[ "$(meta out.safetensors gaussians)" = 1000 ]
	[[ "$(meta out.safetensors options)" == "--iterations 8 --precision u8 --interaction pcmi --similarity dot --query words --contrast cosine --feature-width 16 \
--temperature 0.1 --lambda 0.02 --feature-rate 0.0025 --mlp-rate 0.0001 --batch 1 --negatives 12 --tolerance 0 --share 0.04 --init-iterations 0 --seed 1, inputs "???????? ]]
}

@test "--threads 1, 2 and 3 give the same bytes" {
	for n in 1 2 3; do train --threads $n --batch 2 --log log$n -o m$n; done
	cmp m1 m2
	cmp m1 m3
	cmp log1 log2
}

@test "--memory: views that are read from a file give the same bytes, and nothing is left" {
	for more in "--batch 2" "--share 0 --tolerance 0.1"; do
		train $more --interaction none --log log -o m
		train -v --memory 0 --threads 3 $more --interaction none --log read.log -o read 2>said
		grep -qE '^refer-train: the weights of 4 views are in a file, [0-9]+ MiB$' said
		cmp m read
		cmp log read.log
	done
	train -v -o m 2>said
	not grep -q 'in a file' said
	train --memory 0 -o - >piped
	cmp m piped
	[ "$(ls | tr '\n' ' ')" = "log m masks.jsonl piped read read.log said scene text.safetensors weights " ]
}

@test "--memory: a training goes on from a checkpoint whatever it was" {
	cut_short
	train --interaction none --iterations 60 -o whole
	train --interaction none --iterations 60 --memory 0 --resume -o m
	cmp m whole
}

@test "--memory: no room for the file" {
	small() { (trap '' XFSZ; ulimit -f 100; train -q --memory 0 --share 0 -o out/m); }
	mkdir out
	says 4 "refer-train: out/m.weights: File too large" small
	[ -z "$(ls -A out)" ]
	says 4 "refer-train: none/refer-train.weights: No such file or directory" env TMPDIR=none "$BIN/refer-train" --scene scene --weights weights \
		--text text.safetensors --masks masks.jsonl --memory 0 -o -
}

@test "the same seed gives the same bytes, another seed others" {
	train -o a
	train -o b --seed 1
	train -o c --seed 2
	cmp a b
	not cmp -s a c
	[ "$(meta c seed)" = 2 ]
}

@test "stdout and stdin equal files" {
	train -o file
	train -o - >piped
	cmp file piped
	"$BIN/refer-train" --scene scene --weights weights --text text.safetensors --masks - --iterations 8 -o from <masks.jsonl
	cmp file from
	"$BIN/refer-train" --scene scene --weights weights --text - --masks masks.jsonl --iterations 8 -o from <text.safetensors
	cmp file from
}

@test "a line of the log every 100 steps, and the loss falls" {
	train --iterations 310 --log log -o m
	[ "$(jq -r .iteration log | tr '\n' ' ')" = "100 200 300 " ]
	jq -se '.[2].loss < 0.2 * .[0].loss and .[2].bce < 0.15 and all(.[]; .loss > .bce and .contrast > 0)' log
	jq -se 'all(.[]; (.bce + 0.02 * .contrast - .loss | fabs) < 1e-6 * .loss)' log
}

@test "--log - is stdout, and a pipe is written to" {
	hundred() { train --interaction none --iterations 100 -o m "$@"; }
	hundred --log log
	hundred --log - >out
	cmp log out
	hundred --log >(cat >piped)
	for _ in 1 2 3 4 5 6 7 8 9 10; do cmp -s log piped && break; sleep 0.1; done
	cmp log piped
}

@test "every --interaction, --similarity and --contrast learns finite numbers" {
	for way in none attention attention+fp add pcmi pcmi-proj; do
		train --interaction $way --iterations 30 -o m
		[ "$(meta m interaction)" = $way ]
		"$BIN/gs-check" m # finite, all of it
	done
	for way in none attention pcmi; do
		train --interaction $way --similarity cosine -o m
		[ "$(meta m similarity)" = cosine ]
		"$BIN/gs-check" m
	done
	for way in none dot pairs; do
		train --contrast $way -o m.$way
		"$BIN/gs-check" m.$way
	done
	not cmp -s m.none m.dot
	not cmp -s m.none m.pairs
}

@test "--query parses: the same bytes for any number of threads, a model that is asked by parses, and no other text" {
	for n in 1 2 3; do train --threads $n --query parses --batch 2 -o m$n; done
	cmp m1 m2
	cmp m1 m3
	[ "$(meta m1 query)" = parses ]
	"$BIN/gs-check" m1
	"$BIN/refer-render" --scene scene --text text.safetensors --model m1 --threads 1 -o one
	"$BIN/refer-render" --scene scene --text text.safetensors --model m1 --threads 3 -o three
	cmp one three
	[ "$(wc -l <one)" -gt 0 ]
	# Without word pieces there is nothing to parse by.
	LC_ALL=C sed 's/"pieces"/"pieceX"/' text.safetensors >foreign
	refuses 3 "foreign: no word pieces, which parses need: encode its sentences again" --query parses --text foreign
	says 3 "refer-render: foreign: no word pieces, which parses need: encode its sentences again" \
		"$BIN/refer-render" --scene scene --text foreign --model m1
}

@test "a killed training goes on to the same model and log" {
	train --interaction none --iterations 230 --log log -o whole
	"$BIN/refer-train" --scene scene --weights weights --text text.safetensors --masks masks.jsonl \
		--interaction none --iterations 230 --checkpoint 30 --log part.log -o part &
	pid=$!
	for ((i = 0; i < 1000; i++)); do [ -e part.checkpoint ] && break; sleep 0.01; done
	kill -KILL $pid
	wait $pid || true
	[ -e part.checkpoint ]
	[ ! -e part ]
	# What the killed one wrote after its checkpoint is written again.
	printf '{"iteration":100000,"bce":1}\n{"iteration":1' >>part.log
	train -v --interaction none --iterations 230 --checkpoint 30 --resume --log part.log -o part 2>err
	grep -qE '^refer-train: going on after step [0-9]+$' err
	cmp whole part
	cmp log part.log
	[ ! -e part.checkpoint ]
	[ "$(ls | tr '\n' ' ')" = "err log masks.jsonl part part.log scene text.safetensors weights whole " ]
}

# m.checkpoint of 50 steps without interaction: step 100 cannot be logged.
cut_short() {
	rm -rf m m.checkpoint
	says 4 "refer-train: /dev/full: No space left on device" \
		train --interaction none --iterations 150 --checkpoint 50 -o m --log /dev/full
	[ "$(meta m.checkpoint iteration)" = 50 ]
}

@test "a training that failed goes on from its checkpoint" {
	train --interaction none --iterations 60 -o whole
	cut_short
	train --interaction none --iterations 60 --resume -o m
	cmp whole m
	[ ! -e m.checkpoint ]
}

@test "--resume with other options or inputs is refused" {
	cut_short
	other="m.checkpoint: is of another training (its options or inputs differ); remove it or train without --resume"
	for option in "--seed 2" "--interaction attention" "--similarity cosine" "--contrast dot" "--feature-width 15" "--temperature 0.2" "--lambda 0.03" \
		"--feature-rate 0.001" "--mlp-rate 0.001" "--batch 2" "--tolerance 0.1"; do
		says 3 "refer-train: $other" train --resume --interaction none $option -o m
	done
	head -n 11 masks.jsonl >fewer.jsonl
	says 3 "refer-train: $other" train --resume --interaction none --masks fewer.jsonl -o m
	says 3 "refer-train: m.checkpoint: has 50 steps, more than the 49 asked for" train --resume --interaction none --iterations 49 -o m
	[ ! -e m ]
	[ -e m.checkpoint ]
	cp text.safetensors m.checkpoint
	says 3 "refer-train: m.checkpoint: format is 'refer.text', expected 'refer.checkpoint'" train --resume -o m
}

@test "--resume without a checkpoint starts at the beginning" {
	train -o a
	train --resume -o b
	cmp a b
}

@test "without --resume a checkpoint is replaced with a warning, or left alone where none are written" {
	cut_short
	cp m.checkpoint kept
	says 0 "refer-train: warning: m.checkpoint: is of an earlier training and will be replaced; --resume would go on from it" \
		train --checkpoint 5 -o m
	[ ! -e m.checkpoint ] # it became this training's own
	cp kept m.checkpoint
	says 0 "" train --checkpoint 0 -o m
	cmp kept m.checkpoint
}

@test "a model that exists is replaced, in the end" {
	echo old >m
	refused() { says 3 "refer-train: none.jsonl: no mask of a training view is of a training sentence of text.safetensors" "$@"; }
	: >none.jsonl
	refused train --masks none.jsonl -o m
	[ "$(cat m)" = old ]
	train -o m
	"$BIN/gs-check" m
}

@test "a model that cannot be written is found out before training" {
	mkdir folder
	for out in folder none/m; do
		run train --iterations 100000000 --log log -o $out
		[ "$status" = 4 ]
		[ ! -e log ]
	done
	[ "$output" = "refer-train: none/m: No such file or directory" ]
	says 4 "refer-train: none/log: No such file or directory" train --iterations 100000000 --log none/log -o m
}

@test "a full disk: exit 4, and nothing is left" {
	[ -e /dev/full ] || skip "no /dev/full"
	says 4 "refer-train: /dev/full: No space left on device" train -o /dev/full
	says 4 "refer-train: /dev/full: No space left on device" train --interaction none --iterations 100 --log /dev/full -o m
	[ ! -e m ]
	# No file above 100 KiB can be written: the checkpoint cannot.
	small() { (trap '' XFSZ; ulimit -f 100; train -q --checkpoint 2 -o m); }
	says 4 "refer-train: m.checkpoint: File too large" small
	[ "$(ls | tr '\n' ' ')" = "masks.jsonl scene text.safetensors weights " ]
}

@test "inputs that are not there: exit 4" {
	refuses 4 "none/splats.safetensors: No such file or directory" --scene none
	refuses 4 "none/view_000.safetensors: No such file or directory" --weights none
	refuses 4 "none: No such file or directory" --text none
	refuses 4 "none: No such file or directory" --masks none
	rm weights/view_001.safetensors
	refuses 4 "weights/view_001.safetensors: No such file or directory"
}

@test "inputs that are empty: exit 3" {
	: >empty
	refuses 3 "empty: 0 bytes, too short for a safetensors file" --text empty
	refuses 3 "empty: no mask of a training view is of a training sentence of text.safetensors" --masks empty
	: >weights/view_000.safetensors
	refuses 3 "weights/view_000.safetensors: 0 bytes, too short for a safetensors file"
	: >scene/splats.safetensors
	refuses 3 "scene/splats.safetensors: 0 bytes, too short for a safetensors file"
}

@test "inputs that are cut short: exit 3" {
	cut() { truncate -s -1 "$1"; }
	cut masks.jsonl
	truncate -s -40 masks.jsonl
	run train -o m
	[ "$status" = 3 ]
	[[ $output == "refer-train: masks.jsonl:12: "* ]]
	cp "$made/masks.jsonl" .
	cut text.safetensors
	run train -o m
	[ "$status" = 3 ]
	[[ $output == "refer-train: text.safetensors: tensor 'middle': ends at data offset "* ]]
	cp "$made/text.safetensors" .
	cut weights/view_000.safetensors
	run train -o m
	[ "$status" = 3 ]
	[[ $output == "refer-train: weights/view_000.safetensors: tensor 'weight': ends at data offset "* ]]
	cut scene/splats.safetensors
	run train -o m
	[ "$status" = 3 ]
	[[ $output == "refer-train: scene/splats.safetensors: tensor 'sh': ends at data offset "* ]]
	[ ! -e m ]
}

@test "inputs of another kind: exit 3" {
	refuses 3 "weights/view_000.safetensors: format is 'refer.weights', expected 'refer.text'" --text weights/view_000.safetensors
	refuses 3 "$made/sentences.jsonl:1: key 'view' is missing" --masks "$made/sentences.jsonl"
	cp text.safetensors weights/view_000.safetensors
	refuses 3 "weights/view_000.safetensors: format is 'refer.text', expected 'refer.weights'"
	cp text.safetensors scene/splats.safetensors
	refuses 3 "scene/splats.safetensors: format is 'refer.text', expected 'refer.splats'"
}

@test "a mask of a view that the scene does not have" {
	sed 's/"view_[0-9]*"/"view_999"/' masks.jsonl >other.jsonl
	refuses 3 "other.jsonl:1: key 'view': the scene has no view 'view_999'; there are 5: view_000, view_001, view_002, view_003, view_004" --masks other.jsonl
	cat masks.jsonl other.jsonl >more.jsonl
	train -q --iterations 2 --masks masks.jsonl -o plain
	train --iterations 2 --masks more.jsonl -o left-out 2>said
	cmp plain left-out
	n=$(wc -l <masks.jsonl)
	grep -q "more.jsonl:$((n + 1)): the scene has no view 'view_999': $n of $((2 * n)) masks, of views that it lacks, are left out$" said
}

@test "two masks of one sentence or object in a view" {
	sed 's/"object":"[^"]*"/"ref":"brown-box-1"/' masks.jsonl >refs.jsonl
	refuses 3 "refs.jsonl:2: a second mask of ref 'brown-box-1' in the same view" --masks refs.jsonl
	sed 's/"object":"[^"]*"/"object":"cup"/' masks.jsonl >objects.jsonl
	refuses 3 "objects.jsonl:2: a second mask of object 'cup' in the same view" --masks objects.jsonl
}

@test "weights of another scene" {
	"$BIN/gs-synth" -q --objects 2 --views 5 --size 64x48 --gaussians 1001 -o other
	"$BIN/gs-import" -q --images other/images -o other/scene other/point_cloud.ply
	"$BIN/gs-weigh" -q -o other/weights other/scene
	refuses 3 "other/weights/view_000.safetensors: is of a scene of 1001 Gaussians, scene has 1000" --weights other/weights
}

@test "masks that match no sentence" {
	sed 's/"object":"/&other /' masks.jsonl >other.jsonl
	refuses 3 "other.jsonl: no mask of a training view is of a training sentence of text.safetensors" --masks other.jsonl
	# Masks of test views teach nothing.
	sed 's/"view":"[^"]*"/"view":"'"$(cat "$made/test-views")"'"/' masks.jsonl | head -n 3 >test.jsonl
	refuses 3 "test.jsonl: no mask of a training view is of a training sentence of text.safetensors" --masks test.jsonl
}

@test "a text without training sentences, or with some that have no words" {
	jq -c '.split = "test"' "$made/some.jsonl" | "$BIN/text-encode" --model "$made/encoder" -o test.safetensors
	refuses 3 "test.safetensors: no training sentence with words" --text test.safetensors
	jq -c 'if .ref == "pink-cone-1" then .text = "" else . end' "$made/some.jsonl" |
		"$BIN/text-encode" --model "$made/encoder" -o wordless.safetensors
	says 0 "refer-train: warning: wordless.safetensors: 1 training sentences without words are left out" \
		train --text wordless.safetensors -o m
	says 0 "" train -q --text wordless.safetensors -o m
}

@test "masks of another size are resized" {
	# Each pixel four times is the same mask.
	"$BIN/gs-weigh" -q --scale 0.5 -o half scene
	"$BIN/gs-weigh" -q --scale 0.25 -o quarter scene
	train --weights half -o a
	[ -s a ]
	# All and nothing stay that at any size.
	for size in 1,1 48,64 73,97; do
		h=${size%,*} w=${size#*,}
		jq -nc --argjson h $h --argjson w $w '{view:"view_000",object:"brown box",segmentation:{size:[$h,$w],counts:[0,$h*$w]}}' >full.jsonl
		train --weights quarter --masks full.jsonl -o m.$w
	done
	cmp m.1 m.64
	cmp m.1 m.97
	jq -nc '{view:"view_000",object:"brown box",segmentation:{size:[64,48],counts:[0,3072]}}' >turned.jsonl
	refuses 3 "turned.jsonl:1: view 'view_000': a mask of 48x64, but the view is 64x48 (width x height): is the photograph turned by EXIF?" --masks turned.jsonl
}

@test "a mask of a sentence goes before that of its object, whatever their order" {
	mask() { printf '{"view":"view_000",%s,"segmentation":{"size":[1,1],"counts":[%s]}}\n' "$1" "$2"; }
	{ mask '"ref":"brown-box-1"' 0,1; mask '"object":"brown box"' 1; } >a.jsonl
	{ mask '"object":"brown box"' 1; mask '"ref":"brown-box-1"' 0,1; } >b.jsonl
	mask '"ref":"brown-box-1"' 0,1 >c.jsonl
	for f in a b c; do train --masks $f.jsonl -o $f; done
	cmp a b
	cmp a c
}

@test "views without any weight" {
	# only the test views see the scene: gs-weigh refuses one that no view sees
	jq -c 'map(if .split == "train" then .world_to_camera[2][3] = -1000 else . end)' scene/cameras.json >moved && mv moved scene/cameras.json
	"$BIN/gs-weigh" -q --split all -o nothing scene
	refuses 3 "nothing: no Gaussian has weight in a view with masks" --weights nothing
}

@test "--precision f32, f16 and u8 store the same model in fewer bytes" {
	for p in f32 f16 u8; do
		train --iterations 100 --precision $p -o m.$p
		"$BIN/gs-check" m.$p | sed -n "s/^m.$p: ok: refer.model, $p, \([0-9]* features\), .*/\1/p" >features.$p
		grep -q "features" features.$p
		cmp features.f32 features.$p
		"$BIN/refer-render" -q --scene scene --text text.safetensors --model m.$p --split all -o masks.$p
		"$BIN/miou-score" -q --fail-under 0.99 --truth masks.f32 masks.$p >scores
	done
	train --iterations 100 -o m
	cmp m m.u8
	[ "$(wc -c <m.f16)" -lt $(($(wc -c <m.f32) * 53 / 100)) ]
	[ "$(wc -c <m.u8)" -lt $(($(wc -c <m.f32) * 32 / 100)) ]
}

@test "--precision does not belong to a checkpoint: a training may end in another" {
	train --interaction none --iterations 60 --precision f16 -o whole
	cut_short
	train --interaction none --iterations 60 --precision f16 --resume -o m
	cmp whole m
}

@test "--feature-width: features of any width learn the same with any number of threads, and answer as bytes too" {
	train -o default
	train --feature-width 16 -o m
	cmp default m
	for n in 1 5; do
		train --iterations 200 --feature-width $n --precision f32 --threads 1 --log log.f32 -o m.f32
		train --iterations 200 --feature-width $n --threads 3 --log log.u8 -o m.u8
		cmp log.f32 log.u8
		for p in f32 u8; do
			[ "$("$BIN/gs-check" --json m.$p | jq .columns)" = $n ]
			"$BIN/refer-render" -q --scene scene --text text.safetensors --model m.$p --split all -o masks.$p
		done
		"$BIN/miou-score" -q --fail-under 0.4 --truth masks.jsonl masks.f32 >scores
		"$BIN/miou-score" -q --fail-under 0.99 --truth masks.f32 masks.u8 >scores
	done
}

@test "--feature-width: a training of another width than the default goes on from its checkpoint" {
	train --interaction none --feature-width 5 --iterations 110 -o whole
	says 4 "refer-train: /dev/full: No space left on device" \
		train --interaction none --feature-width 5 --iterations 150 --checkpoint 10 -o m --log /dev/full
	[ "$(meta m.checkpoint iteration)" = 90 ]
	train --interaction none --feature-width 5 --iterations 110 --resume -o m
	cmp whole m
}

@test "--tolerance leaves Gaussians out" {
	train -o all
	train --tolerance 0.2 -o some
	[ "$(wc -c <some)" -lt "$(wc -c <all)" ]
	"$BIN/gs-check" some
}

@test "-v says what is learned from, and -q leaves out warnings" {
	cat masks.jsonl >more.jsonl
	printf '{"view":"%s","object":"brown box","segmentation":{"size":[1,1],"counts":[1]}}\n' "$(cat "$made/test-views")" >>more.jsonl
	train -v --masks more.jsonl -o m 2>err
	grep -qx 'refer-train: 1 masks of test views are not used' err
	grep -qxE 'refer-train: [0-9]+ of 1000 Gaussians share [0-9]+ features, [0-9.]+ a pixel' err
	grep -qx 'refer-train: 4 views, 3 sentences, 12 pairs' err
	tail -n 1 err | grep -qE '^refer-train: [0-9.]+ s, peak memory [0-9.]+ MiB$'
}

@test "masks of other views are refused" {
	jq -c '.view |= "view_00\((ltrimstr("view_00") | tonumber + 2) % 5)"' masks.jsonl >next
	run train --masks next -o model
	[ "$status" = 3 ]
	[[ "$output" == "refer-train: next: what masks show in one view is not where those of other views show it (by 0."*", at least 0.35 is right): are they of other views, "* ]]
	[ ! -e model ]
}

@test "usage errors" {
	try=$'\n'"Try 'refer-train --help'."
	says 2 "refer-train: --scene, --weights, --text and --masks are required$try" "$BIN/refer-train" -o m
	says 2 "refer-train: -o MODEL is required$try" train
	says 2 "refer-train: --text and --masks cannot both be stdin$try" train --text - --masks - -o m
	says 2 "refer-train: --masks and --init cannot both be stdin$try" train --init - --masks - -o m
	says 2 "refer-train: --init-iterations needs --init$try" train --init-iterations 5 -o m
	says 2 "refer-train: --similarity cosine does not go with --interaction pcmi-proj$try" \
		train --similarity cosine --interaction pcmi-proj -o m
	says 2 "refer-train: --resume needs a file to write to: there is no checkpoint of stdout$try" train --resume -o -
	says 2 "refer-train: -o and --log cannot both be stdout$try" train --log - -o -
	says 2 "refer-train: --iterations: '0' is not a whole number from 1 to 100000000$try" train --iterations 0 -o m
	says 2 "refer-train: --batch: '65' is not a whole number from 1 to 64$try" train --batch 65 -o m
	for width in 0 33 1.5; do
		says 2 "refer-train: --feature-width: '$width' is not a whole number from 1 to 32$try" train --feature-width $width -o m
	done
	says 2 "refer-train: --tolerance: '1' is not a number from 0 to 0.99$try" train --tolerance 1 -o m
	says 2 "refer-train: --precision: 'u4' is not one of f32|f16|u8$try" train --precision u4 -o m
	says 2 "refer-train: --interaction: 'all' is not one of none|attention|attention+fp|add|pcmi|pcmi-proj$try" \
		train --interaction all -o m
	[ ! -e m ]
}

@test "a training that diverges says so, and writes no model and no checkpoint of it" {
	mkdir out
	# rates far too high: the loss is not finite, or stays far above that of no answer
	status=0
	train --iterations 250 --mlp-rate 10 --feature-rate 10 --interaction none --checkpoint 100 -o out/m 2>line || status=$?
	[ $status = 1 ]
	[ "$(wc -l <line)" = 1 ]
	grep -qE '^refer-train: out/m: training diverged after step [0-9]+: .*; lower rates may help$' line
	[ -z "$(ls -A out)" ]
}

@test "a training that is interrupted leaves a checkpoint, its own exit status, and goes on to the same model" {
	local files=(--scene scene --weights weights --text text.safetensors --masks masks.jsonl --iterations 1500)
	local way=(--interaction none --contrast none)
	"$BIN/refer-train" "${files[@]}" "${way[@]}" -o whole
	for signal in INT TERM; do
		env --default-signal "$BIN/refer-train" "${files[@]}" "${way[@]}" --log log -o m 2>said 3>&- &
		sleep 0.3
		kill -$signal $!
		status=0
		wait $! || status=$?
		[ $status = $((128 + $(kill -l $signal))) ]
		grep -qE '^refer-train: stopped after step [0-9]+(; --resume goes on from m.checkpoint)?$' said
		[ ! -e m ]
		[ -z "$(ls ./*.tmp.refersplat* 2>/dev/null)" ]
	done
	"$BIN/gs-check" m.checkpoint
	"$BIN/refer-train" "${files[@]}" "${way[@]}" --resume -o m
	cmp m whole
}

@test "a training that diverges leaves the last good checkpoint as it is" {
	"$BIN/refer-train" --scene scene --weights weights --text text.safetensors --masks masks.jsonl --iterations 100000 \
		--checkpoint 5 -o m 3>&- &
	for _ in $(seq 600); do [ -e m.checkpoint ] && break || sleep 0.1; done
	kill -9 $!
	wait $! || true
	cp m.checkpoint good
	for rates in "--mlp-rate 1 --feature-rate 10" "--mlp-rate 10 --feature-rate 10"; do
		status=0
		train -q --iterations 250 $rates --interaction none --checkpoint 100 -o m 2>line || status=$?
		[ $status = 1 ]
		grep -q 'training diverged after step [0-9]*: ' line
		cmp good m.checkpoint
		[ ! -e m ]
	done
	"$BIN/gs-check" m.checkpoint
}

@test "trainings that end well are no false alarm, however short" {
	for interaction in none pcmi pcmi-proj; do
		train --iterations 1 --interaction $interaction -o m
		train --iterations 120 --interaction $interaction -o m
	done
	train --iterations 210 --interaction none --feature-rate 0.1 -o m
}

@test "Gaussians that --tolerance leaves out stay out where features are shared, and the model says which" {
	# learns OPTION...: as many bits of the model's tensor 'learning' as Gaussians learn
	learns() {
		local n begin end bits
		train -v -o m "$@" 2>said
		read -r begin end < <(head -c $((8 + $(od -An -t d8 -N 8 m))) m | tail -c +9 | jq -r '.learning.data_offsets | @tsv')
		[ $((end - begin)) = 125 ]
		n=$(od -An -t d8 -N 8 m)
		bits=$(tail -c +$((9 + n + begin)) m | head -c 125 | xxd -b -c 1 | awk '{ n += gsub(1, "", $2) } END { print n }')
		grep -q "refer-train: $bits of 1000 Gaussians share" said
		echo "$bits"
	}
	all=$(learns)
	some=$(learns --tolerance 0.2)
	[ "$some" -gt 0 ]
	[ $((2 * some)) -lt "$all" ]
}
