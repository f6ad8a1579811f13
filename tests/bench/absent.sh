#!/usr/bin/env bash
# How well a lifted model tells sentences about what is here from sentences about what is not. The test sentences of a
# synthetic scene are of what is here; those of other scenes, but for things that have a namesake here ("white plate"), are of
# what is absent. usage: tests/bench/absent.sh DIR OTHER...
# Each folder has data/sentences.jsonl (gs-synth) and text.safetensors; DIR also has scene and the model.
#	BIN=build/bin             the tools
#	MODEL=DIR/lifted.safetensors
#	LEAST="0 0.1 ... 0.9"     values of refer-render --min-probability to try
# Prints quantiles of the scores of both kinds and how often a present sentence scores above an absent one (0.5: chance),
# then for each P of LEAST the shares of present sentences that are answered and of absent ones that are refused.
set -eu -o pipefail
[ $# -ge 2 ] || { echo "usage: tests/bench/absent.sh DIR OTHER..." >&2; exit 2; }
BIN=${BIN:-build/bin} MODEL=${MODEL:-$1/lifted.safetensors} LEAST=${LEAST:-0 0.1 0.2 0.3 0.4 0.5 0.6 0.7 0.8 0.9}
here=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# names FILE: what the objects are called, without the numbers of those that are alike.
names() { jq -r '.object | sub(" [0-9]+$"; "")' "$1" | sort -u; }

# scores P: of each sentence, "present" or "absent", and the best score in any view.
scores() {
	local dir kind refs
	for dir in "$here" "${others[@]}"; do
		kind=absent
		[ "$dir" != "$here" ] || kind=present
		refs=$(cat "$work/$(basename "$dir").refs")
		[ -n "$refs" ] || continue
		"$BIN/refer-render" -q --scene "$here/scene" --text "$dir/text.safetensors" --model "$MODEL" --split all --scale 0.15 \
			--refs "$refs" --min-probability "$1" |
			jq -rn --arg kind $kind 'reduce inputs as $r ({}; .[$r.ref] = ([.[$r.ref], $r.score] | max))
				| .[] | [$kind, .] | @tsv'
	done
}

shift
others=("$@")
names "$here/data/sentences.jsonl" >"$work/names"
for dir in "$here" "${others[@]}"; do
	jq -r --rawfile names "$work/names" --argjson here "$([ "$dir" = "$here" ] && echo true || echo false)" \
		'($names | split("\n")) as $known | (.object | sub(" [0-9]+$"; "")) as $name
		| select(.split == "test" and ($here or ($known | index([$name]) == null))) | .ref' \
		"$dir/data/sentences.jsonl" | paste -sd, >"$work/$(basename "$dir").refs"
done

scores 0 | sort -k 1,1 -k 2,2g | awk '
	{ x[$1, ++n[$1]] = $2 }
	function quantile(kind, q) { return x[kind, 1 + int(q * (n[kind] - 1) + 0.5)] }
	function row(kind) {
		printf "%-8s %4d %8.3f %8.3f %8.3f %8.3f %8.3f\n", kind, n[kind], quantile(kind, 0.05), quantile(kind, 0.25),
			quantile(kind, 0.5), quantile(kind, 0.75), quantile(kind, 0.95)
	}
	END {
		printf "%-8s %4s %8s %8s %8s %8s %8s\n", "score", "n", "5%", "25%", "50%", "75%", "95%"
		row("present")
		row("absent")
		for (i = 1; i <= n["present"]; i++)
			for (k = 1; k <= n["absent"]; k++)
				above += x["present", i] > x["absent", k] ? 1 : x["present", i] == x["absent", k] ? 0.5 : 0
		if (n["present"] && n["absent"])
			printf "a present one above an absent one: %.3f\n\n", above / (n["present"] * n["absent"])
	}'
echo "least answered refused"
for p in $LEAST; do
	scores "$p" | awk -v p="$p" '{ n[$1]++; found[$1] += $2 > 0 }
		END { if (n["present"] && n["absent"]) printf "%-5s %8.3f %7.3f\n", p, found["present"] / n["present"], 1 - found["absent"] / n["absent"] }'
done
