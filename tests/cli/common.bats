#!/usr/bin/env bats
# What holds for every tool: help, version, usage errors, a missing file, and a manual page that says the same as --help
# and whose examples run.

setup() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	MAN=$BATS_TEST_DIRNAME/../../man
	cd "$BATS_TEST_TMPDIR"
}

setup_file() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	"$BATS_TEST_DIRNAME/examples-setup.sh" "$BATS_FILE_TMPDIR/examples" "$BIN"
}

# One command line for each tool that is right but for its input, which does not exist.
missing_input() {
	cat <<-END
		gs-check none
		gs-import -o out none
		gs-train --cameras none --images none -o out
		gs-transform --format ply -o out none
		gs-weigh -o out none
		text-encode --model none -o out none
		text-parse -o out none
		parse-train --text none -o out none
		pseudomask-select -o out none
		mask-pick --regions none --name x --point x:1,1 -o out none
		pseudomask-propose --weights none -o out none
		mask-import --names none -o out none
		box-detect --model none -o out none
		mask-export -o out none
		refer-train --scene none --weights none --text none --masks none -o out
		refer-lift --scene none --weights none --text none --masks none -o out
		feature-lift --scene none --weights none -o out none
		feature-query --text none -o out none
		refer-render --scene none --text none --model none -o out
		refer-locate --scene none --text none --model none -o out
		refer-ask -o out none question
		refer-say -o out none
		refer-report -o out none
		refer-serve none
		miou-score --truth none none
		gs-synth --seed 1 -o /dev/null/none
	END
}

# Calls "$@ TOOL" for each tool that is built, and fails, naming them, when any call fails.
each_tool() {
	local tool bad=0
	for tool in "$BIN"/*; do
		tool=${tool##*/}
		"$@" "$tool" || { echo "^ $tool"; bad=1; }
	done
	[ $bad = 0 ]
}

# Runs a command with its standard output in out and error in err, and sets status.
capture() {
	status=0
	"$@" >out 2>err </dev/null || status=$?
}

@test "every tool has a row in the table of this test" {
	row() { missing_input | grep -q "^$1 "; }
	each_tool row
}

@test "--help and -h print the same on stdout, and exit 0" {
	help() {
		capture "$BIN/$1" --help
		[ "$status" = 0 ] && [ ! -s err ] && grep -q "^Usage: $1 " out &&
			"$BIN/$1" -h | cmp - out
	}
	each_tool help
}

@test "--help is printed whatever else is on the line before it" {
	help() { capture "$BIN/$1" one two three --help && [ "$status" = 0 ] && grep -q '^Usage: ' out; }
	each_tool help
}

@test "--help fits 110 columns" {
	narrow() { ! "$BIN/$1" --help | grep -E '.{111}'; }
	each_tool narrow
}

@test "-V and --version print name and version" {
	version() {
		capture "$BIN/$1" -V
		[ "$status" = 0 ] && [ ! -s err ] && grep -qxE "$1 \(refersplat\) [0-9.]+" out && "$BIN/$1" --version | cmp - out
	}
	each_tool version
}

@test "a help that cannot be written is an error" {
	[ -e /dev/full ] || skip "no /dev/full"
	full() { ! "$BIN/$1" --help >/dev/full 2>err; }
	each_tool full
}

@test "an unknown option: exit 2, one line and where to look" {
	unknown() {
		local option shown
		for option in --no-such-option -%; do
			capture "$BIN/$1" $option
			shown=$(printf "%s: unknown option '%s'\nTry '%s --help'." "$1" "$option" "$1")
			[ "$status" = 2 ] && [ ! -s out ] && [ "$(cat err)" = "$shown" ] || { cat err; return 1; }
		done
	}
	each_tool unknown
}

@test "an option without its argument: exit 2" {
	bare() {
		local option
		for option in $("$BIN/$1" --help | sed -nE 's/^ +(-.,)? *--([a-z-]+) [^ ].*/\2/p' | sort -u); do
			"$BIN/$1" --help | grep -qE -- "--$option [A-Z<a-z]+[^ ]*( |$)" || continue
			capture "$BIN/$1" "--$option"
			[ "$status" = 2 ] && [ ! -s out ] && tail -n 1 err | grep -qx "Try '$1 --help'." || { cat err; return 1; }
		done
	}
	each_tool bare
}

@test "a missing input: exit 4, one line that names it, nothing on stdout, no file left" {
	absent() {
		local tool args
		read -r tool args < <(missing_input | grep "^$1 ")
		rm -rf empty && mkdir empty && cd empty
		capture_args=($args)
		status=0
		"$BIN/$1" "${capture_args[@]}" >../out 2>../err </dev/null || status=$?
		cd ..
		[ "$status" = 4 ] && [ ! -s out ] && [ "$(wc -l <err)" = 1 ] && grep -qE "^$1: .*none.*: " err &&
			[ -z "$(ls -A empty)" ] || { echo "status $status"; cat err; ls -A empty; return 1; }
	}
	each_tool absent
}

@test "the manual page names the options of --help and no others" {
	same() {
		"$BIN/$1" --help | sed -nE 's/^ +(-[A-Za-z], )?(--[a-z0-9-]+).*/\1 \2/p' | tr -d , | tr -s ' ' '\n' | grep . |
			sort >of-help
		sed -n '/^\.Sh OPTIONS/,/^\.Sh EXIT/p' "$MAN/$1.1" | grep '^\.It Fl' | grep -oE 'Fl (Fl )?-?[A-Za-z0-9-]+' |
			sed -E 's/Fl Fl /--/; s/Fl /-/' | sort -u >of-man
		diff of-help of-man
	}
	each_tool same
}

@test "manual pages have no mdoc mistakes" {
	command -v mandoc || skip "mandoc is not installed"
	page() { mandoc -T lint -W warning "$MAN/$1.1"; }
	each_tool page
}

@test "manual pages have the sections, in order" {
	sections() {
		[ "$(sed -n 's/^\.Sh //p' "$MAN/$1.1" | sed '/^OPTIONS$/{n;/^ENVIRONMENT$/d}' | tr '\n' ,)" = \
			"NAME,SYNOPSIS,DESCRIPTION,OPTIONS,EXIT STATUS,EXAMPLES,SEE ALSO," ]
	}
	each_tool sections
}

# In one folder, in order, which has a file of each kind; as a terminal of 80 columns shows them.
@test "the examples of the manual pages run as they are pasted" {
	command -v mandoc || skip "mandoc is not installed"
	load pasted
	examples() {
		local script=$BATS_TEST_TMPDIR/$1.sh
		pasted "$MAN/$1.1" EXAMPLES "SEE ALSO" >"$script"
		[ -s "$script" ] || return 1
		[ "$(wc -l <"$script")" = "$(sed -n '/^\.Sh EXAMPLES/,/^\.Sh SEE/p' "$MAN/$1.1" | grep -c '^\.Dl')" ] || { echo "a line is wider than the terminal"; cat "$script"; return 1; }
		rm -rf here && cp -r "$BATS_FILE_TMPDIR/examples" here
		(cd here && XDG_CACHE_HOME=$PWD/cache PATH=$BIN:$PATH bash -eu -o pipefail "$script" >../out 2>&1 </dev/null) || { cat "$script" out; return 1; }
	}
	each_tool examples
}

@test "manual pages: no prose as flags, no blank before a comma, every option in the synopsis, every page that is named in SEE ALSO" {
	command -v mandoc || skip "mandoc is not installed"
	sound() {
		local page=$1 tool=$(basename "${1%.*}") shown
		shown=$(mandoc -T utf8 -O width=200 "$page" | col -bx)
		! grep -nE '^ {5}.*(^| )-[a-z]{3,}|[a-z)’] , |[a-z)’] \. ' <<<"$(grep -vE '^ {11}|[_=]|\(-l' <<<"$shown")" || return 1
		grep -oE '^\.Xr [a-z-]+ [137]' "$page" | cut -d' ' -f2,3 | sort -u | while read -r name part; do
			[ "$name" = "$tool" ] || [ ! -e "$MAN/$name.$part" ] || sed -n '/^\.Sh SEE ALSO/,$p' "$page" | grep -q "^\.Xr $name $part" ||
				{ echo "$page: $name is not in SEE ALSO"; exit 1; }
		done || return 1
		[ -x "$BIN/$tool" ] || return 0
		"$BIN/$tool" --help | sed -nE 's/^ +(-., )?(--[a-z0-9-]+).*/\2/p' | grep -vxE -- '--(help|version|verbose|quiet|output|picture)' | while read -r option; do
			sed -n '/^SYNOPSIS/,/^DESCRIPTION/p' <<<"$shown" | grep -qF -- "$option" || { echo "$page: $option is not in the synopsis"; exit 1; }
		done
	}
	for page in "$MAN"/*.[137]; do sound "$page" || { echo "^ $page"; false; }; done
	# the whole is told of by refersplat(7)
	for page in "$MAN"/*.[13]; do sed -n '/^\.Sh SEE ALSO/,$p' "$MAN/refersplat.7" | grep -q "^\.Xr $(basename "${page%.*}") ${page##*.}"; done
}
