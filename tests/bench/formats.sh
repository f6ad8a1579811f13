#!/usr/bin/env bash
# A scene in each format: its size, how it looks beside the .ply (PSNR, tests/bench/bench_psnr.c), and the time and memory to read it. The scene is
# DATA's point_cloud.ply with its sparse/0, else a synthetic one. SPLAT_TRANSFORM=FILE, the cli.mjs of @playcanvas/splat-transform (npm), adds the
# formats that only it writes, and how long it reads.
. "$(dirname "$0")/common.sh"
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
peer() { node "$SPLAT_TRANSFORM" "$@" >"$work/peer.log" 2>&1; }

if [ -n "$DATA" ]; then
	ply=$DATA/point_cloud.ply cameras=$DATA/sparse/0
else
	"$bin/gs-synth" -q --views 8 --size 320x240 --gaussians 100000 -o "$work/made" || die "gs-synth failed"
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

# row FILE AS: read beside the .ply AS
row() {
	local its=- like=- took
	"$bin/gs-import" -q --cameras "$cameras" -o "$work/scene" "$work/$1" || die "gs-import failed"
	[ "$1" = "$2" ] || {
		"$bin/gs-import" -q --cameras "$cameras" -o "$work/truth" "$work/$2" || die "gs-import failed"
		like=$("$bench/bench_psnr" "$work/truth" "$work/scene")
	}
	"$bin/gs-check" -v "$work/$1" >/dev/null 2>"$work/log" || die "gs-check failed"
	[ -z "${SPLAT_TRANSFORM:-}" ] || {
		took=$(date +%s%N)
		peer -q "$work/$1" null && its=$(awk -v from="$took" -v to="$(date +%s%N)" 'BEGIN { printf "%.2f", (to - from) / 1e9 }')
	}
	printf '%s\t%.1f\t%s\t%s\t%s\t%s\n' "$1" "$(awk -v n="$(wc -c <"$work/$1")" 'BEGIN { print n / 1e6 }')" \
		"${like/-/-$tab-}" "$(seconds "$work/log")" "$(mebibytes "$work/log")" "$its"
}

heading "formats: $("$bin/gs-check" "$work/a.ply" | sed 's/.*: //')"
{
	printf 'file\tMB\tdB, mean\tdB, least\ts to read\tMiB\tits s\n'
	for file in a.ply a.compressed.ply version2.spz version3.spz version4.spz its.spz a.glb a.sog a.splat; do
		[ ! -e "$work/$file" ] || row "$file" a.ply
	done
	[ ! -e "$work/degree0.sog" ] || { row degree0.ply degree0.ply; row degree0.sog degree0.ply; }
} | table
