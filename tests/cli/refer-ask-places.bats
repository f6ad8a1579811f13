#!/usr/bin/env bats
# refer-ask: a thing under a pixel or in a box, how it could be called, distances, and a camera that is not in the scene.

setup_file() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	export OMP_WAIT_POLICY=passive
	load refer-ask
	make_run
	# The first view moved aside, as 3DGS, nerfstudio and COLMAP write cameras.
	jq '.[0] | .world_to_camera as $m | [{img_name: "new", width, height, fx, fy,
		rotation: [range(3) as $i | [range(3) as $k | $m[$k][$i]]],
		position: [range(3) as $i | 0.05 - ([range(3) as $k | $m[$k][$i] * $m[$k][3]] | add)]}]' run/scene/cameras.json >new.json
	jq '.[0] | {w: .width, h: .height, fl_x: .fx, fl_y: .fy, frames: [{file_path: "new.png", transform_matrix:
		[range(3) as $i | [.rotation[$i][0], -.rotation[$i][1], -.rotation[$i][2], .position[$i]]]}]}' new.json >transforms.json
}

setup() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	load ../format/files
	load refer-ask
	export OMP_WAIT_POLICY=passive
	cd "$BATS_FILE_TMPDIR"
}

# The view that shows a thing best, and the rectangle around it: "VIEW left top right bottom"
show() {
	ask --json -o "$BATS_TEST_TMPDIR/shown.png" run "the $1" | jq -r '[.view] + .pixels | join(" ")'
}

@test "each thing is picked by the box around it, and by the pixel in its middle" {
	while read -r thing; do
		read -r view left top right bottom < <(show "$thing")
		answer=$(ask --json --box "$view:$left,$top,$right,$bottom" run)
		jq -e --arg thing "$thing" '.answered and .things[0].name == $thing and .things[0].probability > 0.8 and
			(.picked | length) > 0 and .things[0].centre and (has("question") | not)' <<<"$answer"
		# corners the other way round, and beyond the picture's edge
		[ "$(ask --box "$view:$right,$bottom,$left,$top" run)" = "$(ask --box "$view:$left,$top,$right,$bottom" run)" ]
		answer=$(ask --json --point "$view:$(((left + right) / 2)),$(((top + bottom) / 2))" run)
		jq -e --arg thing "$thing" '.things[0].name == $thing and .things[0].probability > 0.45' <<<"$answer"
		ask --box "$view:$left,$top,$right,$bottom" run | grep -qE "^$thing: [0-9.]+ [a-z ]+ .*; [0-9]+%"
	done <things
	ask --box "$view:-5,-5,500,500" run
}

@test "what a picked thing could be called means that thing, as likely as is said" {
	while read -r thing; do
		read -r view left top right bottom < <(show "$thing")
		answer=$(ask --json --box "$view:$left,$top,$right,$bottom" run)
		called=$(jq -r .called.text <<<"$answer")
		[ -n "$called" ]
		ask --json run "$called" | jq -e --argjson said "$answer" '(.things | length) == 1 and .things[0].name == $said.things[0].name and
			.things[0].probability == $said.called.probability'
		ask --box "$view:$left,$top,$right,$bottom" run | grep -qE "; call it '$called' [0-9]+%$"
	done <things
}

@test "things of one noun are called by more than it" {
	# The same scene, where all things are boxes but for their colours.
	mkdir -p boxes/lifted
	ln -sf ../run/scene boxes/scene
	for file in sentences truth; do
		jq -c '.object |= sub(" .*"; " box") | if .text then .text = "the " + .object else . end' $file.jsonl >boxes.$file.jsonl
	done
	lift boxes boxes.sentences.jsonl boxes.truth.jsonl
	while read -r thing; do
		read -r view left top right bottom < <(show "$thing")
		answer=$(ask --json --box "$view:$left,$top,$right,$bottom" boxes)
		[ "$(jq -r '.things[0].name' <<<"$answer")" = "${thing%% *} box" ]
		jq -e '.called.text | . != "the box" and test("box")' <<<"$answer"
	done <things
}

@test "nothing is picked where nothing was lifted, and a place that is none is a usage error" {
	view=$(jq -r '.[0].name' run/scene/cameras.json)
	says 1 "nothing here is that: no thing that was lifted is seen there" ask --point "$view:0,0" run
	for place in "$view" "$view:1" "$view:1,2,3" "$view:1,x" "$view:1,2 "; do
		says 2 "refer-ask: --point: '$place' is not VIEW:x,y
Try 'refer-ask --help'." ask --point "$place" run
	done
	says 2 "refer-ask: --box: '$view:1,2' is not VIEW:x0,y0,x1,y1
Try 'refer-ask --help'." ask --box "$view:1,2" run
	says 2 "refer-ask: --point: no view 'nowhere'
Try 'refer-ask --help'." ask --point nowhere:1,2 run
	for place in 96,0 0,72 -1,0 0,-0.5; do
		says 2 "refer-ask: --point: '$view:$place' is outside of the view, which is 96x72
Try 'refer-ask --help'." ask --point "$view:$place" run
	done
	says 2 "refer-ask: --box: '$view:96,0,99,9' is outside of the view, which is 96x72
Try 'refer-ask --help'." ask --box "$view:96,0,99,9" run
	says 2 "refer-ask: --point, --box and QUESTION do not go together
Try 'refer-ask --help'." ask --point "$view:1,2" run cup
	says 2 "refer-ask: --point, --box and QUESTION do not go together
Try 'refer-ask --help'." ask --point "$view:1,2" --box "$view:1,2,3,4" run
}

@test "a distance is that of the boxes that each question alone has, however it is asked" {
	a=$(sed -n 1p things) b=$(sed -n 3p things)
	one=$(ask --json run "$a") other=$(ask --json run "$b")
	for question in "how far is the $a from the $b?" "what is the distance between the $a and the $b" \
		"How far apart are the $a and the $b?" "tell me the distance from the $a to the $b" "distance of the $a to the $b" \
		"how far are the $a and the $b from each other" "how close is the $a to the $b?"; do
		ask --json run "$question" | jq -e --argjson one "$one" --argjson other "$other" '.answered and (.things | map(.name)) ==
			[$one.things[0].name, $other.things[0].name] and .distance.gap >= 0 and .distance.gap < .distance.centres and
			(([$one.things[0].centre, $other.things[0].centre] | transpose | map(.[0] - .[1] | . * .) | add | sqrt) - .distance.centres |
			fabs) < 1e-4'
	done
	ask run "how far is the $a from the $b?" | grep -qE "^$a [0-9]+% to $b [0-9]+%: ([0-9.]+ between their boxes|their boxes touch), [0-9.]+ between their centres$"
	# the other way round, and both drawn
	ask --json -o "$BATS_TEST_TMPDIR/two.png" run "how far away from the $b is the $a" >said
	jq -e --arg a "$a" --arg b "$b" '(.things | map(.name)) == [$b, $a] and (.pixels | length) == 4' said
}

@test "a part that has a word of distance itself" {
	a=$(sed -n 1p things) b=$(sed -n 2p things) c=$(sed -n 3p things)
	ask --json run "how far is the $a from the $b that is far from the $c" | jq -e --arg a "$a" --arg b "$b" '(.things | map(.name)) == [$a, $b]'
}

@test "no distance where a thing is not there, is no other one, or is one alone" {
	a=$(head -n 1 things)
	says 1 "nothing here is that: the sofa: nothing here is known as 'sofa'" ask run "how far is the sofa from the $a?"
	says 1 "nothing here is that: a sofa: nothing here is known as 'sofa'" ask run "distance between the $a and a sofa"
	says 1 "nothing here is that: a distance is between two things, and both are $a" ask run "how far is the $a from the $a"
	says 1 "nothing here is that: a distance is between two things, and 'the $a' means 1" ask run "how far is the $a?"
	says 1 "nothing here is that: a distance is between two things, and 'all the things' means 3" ask run "distance between all the things"
	# these ask for a thing
	ask --json run "the $a" | jq -e 'has("distance") | not'
	ask --json run "which thing is far from the $a?" | jq -e 'has("distance") | not'
	ask --json run "the thing at a distance from the $a and the wall" | jq -e 'has("distance") | not' || [ "${PIPESTATUS[0]}" = 1 ]
}

@test "--camera: the picture is what it sees, in the formats of gs-import, and questions are asked from there" {
	thing=$(head -n 1 things)
	ask --json --camera new.json -o one.png run "$thing" >said
	jq -e --arg thing "$thing" '.view == "new" and .things[0].name == $thing and (.pixels | length) == 4' said
	ask --json --camera transforms.json -o two.png run "$thing"
	cmp one.png two.png
	read -r left top right bottom < <(jq -r '.pixels | join(" ")' said)
	ask --camera new.json --box "new:$left,$top,$right,$bottom" run | grep -q "^$thing: "
	# as from its centre, but for perspective
	ask --camera new.json --viewpoint "$(jq -r '.[0].name' run/scene/cameras.json)" run "$thing"
	# turned away, it sees nothing
	jq '.[0].rotation |= map([-.[0], .[1], -.[2]])' new.json >away.json
	ask --camera away.json -o away.png run "$thing" | grep -q '; drawn in view new, where it is not in sight$'
	ask --json --camera away.json -o away.png run "$thing" | jq -e 'has("pixels") | not'
}

@test "--camera: what is wrong with the file" {
	thing=$(head -n 1 things)
	says 4 "refer-ask: none.json: No such file or directory" ask --camera none.json run "$thing"
	jq '. + [.[0] | .img_name = "other"]' new.json >both.json
	says 3 "refer-ask: both.json: has 2 views; --camera takes one" ask --camera both.json run "$thing"
	echo '{}' >empty.json
	run ask --camera empty.json run "$thing"
	[ "$status" = 3 ]
	[[ $output == "refer-ask: empty.json: "* ]]
	says 2 "refer-ask: --camera - and the questions cannot both be stdin
Try 'refer-ask --help'." ask --camera - run
	ask --camera - run "$thing" <new.json
	says 2 "refer-ask: --picture new.json would overwrite --camera new.json
Try 'refer-ask --help'." ask --camera new.json -o new.json run "$thing"
}

@test "1 and 7 threads pick and call the same" {
	read -r view left top right bottom < <(show "$(head -n 1 things)")
	ask --threads 1 --json --box "$view:$left,$top,$right,$bottom" run >one
	ask --threads 7 --json --box "$view:$left,$top,$right,$bottom" run | cmp one -
}
