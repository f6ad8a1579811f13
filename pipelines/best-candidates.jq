# What a detector says of each view by itself, as predictions: for each sentence of a split, in each test view, the candidate with the highest score,
# or an empty mask where it has found nothing.
#	jq -n -c --arg views VIEW,... --arg split test --slurpfile sentences FILE -f best-candidates.jq CANDIDATES
[inputs] as $found
| ($found | map({key: ([.view, .ref] | tojson), value: .}) | group_by(.key)
	| map({key: .[0].key, value: (map(.value) | max_by(.score))}) | from_entries) as $best
| $found[0].segmentation.size as $size
| ($views | split(","))[] as $view | $sentences[] | select(.split == $split) as $s
| $best[[$view, $s.ref] | tojson]
	// {view: $view, ref: $s.ref, object: $s.object, score: 0, segmentation: {size: $size, counts: [$size[0] * $size[1]]}}
