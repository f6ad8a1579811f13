#!/usr/bin/env bats
# Each rule of formats/splats/sog.md broken once, in a copy of tests/golden/sog. What it means, and zips, are in tests/unit/test_sog.c.

setup() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	load files
	load foreign
	cp -r "$BATS_TEST_DIRNAME/../golden/sog" "$BATS_TEST_TMPDIR/s"
	cd "$BATS_TEST_TMPDIR"
	colmap model
	cp s/meta.json good.json
}

import() { "$BIN/gs-import" --cameras model -o scene "$@"; }

# refused EDIT REASON: the folder with this edit of its meta.json is.
refused() {
	jq -c "$1" good.json >s/meta.json
	says 3 "gs-import: s: $2" import s/meta.json && [ ! -e scene ]
}

@test "a folder, and its meta.json" {
	import s
	cp scene/splats.safetensors first
	import s/meta.json
	cmp first scene/splats.safetensors
	says 0 "s/meta.json: ok: sog, 8 gaussians, 4 harmonics" "$BIN/gs-check" s/meta.json
	says 0 "scene: ok: scene, 40x30, 8 gaussians, 4 harmonics, 3 training views, 0 test views, scene $(
		grep -ao '"scene":"[0-9a-f]*"' first | cut -d'"' -f4)" "$BIN/gs-check" scene
}

@test "without harmonics: degree 0" {
	jq 'del(.shN)' good.json >s/meta.json
	import s
	"$BIN/gs-check" scene | grep -q ' 8 gaussians, 1 harmonics'
}

@test "meta.json" {
	refused 'del(.version)' "meta.json: version 1 of SOG, expected version 2"
	refused '.version = 3' "meta.json: another version of SOG, expected version 2"
	refused '.antialias = true' \
		"meta.json: trained for another way of rendering ('antialias'), which would be wrong here: train it without that mode"
	for count in 7.5 -1 1e12; do
		refused ".count = $count" "meta.json: key 'count' is not a whole number from 0 to 4294967295"
	done
	refused '.count = 4e9' "4000000000 Gaussians do not fit $(wc -c <s/means_l.webp) packed bytes of means"
	refused '.count = 17' "image 'means_l.webp' has 4x4 pixels for 17 values"
	refused '.scales.codebook = []' "meta.json: 'scales': key 'codebook' is not a list of 1 to 256 numbers"
	refused '.sh0.codebook[3] = "a"' "meta.json: 'sh0': codebook[3] is not a number"
	refused '.quats.files = []' "meta.json: 'quats': key 'files' has no name 0"
	refused '.quats.files = ["../quats.webp"]' "'../quats.webp' is not the name of a file beside meta.json"
	echo '{' >s/meta.json
	says 3 "gs-import: s: not JSON at offset 2" import s
}

@test "harmonics" {
	refused '.shN.bands = 4' "meta.json: 'shN': 4 bands, expected 1 to 3"
	refused '.shN.bands = 2' "meta.json: 'shN': 192 pixels a row of the palette, expected 512"
	refused '.shN.count = 0' "meta.json: 'shN': a palette of 0, expected 1 to 65536"
	jq -c '.shN.count = 1' good.json >s/meta.json
	status=0
	import s 2>err || status=$?
	[ $status = 3 ]
	grep -qxE "gs-import: s: Gaussian [0-7]: label [1-7] of a palette of 1" err
}

@test "images" {
	refused '.sh0.files = ["meta.json"]' "file 'meta.json' is not a WebP image"
	jq -c '.quats.files = ["sh0.webp"]' good.json >s/meta.json
	not import s 2>err
	grep -qE "the rotation's last byte is [0-9]+, expected 252 to 255" err
	cp good.json s/meta.json
	truncate -s 60 s/means_l.webp
	says 3 "gs-import: s: image 'means_l.webp' is damaged" import s
	rm s/means_l.webp
	says 4 "gs-import: s/means_l.webp: No such file or directory" import s
}

@test "a zip that is none" {
	printf 'PK\3\4abc' >a.sog
	says 3 "gs-import: a.sog: not a zip, or its end is missing" import a.sog
	echo abc >b.sog
	says 3 "gs-import: b.sog: not a zip, or its end is missing" import b.sog
}

# Fails where the command succeeds.
not() { ! "$@"; }

@test "what is written is read: few Gaussians are as they were, but for means, rotations and opacities" {
	local golden=$BATS_TEST_DIRNAME/../golden/sog
	"$BIN/gs-transform" -o out.sog "$golden/eight.ply"
	says 0 "out.sog: ok: sog, 8 gaussians, 4 harmonics" "$BIN/gs-check" out.sog
	"$BIN/gs-transform" --format sog -o - - <"$golden/eight.ply" | cmp - out.sog
	"$BIN/gs-transform" -o out.ply out.sog
	# a line of numbers for each Gaussian, sorted by x; of means a step is 3e-5 of their size
	numbers() {
		"$BIN/gs-transform" --format ply -o - "$1" | LC_ALL=C sed '1,/^end_header/d' | od -An -v -w104 -tf4 | sort -g
	}
	paste -d ' ' <(numbers "$golden/eight.ply") <(numbers out.sog) | awk '{
		for (k = 1; k <= 26; k++) {
			d = $k - $(k + 26)
			# x y z, and opacity as its logit; rotations are compared elsewhere
			most = k <= 3 ? 3e-4 : k == 19 ? 0.2 : k > 22 ? 9 : 1e-6
			if (d > most || d < -most) { print k, $k, $(k + 26); bad = 1 }
		}
	} END { exit bad || NR != 8 }'
	if command -v unzip >/dev/null; then unzip -tqq out.sog; fi
	rm -rf opened && mkdir opened
	if command -v python3 >/dev/null; then
		python3 -m zipfile -e out.sog opened
		[ "$(ls opened | tr '\n' ' ')" = "means_l.webp means_u.webp meta.json quats.webp scales.webp sh0.webp shN_centroids.webp shN_labels.webp " ]
		"$BIN/gs-transform" -o opened.ply opened/meta.json
		cmp opened.ply out.ply
	fi
}

@test "no Gaussians, and no harmonics" {
	load foreign
	splats_ply one.ply '0 0 2 1 0.5 0 0 -3 -3 -3 1 0 0 0'
	"$BIN/gs-transform" --crop 9,9,9,10,10,10 -o none.sog one.ply
	says 0 "none.sog: ok: sog, 0 gaussians, 1 harmonics" "$BIN/gs-check" none.sog
	"$BIN/gs-transform" -o one.sog one.ply
	says 0 "one.sog: ok: sog, 1 gaussians, 1 harmonics" "$BIN/gs-check" one.sog
}
