#!/usr/bin/env bash
# Usage: DESK=DIR/desk ROOM=DIR/room SPLATS=room.ply [BIN=build/bin] [BERT=DIR] [KEEP=DIR] tests/bench/names.sh [dev]
#
# Asks three scenes (a desk and a room in the layouts of pipelines/desk.mk and room.sh, and gs-synth's kitchen 61), lifted from true
# masks with names alone and with training sentences, for "the X", X each name of names.tsv: of things that are in none of them, and what
# people call the things that are. Prints for each half, and for some --min-probability, how many of the absent were answered and how
# many of the present refused, in percent; at last how many of the present were refused or answered by another thing. With `dev` also which, of that
# half. KEEP keeps scenes and weights for the next run, which lifts again. A scene whose folder is not given is left out.
set -euo pipefail
export LC_ALL=C
here=$(cd "$(dirname "$0")" && pwd)
BIN=$(cd "${BIN:-build/bin}" && pwd)
BERT=${BERT:-${XDG_CACHE_HOME:-$HOME/.cache}/refersplat/encoder}
[ $# = 0 ] || [ "$*" = dev ] || { sed -n 's/^# Usage: //p' "$0" >&2; exit 2; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
keep=${KEEP:-$work}
[ -d "$keep/raw.kitchen-61" ] || "$BIN/gs-synth" -q --scene kitchen --seed 61 -o "$keep/raw.kitchen-61"

# ask SCENE DIR SPLATS WAY [VARIABLE]: $work/answers gets a record for each name
ask() {
	local run=$keep/names/$1-$4
	rm -f "$run/lifted/model.safetensors"
	make -s -f "$here/../../pipelines/lift.mk" BIN="$BIN" BERT="$BERT" SCENE="$run" SPLATS="$3" CAMERAS="$2/sparse/0" MASKS="$2/truth.jsonl" \
		"${@:5}" "$run/lifted/model.safetensors" >/dev/null
	grep -v '^#' "$here/names.tsv" | awk -F'\t' -v OFS='\t' -v scene="$1" \
		'{n = split($4, name, ", ")}
			$1 == scene {for (i = 1; i <= n; i++) {of[name[i]] = of[name[i]] "|" $3; row[++rows] = $2 FS $3 FS name[i]}}
			$1 == "absent" {for (i = 1; i <= n; i++) none[++nones] = $2 FS FS name[i]}
			END {for (i = 1; i <= rows; i++) {split(row[i], r, FS); print r[1], r[2], r[3], of[r[3]]}
				for (i = 1; i <= nones; i++) {split(none[i], r, FS); if (!of[r[3]]) print r[1], "", r[3]}}' >"$work/asked"
	awk -F'\t' '{print "\nthe " $3}' "$work/asked" | { "$BIN/refer-ask" -q --json --encoder "$BERT" "$run" || [ $? = 1 ]; } |
		jq -c --arg way "$4" --arg scene "$1" -n --rawfile names "$work/asked" '($names | split("\n")) as $n | foreach inputs as $x (-1; . + 1;
			($n[.] | split("\t")) as $i | {way: $way, scene: $scene, half: $i[0], absent: ($i[1] == ""), kind: $i[1], name: $i[2], believed: $x.probability,
				got: $x.things[0].name, right: ($x.things[0].name // "" | . as $g | $i[3] // "" | split("|")[1:] | any(. as $k | $g | contains($k)))})' >>"$work/answers"
}

for way in names sentences; do
	said() { [ $way = names ] || echo "SENTENCES=$1/sentences.jsonl"; }
	[ -z "${DESK:-}" ] || ask desk "$DESK" "$DESK/point_cloud.ply" $way $(said "$DESK")
	[ -z "${ROOM:-}" ] || ask room "$ROOM" "$SPLATS" $way $(said "$ROOM")
	ask kitchen "$keep/raw.kitchen-61" "$keep/raw.kitchen-61/point_cloud.ply" $way $(said "$keep/raw.kitchen-61")
done
printf 'half\twith\tnames\t%s\tnot right\n' "$(printf '%s\t' 0.1 0.3 0.5 0.7 0.9 | sed 's/\t$//')"
jq -rs 'def percent($n): . * 1000 / $n | round / 10;
	group_by([.half, .way, .absent])[] | length as $n | .[0] as $g | [$g.half, $g.way, if $g.absent then "absent, answered" else "present, refused" end,
		((0.1, 0.3, 0.5, 0.7, 0.9) as $t | map(select((.believed >= $t) == $g.absent)) | length | percent($n)),
		if $g.absent then "" else map(select(.believed >= 0.5 and .right)) | length | $n - . | percent($n) end] | @tsv' "$work/answers"
[ "$*" != dev ] || jq -r 'select(.half == "dev" and (.believed >= 0.5) == .absent) | [.way, .scene, .kind, .name, .believed, .got] | @tsv' "$work/answers"
cp "$work/answers" "$keep/names/answers"
