#!/usr/bin/env bash
# Whether two versions of the tools write the same bytes: every tool runs on two small synthetic scenes with both, and all files,
# messages and exit statuses are compared. usage: tests/same-bytes.sh A B [DATA]
# A and B are commits, which are built, or folders with tools. DATA is a folder in the desk's layout (pipelines/desk.mk), which
# is then lifted and trained on as well. BERT names an encoder (default: the tiny one of tests/golden), KEEP a folder for what
# was made. Prints what differs; the status is 0 where nothing does.
set -eu
here=$(cd "$(dirname "$0")/.." && pwd)
[ $# = 2 ] || [ $# = 3 ] || { sed -n '2,6s/^# //p' "$0" >&2; exit 2; }
data=${3:+$(cd "$3" && pwd)}
bert=$(cd "${BERT:-$here/tests/golden/bert}" && pwd)
export OMP_WAIT_POLICY=${OMP_WAIT_POLICY:-passive}
unset MAKEFLAGS MAKELEVEL MFLAGS
work=${KEEP:-$(mktemp -d)}
mkdir -p "$work"
[ -n "${KEEP-}" ] || trap 'rm -rf "$work"' EXIT

# tools_of NAME VERSION: the folder of its tools.
tools_of() {
	if [ -x "$2/refer-train" ]; then
		(cd "$2" && pwd)
		return
	fi
	mkdir -p "$work/source-$1"
	git -C "$here" archive "$2" | tar -x -C "$work/source-$1"
	make -s -j"$(nproc)" -C "$work/source-$1" tools >&2
	echo "$work/source-$1/build/bin"
}

# run NAME TOOL ARGUMENT...: NAME.out, NAME.err and NAME.status.
run() {
	local name=$1 status=0
	shift
	"$@" >"$name.out" 2>"$name.err" || status=$?
	echo $status >"$name.status"
}

# models STEPS SCALE: trains, lifts, and draws at this scale in this folder, which has scene, weights, text and masks.
models() {
	local ask=(--scene scene --text text) steps=$1 scale=$2
	local from=("${ask[@]}" --weights weights --masks masks)
	run lift refer-lift -q "${from[@]}" -o lifted
	run lift-masks refer-lift -q "${from[@]}" --names masks -o lifted-masks
	run train refer-train -q "${from[@]}" --iterations "$steps" --checkpoint 25 --log train.log -o trained
	run warm refer-train -q "${from[@]}" --iterations "$steps" --init lifted --init-iterations 20 --log warm.log -o warm
	for way in none attention attention+fp add pcmi-proj; do
		run "train-$way" refer-train -q "${from[@]}" --iterations 12 --interaction $way --contrast dot --negatives 0 --share 0 \
			--precision f32 -o "trained-$way"
	done
	run train-cosine refer-train -q "${from[@]}" --iterations 12 --similarity cosine --batch 2 --tolerance 0.01 -o trained-cosine
	for model in lifted lifted-masks trained warm trained-{none,attention,attention+fp,add,pcmi-proj,cosine}; do
		run "check-$model" gs-check $model
		run "render-$model" refer-render -q "${ask[@]}" --model $model --split all --scale "$scale" -o "render-$model.jsonl"
		run "locate-$model" refer-locate -q "${ask[@]}" --model $model -o "locate-$model.jsonl"
	done
	for model in lifted trained; do
		run "amodal-$model" refer-render -q "${ask[@]}" --model $model --amodal --scale "$scale" --png "png-$model" --overlay "overlay-$model" \
			--response "response-$model" --response-type npy -o "amodal-$model.jsonl"
		run "each-$model" refer-render -q "${ask[@]}" --model $model --scale "$scale" --viewpoint each --min-probability 0.1 --calibration none \
			-o "each-$model.jsonl"
		run "ply-$model" refer-locate -q "${ask[@]}" --model $model --refs "$(head -n 1 sentences | jq -r .ref)" --ply "shown-$model.ply" \
			--splat "shown-$model.splat" --show isolated
	done
}

# synthetic NAME OPTION...: a scene of gs-synth, through every tool.
synthetic() {
	mkdir "$1" && cd "$1"
	shift
	run synth gs-synth -q "$@" -o .
	cp sentences.jsonl sentences
	run import gs-import -q --images images --test-views "$(cat test-views)" -o scene point_cloud.ply
	run weigh gs-weigh -q --scale 0.5 -o weights scene
	run weigh-u8 gs-weigh -q --scale 0.3 --tolerance 0.02 --precision u8 --split all -o weights-u8 scene
	run weigh-packed gs-weigh -q --scale 0.3 --tolerance 0.02 --packed --split all -o weights-packed scene
	run encode text-encode -q --model "$bert" -o text sentences
	run parse text-parse -q -o parses.jsonl text
	run grammar text-parse -q --method grammar -o grammar.jsonl text
	for method in ciou iou top1; do
		run "select-$method" pseudomask-select -q --method $method -o "masks-$method" candidates.jsonl
	done
	for method in first scene; do
		run "select-$method" pseudomask-select -q --method $method --scene scene --weights weights -o "masks-$method" candidates.jsonl
	done
	cp masks-ciou masks
	models 60 1
	for model in lifted trained warm; do
		run "score-$model" miou-score --truth truth.jsonl --predicted-views --parses parses.jsonl --bootstrap 50 --json "render-$model.jsonl"
		run "text-score-$model" miou-score --truth truth.jsonl --compare render-lifted-masks.jsonl --bootstrap 50 "render-$model.jsonl"
		run "box-score-$model" miou-score --boxes --truth boxes.jsonl "locate-$model.jsonl"
	done
	run whole miou-score --truth truth.jsonl --whole whole.jsonl amodal-lifted.jsonl
	printf '%s\n' 'the small/P1:smaller mug/T on/P2:on the plate/A2' 'the red/a box/T near/P1:near the lamp/A1, not the kettle/X' >marked
	run marked parse-train -q --sentences -o marked.jsonl marked
	run encode-marked text-encode -q --model "$bert" -o marked.text marked.jsonl
	run learn parse-train -q --epochs 2 --text marked.text -o parser marked
	cd ..
}

# A real scene, at a small size.
real() {
	mkdir real && cd real
	cp "$data/sentences.jsonl" sentences
	run import gs-import -q --cameras "$data/sparse/0" --images "$data/images" -o scene "$data/point_cloud.ply"
	run weigh gs-weigh -q --scale 0.1667 -o weights scene
	run encode text-encode -q --model "$bert" -o text sentences
	run select pseudomask-select -q --scene scene --weights weights -o masks "$data/candidates.jsonl"
	models 100 0.125
	cd ..
}

for side in a b; do
	mkdir "$work/$side"
	[ $side = a ] && version=$1 || version=$2
	tools=$(tools_of $side "$version")
	(
		cd "$work/$side"
		PATH=$tools:$PATH
		synthetic table --objects 5 --views 8 --size 128x96 --gaussians 3000
		synthetic tea --scene tea --objects 8 --views 8 --size 128x96 --gaussians 4000 --seed 3
		[ -z "$data" ] || real
	)
done
cd "$work"
files=$(find a -type f | wc -l)
failed=$(find a -name '*.status' -exec grep -Lx 0 {} + | wc -l)
diff -rq a b || exit 1
echo "$files files are the same; $failed of $(find a -name '*.status' | wc -l) commands failed in both"
