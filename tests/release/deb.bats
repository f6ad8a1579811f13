#!/usr/bin/env bats
# The Debian package: what is in it and what it says that it needs; and its programs and library work from an unpacked folder.
# Parts: tests/deb.mk

setup_file() {
	export ROOT=$BATS_TEST_DIRNAME/../..
	BIN=${BIN:-$ROOT/build/bin}
	export built=$(dirname "$(cd "$BIN" && pwd)")
	can_make || return 0
	make -C "$ROOT" -s -o all BUILD="$built" DEB_FLAGS="-Zgzip -z1" deb >"$BATS_FILE_TMPDIR/log" 2>&1 || { cat "$BATS_FILE_TMPDIR/log"; return 1; }
	cp "$built"/refersplat_*.deb "$BATS_FILE_TMPDIR/refersplat.deb"
	dpkg-deb -x "$BATS_FILE_TMPDIR/refersplat.deb" "$BATS_FILE_TMPDIR/root"
}

can_make() { command -v dpkg-deb && command -v dpkg-shlibdeps && [ -e "$built/lib/librefersplat.a" ]; } >/dev/null

setup() {
	can_make || skip "no dpkg-dev, or built without the library"
	BIN=${BIN:-$ROOT/build/bin}
	deb=$BATS_FILE_TMPDIR/refersplat.deb usr=$BATS_FILE_TMPDIR/root/usr
	cd "$BATS_TEST_TMPDIR"
}

field() { dpkg-deb -f "$deb" "$1"; }

@test "its fields" {
	[ "$(field Package)" = refersplat ]
	[ "refer-ask (refersplat) $(field Version)" = "$("$usr/bin/refer-ask" -V)" ]
	[ "$(field Architecture)" = "$(dpkg --print-architecture)" ]
	[ -n "$(field Maintainer)" ]
	[ "$(field Description | wc -l)" -gt 1 ]
}

@test "it depends on the package of every library that its programs name, and on no other" {
	for file in "$usr"/bin/* "$usr"/lib/*/librefersplat.so; do
		objdump -p "$file" 2>/dev/null | sed -n 's/^ *NEEDED *//p'
	done | grep -v '^ld-linux' | sort -u >needed
	grep -q '^libcjson' needed
	while read -r name; do
		path=$(ldd "$usr/bin/refer-ask" "$usr/bin/refer-serve" "$usr/bin/gs-transform" "$usr"/lib/*/librefersplat.so | awk -v n="$name" '$1 == n { print $3; exit }')
		dpkg -S "$(realpath "$path")" 2>/dev/null || dpkg -S "$path" 2>/dev/null || dpkg -S "/usr$path"
	done <needed | sed 's/:.*//' | sort -u >packages
	[ "$(wc -l <packages)" -ge 8 ]
	field Depends | tr ',' '\n' | sed 's/^ *//; s/ .*//' | grep -vx wordnet-base | sort -u | diff - packages
	# with versions, where the library's package has symbols
	field Depends | grep -qE 'libc6 \(>= 2\.[0-9]+\)'
}

@test "files: the programs, their pages and completion, all under /usr, and sums that hold" {
	[ "$(ls "$usr/..")" = usr ]
	for tool in "$BIN"/*; do
		tool=${tool##*/}
		[ -x "$usr/bin/$tool" ]
		zcat "$usr/share/man/man1/$tool.1.gz" | cmp - "$ROOT/man/$tool.1"
		[ -s "$usr/share/bash-completion/completions/$tool" ] && [ -s "$usr/share/zsh/site-functions/_$tool" ]
	done
	dpkg-deb -c "$deb" | awk '$2 != "root/root" { print; bad = 1 } END { exit bad }'
	dpkg-deb --ctrl-tarfile "$deb" | tar -xO ./md5sums >sums
	(cd "$usr/.." && md5sum --quiet -c "$OLDPWD/sums")
	[ "$(wc -l <sums)" = "$(find "$usr" -type f | wc -l)" ]
}

@test "its programs find what a sentence means" {
	export OMP_WAIT_POLICY=passive
	"$ROOT/tests/cli/examples-setup.sh" made "$usr/bin"
	cd made
	"$usr/bin/refer-ask" --encoder encoder kitchen "where is the brown box?" | grep -q "brown box"
	"$usr/bin/gs-check" kitchen/lifted/model.safetensors
	make -s -f "$usr/share/refersplat/pipelines/lift.mk" help | grep -q '^SCALE '
}

@test "its library links, where pkg-config says it is" {
	cat >x.c <<-'END'
		#include <refersplat.h>
		#include <stdio.h>
		int main(void)
		{
			struct refersplat *r = refersplat_new();
			int status = refersplat_load(r, "none", "none", NULL);
			printf("%d %s", status, refersplat_message(r));
			refersplat_free(r);
		}
	END
	export PKG_CONFIG_PATH=$(dirname "$usr"/lib/*/pkgconfig/refersplat.pc) PKG_CONFIG_SYSROOT_DIR=$BATS_FILE_TMPDIR/root
	cc -o x x.c $(PKG_CONFIG_ALLOW_SYSTEM_CFLAGS=1 PKG_CONFIG_ALLOW_SYSTEM_LIBS=1 pkg-config --cflags --libs refersplat)
	[ "$(LD_LIBRARY_PATH=$(dirname "$usr"/lib/*/librefersplat.so) ./x)" = "4 none: No such file or directory" ]
}

@test "the same bytes again" {
	make -C "$ROOT" -s -o all BUILD="$built" DEB_FLAGS="-Zgzip -z1" deb >log 2>&1
	cmp "$built"/refersplat_*.deb "$deb"
}
