#!/bin/sh
# Prints what is wrong with what a pipeline was given, one line, or nothing: what can be known before any work is done. common.mk calls it.
# usage: check.sh BIN VARIABLE=VALUE...; check.sh --closest NAME KNOWN...; check.sh --records BIN SCENE VARIABLE=FILE...
# --closest prints the known name that is most like one that is not. --records reads all of the records, once the scene is there.
set -euf

# The kinds of the variables; others are no files, or are looked at by the first step.
kind() {
	case $1 in
	SENTENCES | ASK | QUESTIONS) echo sentences ;;
	CANDIDATES | MASKS | TRUTH | WHOLE) echo masks ;;
	BOXES) echo boxes ;;
	esac
}

# say VARIABLE VALUE WHAT
say() {
	echo "$1: $2: $3"
	exit 0
}

# What the first bytes say that a file is, where that is no text.
is_binary() {
	case $(head -c 8 "$1" | od -An -tx1 | tr -d ' \n') in
	89504e47*) echo a PNG ;;
	ffd8ff*) echo a JPEG ;;
	706c790a* | 706c790d*) echo a .ply ;;
	504b0304*) echo 'a zip' ;;
	1f8b* | 28b52ffd*) echo packed ;;
	esac
}

# There, readable, a file, not empty.
check_file() {
	[ -e "$2" ] || say "$1" "$2" "no such file; a name without a leading / is looked for in $PWD"
	[ ! -d "$2" ] || say "$1" "$2" "is a folder, and a file is needed"
	[ -r "$2" ] || say "$1" "$2" "may not be read: permission denied"
	[ -f "$2" ] || say "$1" "$2" "is no regular file"
	[ -s "$2" ] || say "$1" "$2" "is empty"
}

check_folder() {
	[ -e "$2" ] || say "$1" "$2" "no such folder; a name without a leading / is looked for in $PWD"
	[ -d "$2" ] || say "$1" "$2" "is no folder"
	[ -r "$2" ] && [ -x "$2" ] || say "$1" "$2" "may not be read: permission denied"
}

# A trained scene or cameras: the first step says more.
check_source() {
	check_file "$1" "$2"
	what=$(is_binary "$2")
	case $1:$what:$2 in
	CAMERAS:a*) say "$1" "$2" "is $what, and cameras are needed: a COLMAP model (sparse/0), cameras.json or transforms.json" ;;
	SPLATS:*PNG:* | SPLATS:*JPEG:* | SPLATS::*.jsonl) say "$1" "$2" "is ${what:-JSON Lines}, and a trained 3DGS scene is needed: .ply, .spz, .sog, .glb, .splat or the folder that 3DGS wrote" ;;
	esac
}

check_records() {
	check_file "$1" "$2"
	what=$(is_binary "$2")
	[ -z "$what" ] || say "$1" "$2" "is $what, and JSON Lines are needed: a record of $(kind "$1") in each line"
	[ "$(kind "$1")" = sentences ] || case $(head -c 1 "$2") in
	'{' | '') ;;
	*) say "$1" "$2" "is not JSON Lines: a record of $(kind "$1"), {...}, in each line; mask-import makes mask records of other JSON" ;;
	esac
}

# Masks that a person drew; NAMES is set where colours have names.
check_masks() {
	[ -e "$1" ] || check_file MASKS "$1"
	first=$1
	if [ -d "$1" ]; then
		check_folder MASKS "$1"
		set +f
		first=$(ls -d "$1"/*.json "$1"/*.png "$1"/*/*.png 2>/dev/null | head -n 1)
		set -f
		bad=$(ls "$1" | grep "[][:blank:]:;&'\"\`\$\\\\*?[{}<>|!~%=#()]" | head -n 1)
		[ -n "$first" ] || say MASKS "$1" "has no *.png, *.json or NAME/*.png in it"
		case $first in "$1"/*/*) bad= ;; esac
		[ -z "$bad" ] || say MASKS "$1" "has a file '$bad', whose name make cannot take; rename it to letters, digits, '_', '-' and '.'"
	fi
	check_file MASKS "$first"
	what=$(is_binary "$first")
	case $what:$first in
	*PNG:"$1"/*/*) ;;
	*PNG:*) [ -n "$names" ] || say MASKS "$first" "is a painted photograph, so NAMES=FILE is needed: a line for each thing, its colour and its name, as '#ff0000 red cup'" ;;
	:*.json | :*.jsonl) [ -z "$names" ] || say NAMES "$names" "names the colours of painted photographs, and MASKS=$1 has names of its own" ;;
	:*) say MASKS "$first" "is no PNG, .json or .jsonl" ;;
	*JPEG:*) say MASKS "$first" "is $what; paint over the photograph and save it as a PNG, which keeps colours as they are" ;;
	*) say MASKS "$first" "is $what, and masks are needed: a PNG, .json or .jsonl" ;;
	esac
}

# What is made goes there: the folder, or the nearest above it that is there, takes files.
check_output() {
	dir=$2
	while [ ! -e "$dir" ]; do dir=$(dirname "$dir"); done
	[ -d "$dir" ] || say "$1" "$2" "$dir is no folder, so nothing can be written there"
	[ -w "$dir" ] || say "$1" "$2" "$dir may not be written to"
	free=$(df -Pk "$dir" | awk 'NR == 2 { print $4 }')
	[ "${free:-1024}" -ge 1024 ] || say "$1" "$2" "the disk of $dir is full: $free kB are free"
}

check_encoder() {
	[ -e "$2" ] || say "$1" "$2" "no language encoder there: 'make encoder' (installed: refersplat-encoder) fetches it, or BERT=FOLDER names one"
	check_folder "$1" "$2"
	[ -e "$2/config.json" ] || [ -e "$2/open_clip_config.json" ] || say "$1" "$2" "is no language encoder: no config.json in it"
	(set +f && ls "$2"/*.safetensors >/dev/null 2>&1) || say "$1" "$2" "is no language encoder: no *.safetensors in it"
}

# check_options VARIABLE TOOL OPTION...: as the tool sees them.
check_options() {
	variable=$1
	shift
	said=$("$tool$@" --help 2>&1 >/dev/null) || { echo "$variable: $said" | head -n 1; exit 0; }
}

case $1 in
--closest)
	shift
	printf '%s\n' "$@" | awk 'function least(a, b) { return a < b ? a : b }
		NR == 1 { want = $0; next }
		{	a = toupper(want); n = length(a); m = length($0)
			for (j = 0; j <= m; j++) d[0, j] = j
			for (i = 1; i <= n; i++) {
				d[i, 0] = i
				for (j = 1; j <= m; j++)
					d[i, j] = least(d[i - 1, j - 1] + (substr(a, i, 1) != substr($0, j, 1)), 1 + least(d[i - 1, j], d[i, j - 1]))
			}
			if (d[n, m] < (best ? far : 3) && d[n, m] < m) { best = $0; far = d[n, m] } }
		END { if (best) print best }'
	exit
	;;
--records)
	tool=$2 scene=$3
	shift 3
	for given; do
		variable=${given%%=*} file=${given#*=}
		# Plain text is read as it is encoded.
		[ "$(head -c 1 "$file")" = '{' ] || continue
		said=$("${tool}gs-check" "$file") || { echo "$variable: $said"; exit; }
		case $said in
		*": ok: $(kind "$variable"), "*) ;;
		*) say "$variable" "$file" "has ${said##*: ok: }, and $(kind "$variable") are needed" ;;
		esac
		case $variable:$file in
		CANDIDATES:*.jsonl | MASKS:*.jsonl)
			said=$("${tool}mask-import" -q --undistort "$scene" -o /dev/null "$file" 2>&1) || { echo "$variable: ${said#mask-import: }"; exit; }
			;;
		esac
	done
	exit
	;;
esac

tool=$1 names=
shift
for given; do case $given in NAMES=*) names=${given#*=} ;; esac done
command -v "${tool}gs-import" >/dev/null || { echo "BIN: no gs-import in ${tool:-any folder of PATH}: run 'make' in the checkout first, or 'make install'"; exit 0; }
for given; do
	variable=${given%%=*} value=${given#*=}
	case $variable in
	SENTENCES | ASK | QUESTIONS | CANDIDATES | TRUTH | WHOLE | BOXES) check_records "$variable" "$value" ;;
	MASKS) check_masks "$value" ;;
	NAMES)
		check_file "$variable" "$value"
		what=$(is_binary "$value")
		[ -z "$what" ] || say "$variable" "$value" "is $what; a text is needed, a line for each thing: its colour and its name"
		;;
	SPLATS | CAMERAS) [ -d "$value" ] || check_source "$variable" "$value" ;;
	IMAGES | DATA | LABELS) check_folder "$variable" "$value" ;;
	BERT) check_encoder "$variable" "$value" ;;
	SCENE | OUT | DEMO) check_output "$variable" "$value" ;;
	SELECT) check_options "$variable" pseudomask-select $value ;;
	WEIGH) check_options "$variable" gs-weigh $value ;;
	LIFT) check_options "$variable" refer-lift $value ;;
	TRAIN) check_options "$variable" refer-train $value ;;
	RENDER) check_options "$variable" refer-render $value ;;
	SYNTH) check_options "$variable" gs-synth $value ;;
	SCALE) check_options "$variable" gs-weigh --scale "$value" ;;
	ITERATIONS) check_options "$variable" refer-train --iterations "$value" ;;
	SEED) check_options "$variable" refer-train --seed "$value" ;;
	esac
done
