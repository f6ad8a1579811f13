#!/usr/bin/env bats
# The ablation tables: what the report makes of given scores, and the pipeline on the smallest scene there is.
# Parts: pipelines/ablation[a-z-]*\.(mk|sh|awk|sbatch) pipelines/(two-stage|common).mk

setup() {
	export BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	BIN=$(cd "$BIN" && pwd)
	export ROOT=$BATS_TEST_DIRNAME/../..
	cd "$BATS_TEST_TMPDIR"
}

not() { ! "$@"; }

# ablation ARGUMENT...: the pipeline on one tiny scene.
ablation() {
	make -f "$ROOT/pipelines/ablation.mk" OUT="$BATS_TEST_TMPDIR/out" SCENES=diner SEEDS=1 ITERATIONS=20 SCALE=1 BIN="$BIN" \
		SYNTH="--objects 3 --views 6 --size 64x48 --gaussians 1500" BERT="$ROOT/tests/golden/bert" "$@"
}

# score CELL RUN TEST TRAIN: the scores of a training, in shares of 1.
score() {
	mkdir -p "given/$1/$2"
	printf 'group,name,pairs,miou,right\nall,,10,%s,0.5\n' "$3" >"given/$1/$2/test.csv"
	printf 'group,name,pairs,miou,right\nall,,10,%s,0.75\n' "$4" >"given/$1/$2/train.csv"
}

report() {
	ROOT=given SCENES="a b" SEEDS="1 2" RUNS="$2" "$ROOT/pipelines/ablation-report.sh" "$1"
}

@test "a cell is the mean over seeds of the mean over scenes, with the spread of the seeds" {
	score a-1 none 0.10 0.5; score b-1 none 0.20 0.5
	score a-2 none 0.30 0.5; score b-2 none 0.40 0.5
	score a-1 cosine 0.05 0.6; score b-1 cosine 0.15 0.6
	score a-2 cosine 0.25 0.6; score b-2 cosine 0.35 0.6
	run report similarity "none cosine"
	[ "$status" = 0 ]
	grep -qF '| dot product | 28.4 / 18.5 | 25.0 ± 14.1 | 50.0 ± 0.0 | 50.0 ± 0.0 | 75.0 ± 0.0 |' <<<"$output"
	grep -qF '| cosine | below dot product | 20.0 ± 14.1 | 50.0 ± 0.0 | 60.0 ± 0.0 | 75.0 ± 0.0 |' <<<"$output"
}

@test "the published order is said to agree, to be the other way round, or not to be told" {
	for cell in a-1 b-1 a-2 b-2; do score $cell none 0.30 0.40; score $cell cosine 0.20 0.50; done
	run report similarity "none cosine"
	grep -qF 'on test sentences agrees (+10.0 ± 0.0); on training sentences is the other way round (-10.0 ± 0.0)' <<<"$output"
	score a-1 cosine 0.50 0.40
	run report similarity "none cosine"
	grep -qF 'on test sentences cannot be told (+2.5 ± 7.5)' <<<"$output"
}

@test "a claim is silent about figures that one of its rows lacks" {
	for cell in a-1 b-1 a-2 b-2; do
		score $cell both 0.30 0.40
		mkdir -p given/$cell/masks
		echo '{"miou":0.5,"oiou":0.5}' >given/$cell/masks/ciou.quality.json
		echo '{"miou":0.4,"oiou":0.5}' >given/$cell/masks/top1.quality.json
	done
	run report masks both
	[ "$status" = 0 ]
	grep -q '^- confidence-weighted IoU above top-1 (table 3): the masks themselves agrees (+10.0 ± 0.0)$' <<<"$output"
	grep -qF '| top-1 | below | 40.0 ± 0.0 | - | - | - | - |' <<<"$output"
	not grep -q 'above IoU' <<<"$output"
}

@test "groups are pooled by their number of pairs" {
	for cell in a-1 b-1 a-2 b-2; do
		mkdir -p given/$cell/both
		printf '%s\n' 'relation,left,1,0.2' 'visibility,<0.15,3,0.1' >given/$cell/both/test.csv
		cp given/$cell/both/test.csv given/$cell/both/train.csv
	done
	echo 'relation,left,9,0.6' >given/b-2/both/test.csv
	run report hard both
	[ "$status" = 0 ]
	grep -qF '| left | 12 | 50.0 | 20.0 |' <<<"$output" # (3 of 0.2 and 9 of 0.6) / 12
	grep -qF '| <0.15 | 9 | 10.0 | 10.0 |' <<<"$output"
}

@test "the pipeline makes its tables, keeps them, and does nothing the second time" {
	ablation -j2 modules masks >first.log 2>&1
	grep -qE '^\| \+ second stage \| 36.9 / 25.2( \| [0-9.]+){4} \|$' first.log
	grep -qE '^\| top-1 \| below( \| [0-9.]+){5} \|$' out/quick/masks.md
	run ablation scores RUNS="none pcmi gtcl both two top1 iou first"
	[ "$status" = 0 ]
	not grep -qE 'refer-train|refer-render|gs-weigh|miou-score' <<<"$output"
}

@test "the scenes' own figures are those of gs-synth" {
	run ablation -s statistics
	[ "$status" = 0 ]
	words=$(jq '(.words.train * .sentences.train + .words.test * .sentences.test) / (.sentences.train + .sentences.test)' \
		out/quick/diner-1/data/statistics.json)
	hidden=$(jq '.visibility.test | 100 * (.["0"] + .["<0.15"])' out/quick/diner-1/data/statistics.json)
	ciou=$(jq '100 * .miou' out/quick/diner-1/masks/ciou.quality.json)
	grep -qE "^\| diner, seed 1 \| 3 \| .* \| 12 \+ 3 \| $(printf %.1f "$words") \| .*% \| $(printf %.0f "$hidden")% \| .* \| $(printf %.1f "$ciou") \|$" \
		<<<"$output"
}

@test "second stages have a table with the quality of what taught them; exact trainings share nothing" {
	ablation -j2 second exact >first.log 2>&1
	grep -qE "^\| taught by stage 1's answers \(paper\) \| 36.9 / 25.2 \| [0-9.]+( \| [0-9.]+){4} \|\$" out/quick/second.md
	[ "$(grep -cE '^\| [^|]+ \| +\| [0-9.]+( \| [0-9.]+){4} \|$' out/quick/second.md)" = 2 ]
	[ "$(grep -c '^| .*, exact |' out/quick/exact.md)" = 6 ]
	[ "$(cat out/quick/diner-1/two-exact/options)" = "$(sed 's/$/ --share 0 --negatives 0/' out/quick/diner-1/two/options)" ]
	# A second stage of the exact way is taught by the exact first stage.
	[ out/quick/diner-1/both-exact/teach.jsonl -nt out/quick/diner-1/both-exact/model.safetensors ]
}

@test "a CLIP of the user's is a row of the encoders' table" {
	ablation -j2 encoder BERTS="clip=$ROOT/tests/golden/clip" >first.log 2>&1
	grep -qE '^\| clip \| +\| [0-9.]+( \| [0-9.]+){3} \|$' out/quick/encoder.md
	[ "$(grep -cE '\| [0-9.]+( \| [0-9.]+){3} \|$' out/quick/encoder.md)" = 3 ]
}

@test "a training with other options is made again, and no other" {
	ablation scores RUNS="none both" >/dev/null 2>&1
	run ablation scores RUNS="none both" run.none="--interaction add --contrast none"
	[ "$status" = 0 ]
	grep -q 'diner-1/none/model.safetensors' <<<"$output"
	not grep -q 'diner-1/both/model.safetensors' <<<"$output"
}

@test "a training of one's own is a row of its own" {
	run ablation contrast RUNS="both mine" run.mine="--lambda 0.5" contrast="both mine"
	[ "$status" = 0 ]
	grep -qE '^\| mine \| ( \| [0-9.]+){4} \|$' <<<"$output"
}

@test "the cost table times a training and weighs its model" {
	ablation scores RUNS="none both released lift" >/dev/null 2>&1
	run ablation cost RUNS="none both released lift"
	[ "$status" = 0 ]
	grep -qE '^\| lifted: .* \| [0-9.]+ \+ [0-9.]+ \| [0-9.]+ \| [0-9.]+ \| [0-9.]+ \| [0-9.]+ \| [0-9.]+ \|$' <<<"$output"
	grep -qE '^\| both: .* \| [0-9.]+ \| [0-9.]+ \| [0-9.]+ \| [0-9.]+ \| [0-9.]+ \| [0-9.]+ \|$' <<<"$output"
}

@test "answers without training have tables: by parts, by what is hard, and in space" {
	local rows=(lifted="both warmed lift-sentence lift-relations lift lift-voted" hard="warmed lift-relations lift")
	ablation -j2 lifted hard space unseen "${rows[@]}" >first.log 2>&1
	pairs=$(jq '[.one, .several, .none | .pairs] | add' out/quick/diner-1/lift/unseen.answers.json)
	[ "$(awk -F'|' '/^\| that mean/ { n += $3 } END { print n }' out/quick/unseen.md)" = "$pairs" ]
	[ "$(grep -cE '^\| [a-z -]+ \| [0-9]+( \| [0-9.]+){4} \|$' out/quick/unseen.md)" -ge 8 ]
	for row in 'stage 1 from the lifted model' '\+ relations' '\+ sentences say which of several alike'; do
		grep -qE "^\| $row \|  \| [-0-9.]+( \| [0-9.]+){4} \|\$" out/quick/lifted.md
	done
	# Parts are left out one after another: the first row is by the sentence alone.
	[ "$(cat out/quick/diner-1/lift-sentence/options)" = "--without relations,except,sizes,colours,surfaces,names,words,knowledge,purpose" ]
	[ -z "$(cat out/quick/diner-1/lift-relations/options)" ]
	grep -q '^### By objects that look the same' out/quick/hard.md
	grep -qE '^\| diner, seed 1 \|( [0-9.]+ / [0-9.]+ \|){7}$' out/quick/space.md
	run ablation lifted hard space "${rows[@]}"
	not grep -qE 'refer-lift|refer-train|refer-render|miou-score' <<<"$output"
}

@test "bad sizes are refused" {
	run ablation tables SIZE=huge
	[ "$status" = 2 ]
	grep -q 'SIZE is full or quick' <<<"$output"
}

@test "another SCALE weighs anew, and nothing in a value is done" {
	ablation scores RUNS=none >/dev/null 2>&1
	run ablation scores RUNS=none SCALE=0.5
	grep -q gs-weigh <<<"$output"
	not grep -q gs-import <<<"$output"
	for variable in SCENES SEEDS RUNS SYNTH TRAIN SCALE ITERATIONS THREADS; do
		run ablation scores "$variable=1; touch done"
		[ "$status" = 2 ]
		grep -qE "ablation.mk: $variable(: | has a ;)" <<<"$output"
		run ablation scores "$variable="'$(shell touch done)'
		[ "$status" = 2 ]
	done
	run ablation scores "OUT=a b"
	grep -qF ".mk: OUT has a blank" <<<"$output"
	[ ! -e done ]
}

# A stand-in for Slurm's: runs each job of an array, and then what it wraps, at once and here.
slurm() {
	mkdir bin
	cat >bin/sbatch <<-'END'
		#!/usr/bin/env bash
		set -e
		printf '%s\n' "$*" >>sbatch.log
		export SLURM_SUBMIT_DIR=$PWD
		while [[ ${1:-} == --* ]]; do
			case $1 in
			--array=1-*) last=${1#--array=1-} ;;
			--wrap) wrap=$2; shift ;;
			esac
			shift
		done
		[ -z "${wrap:-}" ] || bash -c "$wrap" >wrap.log
		for ((k = 1; k <= ${last:-0}; k++)); do SLURM_ARRAY_TASK_ID=$k "$@" >"cell$k.log"; done
		echo "${last:-7}"
	END
	chmod +x bin/sbatch
	PATH=$PWD/bin:$PATH
}

@test "on Slurm: a job for each scene and seed, and the table after them, the same as without" {
	slurm
	words=(SCENES="diner tea" SEEDS="1 2" RUNS=lift SCALE=1 BIN="$BIN" SYNTH="--objects 3 --views 6 --size 64x48 --gaussians 1500"
		BERT="$ROOT/tests/golden/bert")
	SBATCH_OPTIONS=--partition=long "$ROOT/pipelines/ablation.sbatch" THREADS=2 OUT="$PWD/out" "${words[@]}" unseen >said
	[ "$(cat said)" = "cells: job 4; tables: job 7" ]
	[ "$(grep -c -- '--partition=long --parsable --cpus-per-task=2' sbatch.log)" = 2 ]
	grep -q -- '--dependency=afterok:4' sbatch.log
	for cell in diner-1 diner-2 tea-1 tea-2; do [ -s "out/quick/$cell/lift/test.csv" ]; done
	# each cell's job made its own alone
	not grep -q 'tea-' cell1.log
	make -s -f "$ROOT/pipelines/ablation.mk" THREADS=2 OUT="$PWD/here" "${words[@]}" unseen >/dev/null
	cmp out/quick/unseen.md here/quick/unseen.md
}
