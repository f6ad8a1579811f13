'use strict';
// The page of refer-serve: questions and their answers in words, lit up in photographs and in the scene; clicks on what is there,
// and names for it. formats/serve.md has what the server is asked.
const find = (what, in_ = document) => in_.querySelector(what);
const known = x => x !== null && x !== undefined;
const count = (n, one, more = one + 's') => n.toLocaleString('en') + ' ' + (n === 1 ? one : more);
const STRIP = 16; // photographs beneath the large one; an answer is looked for in these
const DRAG = 6; // pixels of the screen that make a click a line
const photo = find('#photo'), frame = find('.frame'), overlay = find('.frame canvas'), talk = find('#talk ol'), line = find('#ask input');
let scene, viewer = null, is_stale = false; // whether the viewer has the splats of another revision
let view = null, strip = [];
let lit = {names: [], masks: new Map(), is_preview: false}; // what is lit up; its masks by view
let label = null; // the thing that is being named: null unless the mode is on
const kept = {get: key => JSON.parse(sessionStorage.getItem(key)), set: (key, value) => sessionStorage.setItem(key, JSON.stringify(value))};

// An element: attributes, then children; strings become text, never markup.
function make(name, attributes = {}, ...children) {
	const e = document.createElement(name);
	for (const [key, value] of Object.entries(attributes))
		if (key.startsWith('on')) e.addEventListener(key.slice(2), value);
		else if (known(value) && value !== false) e.setAttribute(key, value === true ? '' : value);
	e.append(...children.flat().filter(known));
	return e;
}

// What the server says, and nothing where it says nothing.
function trouble(e) {
	if (e && e.name === 'AbortError') return;
	find('#trouble').textContent = e ? e.message : '';
	find('#trouble').hidden = !e;
}

async function call(path, body, signal) {
	const headers = {'Content-Type': 'application/json'};
	if (kept.get('token')) headers.Authorization = 'Bearer ' + kept.get('token');
	const reply = await fetch(path, body ? {method: 'POST', headers, body: JSON.stringify(body), signal} : {signal}).catch(e => {
		throw e.name === 'AbortError' ? e : new Error('The server does not answer: is refer-serve still running?');
	});
	const json = await reply.json().catch(() => ({error: `the server answers ${reply.status} without a reason`}));
	if (reply.status === 401 || reply.status === 403)
		throw new Error(json.error + ': to name things, open the address that refer-serve prints when it starts');
	if (!reply.ok || json.error) throw new Error(json.error);
	return json;
}

// Masks: run lengths column by column, first of what is outside.

const masks = new Map();
function mask_of(name, things) {
	const key = JSON.stringify([scene.revision, name, things]);
	if (!masks.has(key)) {
		const of = new URLSearchParams([['view', name], ...things.map(t => ['thing', t])]);
		masks.set(key, call('/v1/mask?' + of).catch(e => { masks.delete(key); throw e; }));
	}
	return masks.get(key);
}

const share = mask => mask ? mask.counts.reduce((n, c, k) => n + k % 2 * c, 0) / (mask.width * mask.height || 1) : 0;

// Each step-th row and column of a mask as a picture of one colour.
function stencil(mask, step, colour) {
	const h = Math.ceil(mask.height / step), w = Math.ceil(mask.width / step), canvas = make('canvas', {width: w, height: h});
	const context = canvas.getContext('2d'), image = context.createImageData(w, h), pixels = new Uint32Array(image.data.buffer);
	let at = 0;
	mask.counts.forEach((n, k) => {
		for (let i = at; k % 2 && i < at + n; i++) {
			const x = Math.floor(i / mask.height), y = i % mask.height;
			if (x % step === 0 && y % step === 0) pixels[y / step * w + x / step] = 0xff000000;
		}
		at += n;
	});
	context.putImageData(image, 0, 0);
	context.globalCompositeOperation = 'source-in';
	context.fillStyle = colour;
	context.fillRect(0, 0, w, h);
	return canvas;
}

const colour_of = name => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

// What is outside is veiled, the outline drawn, and the inside tinted.
function draw_mask(canvas, mask, width) {
	const dots = window.devicePixelRatio || 1, w = canvas.width = Math.round(canvas.clientWidth * dots), h = canvas.height = Math.round(canvas.clientHeight * dots);
	if (!w || !h || !share(mask)) return;
	const context = canvas.getContext('2d'), r = width * dots;
	const shape = stencil(mask, Math.max(1, Math.floor(mask.width / w)), colour_of(lit.is_preview ? '--mark' : '--mask'));
	context.fillStyle = colour_of('--veil');
	context.globalAlpha = lit.is_preview ? .6 : 1;
	context.fillRect(0, 0, w, h);
	context.globalAlpha = 1;
	for (let k = 0; k < 12; k++) context.drawImage(shape, r * Math.cos(Math.PI * k / 6), r * Math.sin(Math.PI * k / 6), w, h);
	context.globalCompositeOperation = 'destination-out';
	context.drawImage(shape, 0, 0, w, h);
	context.globalCompositeOperation = 'source-over';
	context.globalAlpha = .35;
	context.drawImage(shape, 0, 0, w, h);
}

// The clicks and the line that were drawn in the photograph that is shown.
function draw_marks() {
	const context = overlay.getContext('2d'), k = overlay.width / view.width, dots = window.devicePixelRatio || 1;
	const stroke = (path, colour) => {
		context.lineWidth = 4 * dots, context.strokeStyle = '#fff', context.stroke(path);
		context.lineWidth = 2 * dots, context.strokeStyle = colour, context.stroke(path);
	};
	context.globalAlpha = 1;
	for (const [list, colour] of [[label.points, '#06627c'], [label.outside, '#b3261e']])
		for (const p of list.filter(p => p.view === view.name)) {
			const path = new Path2D(), x = k * p.x, y = k * p.y, r = 5 * dots;
			path.moveTo(x - r, y), path.lineTo(x + r, y);
			if (list === label.points) path.moveTo(x, y - r), path.lineTo(x, y + r);
			stroke(path, colour);
		}
	const outline = label.drawing || label.outline;
	if (!outline || outline.view !== view.name) return;
	const path = new Path2D();
	outline.points.forEach(([x, y]) => path.lineTo(k * x, k * y));
	if (!label.drawing) path.closePath();
	stroke(path, '#06627c');
}

function draw_large() {
	if (!view) return;
	draw_mask(overlay, lit.masks.get(view.name), 2.5);
	if (label) draw_marks();
	const is_known = lit.masks.has(view.name) && (lit.names.length || lit.is_preview);
	find('.hint', frame).textContent = is_known && !share(lit.masks.get(view.name)) ? 'Not seen in this photograph.' : '';
}

function put_mask(name, mask) {
	lit.masks.set(name, mask);
	const small = strip.find(s => s.view.name === name);
	if (small) draw_mask(small.canvas, mask, 1.2);
	if (view.name === name) draw_large();
}

function clear_masks(names, is_preview) {
	lit = {names, masks: new Map(), is_preview};
	for (const s of strip) draw_mask(s.canvas, null);
	draw_large();
	find('#nothing').hidden = !names.length;
}

// The photographs.

const address = v => '/v1/view?' + new URLSearchParams({name: v.name});

async function set_view(v) {
	view = v;
	frame.style.setProperty('--aspect', v.width / v.height);
	const img = find('img', frame);
	img.src = address(v);
	img.alt = 'the photograph ' + v.name;
	find('select', photo).value = v.name;
	for (const s of strip) s.button.setAttribute('aria-pressed', s.view === v);
	draw_large();
	if (lit.masks.has(v.name)) return;
	if (label && is_marked() && !label.outline) return preview();
	const now = lit;
	if (!now.names.length) return;
	const mask = await mask_of(v.name, now.names);
	if (lit === now) put_mask(v.name, mask);
}

function set_strip() {
	const n = scene.views.length, few = Math.min(n, STRIP);
	strip = Array.from({length: few}, (_, k) => {
		const v = scene.views[Math.floor(k * n / few)], canvas = make('canvas');
		const button = make('button', {'aria-label': v.name, title: v.name, style: `aspect-ratio: ${v.width} / ${v.height}`, onclick: () => set_view(v).catch(trouble)},
			make('img', {src: address(v), alt: '', loading: 'lazy'}), canvas);
		return {view: v, button, canvas};
	});
	find('.strip').replaceChildren(...strip.map(s => s.button));
	find('select', photo).replaceChildren(...scene.views.map(v => make('option', {value: v.name}, v.name)));
}

// Those that show most of it first, and the first of them large, unless the one that is there is to stay, or nearly as good.
function sort_strip(in_view) {
	const of = s => share(lit.masks.get(s.view.name)), best = [...strip].sort((a, b) => of(b) - of(a));
	const stays = in_view || of(best[0]) <= 1.3 * share(lit.masks.get(view.name));
	if (stays) best.sort((a, b) => (b.view === view) - (a.view === view));
	find('.strip').replaceChildren(...best.map(s => s.button));
	find('.strip').scrollLeft = 0;
	if (!stays) set_view(best[0].view).catch(trouble);
}

// Lights things up, in the photographs and in the scene.
async function show(names, words = '', in_view = false) {
	if (label) set_mode(false);
	clear_masks(names, false);
	mark_chips();
	if (viewer) viewer.show(names, words, innerWidth > 800);
	if (!names.length) return;
	const now = lit, waiting = [view, ...strip.map(s => s.view).filter(v => v !== view)];
	const take = async () => {
		for (let v; lit === now && (v = waiting.shift());) {
			const mask = await mask_of(v.name, names);
			if (lit === now) put_mask(v.name, mask);
		}
	};
	await Promise.all([take(), take()]);
	if (lit === now) sort_strip(in_view);
}

// The conversation: the last first.

function item(question, reply) {
	const size = reply.picked && reply.things[0]?.size ? '\nsize ' + reply.things[0].size.map(x => x.toPrecision(3)).join(' x ') + ' high' : '';
	const words = (reply.words || reply.reason || 'There is no answer.') + size, names = (reply.things || []).map(t => t.name), more = [], others = reply.unsure && reply.runner_up ? [reply.runner_up.name] : [];
	// What stands behind the first ";" of a line is how sure it is.
	const parts = words.split('\n').flatMap((l, k) => [(k ? '\n' : '') + l.replace(/;.*/, ''), /;/.test(l) ? make('span', {class: 'soft'}, l.slice(l.indexOf(';'))) : null]);
	const li = make('li', {class: names.length ? null : 'refused'});
	const choose = async () => {
		for (const e of talk.children) e.classList.toggle('is-shown', e === li);
		await show([...names, ...others], words.split(/[\n;]/)[0], !!reply.pointed);
	};
	if (reply.unsure)
		for (const name of new Set([...names, ...others]))
			more.push(make('button', {onclick: () => ask('the ' + name)}, 'The ' + name));
	if (reply.called && reply.called.text)
		more.push(make('button', {onclick: () => ask(reply.called.text)}, `Ask for “${reply.called.text}”`));
	if (reply.pointed && !names.length && can_name())
		more.push(make('button', {onclick: () => { set_mode(true); click(reply.pointed, false); }}, 'Give it a name'));
	const asked = reply.is_said ? make('span', {class: 'question'}, question) :
		make('a', {class: 'question', href: '#q=' + encodeURIComponent(question), title: 'ask again; the link asks it too'}, question);
	asked.addEventListener('click', e => { if (!reply.is_said) { e.preventDefault(); ask(question); } });
	li.append(asked, names.length ? make('button', {class: 'words', title: 'show it', onclick: () => choose().catch(trouble)}, parts) : make('p', {class: 'words'}, parts));
	if (more.length) li.append(make('div', {class: 'controls'}, more));
	li.choose = choose;
	return li;
}

function say(question, reply, waiting) {
	const li = item(question, reply);
	if (waiting) waiting.replaceWith(li); else talk.prepend(li);
	while (talk.children.length > 100) talk.lastChild.remove();
	find('#talk-end').hidden = false;
	find('#talk').scrollTop = 0;
	kept.set('talk', [[question, reply], ...(kept.get('talk') || [])].slice(0, 30));
	return li;
}

async function answer(question, path, body, extra = {}) {
	const waiting = make('li', {class: 'waiting'}, make('span', {class: 'question'}, question), make('p', {class: 'words'}, '…'));
	talk.prepend(waiting);
	try {
		const reply = Object.assign(await call(path, body), extra);
		trouble(null);
		await say(question, reply, waiting).choose();
	} catch (e) {
		waiting.remove();
		throw e;
	}
}

async function ask(question) {
	const asked = (kept.get('asked') || []).filter(q => q !== question);
	kept.set('asked', [...asked, question].slice(-100));
	line.value = '';
	line.place = 0;
	history.replaceState(null, '', '#q=' + encodeURIComponent(question));
	const from = find('#from').checked ? view.name : undefined;
	await answer(question, '/v1/ask', {question, conversation: kept.get('conversation'), from}).catch(e => {
		line.value ||= question;
		trouble(e);
	});
}

// Up and Down: the questions of before.
function recall(e) {
	const asked = kept.get('asked') || [], step = {ArrowUp: 1, ArrowDown: -1}[e.key];
	if (!step || !asked.length) return;
	e.preventDefault();
	line.place = Math.max(0, Math.min(asked.length, (line.place || 0) + step));
	line.value = line.place ? asked[asked.length - line.place] : '';
}

async function forget() {
	await call('/v1/ask', {question: '', conversation: kept.get('conversation')});
	kept.set('talk', []);
	talk.replaceChildren();
	find('#talk-end').hidden = true;
	history.replaceState(null, '', location.pathname);
	await show([]);
}

// What is under a click, as {view, x, y} or {origin, direction}.
const pick = (place, words) => answer(words, '/v1/pick', place, {pointed: place.view ? place : undefined, is_said: true}).catch(trouble);

// Names for things.

const can_name = () => scene.can_label || scene.can_outline;
const empty = () => ({points: [], outside: [], size: 0, outline: null});
const is_marked = () => label.points.length > 0 || label.outline !== null;

function set_mode(is_on) {
	label = is_on ? {...empty(), before: [], clicks: 0} : null;
	photo.classList.toggle('is-labelling', is_on);
	find('#label').hidden = !is_on;
	find('#label input').value = '';
	find('#mode').textContent = is_on ? 'Done' : 'Label';
	find('#mode').title = is_on ? 'no more names (Esc)' : 'give things names (L)';
	find('[data-act=outside]').setAttribute('aria-pressed', false);
	clear_masks([], is_on);
	find('.strip').replaceChildren(...strip.map(s => s.button));
	if (is_on) tell_label(); else update_viewer();
}

function tell_label(words) {
	const how = scene.can_label ? 'Click a thing in the photograph, or draw round it.' : 'Draw round a thing in the photograph.';
	const then = scene.can_label && !label.outline ? 'Click what is missing, or Shift-click (“Not this”) what is too much; then type its name.' : 'Type its name.';
	find('#label p').textContent = words || (is_marked() ? then : how);
	for (const e of document.querySelectorAll('#label button, #label input')) {
		e.disabled = !!label.saving || !(is_marked() || e.dataset.act === 'undo' && label.before.length);
		e.hidden = (label.outline || !scene.can_label) && /larger|smaller|outside/.test(e.dataset.act);
	}
}

const marks = () => { const {points, outside, size, outline} = label; return structuredClone({points, outside, size, outline}); };
const to_send = () => label.outline ? {outline: label.outline} : {points: label.points, outside: label.outside, size: label.size};

async function mark(change) {
	label.before.push(marks());
	change();
	label.clicks++;
	await preview();
}

// Shows what the marks mean: in the photograph that is looked at, then in the others.
async function preview() {
	const now = label;
	now.abort?.abort();
	now.abort = new AbortController();
	tell_label();
	draw_large();
	if (!is_marked()) return clear_masks([], true);
	try {
		const others = strip.map(s => s.view.name).filter(name => name !== view.name);
		for (const views of [[view.name], others]) {
			const reply = await call('/v1/label', {...to_send(), views}, now.abort.signal);
			if (label !== now) return;
			for (const name of label.outline ? [] : views) put_mask(name, null);
			for (const m of reply.masks) put_mask(m.view, m);
		}
		trouble(null);
	} catch (e) {
		trouble(e);
		if (e.name === 'AbortError' || label !== now) return;
		Object.assign(label, label.before.pop());
		tell_label();
		draw_large();
	}
}

function click(place, is_outside) {
	if (label.saving || !scene.can_label) return;
	const outside = is_outside && label.points.length > 0;
	mark(() => {
		label.outline = null;
		label[outside ? 'outside' : 'points'].push(place);
	});
	focus_name();
}

const acts = {
	outside: () => { const b = find('[data-act=outside]'); b.setAttribute('aria-pressed', b.getAttribute('aria-pressed') !== 'true'); },
	larger: () => mark(() => { label.size++; }),
	smaller: () => mark(() => { label.size--; }),
	undo: () => { if (label.before.length) { Object.assign(label, label.before.pop()); label.clicks--; preview(); } },
};

// Not where that brings a keyboard over the photograph.
function focus_name() {
	if (label.by !== 'touch') find('#label input').focus({preventScroll: true});
}

// Saved, and the scene lifted again: how long that takes is counted.
async function save() {
	const name = find('#label input').value.trim(), begin = performance.now(), now = label;
	if (!name || !is_marked() || now.saving) return;
	now.saving = true;
	const tick = () => tell_label(`“${name}” is lifted onto the scene … ${((performance.now() - begin) / 1000).toFixed(0)} s`);
	const clock = setInterval(tick, 500);
	find('progress').hidden = false;
	tick();
	try {
		const reply = await call('/v1/label', {...to_send(), name});
		trouble(null);
		await refresh();
		if (label === now) set_mode(true);
		say('New: ' + name, {things: [{name}], is_said: true, called: {text: 'the ' + name},
			words: `It can be asked now; ${now.outline ? 'drawn round' : count(now.clicks, 'click')}, lifted in ${reply.seconds.toFixed(1)} s`});
	} catch (e) {
		trouble(e);
	} finally {
		clearInterval(clock);
		find('progress').hidden = true;
		now.saving = false;
		if (label) tell_label();
	}
}

// Things that have a name; those that were named here can be named anew, or forgotten.
function chip(thing) {
	const {name} = thing, e = make('span', {'data-name': name});
	// No mask is asked for of a name that is about to go.
	const change = async body => {
		if (lit.names.includes(name)) clear_masks([], false);
		await Promise.allSettled([...masks.values()]);
		await call('/v1/label', body);
		trouble(null);
		await refresh();
	};
	const rename = () => {
		const box = make('input', {value: name, 'aria-label': 'new name of ' + name, maxlength: 200});
		box.addEventListener('keydown', k => {
			if (k.key === 'Escape') put();
			if (k.key === 'Enter') change({name, rename: box.value.trim()}).catch(trouble);
		});
		box.addEventListener('blur', put);
		e.replaceChildren(box);
		box.select();
	};
	const remove = k => {
		if (k.target.is_sure) return change({remove: name}).catch(trouble);
		k.target.is_sure = true;
		k.target.textContent = 'remove?';
		k.target.addEventListener('blur', put);
	};
	function put() {
		e.replaceChildren(make('button', {title: count(thing.gaussians, 'Gaussian'), onclick: () => show([name], name).catch(trouble)}, name));
		if (!thing.labelled) return;
		e.append(make('button', {'aria-label': 'rename ' + name, title: 'rename', onclick: rename}, '✎'),
			make('button', {'aria-label': 'remove ' + name, title: 'remove', onclick: remove}, '×'));
	}
	put();
	return e;
}

// Not while things are named one after the other: splats take long to load.
function update_viewer() {
	if (!viewer || !is_stale || label) return;
	is_stale = false;
	viewer.change(scene);
}

function mark_chips() {
	for (const e of document.querySelectorAll('.things > span')) {
		e.classList.toggle('is-shown', lit.names.includes(e.dataset.name));
		e.classList.toggle('is-one', lit.names.join() === e.dataset.name);
	}
}

// What is there now; another page may have named something too.
async function refresh() {
	const before = scene, now = await call('/v1/things');
	scene = {...now, views: before ? before.views : now.views};
	if (before && before.revision === scene.revision) return;
	find('#mode').hidden = !can_name();
	find('.things').replaceChildren(...scene.things.map(chip));
	if (!scene.things.length)
		find('.things').append(make('p', {class: 'soft'}, can_name() ? 'Nothing has a name yet. Press Label, click a thing in the photograph, and say what it is.' : 'Nothing has a name here.'));
	masks.clear();
	if (!lit.names.every(name => scene.things.some(t => t.name === name))) clear_masks([], false);
	mark_chips();
	is_stale = true;
	update_viewer();
}

// Clicks on what is shown.

const is_near = (a, b) => Math.hypot(a.clientX - b.clientX, a.clientY - b.clientY) < DRAG;

function place_of(e) {
	const r = overlay.getBoundingClientRect(), to = (at, size) => Math.max(0, Math.min(size - 1, Math.floor(at * size)));
	return {view: view.name, x: to((e.clientX - r.left) / r.width, view.width), y: to((e.clientY - r.top) / r.height, view.height)};
}

function follow_photograph() {
	let down = null;
	overlay.addEventListener('pointerdown', e => {
		if (e.button !== 0) return;
		down = e;
		if (!label) return;
		label.by = e.pointerType;
		overlay.setPointerCapture(e.pointerId);
	});
	overlay.addEventListener('pointermove', e => {
		if (!down || !label || label.saving || !label.drawing && is_near(down, e)) return;
		const p = place_of(e);
		label.drawing ||= {view: view.name, points: [[place_of(down).x, place_of(down).y]]};
		label.drawing.points.push([p.x, p.y]);
		draw_large();
	});
	overlay.addEventListener('pointercancel', () => { down = null; if (label) label.drawing = null; });
	overlay.addEventListener('pointerup', e => {
		const from = down, drawn = label && label.drawing;
		down = null;
		if (!from) return;
		if (!label) return is_near(from, e) && pick(place_of(e), 'Pointed at in ' + view.name);
		label.drawing = null;
		const is_outside = e.shiftKey || e.altKey || find('[data-act=outside]').getAttribute('aria-pressed') === 'true';
		if (!drawn) return click(place_of(e), is_outside);
		const every = Math.ceil(drawn.points.length / 400), points = drawn.points.filter((_, k) => k % every === 0);
		mark(() => Object.assign(label, empty(), {outline: {view: drawn.view, points}}));
		focus_name();
	});
}

function start_viewer() {
	const section = find('#viewer'), stage = find('.stage'), files = {'./three.core.min.js': 'three.core.min.js', three: 'three.module.min.js', 'three/addons/postprocessing/Pass.js': 'Pass.js', orbit: 'OrbitControls.js', spark: 'spark.module.min.js'};
	const get = async path => {
		const reply = await fetch(path);
		if (!reply.ok) throw new Error(`the server answers ${reply.status} for ${path}`);
		return reply;
	};
	section.hidden = false;
	document.body.classList.add('has-viewer');
	is_stale = false;
	if (scene.camera.name) stage.style.backgroundImage = `url("${address({name: scene.camera.name})}")`;
	viewer = make_viewer(stage, scene, {
		splats: async () => (await get('/v1/splats')).arrayBuffer(),
		module: async name => (await get('/modules/' + files[name])).text(),
	});
	note_scene(section, scene);
	find('#home').addEventListener('click', viewer.home);
	for (const id of ['#box', '#dim']) find(id).addEventListener('input', () => viewer.set_look(find('#box').checked, find('#dim').checked));
	const canvas = find('canvas', stage);
	let down = null;
	canvas.addEventListener('pointerdown', e => { down = e; });
	canvas.addEventListener('pointerup', e => {
		const ray = down && e.button === 0 && is_near(down, e) && viewer.ray_at(e.clientX, e.clientY);
		down = null;
		if (ray) pick(ray, 'Pointed at in the scene');
	});
	if (innerWidth > 800) viewer.begin();
}

function keys(e) {
	const is_in_text = e.target.matches('input:not([type=checkbox]), select'), is_typing = is_in_text && e.target.value !== '';
	if (e.key === 'Escape' && label && !label.saving) return is_marked() ? set_mode(true) : set_mode(false);
	if (label && !is_typing && !label.saving) {
		const act = e.ctrlKey || e.metaKey ? {z: 'undo'}[e.key] : is_marked() && !label.outline && {'+': 'larger', '=': 'larger', '-': 'smaller'}[e.key];
		if (act) { e.preventDefault(); return acts[act](); }
	}
	if (label && is_marked() && !is_in_text && /^[^ +=-]$/.test(e.key)) return find('#label input').focus();
	if (is_in_text || e.ctrlKey || e.metaKey || e.altKey) return;
	if (e.key === '/') { e.preventDefault(); line.focus(); }
	if (e.key === 'l' && can_name()) { e.preventDefault(); set_mode(!label); }
}

const question_in = hash => hash.startsWith('#q=') ? new URLSearchParams(hash.slice(1)).get('q') : '';

async function start() {
	const token = /^#([0-9a-f]{32})$/.exec(location.hash);
	if (token) {
		if (kept.get('token') !== token[1]) kept.set('talk', []);
		kept.set('token', token[1]);
		history.replaceState(null, '', location.pathname);
	}
	if (!kept.get('conversation')) kept.set('conversation', crypto.randomUUID());
	await refresh();
	set_strip();
	find('#ask').addEventListener('submit', e => { e.preventDefault(); if (line.value.trim()) ask(line.value.trim()); });
	line.addEventListener('keydown', recall);
	find('#mode').addEventListener('click', () => set_mode(!label));
	find('#label').addEventListener('submit', e => { e.preventDefault(); save(); });
	find('#label').addEventListener('click', e => { if (label && acts[e.target.dataset.act]) acts[e.target.dataset.act](); });
	find('select', photo).addEventListener('input', e => set_view(scene.views.find(v => v.name === e.target.value)).catch(trouble));
	find('#nothing').addEventListener('click', () => show([]).catch(trouble));
	find('#forget').addEventListener('click', () => forget().catch(trouble));
	addEventListener('keydown', keys);
	addEventListener('hashchange', () => { if (question_in(location.hash)) ask(question_in(location.hash)); });
	addEventListener('focus', () => refresh().catch(trouble));
	new ResizeObserver(() => { draw_large(); for (const s of strip) draw_mask(s.canvas, lit.masks.get(s.view.name), 1.2); }).observe(frame);
	follow_photograph();
	await set_view(scene.views.find(v => v.name === scene.camera.name) || scene.views[0]);
	for (const [question, reply] of kept.get('talk') || []) talk.append(item(question, reply));
	find('#talk-end').hidden = !talk.children.length;
	if (scene.has_viewer) start_viewer();
	if (question_in(location.hash)) await ask(question_in(location.hash));
	else if (innerWidth > 800) line.focus({preventScroll: true});
}
start().catch(trouble);
