'use strict';
// The scene as splats, in a stage (a canvas, a hint and a button to start), unpacked and shown when it is first asked for.
async function inflate(bytes) {
	return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'))).arrayBuffer();
}

// Of what is shown, scene has all but the splats. source.splats() promises their planes, packed; source.module(name), the text of
// one of modules, which import each other by these names.
function make_viewer(stage, scene, source) {
	const canvas = stage.querySelector('canvas'), hint = stage.querySelector('.hint'), start = stage.querySelector('.start');
	const record = 32, modules = ['./three.core.min.js', 'three', 'three/addons/postprocessing/Pass.js', 'orbit', 'spark'];
	let three, lit = [], loading = null, words = '', is_dim = true, is_boxed = true;

	// Here each name is the address of a blob.
	async function load_modules() {
		const address = {}, loaded = {};
		for (const name of modules) {
			const linked = (await source.module(name)).replace(/(\bfrom\s*)(["'])([^"']+)\2/g, (all, from, quote, name) => address[name] ? `${from}"${address[name]}"` : all);
			address[name] = URL.createObjectURL(new Blob([linked], {type: 'text/javascript'}));
		}
		for (const name of ['three', 'spark', 'orbit']) loaded[name] = await import(address[name]);
		return {THREE: loaded.three, SPARK: loaded.spark, OrbitControls: loaded.orbit.OrbitControls};
	}

	// Plane by plane, as packed, to splat by splat.
	async function load_splats() {
		const planes = new Uint8Array(await inflate(await source.splats())), n = scene.count, bytes = new Uint8Array(record * n);
		for (let k = 0; k < record; k++)
			for (let i = 0; i < n; i++) bytes[record * i + k] = planes[k * n + i];
		return bytes;
	}

	function box_of(THREE, b) {
		const [x, y, z] = b.axes.map(a => new THREE.Vector3(...a));
		const lines = new THREE.LineSegments(new THREE.EdgesGeometry(new THREE.BoxGeometry(...b.half.map(h => 2 * h))),
			new THREE.LineBasicMaterial({color: 0x10c8ff, depthTest: false, transparent: true}));
		lines.applyMatrix4(new THREE.Matrix4().makeBasis(x, y, z).setPosition(...b.centre));
		lines.renderOrder = 10;
		lines.visible = false;
		return lines;
	}

	async function add_groups() {
		const {THREE, SPARK, world} = three, bytes = await load_splats(), groups = [];
		let at = 0;
		for (const g of scene.groups) {
			const mesh = g.count ? new SPARK.SplatMesh({fileBytes: bytes.slice(record * at, record * (at + g.count)), fileType: 'splat'}) : null;
			at += g.count;
			if (mesh) await mesh.initialized;
			groups.push({name: g.name, mesh, box: g.box ? box_of(THREE, g.box) : null, centre: g.box ? g.box.centre : null});
		}
		for (const g of three.groups) {
			world.remove(...[g.mesh, g.box].filter(Boolean));
			g.mesh?.dispose();
		}
		for (const g of groups) world.add(...[g.mesh, g.box].filter(Boolean));
		three.groups = groups;
		const view = new DataView(bytes.buffer);
		three.some = Array.from({length: Math.min(scene.count, 999)}, (_, k) => record * Math.floor(k * scene.count / 999))
			.map(i => [0, 4, 8].map(b => view.getFloat32(i + b, true)));
	}

	function make_scene({THREE, SPARK, OrbitControls}) {
		const renderer = new THREE.WebGLRenderer({canvas, antialias: false});
		const world = new THREE.Scene(), camera = new THREE.PerspectiveCamera(50, 1, .01, 1000);
		world.background = new THREE.Color(0x22252a);
		const spark = new SPARK.SparkRenderer({renderer});
		world.add(spark);
		camera.up.set(...scene.up);
		const controls = new OrbitControls(camera, canvas);
		controls.zoomSpeed = .6;
		controls.rotateSpeed = .5;
		three = {THREE, SPARK, renderer, spark, world, camera, controls, groups: [], until: 0, frames: 0};
	}

	// Frames are drawn while something moves, until the splats are sorted for it, however long that takes, and a few more. The
	// photograph stays until the first that are sorted.
	function wake() { three.until = performance.now() + 1500; }

	function is_sorted({spark}) {
		return spark.lastSortTime > 0 && !spark.sorting && !spark.sortDirty && (three.is_ready || spark.activeSplats > 0 || !scene.count);
	}

	function draw() {
		const {renderer, world, camera, controls} = three;
		if (controls.update()) wake();
		three.frames = is_sorted(three) ? three.frames + 1 : 0;
		if (performance.now() > three.until && three.frames > 4) return;
		renderer.render(world, camera);
		stage.dataset.frames = 1 + Number(stage.dataset.frames || 0);
		if (three.is_ready || three.frames < 3) return;
		three.is_ready = true;
		stage.classList.add('is-on');
		tell();
	}

	function tell() {
		hint.textContent = !three.is_ready ? 'Sorting the scene …' :
			words || 'Drag to turn, scroll or pinch to come nearer, right button or two fingers to move.';
	}

	function resize() {
		const {renderer, camera} = three, w = stage.clientWidth, h = stage.clientHeight, from = scene.camera;
		renderer.setPixelRatio(Math.min(window.devicePixelRatio, 1.5));
		renderer.setSize(w, h, false);
		camera.aspect = w / h;
		const tan = Math.max(from.tan_y || .5, (from.tan_x || .5) * h / w);
		camera.fov = 360 / Math.PI * Math.atan(tan);
		camera.updateProjectionMatrix();
		wake();
	}

	// Looks as the first view's camera did, as far as the things are, or, where there are none yet, the splats.
	function home() {
		const {THREE, camera, controls, groups} = three, from = scene.camera;
		if (!from.centre) return;
		const centre = new THREE.Vector3(...from.centre), forward = new THREE.Vector3(...from.forward);
		const places = groups.some(g => g.centre) ? groups.filter(g => g.centre).map(g => g.centre) : three.some;
		const depths = places.map(p => new THREE.Vector3(...p).sub(centre).dot(forward)).filter(d => d > 0).sort((a, b) => a - b);
		const depth = depths.length ? depths[depths.length >> 1] : 3;
		camera.near = depth / 500;
		camera.far = depth * 200;
		camera.updateProjectionMatrix();
		camera.position.copy(centre);
		controls.target.copy(centre).addScaledVector(forward, depth);
		controls.update();
		wake();
	}

	function light() {
		for (const g of three.groups) {
			const is_lit = g.name !== undefined && lit.includes(g.name);
			if (g.mesh) {
				if (is_lit) g.mesh.recolor.setRGB(1.5, .75, .5);
				else g.mesh.recolor.setScalar(is_dim && lit.length ? .45 : 1);
				g.mesh.needsUpdate = true;
			}
			if (g.box) g.box.visible = is_lit && is_boxed;
		}
		tell();
		wake();
	}

	async function load() {
		start.hidden = true;
		hint.textContent = 'Unpacking the scene …';
		await new Promise(done => setTimeout(done, 30));
		make_scene(await load_modules());
		await add_groups();
		resize();
		home();
		light();
		new ResizeObserver(resize).observe(stage);
		three.controls.addEventListener('change', wake);
		three.renderer.setAnimationLoop(draw);
	}

	function begin() {
		loading ||= load().catch(e => { hint.textContent = 'The scene cannot be shown here: ' + e.message; three = null; });
		return loading;
	}

	async function show(names, text, may_begin = true) {
		lit = names;
		words = text;
		if (may_begin || loading) await begin();
		if (three) light();
	}

	function set_look(with_box, with_dim) {
		is_boxed = with_box;
		is_dim = with_dim;
		if (three) light();
	}

	// Other groups, once those of before are there, seen from where one looks now.
	function change(to) {
		scene = to;
		if (loading) loading = loading.then(() => three && add_groups().then(light)).catch(e => { hint.textContent = 'The scene is as it was before: ' + e.message; });
		return loading;
	}

	// The ray under a place of the window.
	function ray_at(x, y) {
		if (!three) return null;
		const {THREE, camera} = three, r = canvas.getBoundingClientRect(), caster = new THREE.Raycaster();
		caster.setFromCamera(new THREE.Vector2(2 * (x - r.left) / r.width - 1, 1 - 2 * (y - r.top) / r.height), camera);
		return {origin: caster.ray.origin.toArray(), direction: caster.ray.direction.toArray()};
	}

	start.addEventListener('click', begin);
	return {begin, show, set_look, change, ray_at, home: () => three && home()};
}

// In a report everything is in the page. window.scene_viewer.show(sentence) lights up what a sentence of the page means.
if (document.getElementById('scene')) window.scene_viewer = (() => {
	const scene = JSON.parse(document.getElementById('scene').textContent), section = document.getElementById('viewer');
	const chosen = section.querySelector('select'), stage = section.querySelector('.stage'), dim = section.querySelector('#dim'), box = section.querySelector('#box');

	function take(element) {
		const bytes = Uint8Array.from(atob(element.textContent), c => c.charCodeAt(0));
		element.textContent = '';
		return bytes;
	}

	const viewer = make_viewer(stage, scene, {
		splats: async () => take(document.getElementById('splats')),
		module: async name => new TextDecoder().decode(await inflate(take(document.querySelector(`script[data-module="${name}"]`)))),
	});

	async function show(sentence) {
		for (const card of document.querySelectorAll('.card')) card.classList.toggle('is-shown', card.dataset.ref === sentence.ref);
		section.scrollIntoView({behavior: 'smooth'});
		chosen.value = sentence.answer.length === 1 ? sentence.answer[0] : '';
		await viewer.show(sentence.answer, `“${sentence.text}”: ${sentence.answer.join(', ')}`);
	}

	section.hidden = false;
	stage.classList.add('view-0');
	chosen.append(new Option('everything', ''), ...scene.groups.slice(1).map(g => new Option(g.name, g.name)));
	chosen.addEventListener('input', () => viewer.show(chosen.value ? [chosen.value] : [], chosen.value));
	section.querySelector('#home').addEventListener('click', viewer.home);
	for (const e of [box, dim]) e.addEventListener('input', () => viewer.set_look(box.checked, dim.checked));
	note_scene(section, scene);
	return {show};
})();

// What of the scene is shown, and by whose work.
function note_scene(section, scene) {
	section.querySelector('#viewer-note').textContent = `${scene.count.toLocaleString('en')} of ${scene.all.toLocaleString('en')} Gaussians are here. ` +
		`Those of an opacity below ${scene.least_opacity} are left out${scene.count === scene.most ? ', and those that cover least' : ''}; ` +
		'colours do not change with the direction. ' +
		'Drawn by Spark and three.js.';
	const licences = document.createElement('details'), title = document.createElement('summary');
	title.textContent = 'Their licences';
	licences.append(title, ...scene.licences.map(text => {
		const e = document.createElement('pre');
		e.textContent = text;
		return e;
	}));
	section.append(licences);
}
