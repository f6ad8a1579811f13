#!/usr/bin/env bats
# Scores: formats/records/scores.md.

setup() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	PAGE=$BATS_TEST_DIRNAME/../../formats/records/scores.md
	EXAMPLE=$BATS_TEST_DIRNAME/../golden/scores/example.txt
	load files
	cd "$BATS_TEST_TMPDIR"
	files
}

# Small files and what is printed of them.
example() { cat "$EXAMPLE"; }

# Makes the files that the example shows.
files() { example | awk '/^\$ /{ name = $2 == "cat" ? $3 : ""; next } name { print >name }'; }

# The page's keys of JSON (rows of the table whose first column is $1).
keys() { sed -n "/^| $1 |/,/^\$/p" "$PAGE" | sed -n 's/^| \(`.*`\) | .*/\1/p' | grep -oE '`[a-z0-9_]+`' | tr -d '`'; }

@test "the example is what is printed" {
	local commands=0 line
	while IFS= read -r line; do
		[[ "$line" == '$ miou-score '* ]] || continue
		commands=$((commands + 1))
		# blank lines are not compared
		PATH=$BIN:$PATH bash -c "${line#?}" | grep . >printed
		example | awk -v "line=$line" '/^\$ /{ on = $0 == line; next } on' | cmp - printed
	done < <(example)
	[ "$commands" -ge 4 ]
}

@test "JSON has the keys of the page, in its order" {
	"$BIN/miou-score" -q --json --bootstrap 10 --compare other.jsonl --parses parses.jsonl --whole whole.jsonl \
		--truth truth.jsonl <(sed 's/"segmentation"/"peak":[0,0],&/' pred.jsonl) >all.json
	diff <(keys key) <(jq -r 'keys_unsorted[]' all.json)
	[ "$(jq -r '.objects["cup, red"] | keys_unsorted[]' all.json | xargs)" = "pairs miou miou_low miou_high resampled units compare" ]
	[ "$(jq -r '.relations.left | keys_unsorted[]' all.json | xargs)" = \
		"pairs miou oiou p25 p50 p75 right missing miou_low miou_high oiou_low oiou_high resampled units compare" ]
	[ "$(jq -c '[.compare, .relations.left.compare, .objects.plate.compare | keys_unsorted] | unique | length' all.json)" = 1 ]
	for key in $(keys 'key of `compare`'); do jq -e --arg key "$key" '.compare | has($key)' all.json; done
	# every key is absent without its option
	[ "$("$BIN/miou-score" --json --truth truth.jsonl pred.jsonl | jq -r 'keys_unsorted[]' | xargs)" = \
		"miou oiou p25 p50 p75 right pairs empty_truth missing objects" ]
}

@test "CSV has the columns of the page, and as many fields in every row" {
	"$BIN/miou-score" --csv --compare other.jsonl --truth truth.jsonl pred.jsonl >all.csv
	diff <(keys column) <(head -n 1 all.csv | tr , '\n')
	diff <(keys column | sed '/^other$/,$d') <("$BIN/miou-score" --csv --truth truth.jsonl pred.jsonl | head -n 1 | tr , '\n')
	sed 's/"[^"]*"/x/g' all.csv | awk -F, 'NR == 1 { n = NF } NF != n || /\r/ { exit 1 }'
}

@test "CSV: commas and quotation marks are quoted, and names have no line breaks" {
	segmentation='"segmentation":{"size":[1,1],"counts":[0,1]}'
	for name in 'a,b' 'say \"hi\"' "plain 'n' simple; ü"; do
		echo "{\"view\":\"v\",\"object\":\"$name\",$segmentation}"
	done >names.jsonl
	"$BIN/miou-score" --csv --truth names.jsonl names.jsonl >names.csv
	printf '%s\n' 'object,"a,b",1' "object,plain 'n' simple; ü,1" 'object,"say ""hi""",1' |
		cmp - <(sed 1,2d names.csv | sed 's/,1,.*/,1/')
	echo "{\"view\":\"v\",\"object\":\"two\\nlines\",$segmentation}" >names.jsonl
	says 3 "miou-score: names.jsonl:1: key 'object' has a control character at byte 4" \
		"$BIN/miou-score" --csv --truth names.jsonl names.jsonl
}

@test "CSV has the figures of JSON" {
	all="-q --bootstrap 100 --compare other.jsonl --parses parses.jsonl --whole whole.jsonl --truth truth.jsonl pred.jsonl"
	"$BIN/miou-score" --json $all | jq -r 'def row: [.pairs, .miou, .miou_low, .miou_high, .compare.miou, .compare.difference, .compare.p, .compare.worse];
		row, (.objects[] | row), (.relations[] | row), (.visibility[] | row) | map(if . == null then "" else . * 1e9 | round end) | join(" ")' >json
	"$BIN/miou-score" --csv $all | sed '1d; s/"[^"]*"/x/' | awk -F, '{
		n = split($3 "," $4 "," $5 "," $6 "," $14 "," $18 "," $21 "," $23, f, ",")
		for (i = 1; i <= n; i++) printf "%s%s", f[i] == "" ? "" : sprintf("%.0f", f[i] * 1e9), i < n ? " " : "\n"
	}' | cmp json -
}

@test "--csv and --json exclude each other" {
	run "$BIN/miou-score" --csv --json --truth truth.jsonl pred.jsonl
	[ "$status" -eq 2 ]
	[ "${lines[0]}" = "miou-score: --json and --csv exclude each other" ]
	[ "${lines[1]}" = "Try 'miou-score --help'." ]
}
