#!/usr/bin/env bash
# Kills tools amid their work, runs the same command again, and compares all that it leaves with what an undisturbed run leaves.
# usage: tests/kill.sh BIN COUNT [TOOL...]: COUNT kills of each tool (default: splats import weigh select lift train render pipeline), each
# at a random moment of the time that an undisturbed run takes. SEED picks the moments, KEEP is a folder for what was made.
# Prints for each tool how many kills there were and after how many the second run left the same bytes; at last "N passed, N failed".
set -u
here=$(cd "$(dirname "$0")/.." && pwd)
bin=$(cd "$1" && pwd) count=$2
shift 2
[ $# != 0 ] || set -- splats import weigh select lift train render pipeline
export OMP_WAIT_POLICY=passive PATH=$bin:$PATH
unset MAKEFLAGS MAKELEVEL MFLAGS
RANDOM=${SEED:-1}
work=${KEEP:-$(mktemp -d)}
mkdir -p "$work"
[ -n "${KEEP-}" ] || trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
gs-synth -q --objects 4 --views 8 --size 160x120 --gaussians 20000 -o from || exit 1
cd from || exit 1
gs-import -q --images images --test-views "$(cat test-views)" -o scene point_cloud.ply
gs-weigh -q -o weights scene
text-encode -q --model "$here/tests/golden/bert" -o text sentences.jsonl
pseudomask-select -q -o masks candidates.jsonl
refer-lift -q --scene scene --weights weights --text text --masks masks -o lifted || exit 1
cd ..

# command TOOL: the command, which writes into the folder out.
command_of() {
	local from='--scene ../from/scene --weights ../from/weights --text ../from/text --masks ../from/masks'
	case $1 in
	splats) echo "gs-train -q --cameras ../from/sparse/0 --images ../from/images --gaussians 1000 --iterations 100 --checkpoint 5 --resume --log out/losses -o out/splats.ply" ;;
	import) echo "gs-import -q --images ../from/images -o out/scene ../from/point_cloud.ply" ;;
	weigh) echo "gs-weigh -q --packed --tolerance 0.02 -o out/weights ../from/scene" ;;
	select) echo "pseudomask-select -q --scene ../from/scene --weights ../from/weights -o out/masks ../from/candidates.jsonl" ;;
	lift) echo "refer-lift -q $from -o out/lifted" ;;
	train) echo "refer-train -q $from --iterations 40 --checkpoint 3 --resume --log out/losses -o out/model" ;;
	render) echo "refer-render -q --scene ../from/scene --text ../from/text --model ../from/lifted --split all --png out/png --overlay out/overlay -o out/predictions" ;;
	pipeline) echo "make -s -j2 -f $here/pipelines/lift.mk SCENE=out/kitchen SPLATS=../from/point_cloud.ply CAMERAS=../from/sparse/0 IMAGES=../from/images SENTENCES=../from/sentences.jsonl CANDIDATES=../from/candidates.jsonl BERT=$here/tests/golden/bert TEST_VIEWS=every:4 BIN=$bin" ;;
	*) echo "$1: no such tool" >&2; exit 2 ;;
	esac
}

# same A B: both folders hold the same files, and the same bytes, but for a pipeline's logs of times.
same() {
	diff -rq --exclude=log --exclude='*.log' "$1" "$2"
}

passed=0 failed=0
for tool; do
	command=$(command_of "$tool") || exit 2
	rm -rf "$tool" && mkdir -p "$tool/out" && cd "$tool" || exit 1
	$command >said 2>&1 || { cat said; exit 1; }
	mv out whole
	mkdir out
	begin=$(date +%s%N)
	$command >said 2>&1 || { cat said; exit 1; }
	took=$((($(date +%s%N) - begin) / 1000))
	hit=0 good=0
	# One that ended before it was killed does not count.
	for ((tries = 0; tries < 20 * count && hit < count; tries++)); do
		rm -rf out && mkdir out
		# A pipeline's tools are killed with it, and may take a moment to go; until then their files are a living run's.
		[ "$tool" = pipeline ] && group= || group=--foreground
		timeout $group -s KILL "$(awk -v us=$(((RANDOM * 32768 + RANDOM) % took + 1)) 'BEGIN { printf "%.6f", us / 1e6 }')" $command >said 2>&1
		[ $? = 137 ] || continue
		hit=$((hit + 1))
		[ "$tool" != pipeline ] || sleep 0.5
		if $command >said 2>&1 && same whole out; then
			good=$((good + 1))
		else
			cat said
		fi
	done
	cd ..
	printf '%-10s %4d kills, after %4d of which the second run left the same bytes\n' "$tool" $hit $good
	[ $good = $hit ] && [ $hit != 0 ] && passed=$((passed + 1)) || failed=$((failed + 1))
done 2> >(grep -v ' Killed ' >&2)
echo "$passed passed, $failed failed"
[ $failed = 0 ] && [ $passed != 0 ]
