#!/usr/bin/env bats
# The table of systems, on the smallest scene there is.
# Parts: pipelines/(systems|published).* cmd/feature-.*

setup_file() {
	export BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	BIN=$(cd "$BIN" && pwd)
	export ROOT=$BATS_TEST_DIRNAME/../.. OUT=$BATS_FILE_TMPDIR/out
	systems >"$BATS_FILE_TMPDIR/table" 2>"$BATS_FILE_TMPDIR/err"
}

# systems ARGUMENT...: the pipeline on one tiny scene.
systems() {
	make -f "$ROOT/pipelines/systems.mk" OUT="$OUT" SCENES=diner SEEDS=1 BIN="$BIN" BERT="$ROOT/tests/golden/bert" \
		SYNTH="--objects 3 --views 6 --size 64x48 --gaussians 1500" TRAIN="--iterations 20" "$@"
}

setup() { cd "$BATS_TEST_TMPDIR"; }

not() { ! "$@"; }

@test "a row for each system and stand-in, with all figures" {
	cd "$OUT"
	sed -n '/^### /,$p' "$BATS_FILE_TMPDIR/table" | cmp systems.md
	[ "$(grep -c '^| .* | [0-9.]* | [0-9.]* | [0-9.]* | [0-9]* | [0-9]* |$' systems.md)" = 15 ]
	[ "$(grep -c '^| .* | [0-9.]* | [0-9.]* | - | - | - |$' systems.md)" = 1 ]
	[ "$(grep -c '| stand-in: ' systems.md)" = 13 ]
	grep -qE "^\| Grounded SAM: masks of each view alone \| 15.8 \| stand-in: a synthetic detector's masks of the test view itself \| [0-9]" systems.md
	grep -qE '^\| LangSplat: relevancy, pixels \| 13.9 \| stand-in: names of true masks \| ' systems.md
}

@test "the figures are those of the files" {
	cd "$OUT/diner-1"
	miou=$(jq '.miou * 100' answers/truth-hyperplane.test.score.json)
	bytes=$(($(wc -c <truth/features.safetensors) / 1500))
	grep -F 'GOI: hyperplane | 20.5 | stand-in: names of true masks' ../systems.md |
		grep -qE "\| $(printf %.1f "$miou") \|.* $bytes \|$"
	"$BIN/gs-check" answers/truth-relevancy2d.test.jsonl
	jq -se 'length > 0 and all(.[]; has("peak"))' answers/truth-cosine2d.test.jsonl
	"$BIN/gs-check" selected/truth-cosine.test.safetensors | grep -q 'refer.selection, 3 sentences'
	not grep -q '2"' text/names.jsonl
	[ "$(jq -r .text text/canonical.jsonl | paste -sd' ')" = "object things stuff texture" ]
}

@test "Grounded SAM's row: the most confident mask of each view and sentence, or none" {
	cd "$OUT/diner-1"
	for split in test train; do
		jq -r --arg split $split 'select(.split == $split).ref' data/sentences.jsonl | sort >"$BATS_TEST_TMPDIR/refs"
		[ "$(jq -r .view answers/views-sam.$split.jsonl | sort -u)" = "$(tr , '\n' <data/test-views | sort)" ]
		for view in $(tr , ' ' <data/test-views); do
			jq -r --arg v "$view" 'select(.view == $v).ref' answers/views-sam.$split.jsonl | sort | cmp - "$BATS_TEST_TMPDIR/refs"
		done
		while IFS=$'\t' read -r view ref score; do
			most=$(jq -r --arg v "$view" --arg r "$ref" 'select(.view == $v and .ref == $r).score' data/candidates.test.jsonl | sort -g | tail -n 1)
			[ "$score" = "${most:-0}" ]
		done < <(jq -r '[.view, .ref, .score] | @tsv' answers/views-sam.$split.jsonl)
	done
	jq -e '.missing == 0 and .pairs > 0' answers/views-sam.test.score.json
}

@test "a second run makes nothing, and another option what depends on it" {
	touch stamp
	systems >again
	cmp again "$OUT/systems.md"
	[ -z "$(find "$OUT" -name '*.safetensors' -newer stamp)" ]
	systems PRUNE=0.25 >other
	made=$(cd "$OUT/diner-1" && find . -name '*.safetensors' -newer "$OLDPWD/stamp" | LC_ALL=C sort)
	[ "$(grep -c selected <<<"$made")" = 12 ] || { echo "$made"; false; }
	[ "$(grep -v selected <<<"$made" | paste -sd' ')" = "./detector/features.safetensors ./truth/features.safetensors" ]
	run make -f "$ROOT/pipelines/systems.mk" OUT="$OUT" SCENES='a;b'
	[ "$status" = 2 ]
	[[ $output == *"SCENES has a ;"* ]]
	make -f "$ROOT/pipelines/systems.mk" help | grep -q '^PRUNE '
}
