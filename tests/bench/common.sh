# What the parts of the bench share; sourced by them. They run at the root of the tree.
#	BUILD   build folder; results go to BUILD/bench
#	FULL=1  more and larger measurements
#	DATA    folder of a real scene in the desk's layout (pipelines/desk.mk), for the knobs
#	BERT    folder of the language encoder
set -u -o pipefail
: "${BUILD:=build}" "${FULL:=}" "${DATA:=}" "${BERT:=${XDG_CACHE_HOME:-$HOME/.cache}/refersplat/encoder}"
bin=$BUILD/bin bench=$BUILD/bench out=$BUILD/bench here=tests/bench tab=$'\t'
threads=$(nproc)
# Threads that wait for one another give their processor to other programs.
export OMP_WAIT_POLICY=${OMP_WAIT_POLICY:-passive}
mkdir -p "$out/log"

die() {
	echo "bench: $1" >&2
	exit 1
}

heading() {
	printf '\n== %s\n' "$1"
}

# Ends a part that needs the language encoder where that is not.
need_encoder() {
	[ -f "$BERT/config.json" ] || { echo "left out: no language encoder in $BERT (make encoder)"; exit 0; }
}

# Lines of fields separated by tabs, the first a heading, as an aligned table.
table() {
	awk -F '\t' '{ rows = NR; if (NF > columns) columns = NF
		for (i = 1; i <= NF; i++) { cell[NR, i] = $i; if (length($i) > width[i]) width[i] = length($i) } }
		END { for (r = 1; r <= rows; r++) {
			line = ""
			for (i = 1; i <= columns; i++) line = line sprintf(i == 1 ? "%-" width[i] "s" : "  %" width[i] "s", cell[r, i])
			sub(/ +$/, "", line); print line } }'
}

# plot NAME: draws the plot on stdin (plot.awk's language) as NAME.svg, and keeps its data as NAME.tsv.
plot() {
	cat >"$out/$1.tsv"
	awk -f $here/plot.awk "$out/$1.tsv" >"$out/$1.svg" && echo "plot: $out/$1.svg"
}

# plot_head TITLE NOTE XLABEL YLABEL [DIRECTIVE...]: how a plot begins.
plot_head() {
	printf '#title\t%s\n#note\t%s\n#xlabel\t%s\n#ylabel\t%s\n' "$1" "$2" "$3" "$4"
	shift 4
	[ $# = 0 ] || printf '#%s\n' "$@"
}

fit_head() {
	printf 'time of\tpoints\tfrom\tto\texponent\tR2\ta, ms\tb, ms\tlargest share of a\n'
}

# fit NAME: a row under fit_head from lines "X Y" on stdin.
fit() {
	awk -f $here/fit.awk -v name="$1"
}

# seconds LOG, mebibytes LOG: from the last line of a tool that ran with -v.
seconds() {
	sed -n 's/.*: \([0-9.]*\) s, peak memory [0-9.]* MiB$/\1/p' "$1" | tail -n 1
}
mebibytes() {
	sed -n 's/.*, peak memory \([0-9.]*\) MiB$/\1/p' "$1" | tail -n 1
}

# logged LOG TOOL ARGUMENT...: runs a tool with -v, its messages into LOG, its standard output nowhere.
logged() {
	local log=$1 tool=$2
	shift 2
	mkdir -p "$(dirname "$log")"
	"$bin/$tool" -v "$@" >/dev/null 2>"$log" || { tail -n 3 "$log" >&2; return 1; }
}

# has_option TOOL OPTION: whether a tool knows it.
has_option() {
	"$bin/$1" --help | grep -q -e "^ *\(-., \)\? *$2\b"
}

# Which build the tools are of: results and scenes of another are made again.
build_sum() {
	cat "$bin"/* | cksum | cut -d ' ' -f 1
}

# is_of FILE BUILD_SUM: whether a stamp is of a build.
is_of() {
	[ "$(cat "$1" 2>/dev/null)" = "$2" ]
}

# prepare DIR SPLATS CAMERAS TEST_VIEWS SENTENCES CANDIDATES: everything that gs-weigh and refer-train read, in DIR.
prepare() {
	local dir=$1
	! is_of "$dir/prepared" "$(build_sum)" || return 0
	logged "$dir/log/gs-import" gs-import --cameras "$3" --test-views "$4" -o "$dir/scene" "$2" &&
		logged "$dir/log/text-encode" text-encode --model "$BERT" -o "$dir/text.safetensors" "$5" &&
		logged "$dir/log/pseudomask-select" pseudomask-select -o "$dir/masks.jsonl" "$6" &&
		build_sum >"$dir/prepared"
}

# synthetic DIR GAUSSIANS SIZE VIEWS SEED: a synthetic scene in DIR/data, prepared in DIR; nothing else stays in DIR when it is
# made again.
synthetic() {
	local dir=$1
	is_of "$dir/prepared" "$(build_sum)" || rm -rf "$dir"
	[ -e "$dir/data/truth.jsonl" ] ||
		logged "$dir/log/gs-synth" gs-synth --gaussians "$2" --size "$3" --views "$4" --seed "$5" -o "$dir/data" || return
	prepare "$dir" "$dir/data/point_cloud.ply" "$dir/data/sparse/0" "$(cat "$dir/data/test-views")" \
		"$dir/data/sentences.jsonl" "$dir/data/candidates.jsonl"
}
