#!/usr/bin/env bash
# A scene in each format: its size, how it looks beside the .ply (PSNR, tests/bench/bench_psnr.c), and the time and memory to read it. The scene is
# DATA's point_cloud.ply with its sparse/0, else a synthetic one. SPLAT_TRANSFORM=FILE, the cli.mjs of @playcanvas/splat-transform (npm), adds the
# formats that only it writes, and how long it reads. GAUSSIANS=N makes the synthetic scene so large; REPEATS=N reads each file so often, and times are
# medians.
. "$(dirname "$0")/common.sh"
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
peer() { node "$SPLAT_TRANSFORM" "$@" >"$work/peer.log" 2>&1; }

if [ -n "$DATA" ]; then
	ply=$DATA/point_cloud.ply cameras=$DATA/sparse/0
else
	"$bin/gs-synth" -q --views 8 --size 320x240 --gaussians "${GAUSSIANS:-100000}" -o "$work/made" || die "gs-synth failed"
	ply=$work/made/point_cloud.ply cameras=$work/made/sparse/0
fi
cp "$ply" "$work/a.ply"

for v in 2 3 4; do "$bin/gs-transform" --spz-version $v -o "$work/version$v.spz" "$work/a.ply" || die "gs-transform failed"; done
for file in a.splat a.glb a.sog; do "$bin/gs-transform" -o "$work/$file" "$work/a.ply" || die "gs-transform failed"; done
if [ -n "${SPLAT_TRANSFORM:-}" ]; then
	peer -q "$work/a.ply" "$work/a.compressed.ply"
	peer -q "$work/a.ply" "$work/its.spz"
	# Without harmonics: it has no quick way to make a palette of them without a GPU.
	peer -q "$work/a.ply" -H 0 "$work/degree0.ply"
	peer -q -g cpu "$work/degree0.ply" "$work/degree0.sog"
fi

# median COMMAND...: of the numbers that it prints in REPEATS runs.
median() {
	for ((k = 0; k < ${REPEATS:-1}; k++)); do "$@" || return; done | sort -g | awk '{ v[NR] = $1 } END { if (!NR) exit 1; print v[int((NR + 1) / 2)] }'
}

our_seconds() { "$bin/gs-check" -v "$1" >/dev/null 2>"$work/log" && seconds "$work/log"; }

its_seconds() {
	local from
	from=$(date +%s%N)
	peer -q "$1" null && awk -v from="$from" -v to="$(date +%s%N)" 'BEGIN { printf "%.2f\n", (to - from) / 1e9 }'
}

# Its memory in MiB, where GNU time is.
its_mebibytes() {
	type -P time >/dev/null && command time -f %M -o "$work/peak" node "$SPLAT_TRANSFORM" -q "$1" null >"$work/peer.log" 2>&1 &&
		awk '{ printf "%.0f\n", $1 / 1024 }' "$work/peak"
}

# row FILE AS: read beside the .ply AS
row() {
	local its=- its_peak=- like=- took
	"$bin/gs-import" -q --cameras "$cameras" -o "$work/scene" "$work/$1" || die "gs-import failed"
	[ "$1" = "$2" ] || {
		"$bin/gs-import" -q --cameras "$cameras" -o "$work/truth" "$work/$2" || die "gs-import failed"
		like=$("$bench/bench_psnr" "$work/truth" "$work/scene")
	}
	took=$(median our_seconds "$work/$1") || die "gs-check failed"
	[ -z "${SPLAT_TRANSFORM:-}" ] || {
		its=$(median its_seconds "$work/$1") || its=-
		its_peak=$(its_mebibytes "$work/$1") || its_peak=-
	}
	printf '%s\t%.1f\t%s\t%s\t%s\t%s\t%s\n' "$1" "$(awk -v n="$(wc -c <"$work/$1")" 'BEGIN { print n / 1e6 }')" \
		"${like/-/-$tab-}" "$took" "$(mebibytes "$work/log")" "$its" "$its_peak"
}

heading "formats: $("$bin/gs-check" "$work/a.ply" | sed 's/.*: //')"
{
	printf 'file\tMB\tdB, mean\tdB, least\ts to read\tMiB\tits s\tits MiB\n'
	for file in a.ply a.compressed.ply version2.spz version3.spz version4.spz its.spz a.glb a.sog a.splat; do
		[ ! -e "$work/$file" ] || row "$file" a.ply
	done
	[ ! -e "$work/degree0.sog" ] || { row degree0.ply degree0.ply; row degree0.sog degree0.ply; }
} | table
