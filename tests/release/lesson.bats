#!/usr/bin/env bats
# The lesson of refersplat(7): every command of it, one after the other in an empty folder; and with the real encoder, where that is, what the
# lesson says that they answer.
# Parts: man/refersplat.7 cmd/[a-z-]*.c pipelines/(lift|two-stage|common).mk

setup_file() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	export cache=${ENCODER_CACHE:-${XDG_CACHE_HOME:-$HOME/.cache}/refersplat/encoder}
	export lesson=$BATS_FILE_TMPDIR/lesson.sh
	load ../cli/pasted
	pasted "$BATS_TEST_DIRNAME/../../man/refersplat.7" "A LESSON" ENVIRONMENT >"$lesson"
}

setup() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	cd "$BATS_TEST_TMPDIR"
}

# follow ENCODER: the lesson in the folder `here`, with all that it says in `said`.
follow() {
	mkdir -p home/.cache/refersplat here
	ln -s "$1" home/.cache/refersplat/encoder
	(cd here && env -u XDG_CACHE_HOME HOME="$BATS_TEST_TMPDIR/home" OMP_WAIT_POLICY=passive PATH="$BIN:$PATH" \
		bash -eu "$lesson" >../said 2>../err </dev/null) || { tail -n 5 said err; return 1; }
}

# What the lesson leaves in the folder here.
left() {
	for file in tea/overlays books.png labelled.ply objects labels.jsonl mug.sog; do [ -e "here/$file" ] || { echo "no $file"; return 1; }; done
	[ "$(wc -l <here/labels.jsonl)" = 13 ]
	[ "$(ls here/objects | wc -l)" = 13 ]
	grep -qE '^mug\.sog: ok: sog, [1-9][0-9]+ gaussians' said
	grep -qE '^mIoU +[0-9.]+ %$' said
}

@test "every command runs, and leaves what the lesson says" {
	[ ! -e "$cache/config.json" ] || skip "the next test does the same with the real encoder"
	[ "$(grep -c '^[a-z]' "$lesson")" -ge 18 ]
	# a tiny encoder: its answers are nothing to go by, and one that it refuses is no mistake here
	sed -i 's/^\(refer-ask .*"\)$/\1 || [ $? = 1 ]/; s/^\("how far.*"\)$/\1 || [ $? = 1 ]/' "$lesson"
	sed -i 's/^refer-ask -o books.png.*/& ; touch books.png/' "$lesson"
	follow "$(cd "$BATS_TEST_DIRNAME/../golden/bert" && pwd)"
	left
}

@test "with the real encoder the answers are those of the page" {
	[ -e "$cache/config.json" ] || skip "make encoder has not been run"
	follow "$cache"
	left
	# nothing but that sentences told look-alikes apart
	[ -z "$(grep -v 'masks that a detector found for others, as their sentences say' err)" ]
	# what is found, up to its percentage
	sed -n '/^\.Ss Questions/,/^\.Ss Masks/p' "$BATS_TEST_DIRNAME/../../man/refersplat.7" | sed -n '/^\.Bd/,/^\.Ed/p' | grep -v '^\.' |
		sed 's/ *\.\.\..*//' >answers
	[ "$(wc -l <answers)" = 5 ]
	while read -r answer; do grep -qF -- "$answer" said || { echo "not said: $answer"; cat said; false; }; done <answers
	grep -qx 1 said
	# most of the masks are right
	awk '$1 == "mIoU" && $2 > 60 { good = 1 } END { exit !good }' said
	gaussians=$(sed -nE 's/^mug\.sog: ok: sog, ([0-9]+) gaussians.*/\1/p' said)
	[ "$gaussians" -ge "$(jq 'select(.object == "green mug").count' here/labels.jsonl)" ]
}
