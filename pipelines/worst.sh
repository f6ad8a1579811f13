#!/bin/sh
# Prints the sentences that were answered worst: mIoU over the views, share of them on the right object, ref and text.
# usage: [BIN=DIR] worst.sh N TRUTH SENTENCES PREDICTIONS
set -eu
count=$1 truth=$2 sentences=$3 predictions=$4
tool=${BIN:+$BIN/}
jq -r '.ref' "$predictions" | sort -u | while IFS= read -r ref; do
	jq -c --arg ref "$ref" 'select(.ref == $ref)' "$predictions" |
		"${tool}miou-score" --json --quiet --predicted-views --truth "$truth" - |
		jq -r --arg ref "$ref" --slurpfile sentences "$sentences" \
			'select(.pairs > 0) | [(1000 * .miou | round / 10), (100 * .right | round), $ref, ($sentences[] | select(.ref == $ref).text)] | @tsv'
done | sort -n | head -n "$count"
