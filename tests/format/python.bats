#!/usr/bin/env bats
# The program of formats/python.md, with Debian's python3 and its NumPy, on a small scene: what it prints is what the tools say.

setup_file() {
	export ROOT=$BATS_TEST_DIRNAME/../..
	BIN=${BIN:-$ROOT/build/bin}
	export BIN=$(cd "$BIN" && pwd)
	export PYTHON=/usr/bin/python3
	"$PYTHON" -c 'import numpy' 2>/dev/null || PYTHON=$(type -P python3 || true)
	[ -n "$PYTHON" ] && "$PYTHON" -c 'import numpy' 2>/dev/null || return 0
	cd "$BATS_FILE_TMPDIR"
	"$BIN/gs-synth" -q --objects 3 --views 5 --size 64x48 --gaussians 1000 -o data
	make -s -f "$ROOT/pipelines/lift.mk" SCENE=work/kitchen SPLATS=data/point_cloud.ply CAMERAS=data/sparse/0 SENTENCES=data/sentences.jsonl \
		CANDIDATES=data/candidates.jsonl TEST_VIEWS=view_004 SCALE=1 WEIGH=--packed LIFT="--names masks" BERT="$ROOT/tests/golden/bert" BIN="$BIN" >log 2>&1
	sed -n 's/^    //p' "$ROOT/formats/python.md" | sed -n '/^feature-lift/,/[^\\]$/p' >commands
	PATH=$BIN:$PATH sh -eu commands
	"$BIN/gs-weigh" -q --scale 1 --precision u8 -o u8 work/kitchen/scene
	awk '/^```python$/ { on = 1; next } /^```$/ { on = 0; print "" } on' "$ROOT/formats/python.md" >program.py
	"$PYTHON" program.py >printed 2>&1 || { cat printed; false; }
}

setup() {
	[ -e "$BATS_FILE_TMPDIR/program.py" ] || skip "python3 with NumPy is not here"
	cd "$BATS_FILE_TMPDIR"
}

# said WORD: the lines of the program that begin so, without it.
said() { sed -n "s/^$1: //p" printed; }

# counted KEY FILE...: that count of what gs-check says.
counted() { "$BIN/gs-check" "${@:2}" | sed -n "s/.*[ ,]\([0-9]*\) $1.*/\1/p"; }

@test "the page has a block for each kind of file" {
	[ "$(grep -c '^```python$' "$ROOT/formats/python.md")" = 10 ]
	[ "$(cut -d: -f1 printed | sort -u | paste -sd' ')" = "box camera label lifted mask scene text weights" ]
}

@test "a scene and its cameras" {
	[[ $(said scene) == "$(counted gaussians work/kitchen/scene) Gaussians, mean opacity 0."* ]]
	[ "$(said camera | wc -l)" = 5 ]
	[ "$(said camera | cut -d' ' -f1,2)" = "$(jq -r '.[] | "\(.name) \(.split)"' work/kitchen/scene/cameras.json)" ]
	# most centres of what is on a table are in every picture
	said camera | awk '{ if ($3 < 300 || $3 > 1000) bad = 1 } END { exit bad || NR != 5 }'
}

@test "weights, which are packed, as the tools blend and unpack them" {
	[ "$(said weights | cut -d' ' -f1)" = "$(counted weights u8/view_000.safetensors)" ]
	cat >>program.py <<-'END'
		packed, size = read_weights("view_000")
		flat, size8 = read("u8/view_000.safetensors")
		order = np.lexsort((flat["index"], np.repeat(np.arange(len(flat["indptr"]) - 1), np.diff(flat["indptr"]))))
		same = (flat["indptr"] == packed["indptr"]).all() and (flat["index"][order] == packed["index"]).all() and (flat["weight"][order] == packed["weight"]).all()
		print("same:", bool(same), bool((blend(flat, size8, colours[:, 0]) - blend(packed, size, colours[:, 0])).max() < 1e-9))
	END
	"$PYTHON" program.py | grep -qx 'same: True True'
}

@test "sentences" {
	[[ $(said text) == "$(counted sentences work/kitchen/text.safetensors) sentences, $(counted words work/kitchen/text.safetensors) words; $(jq -r .ref data/sentences.jsonl | head -n 1) is most like "* ]]
}

@test "lifted objects: as many pixels as refer-render gives them" {
	"$BIN/refer-locate" -q --all --scene work/kitchen/scene --model work/kitchen/lifted/model.safetensors -o all.jsonl
	[ "$(said lifted | sed 's/ has .*//')" = "$(jq -r .object all.jsonl)" ]
	jq -c '{ref: .object, object, text: "the \(.object)", split: "test"}' all.jsonl >asked.jsonl
	"$BIN/text-encode" -q --model "$ROOT/tests/golden/bert" -o asked.safetensors asked.jsonl
	"$BIN/refer-render" -q --scene work/kitchen/scene --text asked.safetensors --model work/kitchen/lifted/model.safetensors --views view_000 -o asked.masks.jsonl
	"$BIN/mask-export" -o asked.json asked.masks.jsonl
	jq -r '.annotations[] | [.ref, .area] | @tsv' asked.json | sort >areas
	# with weights that nothing was rounded in
	"$BIN/gs-weigh" -q -o f32 work/kitchen/scene
	sed 's,^w\, size = .*,w\, size = read("f32/view_000.safetensors"),' program.py >exact.py
	"$PYTHON" exact.py | sed -n "s/^lifted: //p" | sed 's/ has [0-9]* Gaussians and \([0-9]*\) pixels of view_000$/\t\1/' | sort | cmp - areas
	[ "$(awk -F '\t' '$2 > 20' areas | wc -l)" -ge 2 ]
}

@test "labels" {
	[ "$(said label | awk '{ n += $3 } END { print n }')" -le 1000 ]
	[ "$(said label | wc -l)" -ge 2 ]
}

@test "masks: decoded and encoded again" {
	[ "$(said mask | wc -l)" = "$(jq -s length work/kitchen/lifted/masks.jsonl)" ]
	[ -z "$(said mask | grep -v ' True$')" ]
	"$BIN/mask-export" work/kitchen/lifted/masks.jsonl | jq -r '.annotations[].area' >areas
	said mask | awk '{ print $(NF - 1) }' | cmp - areas
}

@test "boxes: the corners are around what refer-locate has along the axes" {
	[ "$(said box | wc -l)" = "$(jq -s 'map(select(.oriented)) | length' work/kitchen/lifted/boxes.jsonl)" ]
	jq -r 'select(.oriented) | .oriented.size | .[0] * .[1] * .[2]' work/kitchen/lifted/boxes.jsonl >volumes
	said box | sed 's/.*volume \([^ ]*\) .*/\1/' | paste - volumes | awk '{ d = $1 / $2 - 1; if (d > 1e-5 || d < -1e-5) bad = 1 } END { exit bad || !NR }'
}
