#!/usr/bin/env bats
# What bash and zsh complete: scripts that the build makes of each tool's --help.

setup() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	made=$BIN/../completion
	cd "$BATS_TEST_TMPDIR"
	mkdir -p folder/inner
	touch file.ply "with blank.ply"
}

# The long options of a tool, one a line.
options_of() { "$BIN/$1" --help | sed -nE 's/^ +(-.,)? *--([a-z0-9-]+).*/--\2/p'; }

# complete WORD...: what bash makes of the last word of a command line, one a line, sorted.
complete_line() {
	bash -c 'source "$0/$1" && COMP_WORDS=("$@") COMP_CWORD=$(($# - 1)) && _${1//-/_} 2>/dev/null && ((${#COMPREPLY[@]})) &&
		printf "%s\n" "${COMPREPLY[@]}"' "$made/bash" "$@" | sort
}

@test "a script of each tool for each shell, and no others" {
	[ "$(ls "$made/bash")" = "$(ls "$BIN")" ]
	[ "$(ls "$made/zsh")" = "$(ls "$BIN" | sed 's/^/_/')" ]
}

@test "bash: every option of every tool" {
	for tool in "$BIN"/*; do
		tool=${tool##*/}
		diff <(complete_line "$tool" --) <(options_of "$tool" | sort)
	done
}

@test "bash: the script is registered for its tool, and no tool has another's function" {
	for tool in "$BIN"/*; do
		tool=${tool##*/}
		[ "$(bash -c 'source "$0" && complete -p '"$tool" "$made/bash/$tool")" = "complete -o filenames -F _${tool//-/_} $tool" ]
	done
}

@test "bash: an option begun, its choices, and with =" {
	[ "$(complete_line gs-transform --sp)" = --spz-version ]
	[ "$(complete_line gs-transform --format "" | tr '\n' ' ')" = "$(printf '%s\n' auto ply splat spz $(more_formats) | sort | tr '\n' ' ')" ]
	[ "$(complete_line gs-transform --format spl)" = splat ]
	[ "$(complete_line gs-transform --format = spl)" = splat ]
	[ "$(complete_line gs-transform --format = | wc -l)" -ge 4 ]
	[ "$(complete_line gs-transform file.ply --format a)" = auto ]
}

# The formats of --help beside those four.
more_formats() { "$BIN/gs-transform" --help | sed -n 's/.*--format auto|ply|splat|spz|\([a-z|]*\).*/\1/p' | tr '|' ' '; }

@test "bash: files, folders, and numbers that are neither" {
	[ "$(complete_line gs-transform f | tr '\n' ' ')" = "file.ply folder " ]
	[ "$(complete_line gs-transform w)" = "with blank.ply" ]
	[ "$(complete_line gs-transform -o f | tr '\n' ' ')" = "file.ply folder " ]
	[ "$(complete_line refer-locate --each f)" = folder ]
	[ -z "$(complete_line gs-transform --scale f)" ]
	[ -z "$(complete_line gs-transform --crop f)" ]
}

@test "zsh: each option has a line, with its choices and files" {
	for tool in "$BIN"/*; do
		tool=${tool##*/}
		head -n 1 "$made/zsh/_$tool" | grep -qx "#compdef $tool"
		diff <(sed -nE "s/^	'\*(--[a-z0-9-]+).*/\1/p" "$made/zsh/_$tool") <(options_of "$tool")
	done
	grep -F -- "'*--format=[" "$made/zsh/_gs-transform" | grep -F "(auto ply splat spz"
	grep -qE -- "^	'\*--each=\[.*\]:DIR:_files -/' \\\\$" "$made/zsh/_refer-locate"
	grep -qE -- "^	'\*-o\+\[.*\]:FILE:_files' \\\\$" "$made/zsh/_gs-transform"
}

# typed TOOL WORDS: the words that zsh hands to the tool, typed at a terminal with a tab after them.
typed() {
	rm -f said ready
	timeout 20 zsh -f typed.zsh "$made/zsh" "$@" && cat said
}

@test "zsh: what is typed is completed" {
	command -v zsh >/dev/null || skip "zsh is not installed"
	for tool in "$BIN"/*; do zsh -n "$made/zsh/_${tool##*/}"; done
	cat >typed.zsh <<-'END'
		zmodload zsh/zpty
		zpty shell "env TERM=dumb zsh -f -i"
		zpty -w shell "PROMPT= fpath=($1 \$fpath); autoload -Uz compinit; compinit -u -D
			$2() { print -r -- \"\$*\" >said.new && mv said.new said; }; : >ready"
		until [[ -e ready ]]; do sleep 0.05; done
		zpty -w -n shell "$2 $3"$'\t'
		sleep 0.3
		zpty -w -n shell $'\r'
		until [[ -e said ]]; do sleep 0.05; zpty -r -t shell out; done
		zpty -d shell
	END
	[ "$(typed gs-transform --spz)" = --spz-version ]
	[ "$(typed gs-transform "--format spl")" = "--format splat" ]
	[ "$(typed gs-transform --format=au)" = --format=auto ]
	[ "$(typed gs-transform "-o fil")" = "-o file.ply" ]
	[ "$(typed refer-locate "--each f")" = "--each folder" ]
	[ "$(typed refer-locate "--show rem")" = "--show removed" ]
}

