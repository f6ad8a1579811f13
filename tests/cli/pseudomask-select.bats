#!/usr/bin/env bats
# pseudomask-select: which candidate stands for an object in a view.

bats_require_minimum_version 1.5.0

setup() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	cd "$BATS_TEST_TMPDIR"
	# one row of six pixels, one column each: A = 1 to 3, B = 2 to 4
	A='{"size":[1,6],"counts":[1,3,2]}' B='{"size":[1,6],"counts":[2,3,1]}' C='{"size":[1,6],"counts":[5,1]}'
	cat > candidates.jsonl <<-END
	{"view":"v2","ref":"cup-1","object":"cup","score":0.9,"segmentation":$A}
	{"view":"v1","ref":"cup-1","object":"cup","score":0.9,"segmentation":$A}
	{"view":"v1","ref":"pan-1","object":"pan","score":0.2,"segmentation":$A}
	{"view":"v1","ref":"cup-2","object":"cup","score":0.5,"segmentation":$B}

	{"view":"v2","ref":"jar-1","object":"jar","segmentation":$C}
	{"view":"v1","ref":"cup-3","object":"cup","score":0.6,"segmentation":$B}
	END
}

# what is in the folder beside the input
strays() { ls | grep -v -x candidates.jsonl || true; }

@test "help and version" {
	run "$BIN/pseudomask-select" --help
	[ "$status" -eq 0 ]
	[[ "${lines[0]}" == "Usage: pseudomask-select [OPTION]... [CANDIDATES]" ]]
	[[ "$output" == *"--method ciou|iou|top1|first"* && "$output" == *"--min-score G"* ]]
	[[ "$output" == *"--scene SCENE"* && "$output" == *"--weights WEIGHTS"* ]]
	run "$BIN/pseudomask-select" -V
	[ "$status" -eq 0 ]
	[[ "$output" == "pseudomask-select (refersplat) "* ]]
}

@test "usage errors" {
	run "$BIN/pseudomask-select" --nonsense
	[ "$status" -eq 2 ]
	[ "${lines[0]}" = "pseudomask-select: unknown option '--nonsense'" ]
	[ "${lines[1]}" = "Try 'pseudomask-select --help'." ]
	run "$BIN/pseudomask-select" --method best candidates.jsonl
	[ "$status" -eq 2 ]
	[ "${lines[0]}" = "pseudomask-select: --method: 'best' is not one of ciou|iou|top1|first|scene" ]
	run "$BIN/pseudomask-select" --min-score 1.5 candidates.jsonl
	[ "$status" -eq 2 ]
	[ "${lines[0]}" = "pseudomask-select: --min-score: '1.5' is not a number from 0 to 1" ]
	run "$BIN/pseudomask-select" candidates.jsonl other.jsonl
	[ "$status" -eq 2 ]
	[ "${lines[0]}" = "pseudomask-select: unexpected operand 'other.jsonl'" ]
}

@test "scene and weights are for the methods that need them, and both" {
	for method in ciou iou top1; do
		run "$BIN/pseudomask-select" --method $method --scene scene --weights weights candidates.jsonl
		[ "$status" -eq 2 ]
		[ "${lines[0]}" = "pseudomask-select: --scene is for --method scene and first" ]
		run "$BIN/pseudomask-select" --method $method --weights weights candidates.jsonl
		[ "$status" -eq 2 ]
		[ "${lines[0]}" = "pseudomask-select: --weights is for --method scene and first" ]
	done
	for given in "" "--scene scene" "--weights weights"; do
		for method in first scene; do
			run "$BIN/pseudomask-select" --method $method $given candidates.jsonl
			[ "$status" -eq 2 ]
			[ "${lines[0]}" = "pseudomask-select: --method $method needs --scene SCENE and --weights WEIGHTS" ]
			[ "${lines[1]}" = "Try 'pseudomask-select --help'." ]
		done
	done
	# without a method, either asks for scene
	run "$BIN/pseudomask-select" --scene scene candidates.jsonl
	[ "$status" -eq 2 ]
	[ "${lines[0]}" = "pseudomask-select: --method scene needs --scene SCENE and --weights WEIGHTS" ]
}

@test "ciou: the object's sentences outvote the most confident of them" {
	run "$BIN/pseudomask-select" --method ciou candidates.jsonl
	[ "$status" -eq 0 ]
	[ "${#lines[@]}" -eq 3 ]
	[ "${lines[0]}" = '{"view":"v2","object":"cup","score":1,"segmentation":{"size":[1,6],"counts":"132"}}' ]
	# (1 + 1.2/3.3 + 0.5/0.6) / 3
	[[ "${lines[1]}" =~ ^'{"view":"v1","object":"cup","score":0.7323232323232'[0-9]+',"segmentation":{"size":[1,6],"counts":"231"}}'$ ]]
	# a person's, who gave no score, stays a person's
	[ "${lines[2]}" = '{"view":"v2","object":"jar","segmentation":{"size":[1,6],"counts":"51"}}' ]
}

@test "ciou is the default" {
	"$BIN/pseudomask-select" candidates.jsonl > default
	"$BIN/pseudomask-select" --method ciou --min-score 0.3 candidates.jsonl > ciou
	cmp default ciou
}

@test "iou: without the confidences" {
	run "$BIN/pseudomask-select" --method iou candidates.jsonl
	[ "$status" -eq 0 ]
	# (1 + 2/4 + 1) / 3
	[[ "${lines[1]}" == '{"view":"v1","object":"cup","score":0.8333333333333334,'*'"counts":"231"}}' ]]
}

@test "top1: the most confident" {
	run "$BIN/pseudomask-select" --method top1 candidates.jsonl
	[ "$status" -eq 0 ]
	[ "${lines[1]}" = '{"view":"v1","object":"cup","score":0.9,"segmentation":{"size":[1,6],"counts":"132"}}' ]
	[[ "${lines[2]}" == '{"view":"v2","object":"jar","segmentation":'* ]]
}

@test "min-score cuts strictly and -v counts what it cost" {
	run --separate-stderr "$BIN/pseudomask-select" -v --method top1 --min-score 0.9 candidates.jsonl
	[ "$status" -eq 0 ]
	[ "${#lines[@]}" -eq 1 ]
	[[ "${lines[0]}" == *'"object":"jar"'* ]]
	[ "${stderr_lines[0]}" = "pseudomask-select: 6 candidates, 5 of them not above 0.9" ]
	[ "${stderr_lines[1]}" = "pseudomask-select: 1 masks; 3 views of an object without one" ]
	run "$BIN/pseudomask-select" --min-score 0.19 candidates.jsonl
	[ "${#lines[@]}" -eq 4 ]
}

@test "a candidate without an object is pooled with its own sentence only" {
	jq -c 'if .object == "cup" then del(.object) else . end' candidates.jsonl > some.jsonl
	run "$BIN/pseudomask-select" --method top1 some.jsonl
	[ "$status" -eq 0 ]
	[ "${#lines[@]}" -eq 5 ]
	[ "${lines[2]}" = '{"view":"v1","ref":"cup-2","score":0.5,"segmentation":{"size":[1,6],"counts":"231"}}' ]
	# the sentence of that name is not the object of that name
	printf '%s\n' "{\"view\":\"v\",\"ref\":\"cup\",\"segmentation\":$A}" "{\"view\":\"v\",\"object\":\"cup\",\"segmentation\":$B}" > two
	run "$BIN/pseudomask-select" two
	[ "${#lines[@]}" -eq 2 ]
}

@test "any order, a pipe, - and any number of threads give the same" {
	"$BIN/pseudomask-select" -o expected candidates.jsonl
	"$BIN/pseudomask-select" --threads 1 candidates.jsonl > one
	"$BIN/pseudomask-select" --threads 2 < candidates.jsonl > two
	cat candidates.jsonl | "$BIN/pseudomask-select" --threads 7 - -o - > seven
	cmp expected one && cmp expected two && cmp expected seven
	tac candidates.jsonl | "$BIN/pseudomask-select" | sed 's/"score":[0-9.]*//' | sort > backwards
	sed 's/"score":[0-9.]*//' expected | sort | cmp - backwards
}

@test "many objects: threads do not change a byte" {
	for i in $(seq 300); do
		echo "{\"view\":\"v$((i % 7))\",\"object\":\"o$((i % 11))\",\"score\":0.$((310 + i % 600)),\"segmentation\":{\"size\":[10,10],\"counts\":[$((i % 50)),$((10 + i % 13)),$((90 - i % 50 - i % 13))]}}"
	done > many.jsonl
	"$BIN/pseudomask-select" --threads 1 many.jsonl > one
	"$BIN/pseudomask-select" --threads 2 many.jsonl > two
	[ "$(wc -l < one)" -eq 77 ]
	cmp one two
}

@test "masks of one view must have one size" {
	echo '{"view":"v1","ref":"cup-4","object":"jug","segmentation":{"size":[2,3],"counts":[6]}}' >> candidates.jsonl
	run "$BIN/pseudomask-select" -o out candidates.jsonl
	[ "$status" -eq 3 ]
	[ "$output" = "pseudomask-select: candidates.jsonl:8: a mask of 3x2, but view 'v1' has 6x1 on line 2" ]
	[ -z "$(strays)" ]
}

@test "no candidates: nothing, and a warning" {
	run --separate-stderr "$BIN/pseudomask-select" /dev/null
	[ "$status" -eq 0 ]
	[ -z "$output" ]
	[ "$stderr" = "pseudomask-select: warning: /dev/null: no candidates" ]
	echo '{"view":"v1","object":"o","score":0.2,"segmentation":{"size":[2,3],"counts":[0,1,5]}}' >weak
	[ "$("$BIN/pseudomask-select" weak 2>&1)" = "pseudomask-select: warning: weak: none of its candidates is above 0.3" ]
	run "$BIN/pseudomask-select" -q < /dev/null
	[ -z "$output" ]
}

@test "missing, truncated and foreign input, and no stray file" {
	run "$BIN/pseudomask-select" -o out nowhere.jsonl
	[ "$status" -eq 4 ]
	[ "$output" = "pseudomask-select: nowhere.jsonl: No such file or directory" ]
	head -c 200 candidates.jsonl > ../cut.jsonl
	run "$BIN/pseudomask-select" -o out ../cut.jsonl
	[ "$status" -eq 3 ]
	[[ "$output" == "pseudomask-select: ../cut.jsonl:2: not JSON at column "* ]]
	printf '\x89PNG\r\n' > ../image.png
	run "$BIN/pseudomask-select" -o out ../image.png
	[ "$status" -eq 3 ]
	[ "$output" = "pseudomask-select: ../image.png:1: not JSON at column 1" ]
	run "$BIN/pseudomask-select" -o out .
	[ "$status" -eq 4 ]
	[ "$output" = "pseudomask-select: .: Is a directory" ]
	[ -z "$(strays)" ]
	run "$BIN/pseudomask-select" -o nowhere/out candidates.jsonl
	[ "$status" -eq 4 ]
	[ "$output" = "pseudomask-select: nowhere/out: No such file or directory" ]
}

@test "an existing output is kept when the input is bad" {
	echo before > out
	run "$BIN/pseudomask-select" -o out nowhere.jsonl
	[ "$(cat out)" = before ]
}

setup_file() {
	local bin=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	cd "$BATS_FILE_TMPDIR"
	"$bin/gs-synth" -q --seed 2 --gaussians 3000 --views 6 --size 96x72 -o .
	"$bin/gs-import" -q --images images --test-views view_004 -o scene point_cloud.ply
	"$bin/gs-weigh" -q -o weights scene
	# two objects that every view sees
	jq -r .object truth.jsonl | sort | uniq -c | sed -n 's/^ *6 //p' | head -n 2 > objects
}

# The masks of the first or second of the two objects, as 1 or 2, or of both.
of() {
	jq -c --arg name "$(sed -n "$1p" "$BATS_FILE_TMPDIR/objects")" 'select(.object == $name)'
}
of_both() {
	jq -c --rawfile names "$BATS_FILE_TMPDIR/objects" 'select(.object | IN($names | split("\n")[]))'
}

# first ARG...: --method first on the synthetic scene, which is linked to as synth.
first() {
	ln -sfn "$BATS_FILE_TMPDIR" synth
	"$BIN/pseudomask-select" --method first --scene synth/scene --weights synth/weights "$@"
}

# The truth of one view as candidates.
truth_of() { jq -c "select(.view == \"$1\") | .score = 0.9" "$BATS_FILE_TMPDIR/truth.jsonl"; }

@test "first: a true mask of one view is carried to every other training view" {
	truth_of view_000 > true.jsonl
	run --separate-stderr first -v -o carried.jsonl true.jsonl
	[ "$status" -eq 0 ]
	[ "${stderr_lines[0]}" = "pseudomask-select: 8 candidates, 0 of them not above 0.3" ]
	[ "${stderr_lines[1]}" = "pseudomask-select: 8 objects, which begin in 1 views; 40 masks in 5 views" ]
	# views in the scene's order, and in each the objects in the order of the candidates
	for view in 0 1 2 3 5; do jq -c "[\"view_00$view\", .object, 0.9]" true.jsonl; done > expected
	jq -c '[.view, .object, .score]' carried.jsonl | cmp - expected
	jq -e -s 'all(.segmentation.size == [72, 96] and (has("ref") | not))' carried.jsonl
	# the view itself keeps its masks, the others' are right but for what it does not see
	cmp <(jq -c 'select(.view == "view_000") | .segmentation' carried.jsonl) <(jq -c .segmentation true.jsonl)
	jq -c 'select(.view != "view_000")' carried.jsonl > others.jsonl
	"$BIN/miou-score" --truth synth/truth.jsonl --predicted-views --fail-under 0.7 others.jsonl
}

@test "first and scene: how much of a whole object is in sight is said of no mask of another view" {
	truth_of view_000 | jq -c '.visible = 0.5' >some.jsonl
	first -o carried.jsonl some.jsonl
	jq -s -e 'length > 8 and all(has("visible") | not)' carried.jsonl
	"$BIN/pseudomask-select" --scene synth/scene --weights synth/weights -o grown.jsonl some.jsonl
	jq -s -e 'length > 8 and all(has("visible") | not)' grown.jsonl
	# a candidate that is only picked keeps it
	"$BIN/pseudomask-select" -o picked.jsonl some.jsonl
	jq -s -e 'length == 8 and all(.visible == 0.5)' picked.jsonl
}

@test "first: the order of the scene decides, not that of the file; test views and weak candidates do not" {
	{ truth_of view_004; truth_of view_003; truth_of view_001; } | of 1 |
		jq -c '.score = if .view == "view_001" then 0.3 else 0.8 end' > late.jsonl
	first -o late late.jsonl
	[ "$(jq -r .view late | tr '\n' ' ')" = "view_000 view_001 view_002 view_003 view_005 " ]
	cmp <(jq -c 'select(.view == "view_003") | .segmentation' late) <(jq -c 'select(.view == "view_003") | .segmentation' late.jsonl)
	first --min-score 0.2 -o early late.jsonl
	cmp <(jq -c 'select(.view == "view_001") | .segmentation' early) <(jq -c 'select(.view == "view_001") | .segmentation' late.jsonl)
	[ "$(jq .score early | sort -u)" = 0.3 ]
	# objects may begin in different views; each is the same as alone
	truth_of view_002 | of 2 > other.jsonl
	first -o other other.jsonl
	cat other.jsonl late.jsonl > both.jsonl
	first -o both both.jsonl
	of 1 < both | cmp - late
	of 2 < both | cmp - other
	[ "$(wc -l < both)" -eq 10 ]
}

@test "first: the most confident candidate of the view, a ref's own where there is no object" {
	truth_of view_000 | of_both > two
	{ jq -c '.object = "thing" | .ref = "r" + (.score | tostring)' two
	of 2 < two | jq -c '.object = "thing" | .score = 0.95'
	of 1 < two | jq -c 'del(.object, .score) | .ref = "lone"'; } > some.jsonl
	first -o out some.jsonl
	[ "$(jq -c 'select(.view == "view_000") | [.object, .ref, .score]' out | tr '\n' ' ')" = '["thing",null,0.95] [null,"lone",null] ' ]
	cmp <(jq -c 'select(.view == "view_000" and .object) | .segmentation' out) <(of 2 < two | jq -c .segmentation)
}

@test "first: masks of another size are reduced to that of the weights" {
	"$BIN/gs-weigh" -q --scale 0.5 -o half "$BATS_FILE_TMPDIR/scene"
	truth_of view_000 > true.jsonl
	first --weights half -o out true.jsonl
	jq -e -s 'length >= 36 and all(.segmentation.size == [36, 48])' out
	"$BIN/miou-score" --truth synth/truth.jsonl --predicted-views --fail-under 0.4 out
}

@test "first: empty masks are not written" {
	truth_of view_000 | of 1 | jq -c '.segmentation = {size: [72, 96], counts: [6912]}' > empty.jsonl
	run --separate-stderr first -v empty.jsonl
	[ "$status" -eq 0 ]
	[ -z "$output" ]
	[[ $stderr == *"pseudomask-select: warning: empty.jsonl: none of its 1 masks has a pixel"* ]]
	[ "${stderr_lines[2]}" = "pseudomask-select: 1 objects, which begin in 1 views; 0 masks in 5 views" ]
}

@test "first: - and a pipe are the file, and threads do not change a byte" {
	cp "$BATS_FILE_TMPDIR/candidates.jsonl" many.jsonl
	first --threads 1 -o one many.jsonl
	first --threads 2 -o two many.jsonl
	first --threads 2 - < many.jsonl > three
	cat many.jsonl | first > four
	[ "$(wc -l < one)" -ge 35 ]
	cmp one two && cmp one three && cmp one four
}

@test "first: training views without weights get no masks, and a warning" {
	truth_of view_000 > true.jsonl
	cp -r "$BATS_FILE_TMPDIR/weights" some
	rm some/view_002.safetensors
	run --separate-stderr first --weights some -o out true.jsonl
	[ "$status" -eq 0 ]
	[ "$stderr" = "pseudomask-select: warning: some: 1 training views have no weights, and get no masks" ]
	first -o whole true.jsonl
	jq -c 'select(.view != "view_002")' whole | cmp - <(jq -c . out)
	mkdir empty
	run --separate-stderr first --weights empty -o none true.jsonl
	[ "$status" -eq 4 ] && [ ! -e none ]
	[ "$stderr" = "pseudomask-select: empty: has no weights of a training view" ]
	# the masks of a view cannot be lifted without
	rm some/view_000.safetensors
	run first --weights some -o out2 true.jsonl
	[ "$status" -eq 4 ]
	[ "$output" = "pseudomask-select: some/view_000.safetensors: No such file or directory" ]
	[ ! -e out2 ]
}

@test "first: nothing to carry" {
	run --separate-stderr first /dev/null
	[ "$status" -eq 0 ]
	[ -z "$output" ]
	[ "$stderr" = "pseudomask-select: warning: /dev/null: no candidates" ]
	truth_of view_004 > test.jsonl
	run --separate-stderr first test.jsonl
	[ "$status" -eq 0 ]
	[ -z "$output" ]
	[ "$stderr" = "pseudomask-select: warning: test.jsonl: no candidate of a training view is above 0.3" ]
}

@test "first: bad scenes and weights, and no stray file" {
	truth_of view_000 > ../true.jsonl
	rm candidates.jsonl
	refuses() {
		local code=$1 message=$2
		shift 2
		run first -o out "$@"
		[ "$status" -eq "$code" ] && [ "$output" = "pseudomask-select: $message" ] && [ "$(ls)" = synth ] ||
			{ echo "$status: $output"; ls; return 1; }
	}
	refuses 4 "nowhere/splats.safetensors: No such file or directory" --scene nowhere ../true.jsonl
	refuses 4 "nowhere: has no weights of a training view" --weights nowhere ../true.jsonl
	jq -c '.view = "view_999"' ../true.jsonl > ../other.jsonl
	refuses 3 "../other.jsonl:1: key 'view': the scene has no view 'view_999'; there are 6: view_000, view_001, view_002 ... view_005" ../other.jsonl
	"$BIN/gs-synth" -q --gaussians 3001 --views 6 --size 96x72 -o ../other
	"$BIN/gs-import" -q --images ../other/images --test-views view_004 -o ../other/scene ../other/point_cloud.ply
	refuses 3 "synth/weights/view_000.safetensors: is of a scene of 3000 Gaussians, ../other/scene has 3001" --scene ../other/scene ../true.jsonl
	mkdir ../cut
	head -c 5000 synth/weights/view_000.safetensors > ../cut/view_000.safetensors
	run first --weights ../cut -o out ../true.jsonl
	[ "$status" -eq 3 ]
	[[ "$output" == "pseudomask-select: ../cut/view_000.safetensors: "* ]]
	[ "$(ls)" = synth ]
	# found only after others were read
	cp -r synth/weights ../late
	printf x | dd of=../late/view_003.safetensors bs=1 seek=9000 conv=notrunc 2>/dev/null
	run first --weights ../late -o out ../true.jsonl
	[ "$status" -eq 3 ]
	[[ "$output" == "pseudomask-select: ../late/view_003.safetensors: "* ]]
	[ "$(ls)" = synth ]
}

# scene ARG...: the objects' regions in the synthetic scene.
scene() {
	ln -sfn "$BATS_FILE_TMPDIR" synth
	"$BIN/pseudomask-select" --scene synth/scene --weights synth/weights "$@"
}

@test "scene: better than votes, in the scene's order, and the default with a scene and weights" {
	cp "$BATS_FILE_TMPDIR/candidates.jsonl" many.jsonl
	scene -o regions many.jsonl
	scene --method scene many.jsonl | cmp - regions
	"$BIN/pseudomask-select" -o votes many.jsonl
	jq -c '[.view, .object]' regions > keys
	for view in 0 1 2 3 5; do
		jq -r .object many.jsonl | awk '!seen[$0]++' | jq -R -c "[\"view_00$view\", .]"
	done | grep -Fxf keys | cmp - keys
	jq -e -s 'all(.segmentation.size == [72, 96] and (has("ref") | not) and .score > 0 and .score <= 1)' regions
	quality() { "$BIN/miou-score" --json -q --predicted-views --truth synth/truth.jsonl "$1" | jq .miou; }
	jq -n -e "$(quality regions) > $(quality votes) + 0.1"
}

@test "scene: what a person drew stays as it is, and a person's" {
	# the first object's mask of one view is a part of it
	jq -c 'del(.score) | select(.view != "view_004")' "$BATS_FILE_TMPDIR/truth.jsonl" | of_both |
		jq -c 'if .view == "view_001" then .segmentation.counts = [0,1,6911] else . end' >drawn
	scene -o out drawn
	[ "$("$BIN/miou-score" --json -q --truth drawn out | jq .miou)" = 1 ]
	jq -e -s 'all(has("score") | not)' out
}

@test "scene: candidates of other views, or of cameras in another frame, are refused" {
	jq -c '.view |= "view_00\([1, 2, 3, 5, 4, 0][ltrimstr("view_00") | tonumber])"' "$BATS_FILE_TMPDIR/candidates.jsonl" >next
	run scene -q -o out next
	[ "$status" = 3 ]
	[[ "$output" == "pseudomask-select: next: what masks show in one view is not where those of other views show it (by 0."* ]]
	"$BIN/gs-transform" -q --translate 0.3,-0.2,0.1 --rotate 0.9,0.2,0.3,0.1 --scale 0.4 -o s.ply synth/point_cloud.ply
	"$BIN/gs-import" -q --cameras synth/sparse/0 --test-views view_004 -o scene s.ply
	"$BIN/gs-weigh" -q -o weights scene
	run "$BIN/pseudomask-select" -q --scene scene --weights weights -o out "$BATS_FILE_TMPDIR/candidates.jsonl"
	[ "$status" = 3 ]
	[[ "$output" == "pseudomask-select: $BATS_FILE_TMPDIR/candidates.jsonl: what masks show in one view is not where "*"are the cameras of scene in another frame than its splats? "* ]]
	[ ! -e out ]
}

@test "scene: a confusion that votes get wrong, and the other object's masks that it is settled with" {
	grep -v view_004 "$BATS_FILE_TMPDIR/truth.jsonl" | of_both > two
	# three of four sentences take the second object for the first, but for a view each
	{ jq -c '.ref = .object + " own" | .score = 0.6' two
	of 1 < two | jq -c '.ref = .object + " same" | .score = 0.7'
	for k in 0 1 2; do
		of 1 < two | grep -v "view_00$k" | jq -c --arg o "$(sed -n 2p "$BATS_FILE_TMPDIR/objects")" ".object = \$o | .ref = \"r$k\" | .score = 0.9"
		of 2 < two | grep "view_00$k" | jq -c ".ref = \"r$k\" | .score = 0.5"
	done; } > confused.jsonl
	"$BIN/pseudomask-select" -o votes confused.jsonl
	of 2 < votes | jq -c .segmentation | sort | comm -12 - <(of 1 < two | jq -c .segmentation | sort) > wrong
	[ "$(wc -l < wrong)" -ge 4 ]
	scene -o regions confused.jsonl
	cmp <(jq -c '[.view, .object, .segmentation]' regions | sort) <(jq -c '[.view, .object, .segmentation]' two | sort)
}

@test "scene: a view without candidates has the rendered region, in the size of its weights" {
	truth_of view_000 > true.jsonl
	truth_of view_001 | jq -c '.segmentation' > size
	run --separate-stderr scene -v -o out true.jsonl
	[ "$status" -eq 0 ]
	[[ "${stderr_lines[1]}" == "pseudomask-select: 8 objects, 8 regions; "*" masks in 5 views, "*" of them rendered" ]]
	cmp <(jq -c 'select(.view == "view_000") | .segmentation' out) <(jq -c .segmentation true.jsonl)
	jq -c 'select(.view != "view_000")' out > others.jsonl
	"$BIN/miou-score" --truth synth/truth.jsonl --predicted-views --fail-under 0.6 others.jsonl
	# candidates larger than the weights: as they are, and what is rendered there as large
	"$BIN/gs-weigh" -q --scale 0.5 -o half "$BATS_FILE_TMPDIR/scene"
	scene --weights half -o half.jsonl true.jsonl
	jq -e -s 'all(.segmentation.size == if .view == "view_000" then [72, 96] else [36, 48] end)' half.jsonl
	"$BIN/miou-score" --truth synth/truth.jsonl --predicted-views --fail-under 0.4 half.jsonl
}

@test "scene: spare regions are what one sentence means and no object is, and change nothing else" {
	# a third thing that four training views see; a sentence of the first object means it
	third=$(jq -r .object "$BATS_FILE_TMPDIR/truth.jsonl" | sort | uniq -c | sed -n 's/^ *[456] //p' | grep -Fxv -f "$BATS_FILE_TMPDIR/objects" | head -n 1)
	first=$(head -n 1 "$BATS_FILE_TMPDIR/objects")
	grep -v view_004 "$BATS_FILE_TMPDIR/truth.jsonl" > truth.jsonl
	of_both < truth.jsonl | jq -c '.ref = .object + " 1" | ., .ref = .object + " 2" | .score = 0.8' > two
	jq -c --arg t "$third" --arg f "$first" 'select(.object == $t) | .object = $f | .ref = "odd" | .score = 0.9' truth.jsonl | cat two - > three
	scene two > expected
	scene --spare none two | cmp - expected
	[ -f none ] && [ ! -s none ]
	scene three > expected
	run --separate-stderr scene -v -o masks --spare spare three
	[ "$status" -eq 0 ]
	[[ "$stderr" == *"pseudomask-select: 1 spare regions"* ]]
	cmp masks expected
	cmp <(jq -c '[.view, .object, .segmentation]' spare) \
		<(jq -c --arg t "$third" 'select(.object == $t) | [.view, "region-1", .segmentation]' truth.jsonl)
	jq -e -s 'all(has("ref") | not) and all(.score > 0.4 and .score <= 1)' spare
	for threads in 1 2 7; do
		scene --threads $threads -o masks --spare - three | cmp - spare
		cmp masks expected
	done
}

@test "scene: --spare is for it alone, and is there whole or not at all" {
	of_both < "$BATS_FILE_TMPDIR/truth.jsonl" > two
	run first --spare spare two
	[ "$status" -eq 2 ]
	[ "${lines[0]}" = "pseudomask-select: --spare is for --method scene" ]
	run "$BIN/pseudomask-select" --spare spare two
	[ "$status" -eq 2 ]
	run scene -o masks --spare ./masks two
	[ "$status" -eq 2 ]
	[ "${lines[0]}" = "pseudomask-select: -o masks and --spare ./masks are the same" ]
	run scene -o masks --spare nowhere/spare two
	[ "$status" -eq 4 ]
	[ "${lines[0]}" = "pseudomask-select: nowhere/spare: No such file or directory" ]
	echo before > spare
	run scene -o masks --spare spare --weights nowhere two
	[ "$status" -eq 4 ]
	[ "$(cat spare)" = before ]
	[ ! -e masks ]
}

@test "scene: - and a pipe are the file, the order of objects decides theirs alone, and threads do not change a byte" {
	cp "$BATS_FILE_TMPDIR/candidates.jsonl" many.jsonl
	scene --threads 1 -o one many.jsonl
	scene --threads 2 -o two many.jsonl
	scene --threads 2 - < many.jsonl > three
	cat many.jsonl | scene > four
	[ "$(wc -l < one)" -ge 35 ]
	cmp one two && cmp one three && cmp one four
}

@test "scene: training views without weights, and nothing to find" {
	cp -r "$BATS_FILE_TMPDIR/weights" some
	rm some/view_002.safetensors
	run --separate-stderr scene --weights some -o out "$BATS_FILE_TMPDIR/candidates.jsonl"
	[ "$status" -eq 0 ]
	[ "$stderr" = "pseudomask-select: warning: some: 1 training views have no weights, and get no masks" ]
	[ "$(jq -r .view out | sort -u | tr '\n' ' ')" = "view_000 view_001 view_003 view_005 " ]
	run --separate-stderr scene /dev/null
	[ "$status" -eq 0 ]
	[ -z "$output" ]
	[ "$stderr" = "pseudomask-select: warning: /dev/null: no candidates" ]
	truth_of view_004 > test.jsonl
	truth_of view_000 | jq -c '.score = 0.3' >> test.jsonl
	run --separate-stderr scene test.jsonl
	[ "$status" -eq 0 ]
	[ -z "$output" ]
	[ "$stderr" = "pseudomask-select: warning: test.jsonl: no candidate of a training view is above 0.3" ]
	truth_of view_000 | jq -c '.segmentation = {size: [72, 96], counts: [6912]}' > empty.jsonl
	run --separate-stderr scene -q empty.jsonl
	[ "$status" -eq 0 ]
	[ -z "$output$stderr" ]
}

@test "scene: bad scenes and weights, and no stray file" {
	truth_of view_000 > ../true.jsonl
	rm candidates.jsonl
	refuses() {
		local code=$1 message=$2
		shift 2
		run scene -o out "$@"
		[ "$status" -eq "$code" ] && [[ "$output" == "pseudomask-select: "$message ]] && [ "$(ls)" = synth ] ||
			{ echo "$status: $output"; ls; return 1; }
	}
	refuses 4 "nowhere/splats.safetensors: No such file or directory" --scene nowhere ../true.jsonl
	jq -c '.view = "view_999"' ../true.jsonl > ../other.jsonl
	refuses 3 "../other.jsonl:1: key 'view': the scene has no view 'view_999'; there are 6: view_000, view_001, view_002 ... view_005" ../other.jsonl
	mkdir ../regions-cut
	head -c 5000 synth/weights/view_000.safetensors > ../regions-cut/view_000.safetensors
	refuses 3 "../regions-cut/view_000.safetensors: *" --weights ../regions-cut ../true.jsonl
}
