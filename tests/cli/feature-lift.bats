#!/usr/bin/env bats
# feature-lift. Options that every tool has are in common.bats; what makes a file malformed in format/features.bats; whether
# the means and votes are right in unit/test_lift_features.c.

setup_file() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	export OMP_WAIT_POLICY=passive
	load npy
	cd "$BATS_FILE_TMPDIR"
	weighed_scene
}

setup() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	load ../format/files
	load npy
	cd "$BATS_TEST_TMPDIR"
	export OMP_WAIT_POLICY=passive
	made=$BATS_FILE_TMPDIR
	cp "$made/text.safetensors" "$made/masks.jsonl" .
	mapfile -t views < <(ls "$made/weights" | sed 's/\.safetensors$//')
	mkdir maps
}

lift() {
	"$BIN/feature-lift" --scene "$made/scene" --weights "$made/weights" "$@"
}

# refuses STATUS MESSAGE [OPTION]...: lifting fails so, and leaves nothing.
refuses() {
	local status=$1 message=$2
	shift 2
	rm -rf out
	mkdir out
	says "$status" "feature-lift: $message" lift -o out/features "$@" && [ -z "$(ls -A out)" ]
}

# a map of 2 x 2 cells and two channels for each view: (3, 4) on the left, (0, -2) on the right
left=0000404000008040 right=00000000000000c0
halves() {
	local view
	for view in "${views[@]}"; do npy "maps/$view.npy" '<f4' '2, 2, 2' $left$right$left$right; done
}

@test "one feature everywhere: every Gaussian that is seen has it, with length 1" {
	for view in "${views[@]}"; do npy "maps/$view.npy" '<f4' '1, 1, 2' $left; done
	lift --precision f32 -o features maps >printed 2>&1
	[ ! -s printed ]
	"$BIN/gs-check" features | grep -qE '^features: ok: refer.features, f32, 2000 gaussians, 2 channels, [0-9]+ seen, scene '
	paste -d' ' <(tensor features features f4 | tr ' ' '\n' | paste -d' ' - -) <(tensor features reliability f4 | tr ' ' '\n') \
		<(tensor features weight f4 | tr ' ' '\n') >rows
	[ "$(wc -l <rows)" = 2000 ]
	awk 'function off(a, b) { return (a - b) ^ 2 > 1e-10 }
		$4 > 0 { seen++; if (off($1, 0.6) || off($2, 0.8) || off($3, 1)) bad = 1 }
		$4 == 0 { unseen++; if ($1 || $2 || $3) bad = 1 }
		END { exit bad || seen < 500 || unseen < 20 }' rows
}

@test "masks, labels and maps that lie across their views are refused" {
	across() { refuses 3 "$1 of 48x64, but the view is 64x48 (width x height): is the photograph turned by EXIF?" -q "${@:2}"; }
	jq -nc --arg view "${views[0]}" '{view: $view, object: "o", segmentation: {size: [64, 48], counts: [0, 3072]}}' >across.jsonl
	across "across.jsonl:1: view '${views[0]}': a mask" --masks across.jsonl
	"$BIN/mask-export" --png tree -o /dev/null across.jsonl
	cp "tree/${views[0]}/o.png" "maps/${views[0]}.png"
	across "maps/${views[0]}.png: a map" maps
	rm maps/*
	npy "maps/${views[0]}.npy" '<f4' '8, 6, 2' "$(printf "$left%.0s" {1..48})"
	refuses 3 "maps/${views[0]}.npy: a map of 6x8, but the view is 64x48 (width x height): is the photograph turned by EXIF?" -q maps
}

@test "halves of the same numbers, and other types of them, are the same" {
	halves
	lift -o expected maps
	for view in "${views[@]}"; do npy "maps/$view.npy" '<f2' '2, 2, 2' $(times 2 00420044000000c0); done
	lift maps | cmp expected
	for view in "${views[@]}"; do npy "maps/$view.npy" '|i1' '2, 2, 2' $(times 2 030400fe); done
	lift maps | cmp expected
	# twice as fine, with the same in both halves of a cell: the same but for rounding
	for view in "${views[@]}"; do npy "maps/$view.npy" '|i1' '2, 4, 2' $(times 2 0304030400fe00fe); done
	lift --precision f32 -o fine maps
	halves
	lift --precision f32 -o coarse maps
	paste -d' ' <(tensor coarse features f4 | tr ' ' '\n') <(tensor fine features f4 | tr ' ' '\n') |
		awk '($1 - $2) ^ 2 > 1e-10 { bad = 1 } END { exit bad || NR != 4000 }'
}

@test "any number of threads, and channels one at a time, give the same" {
	for view in "${views[@]}"; do npy "maps/$view.npy" '|i1' '2, 2, 600' $(times 400 030400fe07f1); done
	lift -o expected maps
	lift --threads 1 maps | cmp expected
	lift --threads 7 maps | cmp expected
	lift --memory 1 maps | cmp expected
	"$BIN/gs-check" expected | grep -q ' 600 channels, '
}

@test "segments with a number for each pixel are the same as their features in a map" {
	halves
	lift -o expected maps
	rm maps/*
	for view in "${views[@]}"; do
		npy "maps/${view}_f.npy" '<f4' '3, 2' $right$left$f0$f0
		# two levels: none and 0; and 1 on the left, 0 on the right, as floats
		npy "maps/${view}_s.npy" '<f4' '2, 1, 2' $fminus$f0$f1$f0
	done
	lift --level 1 -o got maps
	cmp <(tensor expected features u2) <(tensor got features u2)
	[ "$(meta got options)" = "--prune 0 --level 1 --precision f16 --uncovered skip" ]
	# of level 0 the left half says nothing: with a map of zeros there, its Gaussians are not reliable
	lift -o skipped maps
	lift --uncovered zero -o zero maps
	for view in "${views[@]}"; do npy "maps/${view}_s.npy" '<i4' '1, 2' 0200000000000000; done
	lift maps -o zeros
	cmp <(tensor zero features u2) <(tensor zeros features u2)
	[ "$(tensor skipped reliability f4 | tr ' ' '\n' | awk '$1 > 0 && $1 < 0.9' | wc -l)" = 0 ]
	[ "$(tensor zero reliability f4 | tr ' ' '\n' | awk '$1 > 0 && $1 < 0.9' | wc -l)" -gt 20 ]
	# these are pruned
	lift --prune 0.9 -o pruned maps
	[ "$(tensor pruned reliability f4 | tr ' ' '\n' | awk '$1 > 0 && $1 < 0.9' | wc -l)" = 0 ]
	[ "$(tensor pruned weight f4 | tr ' ' '\n' | awk '$1 > 0' | wc -l)" = "$(tensor zero reliability f4 | tr ' ' '\n' | awk '$1 >= 0.9' | wc -l)" ]
}

@test "labels: the objects of masks are those of refer-lift" {
	lift --masks masks.jsonl -o labels
	"$BIN/gs-check" labels | grep -qE '^labels: ok: refer.features, 2000 gaussians, [0-9]+ seen, [0-9]+ labels, scene '
	cat masks.jsonl | lift --masks - --threads 7 | cmp labels
	"$BIN/refer-lift" --names masks --scene "$made/scene" --weights "$made/weights" --text text.safetensors --masks masks.jsonl -o lifted
	tensor labels labels d4 | tr ' ' '\n' >of-each
	read -r -a indptr <<<"$(tensor lifted indptr d8)"
	mapfile -t names < <(meta lifted names | jq -r '.[]')
	for k in 0 1 2; do
		number=$(jq -r .object masks.jsonl | awk '!seen[$0]++' | grep -nxF "${names[k]}" | cut -d: -f1)
		# Gaussians with most of their weight in the object have its label, and others have not
		paste -d' ' <(tensor lifted index d4 | tr ' ' '\n') <(tensor lifted share u1 | tr ' ' '\n') |
			sed -n "$((indptr[k] + 1)),${indptr[k + 1]}p" | awk '$2 > 150 { print $1 + 1 }' >own
		[ "$(wc -l <own)" -gt 20 ]
		awk -v number="$number" 'NR == FNR { own[$1] = 1; next } FNR in own && $1 == number { n++ } END { print n }' own of-each >agree
		[ "$(cat agree)" -gt $(($(wc -l <own) * 9 / 10)) ]
	done
	grep -qx 0 of-each
}

@test "label pictures: grey levels" {
	ref=$(jq -r .ref "$made/sentences.jsonl" | head -n 1)
	"$BIN/refer-lift" --scene "$made/scene" --weights "$made/weights" --text text.safetensors --masks masks.jsonl -o lifted
	"$BIN/refer-render" -q --scene "$made/scene" --text text.safetensors --model lifted --split train --refs "$ref" --png png -o /dev/null
	for view in "${views[@]}"; do cp "png/$view/$ref.png" "maps/$view.png"; done
	lift -o labels maps
	[ "$(tensor labels labels d4 | tr ' ' '\n' | sort -nu | paste -sd' ')" = "-1 0 255" ]
	rm "maps/${views[1]}.png"
	says 0 "feature-lift: warning: maps: 1 training views have no features" lift -o fewer maps
	says 0 "" lift -q -o quiet maps
	cmp fewer quiet
	not cmp -s fewer labels
	refuses 3 "$made/images/${views[0]}.png: PNG: has colours, not numbers of labels" "$made/images"
}

# Fails where the command succeeds; a plain ! would let the test go on.
not() { ! "$@"; }

@test "a text gives masks vectors: by ref, else by object" {
	lift --masks masks.jsonl --text text.safetensors -o by-object
	[ "$("$BIN/gs-check" by-object | grep -o '24 channels')" = '24 channels' ]
	jq -c --slurpfile all "$made/sentences.jsonl" '.object as $o | .ref = ([$all[] | select(.object == $o)][0].ref)' masks.jsonl >by-ref.jsonl
	lift --masks by-ref.jsonl --text text.safetensors | cmp by-object
	jq -c --slurpfile all "$made/sentences.jsonl" '.object as $o | .ref = ([$all[] | select(.object == $o)][2].ref)' masks.jsonl >other.jsonl
	lift --masks other.jsonl --text text.safetensors -o other
	not cmp -s other by-object
	jq -c '.object = "nobody"' masks.jsonl >nobody.jsonl
	says 0 "feature-lift: warning: nobody.jsonl: $(wc -l <nobody.jsonl) masks are of no sentence of text.safetensors" \
		lift --masks nobody.jsonl --text text.safetensors -o none
	[ "$(tensor none weight f4 | tr ' ' '\n' | sort -u)" = 0 ]
}

@test "the surest mask is on top" {
	object=$(jq -r .object masks.jsonl | head -n 1)
	# a second object everywhere, less sure
	full='{"size":[48,64],"counts":[0,3072]}'
	{
		jq -c --arg o "$object" 'select(.object == $o) | .score = 0.9' masks.jsonl
		for view in "${views[@]}"; do echo "{\"view\":\"$view\",\"object\":\"all\",\"score\":0.5,\"segmentation\":$full}"; done
	} >two.jsonl
	lift --masks two.jsonl -o labels
	[ "$(tensor labels labels d4 | tr ' ' '\n' | sort -nu | paste -sd' ')" = "-1 1 2" ]
	sed 's/"score":0.5/"score":0.95/' two.jsonl >over.jsonl
	lift --masks over.jsonl -o over
	[ "$(tensor over labels d4 | tr ' ' '\n' | sort -nu | paste -sd' ')" = "-1 2" ]
}

@test "arrays in .npz: one for each view, or one of all views, stored or deflated" {
	halves
	lift -o expected maps
	mkdir packed
	for view in "${views[@]}"; do
		cp "maps/$view.npy" features.npy
		npy other.npy '<f4' '1' $left
		npz "packed/$view.npz" other.npy features.npy
	done
	lift -o each packed
	cmp each expected
	for view in "${views[@]}"; do
		cp "maps/$view.npy" arr_0.npy
		npz "packed/$view.npz" arr_0.npy
	done
	lift -o unnamed packed
	cmp unnamed expected
	# a .npy comes before a .npz, view by view
	cp "maps/${views[0]}.npy" packed
	echo broken >"packed/${views[0]}.npz"
	lift -o mixed packed
	cmp mixed expected
	npz all.npz other.npy maps/*.npy
	lift -o all all.npz
	cmp all expected
	# as NumPy 1.24 writes them: savez, savez_compressed
	for saved in stored deflated; do
		lift -o $saved "$BATS_TEST_DIRNAME/../golden/npz/$saved.npz"
		cmp $saved expected
	done
}

@test "segments in an .npz" {
	for view in "${views[@]}"; do
		npy "maps/${view}_f.npy" '<f4' '2, 2' $left$right
		npy "maps/${view}_s.npy" '<i4' '1, 2' 0000000001000000
	done
	lift -o expected maps
	npz all.npz maps/*.npy
	lift -o all all.npz
	cmp all expected
	rm "maps/${views[0]}_f.npy"
	npz all.npz maps/*.npy
	refuses 3 "all.npz: ${views[0]}_f.npy: is not there" all.npz
}

@test "archives that are malformed" {
	halves
	view=${views[0]}
	npz all.npz maps/*.npy
	refuses 4 'gone.npz: No such file or directory' gone.npz
	head -c $(($(wc -c <all.npz) - 30)) all.npz >cut.npz
	refuses 3 'cut.npz: not a zip, or its end is missing' cut.npz
	npy other.npy '<f4' '1' $left
	npz other.npz other.npy
	refuses 3 'other.npz: has no VIEW.npy or VIEW_s.npy of a training view' other.npz
	# the second record of the directory, which is as long as the first
	record=$((46 + ${#view} + 4))
	begin=$(($(wc -c <all.npz) - 22 - record * ${#views[@]}))
	{ head -c $((begin + record)) all.npz; printf XX; tail -c +$((begin + record + 3)) all.npz; } >lost.npz
	refuses 3 "lost.npz: the zip's directory is damaged" lost.npz
	# a byte of the first array's numbers
	{ head -c $((30 + ${#view} + 4 + 130)) all.npz; printf '\xff'; tail -c +$((30 + ${#view} + 4 + 132)) all.npz; } >damaged.npz
	refuses 3 "damaged.npz: file '$view.npy' in the zip is damaged" damaged.npz
	npy "maps/$view.npy" '<f4' '2, 2' $left$right
	npz all.npz maps/*.npy
	refuses 3 "all.npz: $view.npy: has 2 dimensions, not 3: height, width and channels" all.npz
	echo text >"maps/$view.npy"
	npz all.npz maps/*.npy
	refuses 3 "all.npz: $view.npy: not a .npy file: it does not begin with \\x93NUMPY" all.npz
	rm "maps/$view.npy"
	npz "maps/$view.npz" other.npy
	refuses 3 "maps/$view.npz: has no array 'features' or 'arr_0'" maps
	says 2 "feature-lift: -o all.npz would overwrite MAPS all.npz
Try 'feature-lift --help'." lift -o all.npz all.npz
	# cut short anywhere: one line
	npz small.npz maps/*.npy
	for ((n = 0; n < $(wc -c <small.npz); n += 97)); do
		head -c $n small.npz >short.npz
		status=0
		lift -o none short.npz 2>err || status=$?
		[ $status = 3 ] && [ "$(wc -l <err)" = 1 ] && [ ! -e none ]
	done
}

@test "maps that are malformed" {
	view=${views[0]}
	halves
	npy "maps/$view.npy" '<f4' '2, 2' $left$right
	refuses 3 "maps/$view.npy: has 2 dimensions, not 3: height, width and channels" maps
	npy "maps/$view.npy" '<f4' '0, 2, 2' ''
	refuses 3 "maps/$view.npy: a map of no pixels" maps
	npy "maps/$view.npy" '<f4' '2, 24, 32' "$(printf "$left%.0s" {1..768})"
	refuses 3 "maps/$view.npy: 2x24x32 is channels, height and width, as it seems: transpose it (in NumPy by (1, 2, 0))" maps
	npy "maps/$view.npy" '<f4' '2, 2, 0' ''
	refuses 3 "maps/$view.npy: 0 channels, not 1 to 65536" maps
	npy "maps/$view.npy" '<c8' '1, 1, 2' $left$right
	refuses 3 "maps/$view.npy: header, offset 20: 'descr' is no float or whole number, little-endian" maps
	npy "maps/$view.npy" '<f4' '1, 2, 2' $left$f1$fnan
	refuses 3 "maps: view '$view': feature 1 is not finite" maps
	halves
	npy "maps/${views[1]}.npy" '<f4' '1, 1, 3' $left$f1
	refuses 3 "maps: view '${views[1]}' has 3 channels, the views before it have 2" maps
	refuses 3 "${made}/weights: has no VIEW.npy, VIEW.npz, VIEW_s.npy or VIEW.png of a training view" "$made/weights"
	refuses 4 "gone: no such folder" gone
}

@test "segments that are malformed" {
	view=${views[0]}
	for each in "${views[@]}"; do
		npy "maps/${each}_f.npy" '<f4' '1, 2' $left
		npy "maps/${each}_s.npy" '<i4' '1, 2' 00000000ffffffff
	done
	lift -o features maps
	refuses 3 "maps/${view}_s.npy: has 1 levels, so none is 1" --level 1 maps
	npy "maps/${view}_s.npy" '<i4' '1, 2' 0000000001000000
	refuses 3 "maps/${view}_s.npy: level 0, row 0, column 1 is 1, not a whole number from -1 to 0" maps
	npy "maps/${view}_s.npy" '<f4' '1, 2' $f0$fhalf
	refuses 3 "maps/${view}_s.npy: level 0, row 0, column 1 is 0.5, not a whole number from -1 to 0" maps
	npy "maps/${view}_s.npy" '<f4' '1, 2' $f0$fnan
	refuses 3 "maps/${view}_s.npy: level 0, row 0, column 1 is nan, not a whole number from -1 to 0" maps
	npy "maps/${view}_s.npy" '<f4' '2' $f0$f0
	refuses 3 "maps/${view}_s.npy: has 1 dimensions, not 3: levels, height and width" maps
	npy "maps/${view}_s.npy" '<f4' '0, 3' ''
	refuses 3 "maps/${view}_s.npy: 3x0 pixels, not 1 to 2147483647 altogether" maps
	npy "maps/${view}_f.npy" '<f4' '2' $left
	refuses 3 "maps/${view}_f.npy: has 1 dimensions, not 2: segments and channels" maps
	rm "maps/${view}_f.npy"
	refuses 4 "maps/${view}_f.npy: No such file or directory" maps
}

@test "a folder without weights" {
	mkdir none
	refuses 4 "none: has no weights of a training view" --weights none --masks masks.jsonl
}

@test "means and reliabilities as NumPy has them in float64, of maps of another size" {
	for python in /usr/bin/python3 python3 ""; do
		[ -z "$python" ] || ! "$python" -c 'import numpy' 2>/dev/null || break
	done
	[ -n "$python" ] || skip "python3 with NumPy is not here"
	export PYTHONDONTWRITEBYTECODE=1
	peer=$BATS_TEST_DIRNAME/../peers/feature_lift.py
	"$python" - "${views[@]}" <<-'END'
		import sys
		import numpy as np
		r = np.random.default_rng(7)
		for view in sys.argv[1:]:
		    map = r.standard_normal((20, 30, 7)).astype(np.float32)
		    map[3, 4] = 0
		    np.save("maps/" + view + ".npy", map)
	END
	for precision in f32 f16; do
		lift --precision $precision -o features maps
		"$python" "$peer" compare "$made/weights" maps features
	done
	# and not, where a map is another
	rm "maps/${views[0]}.npy"
	cp "maps/${views[1]}.npy" "maps/${views[0]}.npy"
	run "$python" "$peer" compare "$made/weights" maps features
	[ "$status" = 1 ]
	"$python" "$peer" time "$made/weights" maps out.npy | jq -e '.seconds >= 0 and .views > 1'
}

@test "options that do not go together, and outputs that are inputs" {
	halves
	local try="
Try 'feature-lift --help'."
	says 2 "feature-lift: --scene and --weights are required$try" "$BIN/feature-lift" maps
	says 2 "feature-lift: either MAPS or --masks is required$try" lift
	says 2 "feature-lift: either MAPS or --masks is required$try" lift --masks masks.jsonl maps
	says 2 "feature-lift: --text needs --masks$try" lift --text text.safetensors maps
	says 2 "feature-lift: -o masks.jsonl would overwrite --masks masks.jsonl$try" lift --masks masks.jsonl -o masks.jsonl
	says 2 "feature-lift: -o maps/${views[0]}.npy would be among the files of MAPS maps$try" lift -o "maps/${views[0]}.npy" maps
}
