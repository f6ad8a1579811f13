#!/usr/bin/env bats
# refer-train from a lifted model. All else is in refer-train.bats.

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
	[[ "$(meta m1 options)" == *" --init-iterations 6 "* ]]
	train -o cold
	not cmp -s m1 cold
	train --init l -o m
	[[ "$(meta m options)" == *" --init-iterations 500 "* ]]
}

@test "a warm start fits what was lifted" {
	lifted l
	train --init l --iterations 400 --share 0 --precision f32 --log log -o m
	jq -se '.[0].iteration == 100 and .[3].bce < 0.01 and .[3].bce < 0.1 * .[0].bce' log
	[ "$(meta m blend)" = shares ]
	train --init l --iterations 11 --init-iterations 10 -o m
	[ "$(meta m blend)" = logits ]
}

@test "a training goes on to the same model from within the warm start, and from after it" {
	lifted l
	for warm in 80 30; do
		options=(--interaction none --init l --init-iterations $warm)
		[ $warm = 80 ] || options+=(--query parses)
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
