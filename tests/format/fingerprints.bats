#!/usr/bin/env bats
# Files of different scenes, cameras and encoders are not mixed, whatever their counts: formats/arrays/safetensors.md, "Fingerprints".

setup_file() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	export OMP_WAIT_POLICY=passive
	"$BATS_TEST_DIRNAME/../cli/examples-setup.sh" "$BATS_FILE_TMPDIR" "$BIN"
	cd "$BATS_FILE_TMPDIR"
	"$BIN/refer-lift" -q --scene scene --weights weights --text text.safetensors --masks masks.jsonl -o lifted.safetensors
	# The same Gaussians, the first two exchanged.
	local header row
	header=$(LC_ALL=C awk '{ n += length($0) + 1 } /^end_header/ { print n; exit }' point_cloud.ply)
	row=$((($(wc -c <point_cloud.ply) - header) / $(LC_ALL=C sed -n 's/^element vertex //p;/^end_header/q' point_cloud.ply)))
	{
		head -c "$header" point_cloud.ply
		tail -c +$((header + row + 1)) point_cloud.ply | head -c "$row"
		tail -c +$((header + 1)) point_cloud.ply | head -c "$row"
		tail -c +$((header + 2 * row + 1)) point_cloud.ply
	} >exchanged.ply
	"$BIN/gs-import" -q --cameras sparse/0 --images images --test-views "$(cat test-views)" -o exchanged exchanged.ply
	# Encoders of the same width that differ in one weight, in one word that no sentence has, or in how words are taken.
	cp -r encoder weight && chmod u+w weight/* && printf '\x01' |
		dd of=weight/model.safetensors bs=1 seek=$(($(wc -c <encoder/model.safetensors) - 1)) conv=notrunc 2>/dev/null
	"$BIN/text-encode" --model weight -o weight.safetensors sentences.jsonl
	cp -r encoder word && chmod u+w word/* && rm word/tokenizer.json
}

setup() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	load files
	export OMP_WAIT_POLICY=passive
	cp -r "$BATS_FILE_TMPDIR/." "$BATS_TEST_TMPDIR"
	cd "$BATS_TEST_TMPDIR"
	mkdir out
}

# meta FILE KEY
meta() {
	head -c $((8 + $(od -An -t d8 -N 8 "$1"))) "$1" | tail -c +9 | jq -r ".__metadata__[\"$2\"]"
}

# refuses MESSAGE COMMAND...: exit 3 with this line, and nothing in the folder out.
refuses() {
	local message=$1
	shift
	says 3 "$1: $message" "$BIN/$1" "${@:2}" && [ -z "$(ls -A out)" ]
}

# forgets FILE...: as a program before fingerprints would have written the file.
forgets() {
	LC_ALL=C sed -i 's/"scene":"/"scenX":"/; s/"encoder":"/"encodeX":"/; s/"camera":"/"camerX":"/' "$@"
}

# Fails where the command succeeds; a plain ! would let the test go on.
not() { ! "$@"; }

first_view() { head -n 1 masks.jsonl | jq -r .view; }

@test "weights of the same Gaussians in another order are refused by all that read weights" {
	local view mine other
	view=weights/$(jq -r '[.[] | select(.split == "train")][0].name' scene/cameras.json).safetensors
	mine=$(meta "$view" scene)
	other=$(meta exchanged/splats.safetensors scene)
	[ "$mine" != "$other" ]
	refuses "$view: is of another scene than exchanged ($mine, not $other)" \
		pseudomask-select -q --scene exchanged --weights weights -o out/masks candidates.jsonl
	view=weights/$(first_view).safetensors
	refuses "$view: is of another scene than exchanged ($mine, not $other)" \
		refer-train -q --scene exchanged --weights weights --text text.safetensors --masks masks.jsonl --iterations 2 -o out/model
	"$BIN/refer-lift" -q --scene exchanged --weights weights --text text.safetensors --masks masks.jsonl -o out/model >line 2>&1 &&
		false
	grep -qx "refer-lift: weights/.*: is of another scene than exchanged ($mine, not $other)" line
	[ "$(wc -l <line)" = 1 ]
}

@test "weights of another camera are refused, at whatever size" {
	local view change
	view=$(first_view)
	for change in '.fx += 0.25' '.cy += 1' '.world_to_camera[2][3] += 0.001'; do
		jq "map(if .name == \"$view\" then $change else . end)" "$BATS_FILE_TMPDIR/scene/cameras.json" >scene/cameras.json
		"$BIN/refer-train" -q --scene scene --weights weights --text text.safetensors --masks masks.jsonl --iterations 2 \
			-o out/model >line 2>&1 && false
		grep -qE "^refer-train: weights/$view.safetensors: is of another camera than scene/cameras.json \([0-9a-f]{16}, not [0-9a-f]{16}\)$" line
		[ -z "$(ls -A out)" ]
	done
	# what is not of the camera does not matter; nor does the scale
	jq 'map(.image = null)' "$BATS_FILE_TMPDIR/scene/cameras.json" >scene/cameras.json
	rm -r weights
	"$BIN/gs-weigh" -q --scale 0.37 -o weights scene
	"$BIN/refer-train" -q --scene scene --weights weights --text text.safetensors --masks masks.jsonl --iterations 2 -o out/model
}

@test "a model of another scene is refused" {
	local model mine other
	mine=$(meta scene/splats.safetensors scene)
	other=$(meta exchanged/splats.safetensors scene)
	for model in model.safetensors lifted.safetensors; do
		[ "$(meta $model scene)" = "$mine" ]
		for tool in refer-render refer-locate; do
			refuses "$model: is of another scene than exchanged ($mine, not $other)" \
				$tool --scene exchanged --text text.safetensors --model $model -o out/answer
		done
	done
	"$BIN/gs-weigh" -q -o weights2 exchanged
	refuses "lifted.safetensors: is of another scene than exchanged ($mine, not $other)" \
		refer-train -q --scene exchanged --weights weights2 --text text.safetensors --masks masks.jsonl --iterations 2 \
		--init lifted.safetensors -o out/model
}

@test "a text of another encoder is refused" {
	local model mine other
	mine=$(meta text.safetensors encoder)
	other=$(meta weight.safetensors encoder)
	[ "$mine" != "$other" ]
	for model in model.safetensors lifted.safetensors; do
		[ "$(meta $model encoder)" = "$mine" ]
		for tool in refer-render refer-locate; do
			refuses "weight.safetensors: is of another encoder than $model ($other, not $mine)" \
				$tool --scene scene --text weight.safetensors --model $model -o out/answer
		done
	done
}

@test "an encoder is its weights, its vocabulary and how words are taken; not its folder or its sentences" {
	local mine
	mine=$(meta text.safetensors encoder)
	"$BIN/text-encode" --model encoder --words static -o static.safetensors sentences.jsonl
	[ "$(meta static.safetensors encoder)" != "$mine" ]
	"$BIN/text-encode" --model word -o word.safetensors sentences.jsonl # vocab.txt in place of tokenizer.json
	[ "$(meta word.safetensors encoder)" = "$mine" ]
	sed -i '$s/.*/zyzzyva/' word/vocab.txt
	"$BIN/text-encode" --model word -o word.safetensors sentences.jsonl
	[ "$(meta word.safetensors encoder)" != "$mine" ]
	cp -r encoder elsewhere
	head -n 1 sentences.jsonl | "$BIN/text-encode" --model elsewhere -o elsewhere.safetensors
	[ "$(meta elsewhere.safetensors encoder)" = "$mine" ]
}

@test "a training does not go on with another scene or encoder" {
	local mine other
	train() {
		"$BIN/refer-train" -q --text text.safetensors --masks masks.jsonl --checkpoint 2 -o out/model "$@"
	}
	# cut off after the first checkpoint: the log cannot be written any more
	train --scene scene --weights weights --iterations 200 --log /dev/full 2>/dev/null && false
	[ "$(meta out/model.checkpoint scene)" = "$(meta scene/splats.safetensors scene)" ]
	[ "$(meta out/model.checkpoint encoder)" = "$(meta text.safetensors encoder)" ]
	"$BIN/gs-weigh" -q -o weights2 exchanged
	says 3 "refer-train: out/model.checkpoint: is of another scene than exchanged ($(meta scene/splats.safetensors scene), not $(meta exchanged/splats.safetensors scene))" \
		train --scene exchanged --weights weights2 --iterations 3 --resume
	mine=$(meta text.safetensors encoder)
	other=$(meta weight.safetensors encoder)
	says 3 "refer-train: out/model.checkpoint: is of another encoder than weight.safetensors ($mine, not $other)" \
		train --scene scene --weights weights --text weight.safetensors --iterations 3 --resume
}

@test "files from before fingerprints are taken as they are" {
	forgets scene/splats.safetensors weights/*.safetensors text.safetensors model.safetensors
	[ "$(meta text.safetensors encoder)" = null ]
	"$BIN/refer-train" -q --scene scene --weights weights --text text.safetensors --masks masks.jsonl --iterations 2 -o out/model
	[ "$(meta out/model encoder)" = null ]
	"$BIN/refer-render" --scene exchanged --text weight.safetensors --model model.safetensors -o out/pred
	"$BIN/gs-check" text.safetensors >line
	[ "$(cat line)" = "text.safetensors: ok: refer.text, $("$BIN/gs-check" "$BATS_FILE_TMPDIR/text.safetensors" |
		sed 's/.*refer.text, //; s/, encoder .*//')" ]
}

@test "gs-check prints fingerprints" {
	local scene encoder view
	scene=$(meta scene/splats.safetensors scene)
	encoder=$(meta text.safetensors encoder)
	view=weights/$(first_view).safetensors
	"$BIN/gs-check" scene scene/splats.safetensors weights | grep -c ", scene $scene\$" | grep -qx 3
	"$BIN/gs-check" text.safetensors | grep -q ", encoder $encoder\$"
	"$BIN/gs-check" model.safetensors lifted.safetensors | grep -c ", scene $scene, encoder $encoder\$" | grep -qx 2
	"$BIN/gs-check" "$view" | grep -q ", scene $scene, camera $(meta "$view" camera)\$"
	"$BIN/gs-check" --json model.safetensors | jq -e --arg s "$scene" --arg e "$encoder" '.scene == $s and .encoder == $e'
}

@test "a folder with weights of two scenes is malformed" {
	local first
	first=$(ls weights | head -n 1)
	"$BIN/gs-weigh" -q -o weights2 exchanged
	cp "weights2/$(ls weights | sed -n 2p)" weights
	"$BIN/gs-check" weights >line && false
	grep -q "^weights: weights/.*: is of another scene than weights/$first (\|^weights/.*: is of another scene than weights/$first (" line
}

@test "a fingerprint that is none is refused, and so is one that is not of the means" {
	LC_ALL=C sed -i 's/"encoder":"....\(............\)"/"encoder":"xyzw\1"/' text.safetensors
	says 1 "text.safetensors: metadata 'encoder' is '$(meta text.safetensors encoder)', not 16 hexadecimal digits" \
		"$BIN/gs-check" text.safetensors
	own=$(meta scene/splats.safetensors scene)
	LC_ALL=C sed -i "s/\"scene\":\"$own\"/\"scene\":\"0123456789abcdef\"/" scene/splats.safetensors
	says 1 "scene/splats.safetensors: metadata 'scene' is 0123456789abcdef, but the means have $own" "$BIN/gs-check" scene
}
