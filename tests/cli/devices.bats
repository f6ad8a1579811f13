#!/usr/bin/env bats
# Devices that fail, for each tool: a full disk, a read error, a folder that cannot be written, a closed pipe. Each time the tool
# says so in one line that names the file, and ends with status 4; what was there stays, and nothing else does. The failures are
# those of failing.c, which is loaded into the tool.

setup_file() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	export OMP_WAIT_POLICY=passive OMP_NUM_THREADS=2
	cd "$BATS_FILE_TMPDIR"
	"$BATS_TEST_DIRNAME/examples-setup.sh" in "$BIN"
	(cd in && "$BIN/feature-lift" -q --scene scene --weights weights --masks masks.jsonl -o labels.safetensors &&
		mv kitchen/lifted/model.safetensors lifted.safetensors && cp lifted.safetensors kitchen/lifted/model.safetensors)
	(cd in && "$BIN/pseudomask-propose" -q --weights weights --regions regions.safetensors -o /dev/null scene)
	echo 'the wug/T' >in/marked
	"${CC:-cc}" -shared -fPIC -o failing.so "$BATS_TEST_DIRNAME/failing.c" -ldl
}

setup() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	SHIM=$BATS_FILE_TMPDIR/failing.so
	if grep -q __asan_init "$BIN/gs-check"; then skip "nothing can be loaded before a sanitizer"; fi
	"${CC:-cc}" -dM -E - </dev/null | grep -q __linux__ || skip "failing.c is for Linux"
	cd "$BATS_TEST_TMPDIR"
}

# What each tool does, where it writes one file, out; the first file that it reads through a stream, and the first that it maps.
commands() {
	cat <<-END
		gs-train --quiet --cameras sparse/0 --images images --gaussians 50 --iterations 2 -o out
		gs-transform --format ply -o out point_cloud.ply
		gs-transform --format splat -o out point_cloud.ply
		gs-transform --format spz -o out point_cloud.ply
		gs-transform --format sog -o out point_cloud.ply
		gs-transform --format glb -o out point_cloud.ply
		text-encode --quiet --model encoder -o out sentences.jsonl
		text-parse --quiet -o out text.safetensors
		parse-train --sentences -o out marked
		pseudomask-select -o out candidates.jsonl
		pseudomask-propose --weights weights -o out scene
		mask-pick --regions regions.safetensors --weights weights --name box --point view_001:32,24 -o out scene
		mask-import -o out labels.json
		mask-export -o out truth.jsonl
		box-detect --quiet --model detector -o out images/view_001.png
		refer-lift --scene scene --weights weights --text text.safetensors --masks masks.jsonl -o out
		refer-train --scene scene --weights weights --text text.safetensors --masks masks.jsonl --iterations 5 -o out
		refer-train --scene scene --weights weights --text text.safetensors --masks masks.jsonl --iterations 5 --memory 0 -o out
		feature-lift --scene scene --weights weights --masks masks.jsonl -o out
		feature-query --text text.safetensors --rule identity --positives lifted.safetensors -o out labels.safetensors
		refer-render --scene scene --text text.safetensors --model model.safetensors -o out
		refer-locate --scene scene --text text.safetensors --model model.safetensors -o out
		refer-ask --encoder encoder -o out kitchen box
		refer-say --quiet --encoder encoder --each 2 -o out kitchen
		refer-report -o out kitchen
		miou-score --truth truth.jsonl -o out pred.jsonl
	END
}

# Those that write a folder.
folders() {
	cat <<-END
		gs-import -o out point_cloud.ply
		gs-weigh -o out scene
		gs-synth --objects 2 --views 3 --size 32x24 --gaussians 1000 -o out
		mask-export --png out -o /dev/null truth.jsonl
		refer-render --scene scene --text text.safetensors --model model.safetensors --png out -o /dev/null
		refer-locate --scene scene --model lifted.safetensors --all --each out -o /dev/null
	END
}

@test "every tool that writes files is among them" {
	for tool in "$BIN"/*; do
		tool=${tool##*/}
		[ "$tool" = gs-check ] || [ "$tool" = refer-serve ] || { commands; folders; } | grep -q "^$tool " || { echo "$tool"; false; }
	done
}

# fails LIST REASON VARIABLE=VALUE...: each command of the list, with that failure, in a folder with `out` from before.
fails() {
	local list=$1 reason=$2 tool args bad=0 status
	shift 2
	while read -r tool args; do
		rm -rf here && cp -r "$BATS_FILE_TMPDIR/in" here
		cd here
		[ "$list" != commands ] || echo old >out
		find . ! -path './out*' | sort >../before
		status=0
		env LD_PRELOAD="$SHIM" "$@" "$BIN/$tool" $args >../stdout 2>../err </dev/null || status=$?
		find . ! -path './out*' | sort | cmp -s - ../before && [ "$status" = 4 ] && [ ! -s ../stdout ] &&
			[ "$(wc -l <../err)" = 1 ] && grep -qE "^$tool: $reason\$" ../err &&
			[ -z "$(find . -name '*.tmp.*')" ] && { [ "$list" != commands ] || [ "$(cat out)" = old ]; } ||
			{ echo "$status: $tool $args"; cat ../err; find . | sort | diff ../before -; bad=1; }
		cd ..
	done < <($list)
	[ "$bad" = 0 ]
}

@test "a full disk: at the first byte, at the end; a device that fails there" {
	[ -e "$SHIM" ]
	fails commands 'out: No space left on device' FAIL=28 FAIL_WRITE=0
	# where the system writes what it had put off
	fails commands 'out: Input/output error' FAIL=5 FAIL_CALL=fsync
	fails commands 'out: No space left on device' FAIL=28 FAIL_CALL=rename
	fails folders '(out|out/.*): No space left on device' FAIL=28 FAIL_WRITE=0
	fails folders '(out|out/.*): No space left on device' FAIL=28 FAIL_CALL=fsync
}

@test "a folder that cannot be written" {
	fails commands 'out: Permission denied' FAIL=13 FAIL_CALL=open
	fails folders '(out|out/.*): Permission denied' FAIL=13 FAIL_CALL=open
	fails folders '(out|out/.*): Read-only file system' FAIL=30 FAIL_CALL=open
}

streams() { commands | grep -vE '^(gs-transform|text-parse|parse-train|feature-query) '; }
maps() { commands | grep -vE '^(gs-train|parse-train|pseudomask-select|mask-import|mask-export|miou-score) '; }

@test "a read error, in files that are read and in those that are mapped" {
	fails streams '[^ ]+(\.jsonl?|\.png|/cameras.txt): Input/output error' FAIL=5 FAIL_READ=0
	fails streams '[^ ]+(\.jsonl?|\.png|/cameras.txt): Input/output error' FAIL=5 FAIL_READ=20
	fails maps '[^ ]+\.(safetensors|ply): it cannot be read, or was cut short meanwhile' FAIL_MAP=1
	cp -r "$BATS_FILE_TMPDIR/in" x
	status=0
	LD_PRELOAD=$SHIM FAIL_MAP=1 "$BIN/gs-check" x/scene x/sentences.jsonl >out 2>err || status=$?
	[ "$status" = 4 ]
	[ "$(cat err)" = "gs-check: x/scene/splats.safetensors: it cannot be read, or was cut short meanwhile" ]
}

@test "a closed pipe ends a tool quietly, or, where that signal is ignored, with a message" {
	cd "$BATS_FILE_TMPDIR/in"
	err=$BATS_TEST_TMPDIR/err
	while read -r tool args; do
		[ "$tool" = refer-ask ] && args=${args/-o out/} || args=${args/-o out/-o -}
		# The reader ends before anything is written.
		(sleep 0.1; "$BIN/$tool" $args 2>"$err") | true
		status=${PIPESTATUS[0]}
		[ "$status" = 141 ] && [ ! -s "$err" ] || { echo "$status $tool"; cat "$err"; false; }
		(trap '' PIPE; sleep 0.1; "$BIN/$tool" $args 2>"$err") | true
		status=${PIPESTATUS[0]}
		[ "$status" = 4 ] && [ "$(cat "$err")" = "$tool: stdout: Broken pipe" ] || { echo "$status $tool"; cat "$err"; false; }
	done < <(commands)
}

@test "a disk that is really full" {
	full() {
		mount -t tmpfs -o size=32k none disk && cd disk && echo old >out || exit 99
		head -c 24k /dev/zero >filling
		"$BIN/gs-transform" --format ply -o out "$BATS_FILE_TMPDIR/in/point_cloud.ply" 2>../err
		echo $? >../status
		ls -A >../left
		cat out >../old
	}
	export -f full
	export BIN BATS_FILE_TMPDIR
	mkdir disk
	unshare -rm bash -c full || skip "nothing can be mounted here"
	[ "$(cat status)" = 4 ]
	[ "$(cat err)" = "gs-transform: out: No space left on device" ]
	[ "$(cat old left)" = "$(printf 'old\nfilling\nout')" ]
}

@test "two runs into one output: each is whole, and the last one stays; a second training is refused" {
	cp -r "$BATS_FILE_TMPDIR/in" x
	cd x
	export -n OMP_NUM_THREADS
	for format in ply splat; do "$BIN/gs-transform" --format $format -o $format point_cloud.ply; done
	for i in 1 2 3 4 5; do
		"$BIN/gs-transform" --format ply -o out point_cloud.ply &
		first=$!
		"$BIN/gs-transform" --format splat -o out point_cloud.ply
		wait $first
		cmp -s out ply || cmp out splat
	done
	train=("$BIN/refer-train" -q --scene scene --weights weights --text text.safetensors --masks masks.jsonl --log l -o m)
	"${train[@]}" --iterations 100000 --checkpoint 10 &
	first=$!
	while [ ! -e m.checkpoint ] && kill -0 $first; do sleep 0.05; done
	status=0
	"${train[@]}" --iterations 5 2>err || status=$?
	kill -9 $first
	wait $first || true
	[ "$status" = 4 ]
	[ "$(cat err)" = "refer-train: m: another run is writing it" ]
	# Of one that was killed nothing is in the way.
	"${train[@]}" --iterations 20 --checkpoint 0
	[ "$(wc -l <l)" -le 1 ]
	[ -z "$(find . -name '*.tmp.*')" ]
}
