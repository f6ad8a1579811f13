#!/usr/bin/env bats
# The page of refer-report in a browser, Chromium without a window: opened, searched, sorted, clicked, and the scene shown, with
# no message on the console. Skipped where there is no Chromium; the scene's part where `make viewer` has not been run.
# Parts: cmd/report/.* pipelines/viewer.mk

setup_file() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	export OMP_WAIT_POLICY=passive VIEWER=${XDG_CACHE_HOME:-$HOME/.cache}/refersplat/viewer
	CHROMIUM=$(command -v chromium || command -v chromium-browser || command -v google-chrome) || return 0 # setup skips
	export CHROMIUM
	cd "$BATS_FILE_TMPDIR"
	cp -r "$BATS_TEST_DIRNAME/../golden/bert" encoder
	"$BIN/gs-synth" -q --objects 3 --views 6 --size 96x72 --gaussians 2000 -o .
	mkdir -p run/lifted
	"$BIN/gs-import" -q --images images --test-views "$(cat test-views)" -o run/scene point_cloud.ply
	"$BIN/gs-weigh" -q -o weights run/scene
	jq -c 'if .split == "test" then .text += " \"<img src=x onerror=console.error(1)>, чашка" else . end' sentences.jsonl >marked.jsonl
	"$BIN/text-encode" -q --model encoder -o run/text.safetensors marked.jsonl
	"$BIN/refer-lift" -q --scene run/scene --weights weights --text run/text.safetensors --masks truth.jsonl -o run/lifted/model.safetensors
	for set in test train; do
		"$BIN/refer-render" -q --scene run/scene --text run/text.safetensors --model run/lifted/model.safetensors \
			--sentences $set --split test -o run/lifted/predictions.$set.jsonl
	done
	"$BIN/refer-report" -q --no-viewer --truth truth.jsonl -o plain.html run
}

setup() {
	[ -n "${CHROMIUM:-}" ] || skip "no chromium"
	cd "$BATS_FILE_TMPDIR"
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
}

# browse PAGE SCRIPT: the page in a browser, where the script, the body of an async function, has run with `check` and `$`. Prints
# what the checks and the console said, a line each, and "end".
browse() {
	local page=${1%.html}.tested.html
	{
		cat <<-'END'
			<!DOCTYPE html><meta charset="utf-8"><script>
			const said = [];
			for (const kind of ['error', 'warn', 'log']) console[kind] = (...words) => said.push(`console.${kind}: ${words.join(' ')}`);
			addEventListener('error', e => said.push('error: ' + (e.message || e.target.outerHTML)), true);
			addEventListener('unhandledrejection', e => said.push('rejected: ' + e.reason));
			</script>
		END
		sed '1d' "$1"
		cat <<-END
			<script>
			const \$ = what => document.querySelector(what);
			const check = (is, what) => said.push((is ? 'ok ' : 'not ok ') + what);
			const until = async is => { for (let k = 0; k < 600 && !is(); k++) await new Promise(done => setTimeout(done, 100)); return is(); };
			const set = (what, value) => { \$(what).value = value; \$(what).dispatchEvent(new Event('input')); };
			const texts = () => [...document.querySelectorAll('.card h3')].map(e => e.textContent);
			(async () => { $2 })().catch(e => said.push('failed: ' + e)).finally(() => {
				for (const line of [...said, 'end']) console.info('said: ' + line.replaceAll('"', '') + ' :said');
			});
			</script>
		END
	} >"$page"
	rm -f chromium.log
	"$CHROMIUM" --headless --no-sandbox --disable-dev-shm-usage --use-gl=angle --use-angle=swiftshader --enable-unsafe-swiftshader \
		--ignore-gpu-blocklist --user-data-dir="$BATS_TEST_TMPDIR/chromium" --window-size="${SIZE:-1280,900}" \
		--remote-debugging-port=0 --enable-logging=stderr "file://$PWD/$page" >chromium.log 2>&1 3>&- &
	for ((k = 0; k < 1200; k++)); do
		grep -q 'said: end :said' chromium.log && break
		sleep 0.1
	done
	kill $!
	wait $! || true
	sed -n 's/.*CONSOLE.*said: \(.*\) :said.*/\1/p' chromium.log
}

# Fails where the browser said anything but "ok ..." and, last, "end".
fine() {
	cat "$1"
	[ "$(tail -n 1 "$1")" = end ] && ! sed '$d' "$1" | grep -v '^ok '
}

@test "the page is opened, searched, sorted and clicked without a message" {
	browse plain.html "
		const sentences = data.sets[0].sentences, all = texts().length;
		check(all === sentences.length, 'a card for each sentence');
		check(texts().every(t => t.includes('<img src=x onerror=')), 'markup in a sentence is text');
		const iou = ref => sentences.find(s => s.text === ref).iou;
		check(texts().every((t, i, list) => !i || iou(list[i - 1]) <= iou(t)), 'the worst comes first');
		set('#sort', '-iou');
		check(texts().every((t, i, list) => !i || iou(list[i - 1]) >= iou(t)), 'or the best');
		set('#sort', 'text');
		check(texts().every((t, i, list) => !i || list[i - 1].localeCompare(t, 'en') <= 0), 'or by sentence');
		set('#filter', sentences[0].text.toUpperCase());
		check(texts().includes(sentences[0].text) && texts().length < all || all === 1, 'some are found');
		set('#filter', 'nothing-like-it');
		check(texts().length === 0 && /^0 of/.test(\$('#count').textContent), 'or none');
		set('#filter', '');
		\$('.card summary').click();
		check(\$('.card details').open && \$('.card details').textContent.includes('Taken apart'), 'reasons are shown');
		\$('.card .picture').click();
		check(\$('dialog').open && \$('dialog svg'), 'a view is enlarged');
		\$('dialog .picture').click();
		check(!\$('dialog').open, 'and closed');
		document.querySelectorAll('.tabs button')[1].click();
		check(texts().length === data.sets[1].sentences.length, 'the other sentences are shown');
		check(\$('#viewer').hidden, 'there is no viewer');
		check(score_words({sentences: [{text: 'mug', said: ['mug'], right: true}]}).startsWith('The right thing is found for 1 of 1 name'), 'names alone are called so');
		check(percent(.999) === '99%' && percent(.001) === 'below 1%' && percent(1) === '100%', 'certain is only what is');
		check(document.documentElement.scrollWidth <= innerWidth, 'nothing is wider than the window');
	" >said
	fine said
	[ "$(grep -c ^ok said)" = 15 ]
}

@test "on a telephone nothing is wider than the window" {
	SIZE=500,844 browse plain.html "check(document.documentElement.scrollWidth <= innerWidth, 'as wide as the window: ' + innerWidth);" >said
	fine said
}

@test "the scene is shown, and what a sentence means is lit up with its box" {
	[ -f "$VIEWER/spark.module.min.js" ] || skip "no viewer: make viewer"
	"$BIN/refer-report" -q --truth truth.jsonl -o scene.html run
	browse scene.html "
		check(!\$('#viewer').hidden, 'there is a viewer');
		const style = what => getComputedStyle(\$(what));
		check(style('.stage').backgroundSize === 'contain' && style('.stage').backgroundImage !== 'none', 'the whole photograph is there');
		// A canvas that can be read, and a worker that sorts long after the page would have come to rest.
		const {getContext} = HTMLCanvasElement.prototype, {postMessage} = Worker.prototype;
		HTMLCanvasElement.prototype.getContext = function (kind, o) { return getContext.call(this, kind, {...o, preserveDrawingBuffer: true}); };
		Worker.prototype.postMessage = function (...what) { setTimeout(() => postMessage.apply(this, what), 2500); };
		\$('.in-scene').click();
		check(await until(() => Number(\$('.stage').dataset.frames) >= 3), 'frames are drawn');
		check(style('.stage canvas').visibility === 'hidden', 'and not shown before they are sorted');
		check(await until(() => style('.stage canvas').visibility === 'visible'), 'then they are');
		const gl = \$('.stage canvas').getContext('webgl2'), pixels = new Uint8Array(4 * gl.drawingBufferWidth * gl.drawingBufferHeight);
		gl.readPixels(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
		const colours = new Set(new Uint32Array(pixels.buffer));
		check(colours.size > 1000, 'the scene has many colours: ' + colours.size);
		check(\$('#viewer select').value === data.sets[0].sentences.find(s => s.ref === \$('.card.is-shown').dataset.ref).answer[0], 'the answer is chosen');
		check(\$('.hint').textContent.includes(\$('.card.is-shown h3').textContent), 'the sentence is there');
		const context = \$('.stage canvas').getContext('webgl2');
		check(context && context.getError() === 0, 'WebGL has no error');
	" >said
	fine said
	[ "$(grep -c ^ok said)" = 9 ]
}
