# The table of what miou-score --answers says of questions (formats/records/scores.md), in percent: a row for those that mean one thing, several and none,
# then the figures of GRES over all.
#	jq -r -f lerf-questions.jq questions.json
def percent: if . == null then "-" else . * 1000 | round / 10 | tostring | if test("[.]") then . else . + ".0" end end;
def padded(n): tostring | (" " * ([n - length, 0] | max)) + .;
def row(name): "  \(name)\(" " * (9 - (name | length)))" + (.pairs | padded(5)) + ([.right, .miou, .refused, .f1_25, .f1_50] | map(percent | padded(9)) | add);
"questions  pairs    right     mIoU  refused  F1@0.25   F1@0.5",
(.one | row("one")), (.several | row("several")), (.none | row("none")),
"  gIoU \(.all.miou | percent), cIoU \(.all.oiou | percent), N-acc \(.n_acc | percent), T-acc \(.t_acc | percent)"
