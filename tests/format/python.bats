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
	"$BIN/gs-synth" -q --objects 3 --views 5 --size 64x48 --gaussians 1000 -o .
	"$BIN/gs-import" -q -o scene point_cloud.ply
	"$BIN/gs-weigh" -q -o weights scene
	"$BIN/gs-weigh" -q --packed -o packed scene
	"$BIN/gs-weigh" -q --precision u8 -o u8 scene
	"$BIN/text-encode" -q --model "$ROOT/tests/golden/bert" -o text.safetensors sentences.jsonl
	"$BIN/feature-lift" -q --scene scene --weights weights --masks truth.jsonl -o features.safetensors
	"$BIN/refer-lift" -q --names masks --scene scene --weights weights --text text.safetensors --masks truth.jsonl -o lifted.safetensors
	"$BIN/refer-render" -q --scene scene --text text.safetensors --model lifted.safetensors --split all -o masks.jsonl
	"$BIN/refer-locate" -q --scene scene --text text.safetensors --model lifted.safetensors -o boxes.jsonl
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
	[ "$(cut -d: -f1 printed | sort -u | paste -sd' ')" = "box camera label lifted mask packed scene text weights" ]
}

@test "a scene and its cameras" {
	[[ $(said scene) == "$(counted gaussians scene) Gaussians, mean opacity 0."* ]]
	[ "$(said camera | wc -l)" = 5 ]
	[ "$(said camera | cut -d' ' -f1,2)" = "$(jq -r '.[] | "\(.name) \(.split)"' scene/cameras.json)" ]
	# most centres of what is on a table are in every picture
	said camera | awk '{ if ($3 < 300 || $3 > 1000) bad = 1 } END { exit bad || NR != 5 }'
}

@test "weights, packed ones too, as the tools blend them" {
	[ "$(said weights | cut -d' ' -f1)" = "$(counted weights weights/view_000.safetensors)" ]
	[ "$(said packed | cut -d' ' -f1)" = "$(counted weights u8/view_000.safetensors)" ]
	# U8 differs from F32 by at most a level a weight
	awk -v a="$(said weights | sed 's/.* //')" -v b="$(said packed | sed 's/.* //')" 'BEGIN { d = a - b; exit !(a > 0.05 && d < 0.02 && d > -0.02) }'
	# and as the tools unpack them
	cat >>program.py <<-'END'
		flat, size8 = read("u8/view_000.safetensors")
		order = np.lexsort((flat["index"], np.repeat(np.arange(len(flat["indptr"]) - 1), np.diff(flat["indptr"]))))
		same = (flat["indptr"] == w8["indptr"]).all() and (flat["index"][order] == w8["index"]).all() and (flat["weight"][order] == w8["weight"]).all()
		print("same:", bool(same), bool((blend(flat, size8, colours[:, 0]) - blend(w8, meta8, colours[:, 0])).max() < 1e-9))
	END
	"$PYTHON" program.py | grep -qx 'same: True True'
}

@test "sentences" {
	[[ $(said text) == "$(counted sentences text.safetensors) sentences, $(counted words text.safetensors) words; $(jq -r .ref sentences.jsonl | head -n 1) is most like "* ]]
}

@test "lifted objects: as many pixels as refer-render gives them" {
	"$BIN/refer-locate" -q --all --scene scene --model lifted.safetensors -o all.jsonl
	[ "$(said lifted | sed 's/ has .*//')" = "$(jq -r .object all.jsonl)" ]
	jq -c '{ref: .object, object, text: "the \(.object)", split: "test"}' all.jsonl >asked.jsonl
	"$BIN/text-encode" -q --model "$ROOT/tests/golden/bert" -o asked.safetensors asked.jsonl
	"$BIN/refer-render" -q --scene scene --text asked.safetensors --model lifted.safetensors --views view_000 -o asked.masks.jsonl
	"$BIN/mask-export" -o asked.json asked.masks.jsonl
	jq -r '.annotations[] | [.ref, .area] | @tsv' asked.json | sort >areas
	said lifted | sed 's/ has [0-9]* Gaussians and \([0-9]*\) pixels of view_000$/\t\1/' | sort | cmp - areas
	[ "$(awk -F '\t' '$2 > 20' areas | wc -l)" -ge 2 ]
}

@test "labels" {
	[ "$(said label | awk '{ n += $3 } END { print n }')" -le 1000 ]
	[ "$(said label | wc -l)" -ge 2 ]
}

@test "masks: decoded and encoded again" {
	[ "$(said mask | wc -l)" = "$(jq -s length masks.jsonl)" ]
	[ -z "$(said mask | grep -v ' True$')" ]
	"$BIN/mask-export" masks.jsonl | jq -r '.annotations[].area' >areas
	said mask | awk '{ print $(NF - 1) }' | cmp - areas
}

@test "boxes: the corners are around what refer-locate has along the axes" {
	[ "$(said box | wc -l)" = "$(jq -s 'map(select(.oriented)) | length' boxes.jsonl)" ]
	jq -r 'select(.oriented) | .oriented.size | .[0] * .[1] * .[2]' boxes.jsonl >volumes
	said box | sed 's/.*volume \([^ ]*\) .*/\1/' | paste - volumes | awk '{ d = $1 / $2 - 1; if (d > 1e-5 || d < -1e-5) bad = 1 } END { exit bad || !NR }'
}
