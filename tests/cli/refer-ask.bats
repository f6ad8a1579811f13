#!/usr/bin/env bats
# refer-ask: questions, on a small scene whose truth is known. Options that every tool has are in common.bats, places and
# distances in refer-ask-places.bats.

setup_file() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	export OMP_WAIT_POLICY=passive
	load refer-ask
	make_run
	# The same scene, where the first thing has a name in another alphabet.
	first=$(jq -r .object sentences.jsonl | head -n 1)
	mkdir -p cyrillic/lifted
	ln -s ../run/scene cyrillic/scene
	for file in sentences truth; do
		jq -c --arg first "$first" 'if .object == $first then .object = "синяя чашка" | if .text then .text = "синяя чашка" else . end else . end' \
			$file.jsonl >$file.cyrillic.jsonl
	done
	lift cyrillic sentences.cyrillic.jsonl truth.cyrillic.jsonl
	sed 's/.*/where is the &?/' things >questions
	printf '%s\n' 'is there a sofa?' 'what is behind the wardrobe?' 'all the things' 'the largest thing' >>questions
	jq -r .text unseen.jsonl | head -n 13 >>questions
}

setup() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	load ../format/files
	load refer-ask
	export OMP_WAIT_POLICY=passive
	cd "$BATS_FILE_TMPDIR"
}

@test "each thing is found by its name, where it is" {
	while read -r thing; do
		answer=$(ask --json run "where is the $thing?")
		[ "$(jq -r '.things | map(.name) | join(",")' <<<"$answer")" = "$thing" ]
		jq -e '.answered and .things[0].probability > 0.5 and .runner_up.probability < 0.3' <<<"$answer"
		# the middle of the box is within a quarter of its length of the true one
		jq -e --argjson truth "$(jq -c --arg thing "$thing" 'select(.object == $thing)' boxes.jsonl)" '.things[0] |
			(([.centre, $truth.centre] | transpose | map(.[0] - .[1] | . * .) | add | sqrt) < ($truth.oriented.size | max) / 4)' <<<"$answer"
		ask run "where is the $thing?" | grep -qE "^$thing: [0-9.]+ [a-z ]+ .*; [0-9]+%, then .*%$"
		ask -v run "where is the $thing?" 2>/dev/null | grep -qE "^$thing: [0-9.]+ [a-z ]+ .*; [0-9]+%, then .*; centre .*, size .* high$"
	done <things
}

@test "the colour of a part, and what a thing is made of, are what a sentence says, or are not known" {
	real=${ENCODER_CACHE:-${XDG_CACHE_HOME:-$HOME/.cache}/refersplat/encoder}
	[ -e "$real/config.json" ] || skip "make encoder has not been run" # the tiny one takes few such sentences apart
	thing=$(head -n 1 things)
	mkdir -p parts/lifted
	ln -s ../run/scene parts/scene
	{ cat sentences.jsonl; jq -nc --arg thing "$thing" '{ref: "part", object: $thing, split: "train", text: "the wooden \($thing) with a turquoise handle"}'; } >sentences.parts.jsonl
	"$BIN/text-encode" -q --model "$real" -o parts.safetensors sentences.parts.jsonl
	"$BIN/refer-lift" -q --names masks --scene run/scene --weights weights --text parts.safetensors -o parts/lifted/model.safetensors \
		--masks <(cat truth.jsonl; jq -c --arg thing "$thing" 'select(.object == $thing) | .ref = "part"' truth.jsonl)
	part() { "$BIN/refer-ask" --encoder "$real" --json parts "$1"; }
	for question in "what colour is the handle of the $thing?" "what's the $thing's handle colour?" "which colour does the handle on the $thing have?"; do
		[ "$(part "$question" | jq -r .value)" = turquoise ]
	done
	part "what colour is the $thing?" | jq -e --arg colour "${thing%% *}" '.value | contains($colour)'
	part "what is the $thing made of?" | jq -e '.value | contains("wooden")'
	[ "$(part "is the $thing made of wood?" | jq .yes)" = true ]
	[ "$(part "is the $thing made of metal?" | jq .yes)" = false ]
	[ "$(part "is the $thing expensive?" | jq -r .value)" = "not known" ]
	part "what colour is the lid of the $thing?" >said || [ $? = 1 ]
	jq -e '.answered | not' said
}

@test "the nearest thing is the one whose centre is nearest, and its side is that of the viewpoint" {
	view=$(jq -r '.[0].name' run/scene/cameras.json)
	for thing in "$(head -n 1 things)" "$(tail -n 1 things)"; do
		answer=$(ask --json run "$thing")
		others=$(grep -vxF "$thing" things | while read -r other; do ask --json run "$other"; done | jq -sc 'map(.things[0])')
		jq -e --argjson others "$others" '.things[0] as $t | $others |
			map({name, d: ([.centre, $t.centre] | transpose | map(.[0] - .[1] | . * .) | add | sqrt)}) | min_by(.d) |
			.name == $t.nearest.name and (.d - $t.nearest.distance | fabs) < 1e-4' <<<"$answer"
		jq -r '.things[0].nearest.side' <<<"$answer" | grep -qxE 'to the (left|right) of|in front of|behind|above|below'
	done
	# two things that are nearest to each other are on opposite sides
	sides=$(while read -r thing; do ask --json --viewpoint "$view" run "$thing"; done <things |
		jq -sr 'map(.things[0]) | . as $all | .[] | . as $a | $all[] | select(.name == $a.nearest.name and .nearest.name == $a.name) |
			[.nearest.side, $a.nearest.side] | sort | join("/")' | sort -u)
	[ -n "$sides" ]
	not grep -vxE 'to the left of/to the right of|behind/in front of|above/below' <<<"$sides"
}

@test "what is not here is refused, with the reason and status 1" {
	says 1 "nothing here is that: nothing here is known as 'sofa'" ask run "where is the sofa?"
	says 1 "nothing here is that: the question has no words" ask run $'\u0301'
	thing=$(head -n 1 things)
	says 1 "nothing here is that: $thing comes nearest, but 'blue' does not fit it" ask run "the blue ${thing##* }"
	run ask --json run "the blue ${thing##* }"
	[ "$status" = 1 ]
	jq -e '(.answered | not) and .things == [] and .probability < 0.65 and (.reason | test("blue"))' <<<"$output"
	# unless nothing is refused
	ask --min-probability 0 run "where is the sofa?"
}

# kind QUESTION: what jq says of the answer in JSON, whatever the status
kind() { ask --json run "$1" | jq -r "$2" || [ "${PIPESTATUS[0]}" = 1 ]; }

@test "lengths are said in metres where the scene's units are metres, and what is alike is counted" {
	a=$(sed -n 1p things) b=$(sed -n 2p things)
	mkdir -p metres/lifted
	"$BIN/gs-import" -q --metres --images images -o metres/scene point_cloud.ply
	grep -a -q '"unit":"m"' metres/scene/splats.safetensors
	# two things of one name but for the number
	jq -c --arg a "$a" --arg b "$b" '.object |= if . == $a then "mug" elif . == $b then "mug 2" else . end' truth.jsonl >mugs.jsonl
	"$BIN/text-encode" -q --model encoder --names -o mugs.safetensors mugs.jsonl
	"$BIN/refer-lift" -q --names masks --scene metres/scene --weights weights --text mugs.safetensors --masks mugs.jsonl \
		-o metres/lifted/model.safetensors
	[[ "$(ask metres "what is there?")" =~ ^"three things: ".*"mug (2)" ]]
	[ "$(ask --json metres "what is there?" | jq -r '.unit, .number, (.things | length)' | paste -sd' ')" = "m 3 3" ]
	[[ "$(ask metres "how tall is the $(sed -n 3p things)?")" =~ ^[0-9.]+" "(cm|m)" high" ]]
	sed 's/"unit":"m"/"unit":"k"/' metres/scene/splats.safetensors >other.safetensors
	run "$BIN/gs-check" other.safetensors
	[ "$status" = 1 ] && [[ "$output" == *"metadata 'unit' is 'k', expected 'm'"* ]]
}

@test "each kind of question gets its kind of answer" {
	a=$(sed -n 1p things) b=$(sed -n 2p things)
	[ "$(ask run "is there a ${a##* }?" | cut -d' ' -f1-3)" = "yes: $a" ]
	says 1 "no: nothing here is known as 'sofa'" ask run "is there a sofa?"
	[ "$(ask run "how many things are there?" | cut -d: -f1)" = three ]
	says 1 "none: nothing here is known as 'sofas'" ask run "please tell me how many sofas there are"
	[ "$(kind "how many ${a##* }s do you see?" .number)" = 1 ]
	[ "$(ask run "what do you see?" | cut -d: -f1)" = "three things" ]
	[ "$(kind "What is there?" '.things | map(.name) | sort | join("\n")')" = "$(cat things)" ]
	# where each is, as of a question for it
	[ "$(kind "what is there?" ".things[] | select(.name == \"$a\") | .nearest.side")" = "$(kind "the $a" '.things[0].nearest.side')" ]
	# what compares nothing is no comparison
	[ "$(kind "which is on the $a or the $b?" .kind)" = which ]
	# the first word of a name is its colour
	[ "$(kind "what colour is the ${a##* }?" .value)" = "${a%% *}" ]
	height=$(jq -r --arg a "$a" 'select(.object == $a) | .oriented.size[2]' boxes.jsonl)
	[ "$(kind "how tall is the $a" "(.value | split(\" \")[0] | tonumber) as \$x | \$x > 0.7 * $height and \$x < 1.4 * $height")" = true ]
	# of two the larger one, whichever comes first
	larger=$(kind "which is larger, the $a or the $b?" '.things[0].name')
	[ "$(kind "which is larger, the $b or the $a?" '.things[0].name')" = "$larger" ]
	[ "$(kind "which is smaller, the $b or the $a?" '.things[0].name')" != "$larger" ]
	[ "$(kind "is the $larger larger than the $(grep -vxF "$larger" things | grep -xF -e "$a" -e "$b")?" .yes)" = true ]
	[ "$(kind "is the $(grep -vxF "$larger" things | grep -xF -e "$a" -e "$b") larger than the $larger?" .yes)" = false ]
	says 1 "nothing here is that: the sofa: nothing here is known as 'sofa'" ask run "which is larger, the sofa or the $a?"
	[ "$(kind "the $a" .kind)" = which ]
	# yes and no of one thing, and which of two it is
	other=$(grep -vxF "$larger" things | grep -xF -e "$a" -e "$b")
	[ "$(kind "is the $other larger or smaller than the $larger?" .value)" = "smaller than the $larger" ]
	[ "$(kind "is the $a the only thing here?" .yes)" = false ]
	says 1 "not known: a scene does not tell that" ask run "who bought the $a?"
	[ "$(kind "is there nothing on the sofa?" .yes)" = true ]
	[ "$(kind "is there only one sofa?" .yes)" = false ]
	[ "$(kind "which is larger, the $a or the $b?" '.value | split(",")[0]')" = "$(kind "what is the size difference between the $a and the $b?" '.value | split(",")[0]')" ]
}

@test "a conversation: words that point back, until a blank line" {
	a=$(sed -n 1p things) b=$(sed -n 2p things)
	printf '%s\n' "how tall is the $a?" "how wide is it" "and the $b?" "where is it?" "no, the other one" "" "where is it?" | ask --json run >said || [ $? = 1 ]
	printf '%s\n' "how tall is the $a?" "and how wide?" | ask --json run | jq -se '.[1].understood | startswith("how wide is the")'
	printf '%s\n' "is there a ${a##* }?" "ok, the $b then?" "or a sofa?" | ask --json run | jq -se '.[1:] | map(.yes) == [true, false]'
	jq -r '[.kind, .understood // "", .things[0].name // ""] | join("|")' said >lines
	sed -i 's/|[^|]*$/|/;5s/.*/other/' lines
	printf '%s\n' "height||" "width|how wide is the $a|" "width|how wide is the $b|" "which|where is the $b?|" other "which||" | diff - lines
	jq -se --arg a "$a" --arg b "$b" '[.[0, 1].things[0].name == $a] + [.[2, 3].things[0].name == $b] + [.[4].things[0].name != $b, (.[5].answered | not)] | all' said
}

@test "of several that were spoken of no other thing is meant, whatever is asked of them" {
	tallest=$(kind "which thing is the tallest?" '.things[0].name')
	mapfile -t two < <(grep -vxF "$tallest" things)
	for ask in "which of them is the tallest?" "which is the tallest?" "which one is the tallest?"; do
		printf '%s\n' "the ${two[0]} and the ${two[1]}" "how many of those are there?" "$ask" "how many are ${tallest%% *}?" "where is the $tallest?" |
			ask --json run >said || [ $? = 1 ]
		jq -se --arg tallest "$tallest" '[.[1].number == 2, (.[2].things | length == 1), .[2].things[0].name != $tallest,
			.[3].number == 0, .[4].things[0].name == $tallest] | all' said
	done
}

@test "--always guesses what would be refused, and says so; what is there is answered as without it" {
	a=$(sed -n 1p things)
	[ "$(ask run --always "the $a")" = "$(ask run "the $a")" ]
	run ask run --always "the sofa"
	[ "$status" = 5 ]
	[[ $output == "a guess: "* ]]
	[ "$(ask --json run --always "the sofa" | jq -c '[.answered, .guess, (.things | length), .probability < 0.5]')" = "[true,true,1,true]" ]
	says 1 "no: nothing here is known as 'sofa'" ask run --always "is there a sofa?"
	says 1 "none: nothing here is known as 'sofas'" ask run --always "how many sofas are there?"
}

@test "nothing is at what is not here, however it is asked" {
	a=$(sed -n 1p things)
	for question in "is the $a on the sofa?" "what is on the sofa?" "how many things are on the sofa?" "is anything behind the sofa?" "which things are left of the sofa?"; do
		run ask run "$question"
		[ "$status" = 1 ]
		[[ $output == *"nothing here is known as what it names" ]]
	done
	[ "$(kind "is the $a not on the sofa?" .yes)" = true ]
}

@test "whether all are, and whether one is" {
	a=$(sed -n 1p things)
	[ "$(kind "are all the things ${a%% *}?" '[.yes, (.things | length)] | join(" ")')" = "false 3" ]
	[ "$(kind "is one of the things ${a%% *}?" '[.yes, .things[0].name] | join(" ")')" = "true $a" ]
	[ "$(kind "are there three things?" .yes)" = true ]
	[ "$(kind "are there more than three things?" .yes)" = false ]
	[ "$(ask run "are there at least two things?" | cut -d: -f1)" = yes ]
	run ask run "are there more than three things?"
	[ "$status" = 1 ]
}

@test "of two kinds of things: of which there are more, and how many" {
	a=$(sed -n 1p things)
	[ "$(ask run "are there more things than ${a##* }s?" | cut -d: -f1)" = "yes, three to one" ]
	[ "$(kind "do you see fewer things than ${a##* }s?" .yes)" = false ]
	[ "$(kind "is the number of things the same as that of ${a##* }s?" .yes)" = false ]
	[ "$(kind "are there as many sofas as ${a##* }s?" '[.yes, .value] | join(" ")')" = "false none to one" ]
	[ "$(kind "how many more things than ${a##* }s are there?" '[.number, .value] | join(" ")')" = "2 two more" ]
	[ "$(kind "which are there fewer of, things or ${a##* }s?" .value)" = "${a##* }s, one to three" ]
}

@test "the others of a kind, however they are asked for" {
	a=$(sed -n 1p things)
	for others in "and how many aren't?" "how many of the rest are there?" "how many of the others are there?"; do
		[ "$(printf '%s\n' "how many things are ${a%% *}?" "$others" "name them" | ask --json run | jq -sc --arg a "$a" 'map(.number // (.things | length))')" = "[1,2,2]" ]
	done
}

@test "what points back within another thing, and a 'that' that begins a clause" {
	a=$(sed -n 1p things)
	printf '%s\n' "where is the $a?" "and the one next to that?" "everything that is red" "how many of those are red?" | ask --json run >said || [ $? = 1 ]
	jq -se --arg a "$a" '[.[1].understood == "the one next to the \($a)", .[2].understood == null] | all' said
	[ "$(kind "tell me what you can see" .kind)" = list ]
	[[ $(ask run "are there any things that one can eat?") != *"does not say"* ]]
}

@test "several things are a line each" {
	[ "$(ask run "all the things" | cut -d: -f1 | sort)" = "$(cat things)" ]
	ask --json run "all the things" | jq -e '.things | length == 3 and (map(.probability) | . == (sort | reverse))'
}

@test "a pipe of twenty questions answers as twenty calls do, in words and in JSON, with blank lines between" {
	[ "$(wc -l <questions)" = 20 ]
	for json in "" --json; do
		while read -r question; do ask $json run "$question" || case $? in 1 | 5) ;; *) false ;; esac; done <questions >one
		sed 's/^/  /; a\\' questions | ask $json run >piped || [ $? = 1 ]
		cmp one piped
	done
	[ "$(wc -l <piped)" = 20 ]
	diff <(jq -r .question piped) questions
}

@test "each answer comes before the next question is read" {
	mkfifo "$BATS_TEST_TMPDIR/to" "$BATS_TEST_TMPDIR/from"
	ask --json run <"$BATS_TEST_TMPDIR/to" >"$BATS_TEST_TMPDIR/from" &
	exec 8>"$BATS_TEST_TMPDIR/to" 9<"$BATS_TEST_TMPDIR/from"
	while read -r thing; do
		echo "$thing" >&8
		read -r -t 20 answer <&9
		[ "$(jq -r '.things[0].name' <<<"$answer")" = "$thing" ]
	done <things
	exec 8>&- 9<&-
	wait
}

@test "questions that wait together are answered, and warned of, as each alone" {
	thing=$(head -n 1 things)
	long="$thing $(printf 'cup %.0s' {1..90})"
	for question in "$thing" "$long" "$thing"; do ask run "$question" || [ $? = 1 ]; done >alone 2>said
	grep -q 'word pieces, cut to the' said
	printf '%s\n' "$thing" "$long" "$thing" | ask run >piped 2>warned || [ $? = 1 ]
	cmp alone piped
	cmp said warned
	# the last line without its end, and one that no read takes whole
	printf '%s\n%70000s\n%s' "$thing" "$thing" "$thing" | ask run >padded 2>err || [ $? = 3 ]
	[ "$(cat err)" = "refer-ask: stdin:2: is longer than 2000 bytes" ]
	[ "$(cat padded)" = "$(sed 2d alone)" ]
}

@test "1 and 7 threads say the same" {
	ask --threads 1 --json --explain run <questions >one || [ $? = 1 ]
	ask --threads 7 --json --explain run <questions >seven || [ $? = 1 ]
	cmp one seven
	ask --threads 1 -o one.png run "$(head -n 1 things)"
	ask --threads 7 -o seven.png run "$(head -n 1 things)"
	cmp one.png seven.png
}

@test "lines that are no questions: one line on stderr for each, the others are answered, status 3" {
	thing=$(head -n 1 things)
	long=$(printf 'cup%.0s' {1..700})
	printf 'caf\xe9\n%s\n%s\n\n\0\n%s' "$thing" "$long" "$thing" >lines
	status=0
	ask run <lines >out 2>err || status=$?
	[ $status = 3 ]
	[ "$(cut -d: -f1 out)" = "$thing"$'\n'"$thing" ]
	[ "$(cat err)" = "refer-ask: stdin:1: is not UTF-8
refer-ask: stdin:3: is longer than 2000 bytes
refer-ask: stdin:5: has a NUL byte, as UTF-16 has: write it as UTF-8" ]
	says 3 "refer-ask: the question is not UTF-8" ask run $'caf\xe9'
	says 3 "refer-ask: the question is longer than 2000 bytes" ask run "$long"
	says 3 "refer-ask: the question is empty" ask run "  "
	printf '%2000s\n' "$thing" | ask run
}

@test "nothing is asked, nothing is said" {
	says 0 '' ask run
	printf '\n \n' | ask run | cmp - /dev/null
}

@test "a name in another alphabet" {
	answer=$(ask --json cyrillic "синяя чашка")
	[ "$(jq -r '.things[0].name' <<<"$answer")" = "синяя чашка" ]
	ask cyrillic "синяя чашка" | grep -q '^синяя чашка: '
	ask -o cyrillic.png cyrillic "синяя чашка"
	"$BIN/gs-check" cyrillic.png
}

@test "a folder that is not there, or lacks a part: what is missing and what makes it" {
	cd "$BATS_TEST_TMPDIR"
	ln -s "$BATS_FILE_TMPDIR/encoder" encoder
	says 4 "refer-ask: none: No such file or directory" ask none cup
	mkdir bare
	says 4 "refer-ask: bare: no scene in it: 'make -f pipelines/lift.mk SCENE=bare ...' makes one, --scene names another" ask bare cup
	ln -s "$BATS_FILE_TMPDIR/run/scene" bare/scene
	says 4 "refer-ask: bare: no lifted/model.safetensors in it: 'make -f pipelines/lift.mk SCENE=bare ...' makes one, --model names another" \
		ask bare cup
	XDG_CACHE_HOME=$PWD says 4 "refer-ask: $PWD/refersplat/encoder: no encoder there: 'refersplat-encoder' fetches one, in a checkout 'make encoder'" \
		"$BIN/refer-ask" "$BATS_FILE_TMPDIR/run" cup
	# with the parts named or in place, it works
	thing=$(head -n 1 "$BATS_FILE_TMPDIR/things")
	ask --model "$BATS_FILE_TMPDIR/run/lifted/model.safetensors" bare "$thing"
	mkdir refersplat
	ln -s "$BATS_FILE_TMPDIR/encoder" refersplat/encoder
	XDG_CACHE_HOME=$PWD "$BIN/refer-ask" "$BATS_FILE_TMPDIR/run" "$thing"
}

@test "a model of another scene or encoder, or a trained one" {
	"$BIN/gs-synth" -q --seed 2 --objects 3 --views 3 --size 32x24 --gaussians 1000 -o other
	"$BIN/gs-import" -q -o other/scene other/point_cloud.ply
	says 3 "refer-ask: run/lifted/model.safetensors: is of a scene of 2000 Gaussians, other/scene has 1000" ask --scene other/scene run cup
	cp run/lifted/model.safetensors cut
	truncate -s -1 cut
	run ask --model cut run cup
	[ "$status" = 3 ]
	[[ $output == "refer-ask: cut: "* ]]
	"$BIN/refer-train" -q --scene run/scene --weights weights --text text.safetensors --masks truth.jsonl --iterations 2 -o trained
	says 3 "refer-ask: trained: is a trained model; questions need one of refer-lift" ask --model trained run cup
}

@test "a picture: one PNG of the view and two lines of words, none where nothing is meant" {
	thing=$(head -n 1 things)
	ask --json -o picture.png run "$thing" >said
	[ "$(jq -r .picture said)" = picture.png ]
	jq -r '.[].name' run/scene/cameras.json | grep -qxF "$(jq -r .view said)"
	# 96 pixels wide, 72 and twice 12 high
	[ "$(od -An -tx1 -j16 -N8 picture.png | tr -d ' ')" = 0000006000000060 ]
	not ask -o none.png run "where is the sofa?"
	[ ! -e none.png ]
	says 2 "refer-ask: --picture needs a QUESTION
Try 'refer-ask --help'." ask -o none.png run
	says 2 "refer-ask: --picture must name a file
Try 'refer-ask --help'." ask -o - run cup
	says 2 "refer-ask: --model - needs a QUESTION, as questions come from stdin
Try 'refer-ask --help'." ask --model - run
	ask --model - run "$thing" <run/lifted/model.safetensors | grep -q "^$thing: "
	says 2 "refer-ask: --picture run/lifted/../lifted/model.safetensors would overwrite --model run/lifted/model.safetensors
Try 'refer-ask --help'." ask --model run/lifted/model.safetensors -o run/lifted/../lifted/model.safetensors run cup
	says 4 "refer-ask: no/x.png: No such file or directory" ask -o no/x.png run "$thing"
}

@test "--explain says the parse, the candidates and the parts" {
	thing=$(head -n 1 things)
	noun=${thing##* }
	ask --explain run "the $noun that is left of the $(tail -n 1 things)" >said || [ $? = 1 ]
	grep -qE "^  parse \([01]\.[0-9]+\): $noun, left \(" said
	grep -qE "^  fit [0-9.]+ $thing: noun $noun [01]\.[0-9]+; clause left \(.*\) [01]\.[0-9]+$" said
	[ "$(grep -c '^  fit ' said)" = 3 ]
	ask --explain --json run "the $noun" | jq -e --arg thing "$thing" '.explanation.candidates[0] | .name == $thing and
		(.parts | map(.part) == ["noun"])'
}

@test "--viewpoint: a view, a point, or neither" {
	view=$(jq -r '.[0].name' run/scene/cameras.json)
	ask --viewpoint "$view" run "$(head -n 1 things)"
	ask --viewpoint 1,2,3 run "$(head -n 1 things)"
	says 2 "refer-ask: --viewpoint: 'nowhere' is no view and no x,y,z
Try 'refer-ask --help'." ask --viewpoint nowhere run cup
	says 2 "refer-ask: --without: no part 'magic'
Try 'refer-ask --help'." ask --without magic run cup
}
