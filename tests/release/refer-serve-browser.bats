#!/usr/bin/env bats
# The page of refer-serve in a browser, Chromium without a window: a scene without names is opened, six things are named by clicks
# in one photograph and asked, with no message on the console and no request but to the server. Skipped where there is no
# chromedriver; the click in the scene where `make viewer` has not been run. SHOTS=DIR keeps pictures of it.
# Parts: cmd/serve/.* cmd/report/report_viewer.* pipelines/viewer.mk

bats_require_minimum_version 1.5.0

setup_file() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	export OMP_WAIT_POLICY=passive OMP_NUM_THREADS=2 VIEWER=${XDG_CACHE_HOME:-$HOME/.cache}/refersplat/viewer
	DRIVER=$(command -v chromedriver) || return 0 # setup skips
	export DRIVER
	cd "$BATS_FILE_TMPDIR"
	cp -r "$BATS_TEST_DIRNAME/../golden/bert" encoder
	"$BIN/gs-synth" -q --objects 6 --views 8 --size 160x120 --gaussians 6000 -o .
	mkdir run
	"$BIN/gs-import" -q --images images --test-views "$(cat test-views)" -o run/scene point_cloud.ply
	"$BIN/gs-weigh" -q --packed --tolerance 0.05 -o run/weights run/scene
	"$BIN/mask-export" -o coco.json truth.jsonl
	jq -c '(.images | INDEX(.id)) as $of | (.categories | INDEX(.id)) as $named | .annotations[] | $of["\(.image_id)"] as $i | .bbox as [$x, $y, $w, $h] |
		{view: ($i.file_name | sub("\\.png$"; "")), size: [$i.height, $i.width], box: [$x, $y, $x + $w, $y + $h],
		 name: $named["\(.category_id)"].name}' coco.json >boxes.jsonl
	jq -r 'select(.view == "view_000").name' boxes.jsonl | sort -u >names
	[ "$(wc -l <names)" = 6 ]
	"$BIN/pseudomask-propose" -q --weights run/weights --boxes boxes.jsonl --regions run/regions.safetensors -o /dev/null run/scene
	"$BIN/refer-serve" --port 0 --encoder encoder run >url 2>serve.err 3>&- &
	echo $! >pid
	"$DRIVER" --port=0 >driver.log 2>&1 3>&- &
	echo $! >driver.pid
	for _ in $(seq 300); do
		[ -s url ] && grep -q 'on port [1-9]' driver.log && break
		sleep 0.1
	done
}

teardown_file() {
	[ -z "${DRIVER:-}" ] || kill "$(cat "$BATS_FILE_TMPDIR/driver.pid")" "$(cat "$BATS_FILE_TMPDIR/pid")" 2>/dev/null || true
}

setup() {
	[ -n "${DRIVER:-}" ] || skip "no chromedriver"
	cd "$BATS_FILE_TMPDIR"
	driver=http://127.0.0.1:$(sed -n 's/.*on port \([1-9][0-9]*\).*/\1/p' driver.log | head -n 1)
	server=$(sed 's,/#.*,,' url)
}

teardown() {
	[ -z "${session:-}" ] || wd DELETE '' >/dev/null
}

# wd METHOD PATH [BODY]: the answer's value.
wd() {
	curl -s -X "$1" "$driver${session:+/session/$session}$2" ${3:+-d "$3"} >answer
	jq -e '(.value | type) != "object" or (.value | has("error") | not)' answer >/dev/null || { cat answer >&2; return 1; }
	jq -c .value answer
}

# browse [KEY: VALUE of Chromium's options...]
browse() {
	local options=${1:-'{}'}
	session=
	session=$(wd POST /session "$(jq -n --arg dir "$BATS_TEST_TMPDIR/chromium" '{capabilities: {alwaysMatch: {
		"goog:loggingPrefs": {browser: "ALL", performance: "ALL"}, "goog:chromeOptions": ({args: ["--headless", "--no-sandbox",
		"--disable-dev-shm-usage", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist",
		"--user-data-dir=\($dir)", "--window-size=1280,900"]} + '"$options"')}}}')" | jq -r .sessionId)
	wd POST /url "$(jq -n --arg url "$(cat url)" '{url: $url}')"
	eventually "return typeof scene === 'object' && document.querySelector('.strip img')?.complete"
}

js() { wd POST /execute/sync "$(jq -n --arg script "$1" '{script: $script, args: []}')"; }
is() { [ "$(js "return !!($1)")" = true ] || { echo "not: $1: $(js "return document.querySelector('main').innerText")"; return 1; }; }

eventually() {
	for _ in $(seq 600); do
		[ "$(js "$1")" != true ] || return 0
		sleep 0.1
	done
	echo "never: $1: $(js "return document.body.innerText")"
	return 1
}

# press X Y [MORE MOVES]: a click, or a drag
press() {
	wd POST /actions "$(jq -n --argjson x "$1" --argjson y "$2" --argjson moves "${3:-[]}" '{actions: [{type: "pointer", id: "mouse", actions:
		([{type: "pointerMove", x: $x, y: $y}, {type: "pointerDown", button: 0}] + [$moves[] | {type: "pointerMove", x: .[0], y: .[1], duration: 20}] +
		[{type: "pointerUp", button: 0}])}]}')" >/dev/null
}

type_in() {
	wd POST /actions "$(jq -n --arg text "$1" '{actions: [{type: "key", id: "keys", actions: [$text | split("")[] | ({type: "keyDown", value: .}, {type: "keyUp", value: .})]}]}')" >/dev/null
}

# Where the middle of a thing's box in view_000 is, of the photograph that is shown.
place() {
	js "const r = document.querySelector('.frame').getBoundingClientRect();
		const [x0, y0, x1, y1] = $(jq -sc --arg name "$1" '[.[] | select(.name == $name and .view == "view_000")][0].box' boxes.jsonl);
		return [r.left + r.width * (x0 + x1) / 2 / 160, r.top + r.height * (y0 + y1) / 2 / 120].map(Math.round)" | jq -r '"\(.[0]) \(.[1])"'
}

shoot() {
	[ -z "${SHOTS:-}" ] || wd GET /screenshot | jq -r . | base64 -d >"$SHOTS/$1.png"
}

ask() {
	js "document.querySelector('#ask input').focus()" >/dev/null
	type_in "$1"$'\ue007'
	eventually "return !document.querySelector('.waiting') && document.querySelector('#talk li .question')?.textContent === $(jq -n --arg q "$1" '$q')"
}

# The names that are lit up are these.
lit() { is "lit.names.sort().join() === $(jq -n --arg names "$1" '$names | split(",") | sort | join(",")')"; }

quiet() {
	wd POST /se/log '{"type": "browser"}' | jq -c '.[]' >said
	[ ! -s said ] || { cat said; return 1; }
	wd POST /se/log '{"type": "performance"}' |
		jq -r '.[].message | fromjson.message | select(.method == "Network.requestWillBeSent").params.request.url' >requests
	not grep -v -e "^$server/" -e "^blob:$server/" -e '^data:' -e '^chrome:' requests # the last are the browser's own
}

not() { ! "$@"; }

@test "six things are named by clicks in one photograph, asked, spoken of, and clicked in the scene" {
	browse
	is "location.href === '$server/' && !scene.things.length"
	js "document.querySelector('#mode').click()"
	while read -r name; do
		press $(place "$name")
		eventually "return lit.masks.size === strip.length"
		is "share(lit.masks.get(view.name)) > 0 && !document.querySelector('#trouble').textContent"
		shoot "label-${name// /-}"
		type_in "$name"$'\ue007'
		eventually "return scene.things.some(t => t.name === '$name') && !label?.points.length"
	done <names
	shoot labelled
	is "scene.revision === 6 && scene.things.length === 6 && scene.things.every(t => t.labelled)"
	type_in $'\ue00c'
	is "label === null"
	"$BIN/miou-score" -q --json --truth <(jq -c 'del(.ref)' truth.jsonl) run/labels.jsonl | tee score | jq -e '.miou > 0.5'
	mapfile -t name <names
	for k in 0 1 2; do
		ask "where is the ${name[k]}?"
		lit "${name[k]}"
	done
	ask "what is it?"
	lit "${name[2]}"
	eventually "return lit.masks.size >= strip.length && share(lit.masks.get(view.name)) > 0"
	shoot asked
	ask "how many things are there?"
	is "/six/.test(talk.firstChild.textContent)"
	ask "where is the zeppelin?"
	is "talk.firstChild.classList.contains('refused') && !lit.names.length"
	type_in $'\ue013\ue013' # up twice
	is "document.querySelector('#ask input').value === 'how many things are there?'"
	js "document.querySelector('#ask input').value = ''; set_view(scene.views[0])"
	press $(place "${name[1]}")
	eventually "return !document.querySelector('.waiting') && /Pointed at/.test(talk.firstChild.textContent)"
	lit "${name[1]}"
	if [ -f "$VIEWER/spark.module.min.js" ]; then
		eventually "return document.querySelector('.stage').classList.contains('is-on')"
		js "document.querySelector('.stage').scrollIntoView({block: 'end'})"
		press $(js "const r = document.querySelector('.stage').getBoundingClientRect(), c = scene.camera;
			const [x0, y0, x1, y1] = $(jq -sc --arg name "${name[3]}" '[.[] | select(.name == $name and .view == "view_000")][0].box' boxes.jsonl);
			const k = r.height / 2 / Math.max(c.tan_y, c.tan_x * r.height / r.width);
			return [r.left + r.width / 2 + k * c.tan_x * ((x0 + x1) / 160 - 1), r.top + r.height / 2 + k * c.tan_y * ((y0 + y1) / 120 - 1)].map(Math.round)" |
			jq -r '"\(.[0]) \(.[1])"')
		eventually "return !document.querySelector('.waiting') && /Pointed at in the scene/.test(talk.firstChild.textContent)"
		lit "${name[3]}"
		sleep 1
		shoot scene
	fi
	quiet
}

@test "names are changed and forgotten, the conversation stays, and a link asks again" {
	curl -s -H "Authorization: Bearer $(sed 's/.*#//' url)" "$server/v1/label" \
		-d '{"outline": {"view": "view_000", "points": [[60, 40], [80, 40], [80, 60]]}, "name": "zeppelin"}' >reply
	browse
	n=$(js "return scene.things.length")
	js "find('.things [data-name=zeppelin] button').click(); find('.things [aria-label=\"rename zeppelin\"]').click(); find('.things input').value = 'green zeppelin'"
	type_in $'\ue007'
	eventually "return scene.things.some(t => t.name === 'green zeppelin')"
	ask "where is the green zeppelin?"
	lit "green zeppelin"
	is "location.hash === '#q=' + encodeURIComponent('where is the green zeppelin?')"
	wd POST /refresh '{}'
	eventually "return document.querySelectorAll('#talk li').length === 2 && lit.names.length === 1"
	for _ in 1 2; do js "find('.things [aria-label=\"remove green zeppelin\"]').click()"; done
	eventually "return scene.things.length === $n - 1"
	ask "where is the green zeppelin?"
	is "talk.firstChild.classList.contains('refused')"
	quiet
}

@test "on a telephone a thing is named by drawing round it, and nothing is wider than the window" {
	browse '{mobileEmulation: {deviceMetrics: {width: 390, height: 844, pixelRatio: 2, touch: true}}}'
	is "document.documentElement.scrollWidth <= innerWidth"
	js "document.querySelector('#mode').click()"
	read -r x y < <(place "$(head -n 1 names)")
	press $((x - 9)) $((y - 9)) "[[$((x + 9)), $((y - 9))], [$((x + 9)), $((y + 9))], [$((x - 9)), $((y + 9))]]"
	eventually "return lit.masks.has(view.name)"
	is "label.outline.points.length > 3 && document.documentElement.scrollWidth <= innerWidth"
	shoot telephone
	js "document.querySelector('#label input').focus()"
	type_in $'drawn thing\ue007'
	eventually "return scene.things.some(t => t.name === 'drawn thing')"
	ask "drawn thing"
	lit "drawn thing"
	is "document.documentElement.scrollWidth <= innerWidth"
	quiet
	kill "$(cat pid)"
	for _ in $(seq 100); do kill -0 "$(cat pid)" 2>/dev/null || break; sleep 0.1; done
	js "ask('where is it?')"
	eventually "return document.querySelector('#trouble').textContent.startsWith('The server does not answer')"
	is "document.querySelector('#ask input').value === 'where is it?'"
}
