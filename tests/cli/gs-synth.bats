#!/usr/bin/env bats
# gs-synth: the folder it makes, and that the suite's readers agree with it. What holds for every tool is in common.bats.

setup() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	load differ
	cd "$BATS_TEST_TMPDIR"
}

# A scene small enough to be made in a moment.
small() {
	"$BIN/gs-synth" --views 5 --size 80x60 --gaussians 3000 "$@"
}

# One hash of every name and byte in a folder.
hash_of() {
	(cd "$1" && find . -type f | LC_ALL=C sort | xargs sha256sum) | sha256sum
}

@test "without -o: exit 2" {
	run "$BIN/gs-synth" --seed 1
	[ "$status" = 2 ]
	[ "${lines[0]}" = "gs-synth: -o DIR is required" ]
	[ "${lines[1]}" = "Try 'gs-synth --help'." ]
}

@test "standard output cannot hold a folder" {
	run "$BIN/gs-synth" -o -
	[ "$status" = 2 ]
	[ "${lines[0]}" = "gs-synth: -o must name a folder" ]
}

@test "numbers out of range: exit 2, and nothing is made" {
	run small --objects 1 -o out
	[ "$status" = 2 ]
	[ "${lines[0]}" = "gs-synth: --objects: '1' is not a whole number from 2 to 64" ]
	run small --views 1001 -o out
	[ "${lines[0]}" = "gs-synth: --views: '1001' is not a whole number from 2 to 1000" ]
	run small --gaussians 999 -o out
	[ "${lines[0]}" = "gs-synth: --gaussians: '999' is not a whole number from 1000 to 10000000" ]
	run small --size 8x60 -o out
	[ "${lines[0]}" = "gs-synth: --size: '8x60' is not WIDTHxHEIGHT with both from 16 to 4096" ]
	run small --scene pub -o out
	[ "$status" = 2 ]
	[ "${lines[0]}" = "gs-synth: --scene: 'pub' is not one of table|diner|toys|tea|kitchen" ]
	run small operand -o out
	[ "$status" = 2 ]
	[ "${lines[0]}" = "gs-synth: unexpected operand 'operand'" ]
	[ ! -e out ]
}

@test "a folder that cannot be made: exit 4 and its name" {
	: >file
	run small -o file/out
	[ "$status" = 4 ]
	[ "$output" = "gs-synth: file/out/images: file: Not a directory" ]
	[ "$(ls -A)" = file ]
}

@test "an output that cannot be written leaves no temporary file" {
	mkdir -p out/truth.jsonl
	run small -o out
	[ "$status" = 4 ]
	[[ $output = "gs-synth: out/truth.jsonl: "* ]]
	[ -z "$(find . -name '*.tmp.*')" ]
}

# interrupted SIGNAL [OPTION OF env]...: sends the signal when four outputs are half written; sets status.
interrupted() {
	local signal=$1 pid i
	shift
	rm -rf out
	# The address sanitizer leaves SIGSEGV to the program.
	ASAN_OPTIONS=${ASAN_OPTIONS-}:handle_segv=0 env "$@" "$BIN/gs-synth" --views 25 --size 400x300 --gaussians 1000 --objects 2 -o out >printed 2>&1 &
	pid=$!
	for ((i = 0; i < 1000; i++)); do
		[ "$(find . -name '*.jsonl.tmp.*' | wc -l)" = 4 ] && break
		sleep 0.01
	done
	[ $i -lt 1000 ]
	kill "-$signal" $pid
	status=0
	wait $pid || status=$?
	[ -z "$(find . -name '*.tmp.*')" ]
}

@test "a file that grows over its limit: exit 4, and nothing is left of it" {
	status=0
	(ulimit -f 64; "$BIN/gs-synth" -o out >printed 2>&1) || status=$?
	[ $status = 4 ]
	[ "$(cat printed)" = "gs-synth: out/point_cloud.ply: File too large" ]
	[ -z "$(find out -type f)" ]
}

@test "what a killed run left is removed by the next that writes the same" {
	# The first is killed amid its work, the second goes on all the while.
	for run in first second; do
		"$BIN/gs-synth" --views 25 --size 400x300 --gaussians 1000 --objects 2 -o out >printed 2>&1 &
		pids+=($!)
		for ((i = 0; i < 1000; i++)); do
			[ "$(find . -name '*.jsonl.tmp.*' | wc -l)" = $((4 * ${#pids[@]})) ] && break
			sleep 0.01
		done
		[ $i -lt 1000 ]
	done
	kill -KILL ${pids[0]}
	wait ${pids[0]} || true
	small -o out
	# Those of the second, which is alive, are still there.
	[ "$(find . -name '*.jsonl.tmp.*' | wc -l)" = 4 ]
	wait ${pids[1]}
	[ -z "$(find . -name '*.tmp.*')" ]
}

@test "a signal leaves no temporary file, and its own exit status" {
	ulimit -c 0
	for signal in HUP INT TERM PIPE QUIT XCPU ABRT SEGV USR1; do
		interrupted $signal --default-signal
		[ $status = $((128 + $(kill -l $signal))) ]
		[ ! -e out/truth.jsonl ]
	done
}

@test "a signal that is ignored from the start stays so" {
	interrupted HUP --ignore-signal=HUP
	[ $status = 0 ]
	[ -e out/truth.jsonl ]
}

@test "a scene that moves: frames, times, sentences; the first frame is the scene, and still where it has one time" {
	small --moving 20 -o out
	[ "$(ls out/frames | wc -l)" = 20 ]
	cmp out/frames/time_00000.ply out/point_cloud.ply
	differ out/frames/time_00000.ply out/frames/time_00019.ply
	[ "$(jq '.frames | [length, .[0].time, .[-1].time]' -c out/transforms.json)" = "[5,0,1]" ]
	[ "$(jq -s '[.[].time] | unique' -c out/truth.jsonl)" = "$(jq '[.frames[].time]' -c out/transforms.json)" ]
	"$BIN/gs-check" out/moving.jsonl out/moving-kept-back.jsonl out/truth.jsonl
	[ "$(jq -s 'all(.[]; (.objects | length) == 1 or .when == null) and any(.[]; .when[1] < 1) and all(.[]; .when == null or .when[0] < .when[1])' out/moving.jsonl)" = true ]
	# The same for any number of threads; what is kept back is another wording.
	OMP_NUM_THREADS=7 small --moving 20 -o again
	[ "$(hash_of out)" = "$(hash_of again)" ]
	differ out/moving.jsonl out/moving-kept-back.jsonl
	# The things and cameras do not depend on how many times there are.
	small --moving 1 -o still
	[ ! -e still/frames ]
	cmp still/point_cloud.ply out/point_cloud.ply
	cmp still/sentences.jsonl out/sentences.jsonl
	run small --moving 0 -o none
	[ "$status" = 2 ]
	[ "${lines[0]}" = "gs-synth: --moving: '0' is not a whole number from 1 to 1000" ]
}

@test "the folder holds what formats/scene/synth.md says" {
	small -o out
	[ "$(cd out && find . -type f | LC_ALL=C sort | tr '\n' ' ')" = "./boxes.jsonl ./candidates.jsonl ./candidates.test.jsonl ./images/view_000.png \
./images/view_001.png ./images/view_002.png ./images/view_003.png ./images/view_004.png ./parses.unseen.jsonl \
./point_cloud.ply ./sentences.jsonl ./sparse/0/cameras.txt ./sparse/0/images.txt ./sparse/0/points3D.txt ./statistics.json ./test-views \
./truth.jsonl ./unseen.jsonl ./whole.jsonl " ]
	[ "$(cat out/test-views)" = view_004 ]
	[ "$(wc -l <out/sentences.jsonl)" = 40 ]
	[ "$(jq -r .split out/sentences.jsonl | sort | uniq -c | xargs)" = "8 test 32 train" ]
	[ "$(wc -l <out/truth.jsonl)" = 40 ]
	[ "$(wc -l <out/whole.jsonl)" = 40 ]
	[ "$(jq -c .segmentation.size out/truth.jsonl out/whole.jsonl out/candidates.jsonl | sort -u)" = "[60,80]" ]
}

@test "truth is of objects in every view, candidates of training sentences in training views" {
	small -o out
	jq -e 'has("ref") or has("score") | not' out/truth.jsonl >/dev/null
	[ "$(jq -r .view out/truth.jsonl | sort | uniq -c | sort -u | awk '{print $1}' | sort -u)" = 8 ]
	[ "$(jq -r .object out/truth.jsonl | sort -u)" = "$(jq -r .object out/sentences.jsonl | sort -u)" ]
	[ "$(jq -r .view out/candidates.jsonl | sort -u | xargs)" = "view_000 view_001 view_002 view_003" ]
	jq -r 'select(.split == "train") | .ref' out/sentences.jsonl | sort >train
	jq -r .ref out/candidates.jsonl | sort -u >pointed
	[ -s pointed ]
	[ -z "$(comm -13 train pointed)" ]
	jq -se 'all(.[]; .score >= 0.2 and .score <= 0.95)' out/candidates.jsonl out/candidates.test.jsonl >/dev/null
	# of all sentences in test views
	[ "$(jq -r .view out/candidates.test.jsonl | sort -u)" = view_004 ]
	jq -r .ref out/candidates.test.jsonl | sort -u >shown
	jq -r 'select(.split == "test").ref' out/sentences.jsonl | sort >test
	[ -n "$(comm -12 test shown)" ]
	[ -n "$(comm -12 train shown)" ]
	[ -z "$(comm -13 <(sort test train) shown)" ]
	[ "$(jq -c .segmentation.size out/candidates.test.jsonl | sort -u)" = "[60,80]" ]
}

@test "a box for every object, which scores 100 against itself" {
	"$BIN/gs-synth" -q --objects 5 --views 2 --size 80x60 --gaussians 1000 -o boxed
	[ "$("$BIN/gs-check" boxed/boxes.jsonl)" = "boxed/boxes.jsonl: ok: boxes, 5 boxes, 5 objects, 0 empty" ]
	[ "$(jq -r .object boxed/boxes.jsonl | sort)" = "$(jq -r .object boxed/sentences.jsonl | sort -u)" ]
	jq -se 'all(.[]; .min[2] >= 0 and (.oriented.size[2] - .max[2] + .min[2] | fabs) < 1e-9)' boxed/boxes.jsonl
	"$BIN/miou-score" --json --boxes --truth boxed/boxes.jsonl boxed/boxes.jsonl | jq -e '.aligned.p50 == 1 and .oriented.miou > 0.999'
}

@test "the truth scores 100 against itself, and candidates much less" {
	"$BIN/gs-synth" --views 10 --gaussians 5000 --size 160x120 -o out
	[ "$("$BIN/miou-score" --json --truth out/truth.jsonl out/truth.jsonl | jq .miou)" = 1 ]
	grep -v -F -f <(tr , '\n' <out/test-views) out/truth.jsonl >truth
	"$BIN/pseudomask-select" --method ciou -o ciou out/candidates.jsonl
	"$BIN/pseudomask-select" --method top1 -o top1 out/candidates.jsonl
	score() { "$BIN/miou-score" --json --truth truth "$1" | jq "$2"; }
	[ "$(score ciou '.miou > 0.5 and .miou < 0.95')" = true ]
	[ "$(score top1 '.miou > 0.2 and .miou < 0.65')" = true ]
	[ "$(jq -n "$(score ciou .miou) > $(score top1 .miou) + 0.1")" = true ]
}

@test "gs-import reads the scene, with its photographs and test views" {
	small --views 10 -o out
	"$BIN/gs-import" --images out/images --test-views "$(cat out/test-views)" -o scene out/point_cloud.ply
	[ "$(jq -r '.[] | select(.split == "test") | .name' scene/cameras.json | xargs)" = "view_004 view_009" ]
	[ "$(jq -r '.[] | .image' scene/cameras.json | xargs -n 1 basename | head -n 1)" = view_000.png ]
	"$BIN/gs-check" scene | grep -q "3000 gaussians"
}

@test "the same seed gives the same bytes, with 1 and 2 threads" {
	small --seed 7 --threads 1 -o one
	small --seed 7 --threads 2 -o two
	[ "$(hash_of one)" = "$(hash_of two)" ]
	small --scene toys --seed 7 --threads 1 -o three
	small --scene toys --seed 7 --threads 2 -o four
	[ "$(hash_of three)" = "$(hash_of four)" ]
}

@test "unseen sentences: kinds, targets among the objects, views among the test views, a parse for each" {
	small --scene tea --views 20 -o out
	"$BIN/gs-check" out/unseen.jsonl
	[ "$(jq -r .kind out/unseen.jsonl | sort -u | xargs)" = \
		"absent chatty comparative function negation ordinal plain several two-hop view" ]
	jq -r '.objects[]' out/unseen.jsonl | sort -u >named
	[ -z "$(comm -23 named <(jq -r .object out/boxes.jsonl | sort))" ]
	jq -r '.view // empty' out/unseen.jsonl | sort -u >views
	[ -s views ]
	[ -z "$(comm -23 views <(tr , '\n' <out/test-views | sort))" ]
	jq -se 'all(.[]; .split == "test" and (.object == (if (.objects | length) == 1 then .objects[0] else null end)) and
		((.objects == []) == (.kind == "absent")) and ((.view != null) == (.kind == "view")))' out/unseen.jsonl >/dev/null
	diff <(jq -r .ref out/unseen.jsonl) <(jq -r .ref out/parses.unseen.jsonl)
	jq -se 'all(.[]; .target and (.clauses | type == "array") and has("text") and has("count")) and
		any(.[]; .ordinal) and any(.[]; .except) and any(.[].clauses[]; .negated) and any(.[].clauses[].anchors[]; .clauses != [])' \
		out/parses.unseen.jsonl >/dev/null
	# none of the sentences is one of the others
	[ -z "$(comm -12 <(jq -r '.text | ascii_downcase' out/unseen.jsonl | sort -u) <(jq -r .text out/sentences.jsonl | sort -u))" ]
}

@test "another seed gives another scene" {
	small --seed 7 -o one
	small --seed 8 -o two
	for file in point_cloud.ply sparse/0/images.txt sentences.jsonl unseen.jsonl parses.unseen.jsonl truth.jsonl whole.jsonl candidates.jsonl candidates.test.jsonl statistics.json \
		images/view_000.png; do
		differ one/$file two/$file
	done
}

@test "more Gaussians leave sentences and cameras as they were" {
	small -o one
	small --gaussians 4000 -o two
	cmp one/sentences.jsonl two/sentences.jsonl
	cmp one/unseen.jsonl two/unseen.jsonl
	cmp one/sparse/0/images.txt two/sparse/0/images.txt
	differ one/point_cloud.ply two/point_cloud.ply
}

@test "few and many objects, and a tall picture" {
	small --objects 2 --views 2 --size 16x40 -o few
	[ "$(wc -l <few/sentences.jsonl)" = 10 ]
	[ "$(cat few/test-views)" = view_001 ]
	small --objects 64 --size 200x150 -o many
	[ "$(wc -l <many/sentences.jsonl)" = 320 ]
	[ "$(jq -r .ref many/sentences.jsonl | sort -u | wc -l)" = 320 ]
	"$BIN/gs-check" few/truth.jsonl many/truth.jsonl many/candidates.jsonl many/sentences.jsonl
}

@test "the detector of a named scene misleads selection, and its sentences are as long as Ref-LERF's" {
	"$BIN/gs-synth" --scene diner --views 12 --size 100x74 --gaussians 3000 -o out
	grep -v -F -f <(tr , '\n' <out/test-views) out/truth.jsonl >truth
	score() { "$BIN/pseudomask-select" --method "$1" out/candidates.jsonl | "$BIN/miou-score" --json --truth truth - | jq .miou; }
	[ "$(jq -n "$(score ciou) as \$c | $(score top1) as \$t | \$t > 0.3 and \$t + 0.02 < \$c and \$c < 0.62")" = true ]
	[ "$(jq -s 'map(.text | split(" ") | length) | add / length | . > 13.2 and . < 14' out/sentences.jsonl)" = true ]
}

@test "sentences have 7 to 22 words, and photographs are not of one colour" {
	small -o out
	jq -se 'all(.[]; .text | split(" ") | length >= 7 and length <= 22)' out/sentences.jsonl >/dev/null
	[ "$(stat -c %s out/images/view_000.png)" -gt 3000 ]
}

@test "a seed gives each scene other things" {
	for scene in table diner kitchen; do
		small --scene $scene --objects 12 --seed 3 -o $scene
		jq -r .object $scene/sentences.jsonl | sort -u >$scene.objects
	done
	differ table.objects diner.objects
	differ table.objects kitchen.objects
	differ diner.objects kitchen.objects
}

@test "options go before what the scene has" {
	"$BIN/gs-synth" --scene tea --objects 5 --views 13 --size 100x50 --gaussians 2000 -o out
	jq -e '[.scene, .objects, .views.train, .views.test, .gaussians] == ["tea", 5, 11, 2, 2000]' out/statistics.json
	[ "$(jq -c .segmentation.size out/truth.jsonl | sort -u)" = "[50,100]" ]
}

@test "the whole is more than the truth where things hide each other" {
	small --scene toys --objects 8 --gaussians 8000 -o out
	overlap() { "$BIN/miou-score" --json --truth out/whole.jsonl "$1" | jq "$2"; }
	[ "$(overlap out/whole.jsonl .miou)" = 1 ]
	[ "$(overlap out/truth.jsonl '.miou > 0.6 and .miou < 0.99')" = true ]
}

@test "--seen-wording: no test sentence has a wording of test sentences; training sentences are the same" {
	small --scene diner --seed 3 -o own
	small --scene diner --seed 3 --seen-wording -o seen
	cmp <(head -n 4 own/sentences.jsonl) <(head -n 4 seen/sentences.jsonl)
	sed -n 's/^said-test\t\([^%\t]*\) .*/\1/p' "$BATS_TEST_DIRNAME/../../libcommon/synth/sentences.tsv" | grep " .* " >wordings
	[ -s wordings ]
	jq -r 'select(.split == "test") | .text' own/sentences.jsonl | grep -F -f wordings >/dev/null
	[ "$(jq -r 'select(.split == "test") | .text' seen/sentences.jsonl | grep -c -F -f wordings)" = 0 ]
}
