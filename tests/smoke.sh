#!/usr/bin/env bash
# Each tool once, on the small scene of the manual pages' examples, with a debugger before its name.
# usage: tests/smoke.sh BIN [COMMAND...], for instance: tests/smoke.sh build/bin valgrind -q --error-exitcode=99. Ends with "N passed, N failed".
set -u
here=$(cd "$(dirname "$0")" && pwd)
bin=$(cd "$1" && pwd) || exit 1
shift
export LSAN_OPTIONS=suppressions=$here/leaks.supp:print_suppressions=0
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
"$here/cli/examples-setup.sh" "$dir" "$bin" || exit 1
passed=0 failed=0
printf '%s\n' '{"do":"ask","question":"where is the box?"}' '{"do":"pick","view":"view_001","x":30,"y":20}' '{"do":"things"}' \
	'{"do":"label","outline":{"view":"view_001","points":[[1,1],[20,1],[20,20]]},"name":"cup"}' '{"do":"label","remove":"cup"}' >"$dir/requests"
cp -r "$dir/weights" "$dir/kitchen"
while read -r line; do
	if (cd "$dir" && "$@" "$bin"/$line >/dev/null <requests); then
		passed=$((passed + 1))
	else
		failed=$((failed + 1))
		echo "FAILED: $line"
	fi
done <<-'END'
	gs-check scene weights text.safetensors model.safetensors masks.jsonl point_cloud.ply
	gs-import -q --images images -o scene2 point_cloud.ply
	gs-transform -q --drop-strays --rotate 1,2,3:40 -o moved.spz point_cloud.ply
	gs-transform -q --known 0,0,0,1,0,0=2 --up-from sparse/0 -o moved.glb point_cloud.ply
	gs-transform -q -o moved.sog moved.glb
	gs-check moved.spz moved.glb moved.sog
	gs-weigh -q --scale 0.5 -o weights2 scene
	text-encode -q --model encoder -o text2.safetensors sentences.jsonl
	gs-synth -q --scene tea --objects 4 --views 6 --size 48x36 --gaussians 1200 -o synth
	pseudomask-select -q -o masks2.jsonl candidates.jsonl
	pseudomask-select -q --method first --scene scene --weights weights -o masks3.jsonl candidates.jsonl
	refer-train -q --scene scene --weights weights --text text.safetensors --masks masks.jsonl --iterations 2 -o model2.safetensors
	refer-render -q --scene scene --text text.safetensors --model model.safetensors --png png -o pred2.jsonl
	pseudomask-select -q --scene scene --weights weights -o masks4.jsonl candidates.jsonl
	refer-lift -q --scene scene --weights weights --text text.safetensors --masks masks.jsonl -o lifted.safetensors
	refer-render -q --scene scene --text text.safetensors --model lifted.safetensors --amodal -o whole2.jsonl
	refer-locate -q --scene scene --text text.safetensors --model lifted.safetensors -o boxes2.jsonl
	refer-locate -q --all --scene scene --model lifted.safetensors --ply labelled.ply --each objects -o labels.jsonl
	mask-export -q --scene scene --png tree -o coco.json masks.jsonl
	refer-train -q --scene scene --weights weights --text text.safetensors --masks masks.jsonl --init lifted.safetensors --init-iterations 2 --iterations 4 -o model3.safetensors
	text-parse -q -o parses.jsonl text.safetensors
	refer-serve -q --stdio --encoder encoder kitchen
	miou-score --truth truth.jsonl pred.jsonl
	miou-score --csv --truth truth.jsonl --bootstrap 20 --compare masks2.jsonl --parses parses.jsonl --whole whole.jsonl pred.jsonl
END
echo "$passed passed, $failed failed"
[ $failed = 0 ] && [ $passed != 0 ]
