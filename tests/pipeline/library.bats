#!/usr/bin/env bats
# librefersplat as another program finds it: installed, compiled against with pkg-config, and called from Python. The two programs are those of
# librefersplat(3).

setup_file() {
	export ROOT=$BATS_TEST_DIRNAME/../..
	BIN=${BIN:-$ROOT/build/bin}
	export built=$(dirname "$(cd "$BIN" && pwd)")
	[ -e "$built/lib/librefersplat.a" ] || return 0
	export OMP_WAIT_POLICY=passive
	make -C "$ROOT" -s -o all BUILD="$built" PREFIX="$BATS_FILE_TMPDIR/to" install
	"$ROOT/tests/cli/examples-setup.sh" "$BATS_FILE_TMPDIR/made" "$BIN"
}

setup() {
	[ -e "$built/lib/librefersplat.a" ] || skip "built without the library"
	BIN=${BIN:-$ROOT/build/bin}
	cd "$BATS_TEST_TMPDIR"
	to=$BATS_FILE_TMPDIR/to made=$BATS_FILE_TMPDIR/made
	export PKG_CONFIG_PATH=$to/lib/pkgconfig OMP_WAIT_POLICY=passive
	files=("$made/scene" "$made/kitchen/lifted/model.safetensors" "$made/encoder")
	question="where is the brown box?"
}

# example FILE FIRST: the listing of the manual page that begins with this line.
example() {
	awk -v first="$2" '/^\.Bd/ { on = 1; n = 0; next } /^\.Ed/ { on = 0 } on { if (!n++) mine = $0 == first } on && mine' \
		"$ROOT/man/librefersplat.3" | sed 's/\\e/\\/g' >"$1"
	[ -s "$1" ]
}

# Pixels of the object in a view, from the COCO run lengths that refer-render writes.
seen_in() {
	echo "$question" >asked.txt
	"$BIN/text-encode" -q --model "${files[2]}" -o asked.safetensors asked.txt
	"$BIN/refer-render" -q --scene "${files[0]}" --text asked.safetensors --model "${files[1]}" --views "$1" -o masks.jsonl
	jq '.segmentation.counts | explode | map(. - 48) |
		reduce .[] as $c ({out: [], x: 0, k: 0}; .x += ($c % 32) * pow(32; .k) | .k += 1 |
			if $c >= 32 then . else
				(if $c % 32 >= 16 then .x -= pow(32; .k) else . end) |
				(if (.out | length) > 2 then .x += .out[-2] else . end) |
				.out += [.x] | .x = 0 | .k = 0
			end) | .out as $runs | [range(1; $runs | length; 2) | $runs[.]] | add' masks.jsonl
}

# expected: what both programs print, from what the tools say.
expected() {
	local object view
	object=$("$BIN/refer-ask" --json --scene "${files[0]}" --model "${files[1]}" --encoder "${files[2]}" "$made" "$question" |
		jq -r '.things[0].name')
	"$BIN/refer-locate" --all --scene "${files[0]}" --model "${files[1]}" | jq -r --arg o "$object" 'select(.object == $o) |
		[.object, .count] + .min | @tsv' | awk -F '\t' '{ printf "%s, %d Gaussians, from %.3f %.3f %.3f\n", $1, $2, $3, $4, $5 }'
	view=$(jq -r '.[0].name' "${files[0]}/cameras.json")
	echo "$(seen_in "$view") of 3072 pixels of $view"
}

@test "the example in C, with the shared library and the static one, says what the tools say" {
	example ask.c '#include <refersplat.h>'
	cc -Wall -Wextra -Werror -o ask ask.c $(pkg-config --cflags --libs refersplat)
	LD_LIBRARY_PATH=$to/lib ldd ask | grep -q "$to/lib/librefersplat.so.0"
	LD_LIBRARY_PATH=$to/lib ./ask "${files[@]}" "$question" >said
	expected | diff - said
	[ "$(head -n 1 said | cut -d, -f1)" = "brown box" ]
	[ "$(tail -n 1 said | cut -d' ' -f1)" -gt 0 ]
	cc -o static ask.c $(pkg-config --cflags refersplat) "$to/lib/librefersplat.a" \
		$(pkg-config --static --libs refersplat | sed 's/-lrefersplat//')
	! ldd static | grep -q librefersplat || false
	./static "${files[@]}" "$question" | diff - said
}

@test "the example in Python says the same" {
	command -v python3 >/dev/null || skip "python3 is not installed"
	example ask.py 'import ctypes'
	LD_LIBRARY_PATH=$to/lib python3 ask.py "${files[@]}" "$question" >said
	expected | diff - said
	run env LD_LIBRARY_PATH="$to/lib" python3 ask.py "${files[@]}" "where is the airship?"
	[ "$status" = 1 ]
	[ -n "$output" ]
	run env LD_LIBRARY_PATH="$to/lib" python3 ask.py none none none x
	[ "$status" = 1 ]
	[ "$output" = "none: No such file or directory" ]
}

@test "nothing but the functions of the header can be seen" {
	grep -oE '\brefersplat_[a-z_]+\(' "$to/include/refersplat.h" | tr -d '(' | sort -u >declared
	[ "$(wc -l <declared)" = 10 ]
	nm -D --defined-only "$to/lib/librefersplat.so" | awk '$2 == "T" { print $3 }' | grep -v '^_' | sort | diff - declared
	# OpenMP's locks have names that all of a program share
	nm -g --defined-only "$to/lib/librefersplat.a" | awk '$2 ~ /[A-Z]/ { print $3 }' | grep -v '^\.gomp_critical_' | sort | diff - declared
	objdump -p "$to/lib/librefersplat.so.0" | grep -q 'SONAME *librefersplat.so.0$'
	grep -oE 'refersplat_[a-z_]+ ,|refersplat_[a-z_]+$' "$ROOT/man/librefersplat.3" | grep -oE 'refersplat_[a-z_]+' | sort -u | diff - declared
}

@test "the header is C++ too, and needs nothing before it" {
	command -v c++ >/dev/null || skip "no C++ compiler"
	printf '#include <refersplat.h>\nint main() { refersplat_free(refersplat_new()); }\n' >x.cc
	c++ -Wall -Wextra -Werror -o x x.cc $(pkg-config --cflags --libs refersplat)
	LD_LIBRARY_PATH=$to/lib ./x
}

# Each line: what is wrong, the status, and the message.
@test "every function with what it does not like" {
	cat >wrong.c <<-'END'
		#include <refersplat.h>
		#include <stdio.h>
		static void tell(const char *what, const struct refersplat *r, int status)
		{
			printf("%s: %d %s\n", what, status, refersplat_message(r));
		}
		int main(int argc, char **argv)
		{
			struct refersplat *r = refersplat_new();
			struct refersplat_object object;
			struct refersplat_view view, last = {0};
			struct refersplat_answer answer;
			const char *json;
			int objects[] = {0, 7};
			size_t views = 0;
			static unsigned char mask[64 * 48];
			if (argc != 5)
				return 2;
			tell("new", r, 0);
			tell("early", r, refersplat_get_object(r, 0, &object));
			tell("early", r, refersplat_ask(r, "x", NULL, &answer));
			tell("early", r, refersplat_mask(r, "x", objects, 1, mask));
			tell("no scene", r, refersplat_load(r, NULL, argv[2], argv[3]));
			tell("no model", r, refersplat_load(r, argv[1], "none", argv[3]));
			tell("a scene", r, refersplat_load(r, argv[1], argv[2], argv[3]));
			tell("object", r, refersplat_get_object(r, 3, &object));
			tell("view", r, refersplat_get_view(r, 5, &view));
			tell("nobody", r, refersplat_ask(r, "where is the cup?", "nowhere", &answer));
			tell("blank", r, refersplat_ask(r, " ", NULL, &answer));
			tell("bytes", r, refersplat_parse(r, "\xff", &json));
			tell("mask", r, refersplat_mask(r, "view_001", objects, 2, mask));
			tell("mask of nothing", r, refersplat_mask(r, "view_001", objects, 0, mask));
			tell("camera", r, refersplat_load_camera(r, "none"));
			tell("a camera", r, refersplat_load_camera(r, argv[4]));
			tell("again", r, refersplat_load_camera(r, argv[4]));
			for (; !refersplat_get_view(r, views, &view); views++)
				last = view;
			printf("%zu views, the last %s of %dx%d\n", views, last.name, last.width, last.height);
			tell("its mask", r, refersplat_mask(r, last.name, objects, 1, mask));
			tell("a parse", r, refersplat_parse(r, "the brown box", &json));
			printf("%s", json);
			int status = refersplat_ask(r, "where is the airship?", last.name, &answer);
			printf("%d, %zu, %d\n", status, answer.count, answer.reason[0] != 0);
			refersplat_free(r);
			refersplat_free(NULL);
			return 0;
		}
	END
	cc -Wall -o wrong wrong.c $(pkg-config --cflags --libs refersplat)
	LD_LIBRARY_PATH=$to/lib ./wrong "${files[@]}" "$made/new-camera.json" >said
	diff - <(sed '/^{/d' said) <<-END
		new: 0 
		early: 2 no scene is loaded
		early: 2 no scene is loaded
		early: 2 no scene is loaded
		no scene: 2 a scene and a model must be named
		no model: 4 none: No such file or directory
		a scene: 0 
		object: 1 no object 3, of 3
		view: 1 no view 5, of 5
		nobody: 2 no view 'nowhere'
		blank: 3 the sentence is empty
		bytes: 3 the sentence is not UTF-8
		mask: 2 no object 7, of 3
		mask of nothing: 0 
		camera: 4 none: No such file or directory
		a camera: 0 
		again: 0 
		6 views, the last new of 64x48
		its mask: 0 
		a parse: 0 
		1, 0, 1
	END
	echo 'the brown box' >asked.txt
	"$BIN/text-encode" -q --model "${files[2]}" -o asked.safetensors asked.txt
	diff <("$BIN/text-parse" asked.safetensors) <(grep '^{' said)
}
