#!/usr/bin/env bats
# A scene that moves, from frames to masks: what holds whatever moves. The file and its import: format/motion.bats.

# times FILTER: the cameras of the still scene in 3DGS's form, with the times and shifts that a filter of index $i gives.
times() {
	jq "[.[] | .world_to_camera as \$w | (if (\$w | length) == 16 then [\$w[0:4], \$w[4:8], \$w[8:12]] else \$w end) as \$m |
		{img_name: .name, width, height, fx, fy, rotation: [range(3) as \$r | [range(3) as \$c | \$m[\$c][\$r]]],
		 position: [range(3) as \$r | -([range(3) as \$c | \$m[\$c][\$r] * \$m[\$c][3]] | add)]}] |
		to_entries | map(.key as \$i | .value | $1)" still/scene/cameras.json
}

# chain DIR SPLATS IMPORT_OPTION...: imports, weighs and lifts into DIR.
chain() {
	local dir=$1 splats=$2
	shift 2
	mkdir -p "$dir/lifted"
	"$BIN/gs-import" -q --test-views "$(cat test-views)" "$@" -o "$dir/scene" "$splats"
	"$BIN/gs-weigh" -q -o "$dir/weights" "$dir/scene"
	"$BIN/refer-lift" -q --scene "$dir/scene" --weights "$dir/weights" --text text.safetensors --masks masks.jsonl -o "$dir/lifted/model.safetensors"
}

render() { "$BIN/refer-render" -q --split all --scene "$1/scene" --text text.safetensors --model "$1/lifted/model.safetensors" "${@:2}"; }

setup_file() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	export OMP_WAIT_POLICY=passive
	cd "$BATS_FILE_TMPDIR"
	cp -r "$BATS_TEST_DIRNAME/../golden/bert" encoder
	"$BIN/gs-synth" -q --objects 3 --views 6 --size 64x48 --gaussians 2000 -o .
	"$BIN/text-encode" -q --model encoder -o text.safetensors sentences.jsonl
	jq -c --arg test "$(cat test-views)" 'select(.view as $v | $test | split(",") | index($v) | not)' truth.jsonl >masks.jsonl
	chain still point_cloud.ply
	render still -o still/masks.jsonl
	mkdir frames same
	cp point_cloud.ply frames/f1.ply
	"$BIN/gs-transform" -q --translate 2,-1,0.5 -o frames/f2.ply point_cloud.ply
	cp point_cloud.ply same/f1.ply
	cp point_cloud.ply same/f2.ply
	times '.time = $i % 2 | .position[0] += 2 * .time | .position[1] -= .time | .position[2] += 0.5 * .time' >together.json
	chain together frames --cameras together.json --times 0:1
}

setup() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	load ../format/files
	export OMP_WAIT_POLICY=passive
	cd "$BATS_FILE_TMPDIR"
}

@test "a scene and cameras that move together have the masks of the still scene" {
	render together -o together/masks.jsonl
	[ "$("$BIN/miou-score" --json --truth still/masks.jsonl together/masks.jsonl | jq '.miou > 0.995')" = true ]
	# and without the times they have not
	render together --time 0 -o together/first.jsonl
	[ "$("$BIN/miou-score" --json --truth still/masks.jsonl together/first.jsonl | jq '.miou < 0.8')" = true ]
	"$BIN/refer-render" -q --threads 7 --split all --scene together/scene --text text.safetensors --model together/lifted/model.safetensors | cmp - together/masks.jsonl
}

@test "a pixel that is pointed at and the masks of a page are of their view's time" {
	masks() { jq -c '{do: "mask", view, thing: .object}' masks.jsonl | head -n 12 | "$BIN/refer-serve" -q --stdio --encoder encoder "$1"; }
	diff <(masks still) <(masks together)
	render still --peak 1 --views "$(jq -r '.[1].name' still/scene/cameras.json)" | jq -r 'select(.peak) | "\(.view):\(.peak[0]),\(.peak[1])"' | sort -u >places
	[ -s places ]
	local place
	while read -r place; do
		found() { "$BIN/refer-ask" -q --json --encoder encoder --point "$place" "$1" | jq -r '.things[0].name'; }
		[ "$(found still)" = "$(found together)" ]
	done <places
}

@test "frames in which nothing moves are a still scene, to the byte" {
	times '.time = $i % 2' >times.json
	times '.' >cameras.json
	chain same_moving same --cameras times.json
	chain same_still point_cloud.ply --cameras cameras.json
	render same_moving -o a.jsonl
	render same_still -o b.jsonl
	cmp a.jsonl b.jsonl
}

@test "where things are at a time" {
	times '.time = 0' >first.json
	chain two frames --cameras first.json
	local object at
	object=$(jq -r .object masks.jsonl | head -n 1)
	centre() { "$BIN/refer-locate" -q --scene two/scene --text text.safetensors --model two/lifted/model.safetensors "$@" | jq -sc "map(select(.object == \"$object\") | .centre // .box.centre)[0]"; }
	at=$(jq -nc --argjson a "$(centre)" --argjson b "$(centre --time 1)" '[range(3) as $k | ($b[$k] - $a[$k]) * 100 | round]')
	[ "$at" = '[200,-100,50]' ]
	says 3 "refer-render: two/scene/motion.safetensors: time 2 is not within its times, 0 to 1" render two --time 2
	says 2 "refer-render: --time: still/scene is still: it has no motion.safetensors
Try 'refer-render --help'." render still --time 0
}

@test "a track: where what is meant is at every stored time" {
	times '.time = 0' >first.json
	[ -e two/scene ] || chain two frames --cameras first.json
	track() { "$BIN/refer-locate" -q --scene two/scene --text text.safetensors --model two/lifted/model.safetensors "$@"; }
	track --track -o track.jsonl
	"$BIN/gs-check" track.jsonl
	[ "$(jq -s 'map(.time) | unique' -c track.jsonl)" = "[0,1]" ]
	cmp <(jq -c 'select(.time == 0) | [.ref, .min, .max, .oriented]' track.jsonl) <(track | jq -c '[.ref, .min, .max, .oriented]')
	# All things move together here, so that the same is meant at either time.
	cmp <(jq -c 'select(.time == 1) | [.ref, .min, .max, .oriented]' track.jsonl) <(track --time 1 | jq -c '[.ref, .min, .max, .oriented]')
	says 2 "refer-locate: --track: still/scene is still: it has no motion.safetensors
Try 'refer-locate --help'." "$BIN/refer-locate" -q --track --scene still/scene --text text.safetensors --model still/lifted/model.safetensors
}

@test "every view at every stored time" {
	times '.time = 0' >first.json
	[ -e two/scene ] || chain two frames --cameras first.json
	render two --all-times -o all.jsonl --overlay all
	"$BIN/gs-check" all.jsonl
	for t in 0 1; do
		render two --time $t | jq -c '{view, ref, segmentation}' | cmp - <(jq -c "select(.view | endswith(\".t0000$t\")) | {view: .view[:-7], ref, segmentation}" all.jsonl)
	done
	[ "$(ls all | wc -l)" = "$((2 * $(jq length two/scene/cameras.json)))" ]
	says 2 "refer-render: --all-times: still/scene is still: it has no motion.safetensors
Try 'refer-render --help'." render still --all-times
	says 2 "refer-render: --time and --all-times do not go together
Try 'refer-render --help'." render two --all-times --time 1
}

@test "views without a time are not drawn" {
	times '.' >none.json
	"$BIN/gs-import" -q --cameras none.json -o none frames
	says 3 "refer-render: none: the scene moves, and view '$(jq -r '.[0].name' none/cameras.json)' has no time: gs-import takes it from the key 'time' of a camera, or one for all with --time" \
		"$BIN/refer-render" -q --split all --scene none --text text.safetensors --model two/lifted/model.safetensors
	"$BIN/refer-render" -q --time 1 --split all --scene none --text text.safetensors --model two/lifted/model.safetensors -o /dev/null
}

@test "scores of sentences that have a time: accuracy, vIoU and tIoU" {
	# The cup is meant at 1 and 2 and answered at 2 (half of it) and 3; the plate always, and always answered.
	for t in 0 1 2 3; do
		echo '{"view":"v'$t'","object":"cup","time":'$t',"segmentation":{"size":[1,8],"counts":[0,4,4]}}'
		echo '{"view":"v'$t'","object":"plate","time":'$t',"segmentation":{"size":[1,8],"counts":[4,4]}}'
		echo '{"view":"v'$t'","ref":"plate","segmentation":{"size":[1,8],"counts":[4,4]}}' >&3
		echo '{"view":"v'$t'","ref":"cup","segmentation":{"size":[1,8],"counts":'$([ $t -lt 2 ] && echo '[8]' || echo '[0,2,6]')'}}' >&3
	done >at.jsonl 3>ap.jsonl
	echo '{"ref":"cup","object":"cup","text":"the cup that falls","kind":"falls","split":"test","when":[1,2]}' >as.jsonl
	echo '{"ref":"plate","object":"plate","text":"the plate","kind":"plain","split":"test"}' >>as.jsonl
	run "$BIN/miou-score" --answers --sentences as.jsonl --truth at.jsonl ap.jsonl
	[ "$status" -eq 0 ]
	diff - <(echo "$output" | sed -n 7,9p) <<-END
	pairs     right      mIoU      oIoU   refused   F1@0.25    F1@0.5       Acc      vIoU      tIoU  kind
	    2   50.00 %   25.00 %   25.00 %   50.00 %   50.00 %    0.00 %   50.00 %   16.67 %   33.33 %  falls
	    4  100.00 %  100.00 %  100.00 %    0.00 %  100.00 %  100.00 %         -         -         -  plain
	END
	"$BIN/miou-score" --answers --json --sentences as.jsonl --truth at.jsonl ap.jsonl | jq -e '.all.timed == 1 and .all.accuracy == 0.5 and (.all.viou * 6 - 1 | fabs < 1e-12) and .kinds.plain.viou == null and .kinds.falls.pairs == 2'
	run "$BIN/miou-score" --answers --sentences as.jsonl --truth <(sed 's/"time":[0-9],//' at.jsonl) ap.jsonl
	[ "$status" -eq 3 ]
	[[ $output = *": no mask of view 'v0' has a time, which sentence 'cup' needs: its 'when'" ]]
	for when in '[2,1]' '[1]' '1' '["a",2]'; do
		run "$BIN/miou-score" --answers --sentences <(sed "s/\[1,2\]/$when/" as.jsonl) --truth at.jsonl ap.jsonl
		[ "$status" -eq 3 ]
		[[ $output = *":1: key 'when' is not [from,to]" ]]
	done
}

# made DIR N: a scene of gs-synth that moves, at N times, imported and lifted, and the masks of all its views in DIR/masks.jsonl.
made() {
	local dir=$1
	"$BIN/gs-synth" -q --seed 71 --moving "$2" --views 12 --size 160x120 --gaussians 6000 -o "$dir"
	cat "$dir/sentences.jsonl" "$dir/moving.jsonl" >"$dir/all.jsonl"
	"$BIN/text-encode" -q --model encoder -o "$dir/text.safetensors" "$dir/all.jsonl"
	lifted "$dir" "$dir/lifted"
}

# lifted DIR TO: the same from DIR's files into TO.
lifted() {
	local dir=$1 to=$2 from=$1/frames
	[ -d "$from" ] || from=$dir/point_cloud.ply
	mkdir -p "$to"
	"$BIN/gs-import" -q --cameras "$dir/transforms.json" -o "$to/scene" "$from"
	"$BIN/gs-weigh" -q -o "$to/weights" "$to/scene"
	"$BIN/refer-lift" -q --scene "$to/scene" --weights "$to/weights" --text "$dir/text.safetensors" -o "$to/model.safetensors" \
		--masks <(jq -c --arg test "$(cat "$dir/test-views")" 'select(.view as $v | $test | split(",") | index($v) | not)' "$dir/truth.jsonl")
	"$BIN/refer-render" -q --split all --scene "$to/scene" --text "$dir/text.safetensors" --model "$to/model.safetensors" -o "$to/masks.jsonl"
}

@test "a scene of gs-synth that moves, from frames to scores: the masks are as good as those of the same scene at rest" {
	made moves 24
	made rests 1
	# Which thing is said without its motion, so that both scenes have the sentence.
	jq -c "select(.kind == \"motion-plain\") | del(.when)" moves/moving.jsonl >plain.jsonl
	jq -c "select(.kind == \"motion-plain\") | del(.when)" rests/moving.jsonl | cmp - plain.jsonl
	score() { "$BIN/miou-score" --answers --json --sentences plain.jsonl --truth "$1/truth.jsonl" "$1/lifted/masks.jsonl" 2>/dev/null | jq .all.miou; }
	jq -n --argjson moves "$(score moves)" --argjson rests "$(score rests)" '$moves > 0.9 and $moves > $rests - 0.03' | grep -x true
	# and they do move: masks of the first time are of little use later
	"$BIN/refer-render" -q --time 0 --split all --scene moves/lifted/scene --text moves/text.safetensors --model moves/lifted/model.safetensors -o first.jsonl
	later() { "$BIN/miou-score" --json --truth <(jq -c 'select(.time == 1)' moves/truth.jsonl) <(jq -c 'select(.ref | test("^motion-plain"))' "$1") 2>/dev/null | jq .miou; }
	jq -n --argjson now "$(later moves/lifted/masks.jsonl)" --argjson first "$(later first.jsonl)" '$now > $first + 0.1' | grep -x true
	for threads in 1 7; do
		OMP_NUM_THREADS=$threads lifted moves again
		for file in scene/motion.safetensors weights model.safetensors masks.jsonl; do
			diff -r "moves/lifted/$file" "again/$file"
		done
		rm -r again
	done
}

# answers OPTION...: what sentences of motion are answered with, of the scene of the test before.
answers() {
	jq -r .text moves/moving.jsonl >questions
	"$BIN/refer-ask" -q --json --encoder encoder --scene moves/lifted/scene --model moves/lifted/model.safetensors "$@" moves <questions || [ $? = 1 ]
}

@test "words of motion: which thing moves so, and when; what nothing does is refused" {
	answers >replies
	right() { jq -n --slurpfile r replies --slurpfile a moves/moving.jsonl "[range(\$a | length) as \$i | \$a[\$i] + {got: [\$r[\$i] | select(.answered).things[].name] | sort} | select($1) |
		.got == (.objects | sort)] | (map(select(.)) | length) / length > $2" | grep -x true; }
	right '.objects != [] and .kind != "motion-plain"' 0.85
	right '.objects == []' 0.9
	# a sentence that says nothing of motion has no time, and what is refused a reason
	jq -n --slurpfile r replies --slurpfile a moves/moving.jsonl '[range($a | length) as $i | $r[$i] | if .answered then has("when") == ($a[$i].kind != "motion-plain") else .reason != "" end] | all' | grep -x true
	answers --threads 7 | cmp - replies
	# masks of these times alone, and the records of all views say them
	ask() { "$BIN/refer-render" -q --split all --scene moves/lifted/scene --text moves/text.safetensors --model moves/lifted/model.safetensors "$@"; }
	ask --when -o when.jsonl
	"$BIN/miou-score" -q --answers --json --sentences moves/moving.jsonl --truth moves/truth.jsonl when.jsonl | jq '.all.viou > 0.85 and .all.tiou > 0.85' | grep -x true
	jq -c '[.view, .ref, .when]' when.jsonl | cmp - <(jq -c '[.view, .ref, .when]' moves/lifted/masks.jsonl)
	"$BIN/gs-check" when.jsonl >check
}

# of KIND: the first such sentence of a thing whose name has no number.
of() { jq -cn --arg kind "$1" 'first(inputs | select(.kind == $kind and (.object // "0" | test("[0-9]") | not)))' moves/moving.jsonl; }

# asks QUESTION TEST: a question about the object of the sentence on standard input, $x, and what holds of the reply.
asks() {
	local x
	x=$(cat)
	"$BIN/refer-ask" -q --json --encoder encoder --scene moves/lifted/scene --model moves/lifted/model.safetensors moves "$(jq -r --arg q "$1" '.object as $o | $q | sub("X"; $o)' <<<"$x")" >reply || [ $? = 1 ]
	jq --argjson x "$x" "$2" reply | grep -x true || { cat reply; false; }
}

@test "questions of motion: yes or no, and when; of what is not known of time, that" {
	of motion-moves | asks "does the X move?" '.kind == "there" and .yes and .things[0].name == $x.object'
	of motion-still | asks "does the X move?" '.yes == false and .reason != ""'
	of motion-stops | asks "when does the X stop?" '.kind == "when" and (.value | ltrimstr("at ") | tonumber - $x.when[1] | fabs < 0.1)'
	of motion-moves | asks "when does the X move?" '.value | startswith("from ")'
	of motion-still | asks "when is the X red?" '.answered == false and .value == "not known"'
	of motion-moves | asks "how fast is the X?" '.answered == false and .value == "not known"'
	of motion-moves | asks "where is the X at the end?" '.answered == false and (.reason | contains("--time"))'
	of motion-moves | asks "where is the X?" '.answered'
}
