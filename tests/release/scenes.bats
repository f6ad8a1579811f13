#!/usr/bin/env bats
# The named scenes of gs-synth: what their statistics must be, and that they stay what they are.
# Parts: libcommon/synth/.* cmd/synth/.* cmd/gs-synth.c

setup() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	load ../cli/differ
	cd "$BATS_TEST_TMPDIR"
}

@test "the named scenes are those that they were" {
	local scene sum
	while read -r scene sum; do
		"$BIN/gs-synth" --scene $scene --seed 81 --views 6 --size 64x48 --gaussians 3000 -o $scene
		[ "$(cd $scene && cat sentences.jsonl candidates.jsonl truth.jsonl test-views sparse/0/images.txt | sha256sum)" = "$sum  -" ]
	done <<-END
	diner 69128bb5878afb660c04ef35ea002d937b62950023aadf7e248b9e8c3037a26c
	toys 04e584da2ba76beddec76ea34390c65258ba2b569a426dffd77554d265b40f08
	tea 0ecc3236fe173e8507c7f6e2d4120c4007f87bfd9803e9e3f2504cb9865b93e2
	kitchen f3a9ea77bfa8cb1f67a91f30ba9d6cca3cb03a841f090826fbc3dac5942446ab
	END
}

# named SCENE OBJECTS ALIKE STACKED TRAINING TEST: what the statistics of the scene must be at its number of views.
named() {
	for seed in 1 2; do
		"$BIN/gs-synth" --scene $1 --seed $seed --size 123x91 --gaussians 10000 --threads 1 -o $1-$seed
		jq -e --argjson want "[$2,$3,$4,$5,$6]" '
			([.objects, .alike, .stacked, .views.train, .views.test] == $want) and
			(.sentences == {train: (4 * .objects), test: .objects}) and .gaussians == 10000 and
			(.words | .train >= 8 and .train <= 18 and .test >= 8 and .test <= 18)' $1-$seed/statistics.json
		# Of the test pairs about a fifth is less than half visible, some of it hardly; next to nothing is out of sight.
		jq -e '.visibility.test | ((."0" + ."<0.15" + ."0.15-0.5") as $hidden | $hidden >= 0.15 and $hidden <= 0.35) and
			."<0.15" >= 0.02 and ."<0.15" <= 0.1 and ."0" <= 0.03 and .outside <= 0.03 * .pairs' $1-$seed/statistics.json
		jq -e '.visibility | .test.pairs + .test.outside + .train.pairs + .train.outside' $1-$seed/statistics.json |
			grep -qx $(($2 * ($5 + $6)))
		# As a trained scene: a third faint, a third opaque, flakes and needles.
		jq -e '(.opacity | .[1] < 0.1 and .[2] > 0.15 and .[2] < 0.6 and .[3] > 0.9) and
			(.aspect | .[0] > 1.3 and .[2] > 5 and .[2] < 15 and .[4] > 100)' $1-$seed/statistics.json
	done
	differ $1-1/truth.jsonl $1-2/truth.jsonl
	differ $1-1/point_cloud.ply $1-2/point_cloud.ply
}

@test "--scene diner" {
	named diner 12 6 2 32 6
}

@test "--scene toys" {
	named toys 20 10 3 44 8
}

@test "--scene tea" {
	named tea 13 7 2 38 7
}

@test "--scene kitchen" {
	named kitchen 14 7 2 50 10
}
