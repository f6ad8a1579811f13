#!/usr/bin/env bats
# feature-query, and what refer-render and refer-locate make of its selections. Options that every tool has are in
# common.bats; what makes a file malformed in format/selection.bats; the rules themselves in unit/test_query.c.

setup_file() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	export OMP_WAIT_POLICY=passive
	load npy
	cd "$BATS_FILE_TMPDIR"
	weighed_scene
	# each object's pixels have the vector of its name as their feature
	jq -c '.object as $o | {ref: $o, object: $o, text: $o, split: "train"}' sentences.jsonl | sort -u >names.jsonl
	"$BIN/text-encode" -q --model encoder -o names.safetensors names.jsonl
	"$BIN/feature-lift" --scene scene --weights weights --masks masks.jsonl --text names.safetensors --uncovered zero \
		--prune 0.5 -o features.safetensors
	"$BIN/feature-lift" --scene scene --weights weights --masks masks.jsonl -o labels.safetensors
	# the sentences say nothing but the name of their object
	jq -c '.text = .object' sentences.jsonl >plain.jsonl
	"$BIN/text-encode" -q --model encoder -o plain.safetensors plain.jsonl
	"$BIN/refer-lift" --names masks --scene scene --weights weights --text plain.safetensors --masks masks.jsonl \
		-o lifted.safetensors
	printf '{"ref":"%s","object":"%s","text":"%s","split":"train"}\n' stuff stuff stuff texture texture texture >canonical.jsonl
	"$BIN/text-encode" -q --model encoder -o canonical.safetensors canonical.jsonl
}

setup() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	load ../format/files
	load npy
	cd "$BATS_TEST_TMPDIR"
	export OMP_WAIT_POLICY=passive
	made=$BATS_FILE_TMPDIR
	ln -s "$made"/*.safetensors "$made/scene" .
}

query() {
	"$BIN/feature-query" --text plain.safetensors "$@"
}

# scores SELECTION: mIoU in percent, without a fraction.
scores() {
	"$BIN/refer-render" -q --scene scene --text plain.safetensors --model "$1" --sentences test -o masks.jsonl
	"$BIN/miou-score" --json -q --predicted-views --truth "$made/truth.jsonl" masks.jsonl | jq '.miou * 100 | floor'
}

# refuses STATUS MESSAGE [OPTION]...: the query fails so, and leaves nothing.
refuses() {
	local status=$1 message=$2
	shift 2
	rm -rf out
	mkdir out
	says "$status" "feature-query: $message" query -o out/selection "$@" && [ -z "$(ls -A out)" ]
}

# Fails where the command succeeds; a plain ! would let the test go on.
not() { ! "$@"; }

@test "a text through a pipe gives its vectors too" {
	query -o expected features.safetensors
	cat plain.safetensors | "$BIN/feature-query" --text - -o piped features.safetensors
	cmp expected piped
}

@test "cosine: names select their objects" {
	query -o selection features.safetensors >printed 2>&1
	[ ! -s printed ]
	"$BIN/gs-check" selection | grep -qE '^selection: ok: refer.selection, 15 sentences, [0-9]+ items, 2000 gaussians of the scene, scene '
	[ "$(meta selection options)" = "--rule cosine" ]
	[ "$(scores selection)" -gt 70 ]
	# no Gaussian is of two objects
	query --sentences test -o test features.safetensors
	[ "$(meta test refs | jq length)" = 3 ]
	[ "$(tensor test index d4 | tr ' ' '\n' | sort | uniq -d | wc -l)" = 0 ]
}

@test "cosine: what is held against a sentence takes from it" {
	query --sentences test -o alone features.safetensors
	query --sentences test --against names.safetensors -o against features.safetensors
	# the same names are as near as the sentences, so that no sentence is nearer
	[ "$(tensor against indptr d8)" = "0 0 0 0" ]
	[ "$(tensor alone index d4 | wc -w)" -gt 100 ]
}

@test "relevancy: names against canonical phrases, and the scale of the threshold" {
	query --rule relevancy --relative --canonical canonical.safetensors -o relative features.safetensors
	[ "$(meta relative options)" = "--rule relevancy --threshold 0.4 --relative" ]
	query --rule relevancy --canonical canonical.safetensors -o published features.safetensors
	[ "$(meta published options)" = "--rule relevancy --threshold 0.5" ]
	count() { tensor "$1" index d4 | wc -w; }
	before=100000
	for t in -1 0 0.45 0.5 0.55 1; do
		query --rule relevancy --threshold $t --canonical canonical.safetensors -o at features.safetensors
		[ "$(count at)" -le $before ]
		before=$(count at)
		[ $t != 0.5 ] || cmp <(tensor at index d4) <(tensor published index d4)
		# everything that is seen, for each of 15 sentences
		[ $t != -1 ] || [ "$before" = $((15 * $("$BIN/gs-check" --json features.safetensors | jq .seen))) ]
	done
	[ "$before" = 0 ]
	query --rule relevancy --relative --threshold 0.9 --canonical canonical.safetensors -o high features.safetensors
	[ "$(count high)" -gt 0 ]
	[ "$(count high)" -lt "$(count relative)" ]
}

@test "relevancy: of several levels the one with the largest relevancy" {
	query --rule relevancy --canonical canonical.safetensors -o one features.safetensors
	# a level of nothing but another text is never chosen, whichever comes first
	"$BIN/feature-lift" --scene scene --weights "$made/weights" --masks <(jq -c '.object = "stuff"' "$made/masks.jsonl") \
		--text canonical.safetensors --uncovered zero --prune 0.5 -o stuff
	query --rule relevancy --canonical canonical.safetensors features.safetensors stuff | cmp one
	query --rule relevancy --canonical canonical.safetensors stuff features.safetensors | cmp one
	query --rule relevancy --canonical canonical.safetensors -o low stuff
	not cmp -s one low
}

@test "hyperplane and identity: what the nearest training sentence's object shows" {
	query --rule hyperplane --positives lifted.safetensors -o plane features.safetensors
	[ "$(meta plane options)" = "--rule hyperplane" ]
	[ "$(scores plane)" -gt 70 ]
	query --rule identity --positives lifted.safetensors -o identity labels.safetensors
	[ "$(meta identity options)" = "--rule identity --threshold 0.7" ]
	[ "$(scores identity)" -gt 70 ]
	query --rule identity --threshold 1 --positives lifted.safetensors -o all labels.safetensors
	[ "$(tensor all index d4 | wc -w)" -lt "$(tensor identity index d4 | wc -w)" ]
}

@test "any number of threads gives the same" {
	for args in "features.safetensors" "--rule relevancy --canonical canonical.safetensors features.safetensors" \
		"--rule hyperplane --positives lifted.safetensors features.safetensors" \
		"--rule identity --positives lifted.safetensors labels.safetensors"; do
		query -o expected $args
		query --threads 1 $args | cmp expected
		query --threads 7 $args | cmp expected
	done
}

@test "vectors of a file, of each kind, in place of the text's" {
	query -o expected features.safetensors
	query --vectors plain.safetensors features.safetensors | cmp expected
	# the sentences of the text, as an array and as a tensor of another program
	length=$(od -An -t d8 -N 8 plain.safetensors | tr -d ' ')
	read -r begin end < <(head -c $((8 + length)) plain.safetensors | tail -c +9 | jq -r '.sentences.data_offsets | @tsv')
	hex=$(tail -c +$((9 + length + begin)) plain.safetensors | head -c $((end - begin)) | xxd -p | tr -d '\n')
	npy vectors.npy '<f4' '15, 24' "$hex"
	query --vectors vectors.npy features.safetensors | cmp expected
	npy more.npy '<f4' '1' $f1
	for name in vectors arr_0; do
		mkdir $name
		cp vectors.npy $name/$name.npy
		npz vectors.npz more.npy $name/$name.npy
		query --vectors vectors.npz features.safetensors | cmp expected
	done
	# vectors comes before arr_0
	cp more.npy arr_0.npy
	npz vectors.npz arr_0.npy vectors/vectors.npy
	query --vectors vectors.npz features.safetensors | cmp expected
	npz vectors.npz arr_0.npy
	refuses 3 "vectors.npz: arr_0.npy: has 1 dimensions, not 2: texts and channels" --vectors vectors.npz features.safetensors
	npz vectors.npz more.npy
	refuses 3 "vectors.npz: has no array 'vectors' or 'arr_0'" --vectors vectors.npz features.safetensors
	echo text >vectors.npz
	refuses 3 "vectors.npz: not a zip, or its end is missing" --vectors vectors.npz features.safetensors
	st other.safetensors "{\"clip\":{\"dtype\":\"F32\",\"shape\":[15,24],\"data_offsets\":[0,1440]}}" "$hex"
	query --vectors other.safetensors features.safetensors | cmp expected
	npy vectors.npy '<f4' '14, 24' "${hex:192}"
	refuses 3 "vectors.npy: has 14 vectors, plain.safetensors has 15 sentences" --vectors vectors.npy features.safetensors
	npy vectors.npy '<f4' '24, 15' "$hex"
	refuses 3 "vectors.npy: vectors of 15 channels, the features have 24" --vectors vectors.npy features.safetensors
	npy vectors.npy '<f4' '360' "$hex"
	refuses 3 "vectors.npy: has 1 dimensions, not 2: texts and channels" --vectors vectors.npy features.safetensors
	npy vectors.npy '<f4' '15, 24' "${hex:8}$fnan"
	refuses 3 "vectors.npy: vector 14 is not finite" --vectors vectors.npy features.safetensors
	refuses 3 "labels.safetensors: has 0 tensors of two dimensions, not 1" --vectors labels.safetensors features.safetensors
}

@test "--pixels: masks and peaks of the test views" {
	query --pixels scene --least 0.5 --sentences test -o pixels.jsonl features.safetensors
	"$BIN/gs-check" pixels.jsonl
	[ "$(jq -r .view pixels.jsonl | sort -u | paste -sd,)" = "$(cat "$made/test-views")" ]
	[ "$(jq -r .ref pixels.jsonl)" = "$(for v in $(tr , ' ' <"$made/test-views"); do jq -r 'select(.split == "test").ref' "$made/sentences.jsonl"; done)" ]
	jq -se 'all(.[]; has("peak") and .score <= 1)' pixels.jsonl
	# the names find their objects, and point at them
	"$BIN/miou-score" --json -q --predicted-views --truth "$made/truth.jsonl" pixels.jsonl | jq -e '.miou > 0.7 and .peak_in_box == 1'
	relevancy="--rule relevancy --relative --canonical canonical.safetensors --pixels scene --least 0.5 --sentences test"
	query $relevancy -o relevant.jsonl features.safetensors
	# of two levels that which says more: the other has nothing
	"$BIN/feature-lift" --scene scene --weights "$made/weights" --masks "$made/masks.jsonl" --text names.safetensors --uncovered zero \
		--prune 1 -o nothing.safetensors
	query $relevancy nothing.safetensors features.safetensors | cmp - relevant.jsonl
	query $relevancy features.safetensors nothing.safetensors | cmp - relevant.jsonl
	for n in 1 7; do query --threads $n $relevancy features.safetensors | cmp - relevant.jsonl; done
}

@test "--pixels: as NumPy has them in float64" {
	for python in /usr/bin/python3 python3 ""; do
		[ -z "$python" ] || ! "$python" -c 'import numpy' 2>/dev/null || break
	done
	[ -n "$python" ] || skip "python3 with NumPy is not here"
	export PYTHONDONTWRITEBYTECODE=1
	peer=$BATS_TEST_DIRNAME/../peers/query_pixels.py
	"$BIN/gs-weigh" -q --split test -o weights scene
	view=$(cut -d, -f1 "$made/test-views")
	"$BIN/feature-lift" --scene scene --weights "$made/weights" --masks "$made/masks.jsonl" --text names.safetensors --precision f32 -o single.safetensors
	query --pixels scene --least 0.3 --smooth 4 -o masks.jsonl single.safetensors
	"$python" "$peer" "weights/$view.safetensors" single.safetensors plain.safetensors all - 0.3 4 masks.jsonl
	for smooth in 1 9; do
		query --rule relevancy --relative --canonical canonical.safetensors --pixels scene --smooth $smooth --sentences test -o masks.jsonl single.safetensors
		"$python" "$peer" "weights/$view.safetensors" single.safetensors plain.safetensors test canonical.safetensors 0 $smooth masks.jsonl
	done
	# and not with another window
	run "$python" "$peer" "weights/$view.safetensors" single.safetensors plain.safetensors test canonical.safetensors 0 3 masks.jsonl
	[ "$status" = 1 ]
}

@test "files that do not belong together" {
	refuses 3 "labels.safetensors: has labels, the rule needs features" labels.safetensors
	refuses 3 "features.safetensors: has features, the rule needs labels" --rule identity --positives lifted.safetensors features.safetensors
	mkdir other
	(cd other && "$BIN/gs-synth" -q --objects 2 --views 2 --size 32x24 --gaussians 1500 -o . &&
		"$BIN/gs-import" -q --images images -o scene point_cloud.ply && "$BIN/gs-weigh" -q -o weights scene &&
		"$BIN/feature-lift" --scene scene --weights weights --masks truth.jsonl --text ../names.safetensors -q -o features)
	refuses 3 "other/features: is of a scene of 1500 Gaussians, features.safetensors has 2000" --rule relevancy \
		--canonical canonical.safetensors features.safetensors other/features
	refuses 3 "lifted.safetensors: is of a scene of 2000 Gaussians, other/features has 1500" --rule hyperplane \
		--positives lifted.safetensors other/features
	query -o small other/features
	says 3 "refer-render: small: is of a scene of 1500 Gaussians, scene has 2000" "$BIN/refer-render" --scene scene \
		--text plain.safetensors --model small -o none
	query --sentences test -o selection features.safetensors
	ref=$(jq -r .ref "$made/sentences.jsonl" | head -n 1)
	says 3 "refer-render: selection: has nothing for ref '$ref' of plain.safetensors" "$BIN/refer-render" --scene scene \
		--text plain.safetensors --model selection -o none
	[ ! -e none ]
}

@test "a selection has boxes and pictures, but answers no questions" {
	query -o selection features.safetensors
	"$BIN/refer-locate" --scene scene --text plain.safetensors --model selection --sentences test -o boxes.jsonl
	"$BIN/miou-score" --boxes --json -q --truth "$made/boxes.jsonl" boxes.jsonl | jq -e '.aligned.miou > 0.2'
	"$BIN/refer-render" -q --scene scene --text plain.safetensors --model selection --sentences test --amodal --overlay pictures -o masks.jsonl
	[ "$(ls pictures | wc -l)" -gt 0 ]
	mkdir -p run/lifted && cp -r "$made/scene" run/scene && cp selection run/lifted/model.safetensors && cp "$made/text.safetensors" run
	says 3 "refer-ask: run/lifted/model.safetensors: is a selection; questions need one of refer-lift" \
		"$BIN/refer-ask" --encoder "$made/encoder" run "where is it?"
}

@test "--pixels: what does not go with it" {
	local try=$'\n'"Try 'feature-query --help'."
	says 2 "feature-query: --pixels is for --rule cosine and relevancy$try" query --rule hyperplane --positives lifted.safetensors --pixels scene features.safetensors
	says 2 "feature-query: --smooth needs --pixels$try" query --smooth 3 features.safetensors
	says 2 "feature-query: --least needs --pixels$try" query --least 0.5 features.safetensors
	refuses 4 "none/splats.safetensors: No such file or directory" --pixels none features.safetensors
	"$BIN/gs-synth" -q --objects 2 --views 2 --size 32x24 --gaussians 1000 -o other
	"$BIN/gs-import" -q -o other/scene other/point_cloud.ply
	refuses 3 "features.safetensors: is of a scene of 2000 Gaussians, other/scene has 1000" --pixels other/scene features.safetensors
}

@test "options that do not go together, and outputs that are inputs" {
	local try="
Try 'feature-query --help'."
	says 2 "feature-query: --text is required$try" "$BIN/feature-query" features.safetensors
	says 2 "feature-query: --rule relevancy needs --canonical$try" query --rule relevancy features.safetensors
	says 2 "feature-query: --rule hyperplane and --rule identity need --positives$try" query --rule identity labels.safetensors
	says 2 "feature-query: several FEATURES need --rule relevancy$try" query features.safetensors features.safetensors
	says 2 "feature-query: -o features.safetensors would overwrite FEATURES features.safetensors$try" \
		query -o features.safetensors features.safetensors
	says 0 "feature-query: warning: names.safetensors: no sentence in this split" "$BIN/feature-query" --text names.safetensors \
		--sentences test -o none features.safetensors
	[ "$(tensor none indptr d8)" = 0 ]
}
