#!/usr/bin/env bats
# refer-train from a lifted model, and with masks held out. All else is in refer-train.bats.

load refer-train

# lifted FILE [OBJECT [GAUSSIANS]]: a lifted model of one object, "brown box" unless another is named: wholly the
# Gaussians 0 to 199 of the scene's 1000.
lifted() {
	local index= share= i header
	for ((i = 0; i < 200; i++)); do index+=$(printf '%02x000000' $i) share+=ff; done
	header='{"__metadata__":{"format":"refer.lifted","version":"1","gaussians":"'"${3:-1000}"'","names":"[\"'"${2:-brown box}"'\"]",
"texts":"[]","pieces":"[]"},
"indptr":{"dtype":"I64","shape":[2],"data_offsets":[0,16]},"offsets":{"dtype":"I64","shape":[1],"data_offsets":[16,24]},
"confidence":{"dtype":"F32","shape":[1],"data_offsets":[24,28]},"index":{"dtype":"I32","shape":[200],"data_offsets":[28,828]},
"share":{"dtype":"U8","shape":[200],"data_offsets":[828,1028]},"object":{"dtype":"I32","shape":[0],"data_offsets":[1028,1028]},
"words":{"dtype":"F16","shape":[0,8],"data_offsets":[1028,1028]}}'
	while ((${#header} % 8)); do header+=' '; done
	st "$1" "$header" "0000000000000000c800000000000000""0000000000000000""$f1$index$share"
}

@test "--init: a warm start, the same for any number of threads and from stdin" {
	lifted l
	for n in 1 2 3; do train --init l --init-iterations 6 --threads $n -o m$n; done
	cmp m1 m2
	cmp m1 m3
	train --init - --init-iterations 6 -o piped <l
	cmp m1 piped
	[[ "$(meta m1 options)" == *" --init-iterations 6 --hold-out 0 "* ]]
	train -o cold
	not cmp -s m1 cold
	train --init l -o m
	[[ "$(meta m options)" == *" --init-iterations 500 "* ]]
}

@test "a warm start fits what was lifted" {
	lifted l
	train --init l --iterations 400 --share 0 --precision f32 --log log -o m
	jq -se '.[0].iteration == 100 and .[3].bce < 0.01 and .[3].bce < 0.1 * .[0].bce' log
}

@test "a training goes on to the same model from within the warm start, and from after it" {
	lifted l
	for warm in 80 30; do
		options=(--interaction none --init l --init-iterations $warm)
		train "${options[@]}" --iterations 120 -o whole
		rm -f m m.checkpoint
		says 4 "refer-train: /dev/full: No space left on device" train "${options[@]}" --iterations 150 --checkpoint 50 -o m --log /dev/full
		[ "$(meta m.checkpoint iteration)" = 50 ]
		says 3 "refer-train: m.checkpoint: is of another training (its options or inputs differ); remove it or train without --resume" \
			train --resume --interaction none --init l --init-iterations 81 -o m
		lifted other "pink cone"
		says 3 "refer-train: m.checkpoint: is of another training (its options or inputs differ); remove it or train without --resume" \
			train --resume "${options[@]}" --init other -o m
		train "${options[@]}" --iterations 120 --resume -o m
		cmp whole m
	done
}

@test "--init that does not fit" {
	lifted l "brown box" 999
	refuses 3 "l: is of a scene of 999 Gaussians, scene has 1000" --init l
	lifted l "brown boy"
	refuses 3 "l: has no object of a training sentence of text.safetensors" --init l
	refuses 4 "none: No such file or directory" --init none
	refuses 3 "text.safetensors: format is 'refer.text', expected 'refer.lifted'" --init text.safetensors
	lifted l
	truncate -s -1 l
	run train --init l -o m
	[ "$status" = 3 ]
	[[ $output == "refer-train: l: "* ]]
	: >l
	refuses 3 "l: 0 bytes, too short for a safetensors file" --init l
}

@test "--hold-out: evaluations in the log, the best state in the model, and a stop" {
	held() { train --interaction none --hold-out 0.3 --patience 1 --feature-rate 0.02 --mlp-rate 0.0008 --iterations 20000 "$@"; }
	held -v --log log -o m 2>err
	grep -qx 'refer-train: 4 views, 3 sentences, 8 pairs, 4 more held out' err
	best=$(jq -s 'map(select(.held_iou)) | max_by(.held_iou).iteration' log)
	steps=$(jq -s 'last.iteration' log)
	[ "$steps" = $((best + 250)) ]
	[ "$steps" -lt 20000 ]
	grep -qE "^refer-train: $steps steps, the held-out masks were answered best after $best: IoU 0\.[0-9]{4}$" err
	[[ "$(meta m options)" == "--iterations $best "*" --hold-out 0.3 "* ]]
	jq -se 'map(select(.held_iou)) | all(.[]; .held_bce > 0 and .held_iou >= 0 and .held_iou <= 1) and .[0].iteration == 250' log
	for n in 1 2 3; do held --threads $n --iterations "$best" --log log$n -o best; cmp m best; done
	cmp log1 log2
	cmp log1 log3
	# The last step is evaluated too.
	train --interaction none --hold-out 0.3 --iterations 90 --log log -o last
	[ "$(jq -r 'select(.held_iou).iteration' log)" = 90 ]
	# Another seed holds out others.
	train --interaction none --hold-out 0.3 --iterations 90 --seed 2 -o other
	not cmp -s last other
}

@test "a training with held-out masks goes on to the same model and log, and stops at the same step" {
	held() { train --interaction none --hold-out 0.3 --patience 3 --feature-rate 0.02 --mlp-rate 0.0008 --iterations 5000 --checkpoint 200 -o "$@"; }
	held whole --log log
	"$BIN/refer-train" --scene scene --weights weights --text text.safetensors --masks masks.jsonl --interaction none --hold-out 0.3 \
		--patience 3 --feature-rate 0.02 --mlp-rate 0.0008 --iterations 5000 --checkpoint 200 -o part --log part.log &
	pid=$!
	for ((i = 0; i < 1000; i++)); do [ "$(meta part.checkpoint best_iteration 2>none)" -gt 0 ] 2>none && break; sleep 0.01; done
	kill -KILL $pid
	wait $pid || true
	[ -e part.checkpoint ]
	[ ! -e part ]
	held part --log part.log --resume
	cmp whole part
	cmp log part.log
	[ ! -e part.checkpoint ]
}

@test "nothing to hold out" {
	head -n 1 masks.jsonl >one.jsonl
	refuses 3 "one.jsonl: one pair of a view and an object, none to hold out" --hold-out 0.5 --masks one.jsonl
}
