#!/usr/bin/env bats
# refer-serve: the same answers as refer-ask over HTTP and a pipe, labels that are kept and asked at once, and what is refused.

bats_require_minimum_version 1.5.0
load refer-ask.bash

setup_file() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	export OMP_WAIT_POLICY=passive OMP_NUM_THREADS=2
	make_run
	cp -r weights run
	"$BIN/pseudomask-propose" -q --weights weights --regions run/regions.safetensors -o /dev/null run/scene
	cp -r run named # what a test labels is not another's
	mkdir nameless
	cp -r run/scene run/weights run/regions.safetensors nameless
	serve run
}

teardown_file() {
	kill "$(cat "$BATS_FILE_TMPDIR/run.pid")"
}

setup() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	cd "$BATS_FILE_TMPDIR"
	ADDRESS=$(sed 's,/#.*,,' run.out)
	TOKEN=$(sed 's/.*#//' run.out)
	thing=$(head -n 1 things)
}

# serve RUN [OPTION...]: in the background; RUN.pid and RUN.out, the line that it prints
serve() {
	"$BIN/refer-serve" --port 0 --encoder encoder "${@:2}" "$1" >"$1.out" 2>"$1.err" 3>&- &
	echo $! >"$1.pid"
	for _ in $(seq 300); do
		[ ! -s "$1.out" ] || return 0
		sleep 0.1
	done
	cat "$1.err"
	return 1
}

post() { curl -s --data-binary @- "${@:2}" "$ADDRESS/v1/$1"; }
lines() { "$BIN/refer-serve" -q --stdio --encoder encoder "$@"; }

# refused STATUS MESSAGE CURL-ARGUMENT...
refused() {
	local status message=$2
	status=$(curl -s -o "$BATS_TEST_TMPDIR/reply" -w '%{http_code}' "${@:3}")
	[ "$status" = "$1" ] && [ "$(jq -r .error "$BATS_TEST_TMPDIR/reply")" = "$message" ] ||
		{ echo "$status: $(cat "$BATS_TEST_TMPDIR/reply")"; return 1; }
}

@test "help and version" {
	run "$BIN/refer-serve" --help
	[[ "$status" -eq 0 && "${lines[0]}" == "Usage: refer-serve [OPTION]... RUN" ]]
	run "$BIN/refer-serve" -V
	[[ "$status" -eq 0 && "$output" == "refer-serve (refersplat) "* ]]
}

@test "it answers as refer-ask does, over HTTP and over a pipe" {
	while read -r question; do
		ask --json run "$question" >alone || [ $? = 1 ] || [ $? = 5 ]
		jq -n --arg q "$question" '{question: $q}' | post ask >http
		jq -nc --arg q "$question" '{do: "ask", question: $q}' | lines run >pipe
		cmp http pipe
		cmp <(jq -S 'del(.words)' http) <(jq -S . alone)
		cmp <(jq -r .words http) <(ask run "$question" || true)
	done <<-END
		$thing
		how many things are there?
		where is the zeppelin?
	END
}

@test "a conversation knows what was spoken of, until it is forgotten" {
	say() { jq -n --arg q "$1" '{question: $q, conversation: "me"}' | post ask; }
	say "where is the $thing?" | jq -e --arg t "$thing" '.things[0].name == $t'
	say "what is it?" | jq -e '.understood != null'
	say "" | jq -e '. == {}'
	say "what is it?" | jq -e '.understood == null'
}

@test "a question may be asked from a view and from a place" {
	echo '{"question": "box", "from": "view_002"}' | post ask | jq -e '.question == "box"'
	echo '{"question": "box", "from": [0, 1, 2]}' | post ask | jq -e '.question == "box"'
	echo '{"question": "box", "from": [0, 1]}' | refused 400 "request: key 'from' is no view and no three numbers" -d @- "$ADDRESS/v1/ask"
	echo '{"question": "box", "from": "nowhere"}' | refused 404 "from: 'nowhere' is no view and no x,y,z" -d @- "$ADDRESS/v1/ask"
}

@test "what is at a pixel is what refer-ask says, and what a ray through it meets" {
	# a pixel of the thing in its own mask: the middle of the longest run
	curl -s "$ADDRESS/v1/mask?view=view_001&thing=$(jq -rn --arg t "$thing" '$t | @uri')" >mask
	read -r x y < <(jq -r '. as $m | reduce .counts[] as $n ({at: 0, on: false, best: 0};
		(if .on and $n > .best then .best = $n | .middle = .at + ($n / 2 | floor) else . end) | .at += $n | .on |= not) |
		"\(.middle / $m.height | floor) \(.middle % $m.height)"' mask)
	ask --json --point "view_001:$x,$y" run >alone
	jq -n --argjson x "$x" --argjson y "$y" '{view: "view_001", x: $x, y: $y}' | post pick >picked
	cmp <(jq -S '.things' alone) <(jq -S '.things' picked)
	jq '.[] | select(.name == "view_001") | . as $c | .world_to_camera as $m |
		[(('"$x"' + 0.5) - .cx) / .fx, (('"$y"' + 0.5) - .cy) / .fy, 1] as $d |
		{origin: [range(3) as $i | -([range(3) as $k | $m[$k][$i] * $m[$k][3]] | add)],
		 direction: [range(3) as $i | [range(3) as $k | $m[$k][$i] * $d[$k]] | add]}' run/scene/cameras.json | post pick >ray
	[ "$(jq -r '.things[0].name' ray)" = "$(jq -r '.things[0].name' alone)" ]
}

@test "a mask is that of refer-render" {
	curl -s "$ADDRESS/v1/mask?view=view_002&thing=$(jq -rn --arg t "$thing" '$t | @uri')" |
		jq -c --arg t "$thing" '{view, object: $t, segmentation: {size: [.height, .width], counts}}' >served
	ref=$(jq -r --arg t "$thing" 'select(.object == $t).ref' sentences.jsonl | head -n 1)
	"$BIN/refer-render" -q --scene run/scene --text text.safetensors --model run/lifted/model.safetensors --split all --views view_002 \
		--refs "$ref" -o rendered
	"$BIN/miou-score" -q --json --truth <(jq -c 'del(.ref)' rendered) served | jq -e '.miou == 1'
}

@test "photographs and splats" {
	curl -s "$ADDRESS/v1/view?name=view_001" | head -c 3 | xxd -p | grep -qx ffd8ff
	curl -s "$ADDRESS/v1/things" >told
	[ "$(curl -s "$ADDRESS/v1/splats" | /usr/bin/python3 -c 'import sys, zlib; print(len(zlib.decompress(sys.stdin.buffer.read())))')" = \
		"$(jq '32 * .count' told)" ]
	jq -e '.can_label and .can_outline and (.views | length == 6) and (.things | length == 3) and ([.groups[].count] | add) == .count' told
}

@test "a click names a thing of a scene without names, which then can be asked by every tool" {
	middle=$(jq -c --arg t "$thing" 'select(.object == $t and .view == "view_001")' truth.jsonl | head -n 1)
	"$BIN/mask-export" -o coco.json <(echo "$middle")
	read -r x y < <(jq -r '.annotations[0].bbox | "\(.[0] + .[2] / 2 | floor) \(.[1] + .[3] / 2 | floor)"' coco.json)
	place="[{\"view\": \"view_001\", \"x\": $x, \"y\": $y}]"
	lines nameless >said <<-END
		{"do": "ask", "question": "where is the cup?"}
		{"do": "label", "points": $place}
		{"do": "label", "points": $place, "name": " cup\u00a0"}
		{"do": "ask", "question": "where is the cup?"}
		{"do": "things"}
		{"do": "label", "name": "cup", "rename": "чашка"}
		{"do": "ask", "question": "чашка"}
		{"do": "label", "remove": "cup"}
	END
	jq -se '.[0].answered == false and (.[1].masks | length == 1) and .[2].labels == ["cup"] and .[3].things[0].name == "cup" and
		.[4].things[0].labelled and .[5].labels == ["чашка"] and .[6].things[0].name == "чашка" and .[7].error == "no label '"'cup'"'"' said
	[ "$(jq -sr 'map(.object) | unique[]' nameless/labels.jsonl)" = чашка ]
	[ "$(ask nameless чашка | cut -d: -f1)" = чашка ]
	# the mask of what was clicked is as mask-pick has it
	"$BIN/mask-pick" --regions run/regions.safetensors --weights weights --point "view_001:$x,$y" --name чашка -o picked run/scene
	cmp picked nameless/labels.jsonl
	echo '{"do": "label", "remove": "чашка"}' | lines nameless | jq -e '.labels == []'
	[ ! -s nameless/labels.jsonl ] && [ ! -e nameless/lifted/labels.safetensors ]
}

@test "a conversation is about the same thing when others get names before it, and about none when it is gone" {
	cp -r nameless talked
	outline() { echo "{\"do\": \"label\", \"outline\": {\"view\": \"view_001\", \"points\": $2}, \"name\": \"$1\"}"; }
	asks() { echo "{\"do\": \"ask\", \"question\": \"$1\", \"conversation\": \"me\"}"; }
	{
		outline zeppelin "[[30, 20], [60, 20], [60, 50]]"
		asks "where is the zeppelin?"
		outline anvil "[[10, 40], [25, 40], [25, 60]]"
		asks "what is it?"
		echo '{"do": "label", "remove": "zeppelin"}'
		asks "what is it?"
	} | lines talked >said
	jq -se '.[1].things[0].name == "zeppelin" and .[3].understood == "what is the zeppelin?" and .[5].understood == null' said
}

@test "an outline needs no regions, and takes the place of a model's thing of that name" {
	rm -f named/regions.safetensors
	lines named >said <<-END
		{"do": "label", "points": [{"view": "view_001", "x": 5, "y": 5}], "name": "x"}
		{"do": "label", "outline": {"view": "view_001", "points": [[30, 20], [60, 20], [60, 50], [30, 50]]}, "name": "$thing"}
		{"do": "things"}
	END
	jq -se '(.[0].error | startswith("named: no regions in it")) and .[1].labels == ["'"$thing"'"] and (.[2].things | length == 3) and
		([.[2].things[] | select(.labelled).name] == ["'"$thing"'"])' said
}

@test "labels that another program wrote are lifted when it begins" {
	cp -r nameless later
	"$BIN/mask-pick" --regions run/regions.safetensors --weights weights --point view_001:48,36 --name pan -o later/labels.jsonl run/scene
	echo '{"do": "ask", "question": "where is the pan?"}' | lines later | jq -e '.things[0].name == "pan"'
	[ "$(ask later pan | cut -d: -f1)" = pan ]
	run "$BIN/refer-serve" --labels - later
	[ "$status" = 2 ] && [ "${lines[0]}" = "refer-serve: --labels must name a file" ]
}

@test "two servers of one folder lose no label" {
	cp -r nameless two
	for k in 1 2 3; do
		for name in a b; do
			echo "{\"do\": \"label\", \"outline\": {\"view\": \"view_00$k\", \"points\": [[30, 20], [60, 20], [60, 50]]}, \"name\": \"$name$k\"}" |
				lines two >"$name$k.said" 3>&- &
		done
	done
	wait
	[ "$(jq -sr 'map(.object) | unique | join(" ")' two/labels.jsonl)" = "a1 a2 a3 b1 b2 b3" ] || { cat ./*.said; return 1; }
}

@test "nothing is kept without the token" {
	label='{"outline": {"view": "view_001", "points": [[30, 20], [60, 20], [60, 50]]}, "name": "x"}'
	no='the token is missing, or another: what keeps something needs it'
	refused 403 "$no" -d "$label" "$ADDRESS/v1/label"
	refused 403 "$no" -d "$label" -H "Authorization: Bearer ${TOKEN/[0-9a-f]/x}" "$ADDRESS/v1/label"
	refused 403 "$no" -d '{"remove": "x"}' "$ADDRESS/v1/label"
	echo '{"outline": {"view": "view_001", "points": [[30, 20], [60, 20], [60, 50]]}}' | post label | jq -e '.masks | length == 1'
	[ ! -e run/labels.jsonl ]
}

@test "requests of other pages and to other names are refused" {
	refused 403 "the Host is not this server's" -H 'Host: example.com' "$ADDRESS/v1/things"
	refused 403 "the Host is not this server's" -H "Host: 127.0.0.1:1" "$ADDRESS/v1/things"
	refused 403 "another page's Origin" -H 'Origin: http://example.com' "$ADDRESS/v1/things"
	refused 403 "another page's Origin" -H 'Origin: null' -d '{"question": "box"}' "$ADDRESS/v1/ask"
	refused 403 "another page's request" -H 'Sec-Fetch-Site: cross-site' "$ADDRESS/v1/view?name=view_001"
	[ "$(curl -s -o /dev/null -w '%{http_code}' -H "Origin: $ADDRESS" "$ADDRESS/")" = 200 ]
	[ "$(curl -s -o /dev/null -w '%{http_code}' "${ADDRESS/127.0.0.1/localhost}/")" = 200 ]
}

@test "what cannot be answered is said" {
	refused 400 "request: not JSON at offset 0" -d 'x' "$ADDRESS/v1/ask"
	refused 400 "request: not a JSON object" -d '[]' "$ADDRESS/v1/ask"
	refused 400 "request: key 'question' is missing" -d '{}' "$ADDRESS/v1/ask"
	refused 400 "the question is longer than 2000 bytes" -d "{\"question\": \"$(head -c 2001 /dev/zero | tr '\0' x)\"}" "$ADDRESS/v1/ask"
	refused 404 "no view '../../etc/passwd'" "$ADDRESS/v1/view?name=../../etc/passwd"
	refused 404 "no thing 'x'" "$ADDRESS/v1/mask?view=view_001&thing=x"
	refused 404 "nothing here" --path-as-is "$ADDRESS/../../etc/passwd"
	refused 404 "no such module: 'make viewer' fetches them" --path-as-is "$ADDRESS/modules/../serving.c"
	refused 405 "POST is what this takes" "$ADDRESS/v1/ask"
	refused 405 "GET is what this takes" -d '{}' "$ADDRESS/v1/things"
	refused 400 "request: key 'points': 9999, 1 is outside of view 'view_001', which is 96x72" \
		-d '{"points": [{"view": "view_001", "x": 9999, "y": 1}]}' "$ADDRESS/v1/label"
	refused 400 "--point: 'view_001:9999.000000,1.000000' is outside of the view, which is 96x72" \
		-d '{"view": "view_001", "x": 9999, "y": 1}' "$ADDRESS/v1/pick"
	refused 400 "request: key 'direction' has no length" -d '{"origin": [0, 0, 0], "direction": [0, 0, 0]}' "$ADDRESS/v1/pick"
	refused 404 "no 'x' here: ask, pick, label, things, splats, view and mask are what there is" "$ADDRESS/v1/x"
}

@test "bodies that never end, slow clients and many connections do not stop it" {
	head -c 2000000 /dev/zero >large
	refused 413 "the body is longer than a megabyte" --data-binary @large "$ADDRESS/v1/ask"
	curl -s -m 20 -H 'Transfer-Encoding: chunked' -T - "$ADDRESS/v1/ask" -X POST <large >reply || true
	[ ! -s reply ]
	port=${ADDRESS##*:}
	for _ in $(seq 40); do
		(exec 9<>"/dev/tcp/127.0.0.1/$port" && printf 'POST /v1/ask HTTP/1.1\r\nHost: 127.0.0.1:%s\r\nContent-Length: 100\r\n\r\n{' "$port" >&9 && sleep 5) 3>&- &
	done
	sleep 0.5
	echo '{"question": "box"}' | post ask -m 4 | jq -e '.question == "box"'
	wait $(jobs -p | grep -vx "$(cat run.pid)") 2>/dev/null || true
}

@test "of a thousand connections at once few are taken, and when they are gone it answers" {
	port=${ADDRESS##*:}
	(
		for _ in $(seq 1000); do
			exec {fd}<>"/dev/tcp/127.0.0.1/$port"
		done
		ls "/proc/$(cat run.pid)/fd" >taken
	) 3>&-
	[ "$(wc -l <taken)" -lt 100 ]
	echo '{"question": "box"}' | post ask -m 20 | jq -e '.question == "box"'
}

@test "it ends cleanly, and the port that another has is told" {
	cp -r nameless ends
	serve ends -v
	port=$(sed 's,.*:\([0-9]*\)/.*,\1,' ends.out)
	run "$BIN/refer-serve" --port "$port" --encoder encoder run
	[ "$status" = 4 ] && [[ "$output" == "refer-serve: 127.0.0.1 port $port: "* ]]
	kill "$(cat ends.pid)"
	for _ in $(seq 100); do kill -0 "$(cat ends.pid)" 2>/dev/null || break; sleep 0.1; done
	grep -q 'peak memory' ends.err
	run "$BIN/refer-serve" --address example.com --encoder encoder run
	[ "$status" = 2 ] && [ "${lines[0]}" = "refer-serve: --address: 'example.com' is no number of an interface, such as 127.0.0.1" ]
}

@test "ask.mk makes what a click needs, once, and opens the page" {
	open=(make -s -f "$BATS_TEST_DIRNAME/../../pipelines/ask.mk" BIN="$BIN" BERT="$PWD/encoder" SCENE=opened SPLATS=point_cloud.ply CAMERAS=sparse/0
		IMAGES=images DETECTOR= PORT=0)
	"${open[@]}" >opened.out 2>&1 3>&- &
	for _ in $(seq 600); do
		! grep -q '^http://' opened.out || break
		sleep 0.1
	done
	curl -s "$(sed -n 's,/#.*,,p' opened.out)/v1/things" | jq -e '.can_label and (.things == [])'
	pkill -f -- "--port 0 opened"
	run grep -c propose opened.out
	"${open[@]}" >again.out 2>&1 3>&- &
	for _ in $(seq 600); do
		! grep -q '^http://' again.out || break
		sleep 0.1
	done
	pkill -f -- "--port 0 opened"
	[ "$output" -gt 0 ] && [ "$(grep -c '^pseudomask-propose (' again.out)" = 0 ]
}

@test "the page and its scripts" {
	curl -s -D head "$ADDRESS/" | grep -q '<!DOCTYPE html>'
	grep -qi "^content-security-policy: default-src 'none'" head
	curl -s "$ADDRESS/page.js" | cmp - "$BATS_TEST_DIRNAME/../../cmd/serve/page.js"
	curl -s "$ADDRESS/viewer.js" | cmp - "$BATS_TEST_DIRNAME/../../cmd/report/report_viewer.js"
}

@test "the examples of formats/serve.md" {
	export ADDRESS
	sed -n 's/^    \(echo .*\)/\1/p' "$BATS_TEST_DIRNAME/../../formats/serve.md" | bash | grep -q .
	sed -n '/^```python/,/^```/{/^```/d;p}' "$BATS_TEST_DIRNAME/../../formats/serve.md" | /usr/bin/python3 | grep -q .
}
