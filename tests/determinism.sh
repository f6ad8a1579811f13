#!/usr/bin/env bash
# Which bytes depend on what: every tool that computes with threads runs with 1, 2, 3, 7, 16 and 64 of them, twice with 3, and with
# plain and AVX2 kernels in place of the machine's widest. usage: tests/determinism.sh BIN [quick]
# Prints two Markdown tables: the outputs that are equal to those of one thread, and how far the kernels' answers are apart. The status
# is 1 where threads or repetition matter, where AVX2 gives other bytes than AVX-512, or where plain kernels are further apart than the
# bounds in the table. KEEP is a folder for what was made.
set -u
here=$(cd "$(dirname "$0")/.." && pwd)
bin=$(cd "$1" && pwd)
gaussians=20000 size=160x120 threads="2 3 7 16 64"
[ "${2:-}" != quick ] || gaussians=3000 size=64x48 threads="7"
export OMP_WAIT_POLICY=passive PATH=$bin:$PATH
unset OMP_NUM_THREADS OMP_THREAD_LIMIT
work=${KEEP:-$(mktemp -d)}
mkdir -p "$work"
[ -n "${KEEP-}" ] || trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
gs-synth -q --objects 5 --views 8 --size $size --gaussians $gaussians -o from || exit 1
cd from || exit 1
gs-import -q --images images --test-views "$(cat test-views)" -o scene point_cloud.ply
gs-weigh -q -o weights scene
text-encode -q --model "$here/tests/golden/bert" -o text sentences.jsonl
pseudomask-select -q -o masks candidates.jsonl
files='--scene ../from/scene --weights ../from/weights --text ../from/text --masks ../from/masks'
refer-lift -q ${files//..\/from\//} -o lifted
feature-lift -q --scene scene --weights weights --masks masks --text text -o features
refer-train -q ${files//..\/from\//} --iterations 40 -o trained || exit 1
cd ..

# NAME and command, which takes --threads and writes into the current folder.
commands() {
	cat <<-END
		gs-weigh gs-weigh -q -o weights ../from/scene
		gs-weigh-packed gs-weigh -q --packed --tolerance 0.02 -o packed ../from/scene
		text-encode text-encode -q --model $here/tests/golden/bert -o text ../from/sentences.jsonl
		pseudomask-select pseudomask-select -q --scene ../from/scene --weights ../from/weights -o selected ../from/candidates.jsonl
		refer-lift refer-lift -q $files -o lifted
		feature-lift feature-lift -q --scene ../from/scene --weights ../from/weights --masks ../from/masks --text ../from/text -o features
		feature-query feature-query -q --rule hyperplane --positives ../from/lifted --text ../from/text -o selection ../from/features
		refer-train refer-train -q $files --iterations 40 -o trained
		refer-train-exact refer-train -q $files --iterations 8 --share 0 --negatives 0 --batch 3 --precision f32 -o exact
		refer-render-lifted refer-render -q --scene ../from/scene --text ../from/text --model ../from/lifted --split all --response response --response-type npy -o predictions
		refer-render-trained refer-render -q --scene ../from/scene --text ../from/text --model ../from/trained --split all --response response --response-type npy -o predictions
		refer-locate refer-locate -q --scene ../from/scene --text ../from/text --model ../from/lifted -o boxes
	END
}

# run FOLDER [OPTION]...: all commands, each in a folder of its own.
run() {
	local folder=$1 name command
	shift
	while read -r name command; do
		mkdir -p "$folder/$name"
		# One level up is where `from` is looked for.
		[ -e "$folder/from" ] || ln -s ../from "$folder/from"
		(cd "$folder/$name" && $command "$@" </dev/null) || { echo "$name $*: failed" >&2; failed=1; }
	done < <(commands)
}
failed=0
run 1 --threads 1
for n in $threads again; do
	run $n --threads ${n/again/3}
done
echo "| tool |$(for n in $threads; do printf ' %s threads |' $n; done) 3 threads again |"
echo "|---|$(for n in $threads again; do printf -- '---|'; done)"
while read -r name command; do
	printf '| `%s` |' "$name"
	for n in $threads again; do
		if diff -rq "1/$name" "$n/$name" >/dev/null; then
			printf ' equal |'
		else
			printf ' DIFFERS |'
			failed=1
		fi
	done
	echo
done < <(commands)

# apart A B: the largest difference between the response maps of two folders, and the largest response.
apart() {
	(cd "$1" && find . -name '*.npy' | sort) | while read -r file; do
		paste <(tail -c +129 "$1/$file" | od -An -v -w4 -t f4) <(tail -c +129 "$2/$file" | od -An -v -w4 -t f4)
	done | awk '{ d = $1 - $2; d = d < 0 ? -d : d; if (d > most) most = d; a = $1 < 0 ? -$1 : $1; if (a > largest) largest = a }
		END { printf "%.1e %.3g %s\n", most, largest, (NR && most <= 1e-4 * largest) ? "ok" : "FAR" }'
}
# masks A B: how many masks of A are not the same in B, and how many A has.
masks() {
	echo "$(comm -23 <(jq -c '[.view, .ref, .segmentation]' "$1" | sort) <(jq -c '[.view, .ref, .segmentation]' "$2" | sort) | wc -l) of $(wc -l <"$1")"
}
echo
echo "| kernels, beside the widest | outputs that are equal | lifted: responses differ by at most | trained: responses differ by at most | masks that differ |"
echo "|---|---|---|---|---|"
for level in avx2 plain; do
	avx2_ok=ok
	REFERSPLAT_CPU=$level run $level --threads 3
	equal= others=
	while read -r name command; do
		if diff -rq "1/$name" "$level/$name" >/dev/null; then
			equal+="${equal:+, }$name"
		else
			others+="${others:+, }$name"
		fi
	done < <(commands)
	[ $level != avx2 ] || [ -z "$others" ] || avx2_ok=
	read -r lifted of_lifted ok <<<"$(apart 1/refer-render-lifted $level/refer-render-lifted)"
	read -r trained of_trained ok2 <<<"$(apart 1/refer-render-trained $level/refer-render-trained)"
	[ "$ok $ok2 $avx2_ok" = "ok ok ok" ] || { failed=1; level="FAILED: $level"; }
	echo "| $level | $([ -n "$others" ] && echo "${equal:-none}" || echo all) | $lifted of $of_lifted | $trained of $of_trained | $(masks 1/refer-render-lifted/predictions "${level#FAILED: }/refer-render-lifted/predictions") lifted, $(masks 1/refer-render-trained/predictions "${level#FAILED: }/refer-render-trained/predictions") trained |"
done
exit $failed
