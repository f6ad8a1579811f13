#!/usr/bin/env bats
# refer-report, on a small scene whose truth is known. Options that every tool has are in common.bats. The page's data are read
# with jq; that a browser shows them is in refer-report-browser.bats.

setup_file() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	# No viewer but the one that the tests make.
	export OMP_WAIT_POLICY=passive XDG_CACHE_HOME=$BATS_FILE_TMPDIR/cache
	cd "$BATS_FILE_TMPDIR"
	mkdir viewer
	for file in three.core.min.js three.module.min.js Pass.js OrbitControls.js spark.module.min.js LICENSE.spark LICENSE.three; do
		echo "// $file </script>" >viewer/$file
	done
	cp -r "$BATS_TEST_DIRNAME/../golden/bert" encoder
	"$BIN/gs-synth" -q --objects 3 --views 6 --size 96x72 --gaussians 2000 -o .
	mkdir -p run/lifted run/log run/stage1
	"$BIN/gs-import" -q --images images --test-views "$(cat test-views)" -o run/scene point_cloud.ply
	"$BIN/gs-weigh" -q -o weights run/scene
	# A sentence that would be markup, and one in another alphabet.
	jq -c 'if .ref == "'"$(jq -r 'select(.split == "test").ref' sentences.jsonl | head -n 1)"'" then
		.text = "the \"<script>alert(1)</script>\" & </script><!-- thing {{viewer}}, синяя чашка" else . end' sentences.jsonl >marked.jsonl
	"$BIN/text-encode" -q --model encoder -o run/text.safetensors marked.jsonl
	"$BIN/refer-lift" -q --scene run/scene --weights weights --text run/text.safetensors --masks truth.jsonl -o run/lifted/model.safetensors
	for set in test train; do
		"$BIN/refer-render" -q --scene run/scene --text run/text.safetensors --model run/lifted/model.safetensors \
			--sentences $set --split test -o run/lifted/predictions.$set.jsonl
	done
	printf 'refer-lift: 3 objects\nrefer-lift: 11.49 s, peak memory 272.6 MiB\n' >run/log/lift
	printf 'refer-lift --scene <run>' >run/log/lift.command
	printf 'miou-score --json --truth %s' "$PWD/truth.jsonl" >run/log/score.command
	printf '{"iteration":%d,"bce":%s,"contrast":0.5,"loss":1}\n' 100 2 200 1.5 >run/stage1/train.log
	"$BIN/refer-report" -q run
	data run/report.html >data.json
}

# The data of a page.
data() { sed -n 's,^.*<script type="application/json" id="data">\(.*\)</script>$,\1,p' "$1"; }

setup() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	load ../format/files
	export OMP_WAIT_POLICY=passive
	cd "$BATS_FILE_TMPDIR"
}

# Fails where the command succeeds; a plain ! would let the test go on.
not() { ! "$@"; }

@test "every answered sentence is on the page, with views, outlines, scores and reasons" {
	[ "$(jq -r '[.sets[] | .way + " " + .name] | join(",")' data.json)" = "lifted test,lifted train" ]
	diff <(jq -r '.sets[] | .sentences[].ref' data.json | sort) <(jq -r .ref sentences.jsonl | sort)
	jq -e '(.views | length) as $views | (.outlines | length) as $outlines | .sets[].sentences[] |
		(.views | length) == $views and all(.views[]; .[0] < $views and .[1] < $outlines and .[2] < $outlines) and
		(.explained.parse | length) > 0 and .sure >= 0 and (.answer | type) == "array"' data.json >all
	not grep -v true all
	jq -e 'all(.outlines[]; test("^(M[0-9]+ [0-9]+(h-?[0-9]+v-?[0-9]+)*h-?[0-9]+z)*$"))' data.json
	jq -e '.scene == {"gaussians": 2000, "views": 6, "test_views": (.views | length), "objects": 3}' data.json
}

@test "scores are those of miou-score" {
	for set in test train; do
		"$BIN/miou-score" --json --predicted-views --truth truth.jsonl run/lifted/predictions.$set.jsonl >score.json
		jq -e --slurpfile score score.json --arg set $set '.sets[] | select(.name == $set) |
			(.score.miou - $score[0].miou | fabs) < 1e-4 and (.score.right - $score[0].right | fabs) < 1e-4 and
			.score.pairs == $score[0].pairs and
			((.sentences | map(select(.pairs > 0) | .iou * .pairs) | add) / $score[0].pairs - $score[0].miou | fabs) < 1e-3' data.json
	done
}

@test "an answer is right where it names what the sentence means" {
	jq -e '.sets[].sentences[] | .right == (.answer == .said)' data.json >all
	not grep -v true all
	jq -e 'any(.sets[].sentences[]; .right)' data.json
}

@test "times, losses and settings are those of the run" {
	jq -e '.steps == [{"step": "lift", "seconds": 11.49, "mib": 272.6, "command": "refer-lift --scene <run>"}]' data.json
	jq -e '.losses == [{"stage": "stage1", "lines": [[100, 2, 0.5, 1], [200, 1.5, 0.5, 1]]}]' data.json
	jq -e '.settings[] | select(.file == "lifted/model.safetensors") | .metadata.format == "refer.lifted" and .metadata.tool == "refer-lift"' data.json
	jq -e 'all(.settings[].metadata | keys[]; startswith("crc32") | not)' data.json
}

@test "a sentence that would be markup, and other alphabets, are text" {
	jq -e 'any(.sets[].sentences[]; .text == "the \"<script>alert(1)</script>\" & </script><!-- thing {{viewer}}, синяя чашка")' data.json
	not grep -F '<script>alert' run/report.html
	not grep -F '<!-- thing' run/report.html
	# the page's own scripts, and no others
	[ "$(grep -c '<script' run/report.html)" = "$(grep -c '<script' "$BATS_TEST_DIRNAME/../../cmd/report/report_page.html")" ]
	# no data get into the page as markup
	not grep -nE 'innerHTML|outerHTML|insertAdjacentHTML|document\.write|eval\(' "$BATS_TEST_DIRNAME/../../cmd/report/report_page.html"
}

@test "the page is one small file that fetches nothing" {
	[ "$(wc -c <run/report.html)" -lt 400000 ]
	not grep -nE '(src|href|srcset|action|poster|data)="|@import|fetch\(|XMLHttpRequest|url\((https?:|//)' run/report.html
	[ "$(grep -o 'https\?://[^ "'"'"'<]*' run/report.html | sort -u)" = http://www.w3.org/2000/svg ]
	grep -q '<meta name="viewport"' run/report.html
}

@test "the pictures are the views' photographs as JPEG, at the width that was asked for" {
	"$BIN/refer-report" -q --width 48 -o small.html run
	data small.html | jq -e 'all(.views[]; .width == 48 and .height == 36 and .photograph)'
	data small.html | jq -r '.views[0].picture' | sed 's/^data:image\/jpeg;base64,//' | base64 -d >small.jpg
	[ "$(head -c 3 small.jpg | xxd -p)" = ffd8ff ]
	[ "$(wc -c <small.html)" -lt "$(wc -c <run/report.html)" ]
}

@test "without photographs the scene is rendered, one that is broken is warned of" {
	cp -r run none
	jq -c 'map(del(.image))' run/scene/cameras.json >none/scene/cameras.json
	"$BIN/refer-report" -q none
	data none/report.html | jq -e 'all(.views[]; .photograph | not) and (.views | length > 0)'
	echo broken >broken.png
	jq -c --arg image "$PWD/broken.png" 'map(.image = $image)' run/scene/cameras.json >none/scene/cameras.json
	run "$BIN/refer-report" none
	[ "$status" = 0 ]
	[[ $output == *"warning: $PWD/broken.png: "*"; the view is rendered instead"* ]]
	rm -r none
}

@test "--views takes fewer, of those with truth" {
	view=$(jq -r .view run/lifted/predictions.test.jsonl | sort -u | tail -n 1)
	jq -c --arg view "$view" 'select(.view == $view)' truth.jsonl >one.jsonl
	"$BIN/refer-report" -q --views 1 --truth one.jsonl -o one.html run
	data one.html | jq -e --arg view "$view" '(.views | map(.name)) == [$view] and all(.sets[].sentences[]; .pairs == 1)'
}

@test "without truth there are no scores" {
	mv run/log/score.command score.command
	"$BIN/refer-report" -q -o untrue.html run
	mv score.command run/log/score.command
	data untrue.html | jq -e 'all(.sets[]; has("score") | not) and all(.sets[].sentences[]; .iou == null and .views[0][2] == -1)'
}

@test "a run without predictions is answered in training views" {
	mkdir -p names/lifted
	cp -r run/scene run/text.safetensors names
	cp run/lifted/model.safetensors names/lifted
	"$BIN/refer-report" -q names
	data names/report.html >names.json
	jq -e '(.views | length) > 0 and all(.views[]; .split == "train") and (.sets | length) == 1 and
		any(.sets[0].sentences[].views[]; .[1] > 0)' names.json
	[ "$(jq '.sets[0].sentences | length' names.json)" = "$(wc -l <sentences.jsonl)" ]
}

# Bytes that were packed for the viewer: zlib's, which gzip takes with another head, and complains of the end.
unpack() { { printf '\037\213\010\0\0\0\0\0\0\003'; base64 -d | tail -c +3; } | gzip -dc 2>/dev/null || true; }

@test "the viewer has its modules, the splats by object, their boxes, and a camera" {
	"$BIN/refer-report" -q --viewer viewer -o viewer.html run
	sed -n 's,^<script type="text/plain" data-module="spark">\(.*\)</script>$,\1,p' viewer.html | unpack | cmp - viewer/spark.module.min.js
	sed -n 's,^<script type="application/json" id="scene">\(.*\)</script>$,\1,p' viewer.html >scene.json
	jq -e '(.groups | map(.count) | add) == .count and .count <= .all and .all == 2000 and .camera.name != null and
		.licences == ["// LICENSE.spark </script>\n", "// LICENSE.three </script>\n"]' scene.json
	diff <(jq -r '.groups[1:][].name' scene.json | sort) <(jq -r .object sentences.jsonl | sort -u)
	n=$(jq .count scene.json)
	sed -n 's,^<script type="text/plain" id="splats">\(.*\)</script>$,\1,p' viewer.html | unpack >splats
	[ "$(wc -c <splats)" = $((32 * n)) ]
	# the lowest bytes of the positions are 0; no opacity is below 0.03
	[ "$(head -c $n splats | tr -d '\0' | wc -c)" = 0 ]
	tail -c +$((27 * n + 1)) splats | head -c $n | od -An -v -tu1 -w1 | awk '$1 < 7 { exit 1 }'
	# boxes are those of refer-locate
	thing=$(jq -r '.groups[1].name' scene.json)
	ref=$(jq -r --arg thing "$thing" '.sets[].sentences[] | select(.answer == [$thing]).ref' data.json | head -n 1)
	"$BIN/refer-locate" -q --scene run/scene --text run/text.safetensors --model run/lifted/model.safetensors --refs "$ref" -o box.jsonl
	jq -e --slurpfile box box.jsonl '.groups[1].box as $b | [$b.centre, $box[0].oriented.centre] | transpose | all(.[]; (.[0] - .[1] | fabs) < 1e-3)' scene.json
}

@test "--splats takes those that cover most, --no-viewer leaves all out" {
	"$BIN/refer-report" -q --viewer viewer --splats 100 -o few.html run
	sed -n 's,^<script type="application/json" id="scene">\(.*\)</script>$,\1,p' few.html | jq -e '.count == 100'
	mkdir -p cache/refersplat
	cp -r viewer cache/refersplat/viewer
	"$BIN/refer-report" -q -o found.html run
	cmp found.html <("$BIN/refer-report" -q --viewer viewer -o - run)
	"$BIN/refer-report" -q --no-viewer -o - run | cmp - run/report.html
	rm -r cache
	says 2 "refer-report: --viewer and --no-viewer exclude each other
Try 'refer-report --help'." "$BIN/refer-report" --viewer viewer --no-viewer run
	mkdir nothing
	says 4 "refer-report: nothing/three.core.min.js: No such file or directory" "$BIN/refer-report" --viewer nothing -o none.html run
	[ ! -e none.html ]
}

@test "1, 2 and 7 threads make the same bytes" {
	for run in run names; do
		for threads in 1 2 7; do "$BIN/refer-report" -q --viewer viewer --threads $threads -o threads.$threads.html $run; done
		cmp threads.1.html threads.2.html
		cmp threads.1.html threads.7.html
	done
}

@test "- is standard output" {
	"$BIN/refer-report" -q -o - run | cmp - run/report.html
}

@test "what is no run is refused, and nothing is left" {
	mkdir -p empty half/lifted
	says 4 "refer-report: empty: no scene in it: 'make -f pipelines/lift.mk SCENE=empty ...' makes one" "$BIN/refer-report" empty
	[ -z "$(ls empty)" ]
	cp -r run/scene half
	says 4 "refer-report: half: no answers in it: 'make -f pipelines/lift.mk SCENE=half ...' makes some" "$BIN/refer-report" half
	cp run/text.safetensors half
	printf '{"view":"v"}\n' >half/lifted/predictions.test.jsonl
	says 3 "refer-report: half/lifted/predictions.test.jsonl:1: neither key 'ref' nor key 'object'" "$BIN/refer-report" half
	[ ! -e half/report.html ]
}

@test "an input is not written over" {
	run "$BIN/refer-report" --truth truth.jsonl -o truth.jsonl run
	[ "$status" = 2 ]
	run "$BIN/refer-report" -o run/text.safetensors run
	[ "$status" = 2 ]
}
