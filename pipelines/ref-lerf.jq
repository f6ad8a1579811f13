# What Ref-LERF says of a scene, as records of ours: its json/VIEW.json has the objects of each view, and of each the name of a
# mask in gt_mask, a category and sentences.
#	jq -n -c --arg what sentences|masks|truth --arg test VIEW,... --arg masks DIR -f ref-lerf.jq DIR/json/*.json
# Sentences of test views are for testing, whatever is said in training views. Masks are of training views and by object; the truth
# is of test views and by sentence, as a test view is scored with its own sentences only.
def view: input_filename | sub(".*/"; "") | sub("\\.json$"; "");
def key: [.split, .object, .text];
($test | split(",")) as $tested
| [inputs | view as $view | (.object // .objects // [])[] | . as $o | ([$o.sentence] | flatten)[]
	| {view: $view, object: $o.category, text: ., path: "\($masks)/\($o.segmentation)",
		split: (if $tested | index($view) then "test" else "train" end)}]
| . as $all
| ($all | map(key) | unique | group_by(.[:2]) | map(to_entries | map({key: (.value | tojson),
	value: "\(.value[1]) \(.value[0]) \(.key + 1)"})) | add // [] | from_entries) as $refs
| if $what == "sentences" then
	$all | unique_by(key)[] | {ref: $refs[key | tojson], object, text, split}
elif $what == "truth" then
	$all | map(select(.split == "test")) | unique_by([.view, key])[] | {view, ref: $refs[key | tojson], path}
else
	$all | map(select(.split == "train")) | unique_by([.view, .object, .path])[] | {view, object, path}
end
