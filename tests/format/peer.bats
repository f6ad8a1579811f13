#!/usr/bin/env bats
# What splat-transform (npm, @playcanvas/splat-transform, MIT) makes of a scene, read here, and what is written here, read there: the same within what
# the formats keep. Only where it is: SPLAT_TRANSFORM=FILE names its cli.mjs, or splat-transform is on the path.

setup() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	load files
	cd "$BATS_TEST_TMPDIR"
	if [ -n "${SPLAT_TRANSFORM:-}" ]; then
		peer() { node "$SPLAT_TRANSFORM" -q -w "$@"; }
	elif command -v splat-transform >/dev/null; then
		peer() { splat-transform -q -w "$@"; }
	else
		skip "splat-transform is not here"
	fi
	"$BIN/gs-synth" -q --objects 3 --views 5 --size 32x24 --gaussians 1000 -o made
	cp made/point_cloud.ply s.ply
}

# largest A B COLUMNS: the largest difference of these columns of two CSV files that splat-transform wrote; Gaussians are compared with the
# nearest or, where `order` is set, with those of the same place.
largest() {
	node -e '
		const fs = require("fs");
		const read = (file) => {
			const [head, ...rows] = fs.readFileSync(file, "utf8").trim().split("\n").map((line) => line.split(","));
			return rows.map((row) => Object.fromEntries(head.map((name, i) => [name.trim(), Number(row[i])])));
		};
		const [a, b] = process.argv.slice(1, 3).map(read), names = process.argv[3].split(" ");
		const far = (p, q) => Math.hypot(p.x - q.x, p.y - q.y, p.z - q.z);
		const turned = (p, q) => {
			const of = (g) => [0, 1, 2, 3].map((k) => g["rot_" + k]), length = (v) => Math.hypot(...v);
			const [v, w] = [of(p), of(q)];
			return 2 * Math.acos(Math.min(1, Math.abs(v.reduce((s, x, k) => s + x * w[k], 0)) / length(v) / length(w)));
		};
		// An .spz has no scale below exp(-10).
		const value = (g, name) => name.startsWith("scale") ? Math.max(-10, g[name]) : g[name];
		const opacity = (g) => 1 / (1 + Math.exp(-g.opacity));
		let most = a.length === b.length ? 0 : Infinity;
		for (const [i, p] of a.entries()) {
			const q = process.argv[4] ? b[i] : b.reduce((best, one) => far(p, one) < far(p, best) ? one : best);
			for (const name of names)
				most = Math.max(most, name === "turn" ? turned(p, q) : name === "opacity" ? Math.abs(opacity(p) - opacity(q)) : Math.abs(value(p, name) - value(q, name)));
		}
		console.log(most);
	' "$1" "$2" "$3" "${order:-}"
}

# within A B MEANS SCALES TURN OPACITY COLOUR: no difference is above these.
within() {
	peer "$1" a.csv
	peer "$2" b.csv
	local names=('x y z' 'scale_0 scale_1 scale_2' turn opacity 'f_dc_0 f_dc_1 f_dc_2') i most
	for i in 0 1 2 3 4; do
		most=$(largest a.csv b.csv "${names[i]}")
		awk -v a="$most" -v b="${*:3+i:1}" 'BEGIN { exit !(a <= b) }' || { echo "${names[i]}: $most"; return 1; }
	done
}

@test "its .spz, read here" {
	for v in 3 4; do
		peer --spz-version $v s.ply s.spz
		"$BIN/gs-transform" -o out.ply s.spz
		# as it reads it itself
		within out.ply s.spz 1e-6 1e-5 1e-3 1e-5 1e-5
		# and as it was
		order=same within out.ply s.ply 0.00013 0.03126 0.004 0.002 0.0131
	done
}

@test "our .spz, read there" {
	for v in 2 3 4; do
		"$BIN/gs-transform" --spz-version $v -o s.spz s.ply
		"$BIN/gs-transform" -o out.ply s.spz
		within out.ply s.spz 1e-6 1e-5 1e-3 1e-5 1e-5
	done
}

@test "its SOG, read here" {
	peer -g cpu s.ply s.sog
	"$BIN/gs-transform" -o out.ply s.sog
	within out.ply s.sog 1e-5 1e-5 1e-3 2e-6 1e-5
}

@test "our SOG, read there, and as near to the scene as its own" {
	"$BIN/gs-transform" -o our.sog s.ply
	"$BIN/gs-transform" -o out.ply our.sog
	within out.ply our.sog 1e-5 1e-5 1e-3 2e-6 1e-5
	# means of 16 bits; codes as near as 256 can be
	within our.sog s.ply 2.3e-4 0.05 0.02 0.0021 0.02
	peer -g cpu s.ply its.sog
	for names in 'scale_0 scale_1 scale_2' 'f_dc_0 f_dc_1 f_dc_2'; do
		peer its.sog b.csv
		peer s.ply a.csv
		theirs=$(largest a.csv b.csv "$names")
		peer our.sog b.csv
		awk -v ours="$(largest a.csv b.csv "$names")" -v theirs="$theirs" 'BEGIN { exit !(ours <= 1.5 * theirs) }' || { echo "$names: $theirs"; false; }
	done
}

@test "its .glb, read here" {
	peer s.ply s.glb
	"$BIN/gs-transform" -o out.ply s.glb
	order=same
	within out.ply s.ply 1e-6 1e-5 1e-3 1e-6 1e-6
	rest=$(head -n 1 a.csv | tr , '\n' | grep f_rest | tr '\n' ' ')
	[ -n "$rest" ]
	awk -v a="$(largest a.csv b.csv "${rest% }")" 'BEGIN { exit !(a < 1e-6) }'
}

# It writes .glb and does not read it: ours is compared with its own, attribute by attribute.
@test "our .glb has the numbers of its own" {
	peer s.ply its.glb
	"$BIN/gs-transform" -o our.glb s.ply
	node -e '
		const fs = require("fs");
		const read = (file) => {
			const bytes = fs.readFileSync(file), length = bytes.readUInt32LE(12);
			const json = JSON.parse(bytes.toString("utf8", 20, 20 + length)), bin = 20 + length + 8;
			const primitive = json.meshes[0].primitives[0];
			return { extension: primitive.extensions.KHR_gaussian_splatting, mode: primitive.mode, of: (name) => {
				const a = json.accessors[primitive.attributes[name]], v = json.bufferViews[a.bufferView];
				const from = bin + v.byteOffset + (a.byteOffset || 0), values = [];
				for (let k = 0; k < a.count * { SCALAR: 1, VEC3: 3, VEC4: 4 }[a.type]; k++)
					values.push(bytes.readFloatLE(from + 4 * k));
				return values;
			}, names: Object.keys(primitive.attributes).filter((name) => name !== "COLOR_0").sort() };
		};
		const [a, b] = ["its.glb", "our.glb"].map(read), assert = require("assert");
		assert.deepStrictEqual([a.extension, a.mode, a.names], [b.extension, b.mode, b.names]);
		for (const name of a.names) {
			const [x, y] = [a.of(name), b.of(name)];
			assert.strictEqual(x.length, y.length);
			// a rotation q is -q too
			const same = name.endsWith("ROTATION") ? (k) => {
				const [p, q] = [x, y].map((v) => v.slice(k - k % 4, k - k % 4 + 4));
				return Math.abs(Math.abs(p.reduce((s, v, i) => s + v * q[i], 0)) - 1) < 1e-6;
			} : (k) => Math.abs(x[k] - y[k]) <= 1e-6 * (1 + Math.abs(x[k]));
			x.forEach((_, k) => assert(same(k), `${name} ${k}: ${x[k]} ${y[k]}`));
		}
	'
}

@test "our .splat, read there" {
	"$BIN/gs-transform" -o s.splat s.ply
	"$BIN/gs-transform" -o out.ply s.splat
	# it takes a rotation's byte for another number: 2 v / 255 - 1
	within out.ply s.splat 1e-6 1e-5 0.03 1e-5 1e-5
}

@test "a rotated scene: harmonics as it turns them" {
	# its axes are those of a .ply with x and y turned round
	"$BIN/gs-transform" --rotate 0,1,0:-90 -o out.ply s.ply
	peer s.ply -r 0,90,0 turned.ply
	order=same
	within out.ply turned.ply 1e-5 1e-5 1e-3 1e-6 1e-5
	peer out.ply a.csv
	peer turned.ply b.csv
	rest=$(head -n 1 a.csv | tr , '\n' | grep f_rest | tr '\n' ' ')
	[ -n "$rest" ]
	awk -v a="$(largest a.csv b.csv "${rest% }")" 'BEGIN { exit !(a < 1e-4) }'
}
