#!/usr/bin/env bats
# miou-score: predictions against truth.

bats_require_minimum_version 1.5.0

setup() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	cd "$BATS_TEST_TMPDIR"
	# one row of eight pixels
	four='{"size":[1,8],"counts":[0,4,4]}' two='{"size":[1,8],"counts":[0,2,6]}' none='{"size":[1,8],"counts":[8]}'
	cat > truth.jsonl <<-END
	{"view":"v1","object":"cup","segmentation":$four}
	{"view":"v1","object":"plate","segmentation":$none}
	{"view":"v1","ref":"spoon-1","object":"spoon","segmentation":$two}
	{"view":"v2","object":"cup","segmentation":$four}
	END
	cat > pred.jsonl <<-END
	{"view":"v1","ref":"cup-1","object":"cup","score":0.5,"segmentation":$four}
	{"view":"v1","ref":"cup-2","object":"cup","segmentation":$two}
	{"view":"v1","ref":"plate-1","object":"plate","segmentation":$four}
	{"view":"v1","ref":"spoon-1","segmentation":$two}
	{"view":"v9","ref":"cup-1","object":"cup","segmentation":$four}
	END
}

# what is in the folder beside the input
strays() { ls | grep -v -x -e truth.jsonl -e pred.jsonl || true; }

@test "the table" {
	run --separate-stderr "$BIN/miou-score" --truth truth.jsonl pred.jsonl
	[ "$status" -eq 0 ]
	[ -z "$stderr" ]
	# 1, 1/2, 1 and a missing one; 4+2+2 of 4+4+2+4 pixels
	diff - <(echo "$output") <<-END
	mIoU          62.50 %
	overall IoU   57.14 %
	P@0.25        75.00 %
	P@0.5         75.00 %
	P@0.75        50.00 %
	right object  50.00 %
	pairs             4
	missing           1
	empty truth       1

	pairs     mIoU  object
	    3  50.00 %  cup
	    0        -  plate
	    1 100.00 %  spoon
	END
}

@test "--json has the same figures in 0 to 1" {
	run --separate-stderr "$BIN/miou-score" --json --truth truth.jsonl pred.jsonl
	[ "$status" -eq 0 ]
	[ "$(echo "$output" | jq -c '[.miou,.p25,.p50,.p75,.pairs,.empty_truth,.missing]')" = "[0.625,0.75,0.75,0.5,4,1,1]" ]
	[ "$(echo "$output" | jq '.oiou * 14 - 8 | fabs < 1e-12')" = true ]
	[ "$(echo "$output" | jq -c .objects)" = \
		'{"cup":{"pairs":3,"miou":0.5},"plate":{"pairs":0,"miou":null},"spoon":{"pairs":1,"miou":1}}' ]
	[ "$(echo "$output" | jq -c keys)" = '["empty_truth","miou","missing","objects","oiou","p25","p50","p75","pairs","right"]' ]
}

@test "figures are summed in the order of the files, whatever the objects are called" {
	for n in 1 2 3; do
		echo "{\"view\":\"v\",\"object\":\"$((4 - n))\",\"segmentation\":{\"size\":[1,10],\"counts\":[0,$n,$((10 - n))]}}"
	done >p
	sed 's/"counts":.*/"counts":[0,10]}}/' p >t
	# 0.1 + 0.2 + 0.3, which is not 0.3 + 0.2 + 0.1
	[[ "$("$BIN/miou-score" --csv --truth t p | sed -n 2p)" == all,,3,0.20000000000000004,* ]]
}

@test "truth against itself is 1" {
	"$BIN/miou-score" --json --truth truth.jsonl truth.jsonl | jq -e '.miou == 1 and .oiou == 1 and .missing == 0'
}

@test "the right object is the one that a mask fits best" {
	mask() { echo "{\"view\":\"$1\",\"object\":\"$2\",\"segmentation\":{\"size\":[1,$4],\"counts\":[$3]}}"; }
	{ mask v a 0,4,8 12; mask v b 4,4,4 12; mask v c 8,4 12; mask v none 12 12; mask w a 0,2,2 4; mask w b 2,2 4; } >truth.jsonl
	right() { "$BIN/miou-score" --json --truth truth.jsonl pred.jsonl | jq -c "[.right, .pairs, .p25]"; }
	mask v a 0,7,5 12 >pred.jsonl # a whole, and most of b
	[ "$(right)" = "[0.2,5,0.2]" ]
	mask v a 1,7,4 12 >pred.jsonl # more of b than of a, though well above a quarter of a
	[ "$(right)" = "[0,5,0.2]" ]
	mask v a 2,4,6 12 >pred.jsonl # as much of either
	[ "$(right)" = "[0,5,0.2]" ]
	mask v a 12 12 >pred.jsonl # nothing
	[ "$(right)" = "[0,5,0]" ]
	mask v a 0,2,4 6 >pred.jsonl # of another size: a
	[ "$(right)" = "[0.2,5,0.2]" ]
	{ mask v b 4,4,4 12; mask w a 2,2 4; } >pred.jsonl # objects of other views do not count
	[ "$(right)" = "[0.2,5,0.2]" ]
	# Sentences of one object share it.
	sed -i 's/"object":"b"/"ref":"x","object":"a"/' truth.jsonl
	mask v a 1,7,4 12 >pred.jsonl
	[ "$(right)" = "[0.4,5,0.4]" ]
}

@test "peaks: the share in a box of the truth, and in its mask" {
	# rows of 8 pixels: in the mask; in the box alone; in the second of two boxes; nowhere; no peak; no prediction
	hole='{"size":[1,8],"counts":[0,2,2,2,2]}'
	for v in 1 2 3 4 5 6; do echo "{\"view\":\"v$v\",\"object\":\"o\",\"segmentation\":$hole}"; done |
		jq -c 'if .view == "v3" then .boxes = [[7, 0, 7, 0], [6, -1, 6.5, 1]] else . end' >truth.jsonl
	for at in 1:4 2:3 3:6 4:6; do echo "{\"view\":\"v${at%:*}\",\"object\":\"o\",\"peak\":[${at#*:},0],\"segmentation\":$four}"; done >pred.jsonl
	echo "{\"view\":\"v5\",\"object\":\"o\",\"segmentation\":$four}" >>pred.jsonl
	"$BIN/miou-score" --json --truth truth.jsonl pred.jsonl | jq -e '[.peak_in_box, .peak_in_mask] | map(. * 6 | round) == [3, 1]'
	"$BIN/miou-score" --truth truth.jsonl pred.jsonl >table
	grep -qx 'peak in box   50.00 %' table
	grep -qx 'peak in mask  16.67 %' table
	# of a prediction of another size, the point too
	jq -c '.segmentation = {size: [2, 16], counts: [32]} | if .peak then .peak = [2 * .peak[0] + 1, 1] else . end' pred.jsonl >large.jsonl
	"$BIN/miou-score" --json --truth truth.jsonl large.jsonl | jq -e '[.peak_in_box, .peak_in_mask] | map(. * 6 | round) == [3, 1]'
	# without peaks nothing is said of them
	jq -c 'del(.peak)' pred.jsonl | "$BIN/miou-score" --truth truth.jsonl - >table
	! grep peak table
}

@test "--fail-under: exit 1 below, 0 at it, and the scores all the same" {
	run --separate-stderr "$BIN/miou-score" --fail-under 0.626 --truth truth.jsonl pred.jsonl
	[ "$status" -eq 1 ]
	[ "${lines[0]}" = "mIoU          62.50 %" ]
	[ "$stderr" = "miou-score: mIoU 0.6250 is below 0.626" ]
	run --separate-stderr "$BIN/miou-score" --fail-under 0.625 --truth truth.jsonl pred.jsonl
	[ "$status" -eq 0 ]
	[ -z "$stderr" ]
	run "$BIN/miou-score" --fail-under 62 --truth truth.jsonl pred.jsonl
	[ "$status" -eq 2 ]
	[ "${lines[0]}" = "miou-score: --fail-under: '62' is not a number from 0 to 1" ]
}

@test "a mask without ref serves every sentence of its object" {
	printf '%s\n' "{\"view\":\"v\",\"ref\":\"r1\",\"object\":\"cup\",\"segmentation\":$four}" \
		"{\"view\":\"v\",\"ref\":\"r2\",\"object\":\"cup\",\"segmentation\":$two}" > t
	echo "{\"view\":\"v\",\"object\":\"cup\",\"segmentation\":$two}" > p
	"$BIN/miou-score" --json --truth t p | jq -e '.pairs == 2 and .miou == 0.75 and .missing == 0'
}

@test "predictions that no truth belongs to are left out and told" {
	echo "{\"view\":\"v1\",\"ref\":\"fork-1\",\"object\":\"fork\",\"segmentation\":$four}" >> pred.jsonl
	run --separate-stderr "$BIN/miou-score" -v --truth truth.jsonl pred.jsonl
	[ "$status" -eq 0 ]
	[ "${lines[0]}" = "mIoU          62.50 %" ]
	[ "${stderr_lines[0]}" = "miou-score: 1 predictions of views without truth were left out" ]
	[ "${stderr_lines[1]}" = \
		"miou-score: warning: pred.jsonl: 1 predictions of labelled views match no truth's ref or object and were left out" ]
	run --separate-stderr "$BIN/miou-score" -q --truth truth.jsonl pred.jsonl
	[ -z "$stderr" ]
	sed 's/"view":"[^"]*"/"view":"other"/' pred.jsonl | head -n 1 >strange.jsonl
	run "$BIN/miou-score" --truth truth.jsonl strange.jsonl
	[ "$status" = 3 ] && [[ "$output" == "miou-score: strange.jsonl: none of its views is one of truth.jsonl: are they named alike? They have 'other' and '"* ]]
}

@test "a prediction of another size is brought to the truth's" {
	echo '{"view":"v1","object":"cup","segmentation":{"size":[2,16],"counts":[0,16,16]}}' > p
	head -n 1 truth.jsonl > t
	"$BIN/miou-score" --json --truth t p | jq -e '.miou == 1'
	echo '{"view":"v1","object":"cup","segmentation":{"size":[1,4],"counts":[0,1,3]}}' > p
	"$BIN/miou-score" --json --truth t p | jq -e '.miou == 0.5'
}

@test "no predictions at all: everything is missing" {
	run "$BIN/miou-score" --json --truth truth.jsonl /dev/null
	[ "$status" -eq 0 ]
	[ "$(echo "$output" | jq -c '[.miou,.oiou,.pairs,.missing,.empty_truth]')" = "[0,0,3,3,1]" ]
}

@test "- is stdin on either side, but not on both" {
	"$BIN/miou-score" --truth truth.jsonl -o expected pred.jsonl
	"$BIN/miou-score" --truth truth.jsonl < pred.jsonl | cmp expected -
	cat pred.jsonl | "$BIN/miou-score" --truth truth.jsonl - -o - | cmp expected -
	"$BIN/miou-score" --truth - pred.jsonl < truth.jsonl | cmp expected -
	run "$BIN/miou-score" --truth - < truth.jsonl
	[ "$status" -eq 2 ]
	[ "${lines[0]}" = "miou-score: truth and predictions cannot both be stdin" ]
	run "$BIN/miou-score" pred.jsonl
	[ "$status" -eq 2 ]
	[ "${lines[0]}" = "miou-score: --truth TRUTH is required" ]
}

@test "a prediction of another shape than its truth is an error" {
	echo '{"view":"v1","object":"cup","segmentation":{"size":[300,100],"counts":[30000]}}' >>pred.jsonl
	run "$BIN/miou-score" --truth truth.jsonl -o out pred.jsonl
	[ "$status" -eq 3 ]
	[[ $output == "miou-score: pred.jsonl:6: view 'v1': a mask of 100x300, but its truth is "*" (width x height): "* ]]
	[ -z "$(strays)" ]
}

@test "two records of one name are an error with both lines" {
	echo "{\"view\":\"v1\",\"ref\":\"cup-2\",\"object\":\"mug\",\"segmentation\":$two}" >> pred.jsonl
	run "$BIN/miou-score" --truth truth.jsonl -o out pred.jsonl
	[ "$status" -eq 3 ]
	[ "$output" = "miou-score: pred.jsonl:6: view 'v1', ref 'cup-2' is on line 2 already" ]
	echo "{\"view\":\"v2\",\"object\":\"cup\",\"segmentation\":$two}" >> truth.jsonl
	run "$BIN/miou-score" --truth truth.jsonl -o out pred.jsonl
	[ "$status" -eq 3 ]
	[ "$output" = "miou-score: truth.jsonl:5: view 'v2', object 'cup' is on line 4 already" ]
	[ -z "$(strays)" ]
}

@test "truth without anything in it cannot be scored" {
	run "$BIN/miou-score" --truth /dev/null pred.jsonl
	[ "$status" -eq 3 ]
	[ "$output" = "miou-score: /dev/null: no mask with anything in it: there is nothing to score" ]
	sed -n 2p truth.jsonl > ../empty.jsonl
	run "$BIN/miou-score" --truth ../empty.jsonl -o out pred.jsonl
	[ "$status" -eq 3 ]
	[ "$output" = "miou-score: ../empty.jsonl: no mask with anything in it: there is nothing to score" ]
	[ -z "$(strays)" ]
}

@test "missing, truncated and foreign input, and no stray file" {
	run "$BIN/miou-score" --truth truth.jsonl -o out nowhere.jsonl
	[ "$status" -eq 4 ]
	[ "$output" = "miou-score: nowhere.jsonl: No such file or directory" ]
	run "$BIN/miou-score" --truth nowhere.jsonl -o out pred.jsonl
	[ "$status" -eq 4 ]
	[ "$output" = "miou-score: nowhere.jsonl: No such file or directory" ]
	head -c 150 pred.jsonl > ../cut.jsonl
	run "$BIN/miou-score" --truth truth.jsonl -o out ../cut.jsonl
	[ "$status" -eq 3 ]
	[[ "$output" == "miou-score: ../cut.jsonl:2: not JSON at column "* ]]
	[ -z "$(strays)" ]
}

@test "--predicted-views leaves out the truth of views without a prediction" {
	printf '{"view":"v%d","object":"cup","segmentation":{"size":[2,3],"counts":[0,2,4]}}\n' 1 2 >two.jsonl
	head -n 1 two.jsonl >one.jsonl
	[ "$("$BIN/miou-score" --json --truth two.jsonl one.jsonl | jq -c '[.miou,.pairs,.missing]')" = '[0.5,2,1]' ]
	[ "$("$BIN/miou-score" --json --predicted-views --truth two.jsonl one.jsonl | jq -c '[.miou,.pairs,.missing]')" = '[1,1,0]' ]
}

# Six objects in three views, two sentences each; the predictions share most with the truth, the others less.
make_scene() {
	local o v r n
	mkdir -p ../scene && cd ../scene
	for o in 0 1 2 3 4 5; do
		# of the cup near the box that is on the table, and of the red cup
		echo "{\"ref\":\"o$o-0\",\"target\":{\"noun\":\"cup\"},\"clauses\":[{\"relation\":\"near\",\"anchors\":[{\"noun\":\"box\",\"clauses\":[{\"relation\":\"above\",\"contact\":true}]}]}]}"
		echo "{\"ref\":\"o$o-1\",\"target\":{\"noun\":\"cup\",\"words\":[\"red\"]}}"
	done >parses.jsonl
	for o in 0 1 2 3 4 5; do
		for v in 1 2 3; do
			n=$((4 + o + v))
			echo "{\"view\":\"v$v\",\"object\":\"obj$o\",\"segmentation\":{\"size\":[1,40],\"counts\":[0,$n,$((40 - n))]}}"
			echo "{\"view\":\"v$v\",\"object\":\"obj$o\",\"segmentation\":{\"size\":[1,40],\"counts\":[0,$((n * v)),$((40 - n * v))]}}" >&3
			for r in 0 1; do
				echo "{\"view\":\"v$v\",\"ref\":\"o$o-$r\",\"object\":\"obj$o\",\"segmentation\":{\"size\":[1,40],\"counts\":[$((o / 2)),$((n - r)),$((40 - n + r - o / 2))]}}" >&4
				echo "{\"view\":\"v$v\",\"ref\":\"o$o-$r\",\"object\":\"obj$o\",\"segmentation\":{\"size\":[1,40],\"counts\":[$((r + v - 1)),$n,$((41 - n - r - v))]}}" >&5
			done
		done
	done >truth.jsonl 3>whole.jsonl 4>pred.jsonl 5>other.jsonl
}

@test "--best: each thing has its best object in all views" {
	# "a" is the cup in v1 only, "b" half of it in both
	cat > regions.jsonl <<-END
	{"view":"v1","object":"a","segmentation":$four}
	{"view":"v2","object":"a","segmentation":$none}
	{"view":"v1","object":"b","segmentation":$two}
	{"view":"v2","object":"b","segmentation":'{"size":[1,8],"counts":[0,3,5]}'}
	END
	sed -i "s/'//g" regions.jsonl
	run "$BIN/miou-score" --best --json --truth truth.jsonl regions.jsonl
	[ "$(jq -c '[.objects.cup.miou, .objects.spoon.miou]' <<<"$output")" = '[0.625,1]' ]
	[ "$("$BIN/miou-score" --best --json --truth truth.jsonl truth.jsonl | jq .miou)" = 1 ]
	tac regions.jsonl | "$BIN/miou-score" --best --json --truth truth.jsonl - | cmp - <(echo "$output")
	for other in --boxes "--answers --sentences x" "--compare pred.jsonl"; do
		run "$BIN/miou-score" --best $other --truth truth.jsonl regions.jsonl
		[ "$status" = 2 ]
	done
}

@test "--bootstrap: an interval, and of what" {
	make_scene
	run --separate-stderr "$BIN/miou-score" --truth truth.jsonl --bootstrap 1000 pred.jsonl
	[ "$status" -eq 0 ]
	[ -z "$stderr" ]
	grep -qxE 'mIoU          82\.10 %  \[7[0-9]\.[0-9], 8[0-9]\.[0-9]\]' <<<"${lines[0]}"
	grep -qxE 'overall IoU   80\.00 %  \[7[0-9]\.[0-9], 8[0-9]\.[0-9]\]' <<<"${lines[1]}"
	[ "${lines[9]}" = "interval     95 % of 1000 resamples of 6 objects" ]
	[ "${lines[10]}" = "pairs     mIoU  interval        object" ]
	"$BIN/miou-score" --json --truth truth.jsonl --bootstrap 1000 pred.jsonl | jq -e '.miou_low < .miou and .miou < .miou_high
		and .oiou_low < .oiou and .oiou < .oiou_high and .resampled == "objects" and .units == 6 and .resamples == 1000
		and .confidence == 0.95 and .seed == 1 and .objects.obj3.resampled == "pairs" and .objects.obj3.units == 6
		and .objects.obj3.miou_low <= .objects.obj3.miou'
	# the figures themselves stay
	diff <("$BIN/miou-score" --truth truth.jsonl pred.jsonl | sed 1,2d | head -n 6) \
		<("$BIN/miou-score" --truth truth.jsonl --bootstrap 10 pred.jsonl | sed 1,2d | head -n 6)
	cmp <("$BIN/miou-score" --truth truth.jsonl pred.jsonl) <("$BIN/miou-score" --truth truth.jsonl --bootstrap 0 pred.jsonl)
}

@test "--bootstrap draws pairs where objects are few, and says so" {
	run "$BIN/miou-score" --truth truth.jsonl --bootstrap 100 pred.jsonl
	[ "${lines[9]}" = "interval     95 % of 100 resamples of 4 pairs, as there are fewer than 5 objects" ]
	[ "${lines[12]}" = "    0        -  -               plate" ]
	head -n 1 truth.jsonl >../one.jsonl
	head -n 1 pred.jsonl >../one-pred.jsonl
	run "$BIN/miou-score" --truth ../one.jsonl --bootstrap 100 ../one-pred.jsonl
	[ "${lines[0]}" = "mIoU         100.00 %" ]
	[ "${lines[9]}" = "interval     none: there is one pair alone" ]
	"$BIN/miou-score" --json --truth ../one.jsonl --bootstrap 100 ../one-pred.jsonl |
		jq -e 'has("miou_low") and .miou_low == null and .resampled == null'
}

@test "--confidence widens the interval, --seed changes it" {
	make_scene
	range() { "$BIN/miou-score" --json --truth truth.jsonl --bootstrap 500 "$@" pred.jsonl | jq -c '[.miou_low,.miou_high]'; }
	[ "$(range)" = "$(range --seed 1 --confidence 0.95)" ]
	[ "$(range)" != "$(range --seed 2)" ]
	jq -n -e --argjson narrow "$(range --confidence 0.5)" --argjson wide "$(range)" \
		'$wide[0] < $narrow[0] and $narrow[1] < $wide[1]'
	run "$BIN/miou-score" --truth truth.jsonl --bootstrap 1000001 pred.jsonl
	[ "$status" -eq 2 ]
	[ "${lines[0]}" = "miou-score: --bootstrap: '1000001' is not a whole number from 0 to 1000000" ]
	run "$BIN/miou-score" --truth truth.jsonl --confidence 95 pred.jsonl
	[ "$status" -eq 2 ]
	[ "${lines[0]}" = "miou-score: --confidence: '95' is not a number from 0.01 to 0.9999" ]
}

@test "the number of threads changes no byte" {
	make_scene
	for form in --json --csv -q; do
		all="$form --truth truth.jsonl --bootstrap 2000 --compare other.jsonl --parses parses.jsonl --whole whole.jsonl pred.jsonl"
		cmp <("$BIN/miou-score" --threads 1 $all) <("$BIN/miou-score" --threads 2 $all)
	done
}

@test "--compare: both, the difference, and how sure it is" {
	make_scene
	run --separate-stderr "$BIN/miou-score" --truth truth.jsonl --compare other.jsonl --bootstrap 500 pred.jsonl
	[ "$status" -eq 0 ]
	[ -z "$stderr" ]
	diff - <(echo "$output" | sed -n '11,19p' | sed -E 's/\[[-+0-9., ]+\]/I/') <<-END

	other mIoU    71.67 %  I
	other oIoU    70.00 %  I
	difference   +10.43 %  I, p 0.188
	better           22
	worse             8
	equal             6
	other missed      0

	END
	[ "${lines[17]}" = "pairs     mIoU  interval           other  difference  object" ]
	grep -qxE '    6  69\.54 %  \[6[0-9.]+, 7[0-9.]+\]     75\.81 %     -6\.27 %  obj4' <<<"$output"
	"$BIN/miou-score" --json --truth truth.jsonl --compare other.jsonl --bootstrap 500 pred.jsonl >c.json
	"$BIN/miou-score" --json --truth truth.jsonl pred.jsonl >own.json
	"$BIN/miou-score" --json --truth truth.jsonl other.jsonl >other.json
	jq -s -e '.[0] as $c | $c.miou == .[1].miou and $c.compare.miou == .[2].miou and $c.compare.oiou == .[2].oiou
		and ($c.compare.difference - ($c.miou - $c.compare.miou) | fabs) < 1e-12
		and $c.compare.better + $c.compare.worse + $c.compare.equal == $c.pairs
		and $c.objects.obj2.compare.miou == .[2].objects.obj2.miou
		and $c.compare.difference_low < $c.compare.difference and $c.compare.difference < $c.compare.difference_high
		and $c.compare.p == 0.1875' c.json own.json other.json # 12 of 64 patterns
	[ "$(jq -c '.compare | keys' c.json)" = '["better","difference","difference_high","difference_low","equal","miou","miou_high","miou_low","missing","oiou","oiou_high","oiou_low","p","p25","p50","p75","right","worse"]' ]
	# the intervals are those of each file alone
	for file in pred other; do "$BIN/miou-score" --json --truth truth.jsonl --bootstrap 500 $file.jsonl; done |
		jq -s -e --slurpfile c c.json 'def ends: [.miou_low,.miou_high,.oiou_low,.oiou_high];
			(.[0] | ends) == ($c[0] | ends) and (.[1] | ends) == ($c[0].compare | ends)
			and (.[0] | ends | unique | length) == 4'
	"$BIN/miou-score" --json --truth truth.jsonl --compare pred.jsonl other.jsonl | jq -s -e '.[0].compare.difference == -.[1].compare.difference
		and .[0].compare.better == .[1].compare.worse and (.[0].compare | has("p") | not)' - c.json
}

@test "--compare with the same file: no difference, and p is 1" {
	make_scene
	"$BIN/miou-score" --json --truth truth.jsonl --compare pred.jsonl --bootstrap 100 pred.jsonl | jq -e '.compare |
		.difference == 0 and .difference_low == 0 and .difference_high == 0 and .p == 1 and .better == 0 and .worse == 0 and .equal == 36'
}

@test "--compare: what one file lacks is missing there" {
	make_scene
	sed 1d pred.jsonl >less.jsonl
	"$BIN/miou-score" --json --truth truth.jsonl --compare less.jsonl pred.jsonl |
		jq -e '.pairs == 36 and .missing == 0 and .compare.missing == 1 and .compare.better == 1 and .compare.equal == 35'
	"$BIN/miou-score" --json --truth truth.jsonl --compare pred.jsonl less.jsonl |
		jq -e '.pairs == 36 and .missing == 1 and .compare.missing == 0 and .compare.worse == 1'
	grep -v '"v2"' other.jsonl >views.jsonl
	"$BIN/miou-score" --json --truth truth.jsonl --predicted-views --compare views.jsonl views.jsonl | jq -e '.pairs == 24'
	"$BIN/miou-score" --json --truth truth.jsonl --predicted-views --compare pred.jsonl views.jsonl |
		jq -e '.pairs == 36 and .missing == 12 and .compare.missing == 0'
}

@test "--compare: bad files are named, and duplicates in them" {
	make_scene
	run "$BIN/miou-score" --truth truth.jsonl --compare nowhere.jsonl -o ../out pred.jsonl
	[ "$status" -eq 4 ]
	[ "$output" = "miou-score: nowhere.jsonl: No such file or directory" ]
	{ cat other.jsonl; head -n 1 other.jsonl; } >twice.jsonl
	run "$BIN/miou-score" --truth truth.jsonl --compare twice.jsonl -o ../out pred.jsonl
	[ "$status" -eq 3 ]
	[ "$output" = "miou-score: twice.jsonl:37: view 'v1', ref 'o0-0' is on line 1 already" ]
	echo '{"view":"v1","object":"fork","segmentation":{"size":[1,1],"counts":[1]}}' >>other.jsonl
	run --separate-stderr "$BIN/miou-score" --truth truth.jsonl --compare other.jsonl pred.jsonl
	[ "$stderr" = "miou-score: warning: other.jsonl: 1 predictions of labelled views match no truth's ref or object and were left out" ]
	[ ! -e ../out ]
}

@test "--parses: a row for each relation that occurs" {
	make_scene
	run --separate-stderr "$BIN/miou-score" --truth truth.jsonl --parses parses.jsonl pred.jsonl
	[ "$status" -eq 0 ]
	[ -z "$stderr" ]
	diff - <(echo "$output" | sed -n '/relation/,$p' | sed 's/[0-9.]* %/N/') <<-END
	pairs     mIoU  relation
	   18  N  on
	   18  N  near
	   18  N  (none)
	END
	# the same figures as of those sentences alone
	grep -e '-0"' pred.jsonl >first.jsonl
	[ "$("$BIN/miou-score" --json --truth truth.jsonl --parses parses.jsonl pred.jsonl | jq -c '.relations.on')" = \
		"$("$BIN/miou-score" --json --truth truth.jsonl first.jsonl | jq -c '{pairs,miou,oiou,p25,p50,p75,right,missing}')" ]
}

@test "--parses: pairs without one are a row, and told" {
	make_scene
	sed -i '/o3-/d' parses.jsonl
	run --separate-stderr "$BIN/miou-score" --json --truth truth.jsonl --parses parses.jsonl pred.jsonl
	[ "$status" -eq 0 ]
	[ "$stderr" = "miou-score: warning: parses.jsonl: 6 pairs have no sentence there" ]
	echo "$output" | jq -e '.relations["(unknown)"].pairs == 6 and .relations.on.pairs == 15'
	run "$BIN/miou-score" --truth truth.jsonl --parses truth.jsonl -o ../out pred.jsonl
	[ "$status" -eq 3 ]
	[ "$output" = "miou-score: truth.jsonl:1: key 'ref' is missing" ]
	echo '{"ref":"o3-0","text":"the cup"}' >sentences.jsonl
	run "$BIN/miou-score" --truth truth.jsonl --parses sentences.jsonl -o ../out pred.jsonl
	[ "$status" -eq 3 ]
	[ "$output" = "miou-score: sentences.jsonl:1: key 'target' is missing: text-parse writes such records" ]
	head -n 1 parses.jsonl >>parses.jsonl
	run "$BIN/miou-score" --truth truth.jsonl --parses parses.jsonl -o ../out pred.jsonl
	[ "$status" -eq 3 ]
	[ "$output" = "miou-score: parses.jsonl:11: ref 'o0-0' is already on line 1" ]
	run "$BIN/miou-score" --truth truth.jsonl --parses nowhere.jsonl -o ../out pred.jsonl
	[ "$status" -eq 4 ]
	[ "$output" = "miou-score: nowhere.jsonl: No such file or directory" ]
	run "$BIN/miou-score" --truth truth.jsonl --sentences sentences.jsonl pred.jsonl
	[ "$status" -eq 2 ]
	[ "${lines[0]}" = "miou-score: --sentences goes with --answers only" ]
	[ ! -e ../out ]
}

@test "--whole: a row for each range of what is seen" {
	make_scene
	run --separate-stderr "$BIN/miou-score" --truth truth.jsonl --whole whole.jsonl pred.jsonl
	[ "$status" -eq 0 ]
	[ -z "$stderr" ]
	# all is seen in view 1, a half in view 2, a third in view 3
	diff - <(echo "$output" | sed -n '/visibility/,$p' | sed 's/[0-9.]* %/N/') <<-END
	pairs     mIoU  visibility
	    0        -  <0.15
	   12  N  0.15-0.5
	   12  N  0.5-0.85
	   12  N  >=0.85
	END
	grep '"v2"' pred.jsonl >second.jsonl
	[ "$("$BIN/miou-score" --json --truth truth.jsonl --whole whole.jsonl pred.jsonl | jq -c '.visibility["0.5-0.85"]')" = \
		"$("$BIN/miou-score" --json --truth truth.jsonl --predicted-views second.jsonl | jq -c '{pairs,miou,oiou,p25,p50,p75,right,missing}')" ]
}

@test "--whole: truth without its whole is a row, and told; empty truth is not" {
	make_scene
	sed -i 3,4d whole.jsonl
	run --separate-stderr "$BIN/miou-score" --json --truth truth.jsonl --whole whole.jsonl pred.jsonl
	[ "$status" -eq 0 ]
	[ "$stderr" = "miou-score: warning: whole.jsonl: 2 masks of the truth have no whole there" ]
	echo "$output" | jq -e '.visibility["(unknown)"].pairs == 4 and ([.visibility[].pairs] | add) == .pairs and .visibility["<0.15"].miou == null'
	sed -i '3s/"counts":.*/"counts":[40]}}/' truth.jsonl
	run --separate-stderr "$BIN/miou-score" --json --truth truth.jsonl --whole whole.jsonl pred.jsonl
	[ "$stderr" = "miou-score: warning: whole.jsonl: 1 masks of the truth have no whole there" ]
	echo "$output" | jq -e '.empty_truth == 2 and .visibility["(unknown)"].pairs == 2'
	run "$BIN/miou-score" --truth truth.jsonl --whole parses.jsonl -o ../out pred.jsonl
	[ "$status" -eq 3 ]
	[ "$output" = "miou-score: parses.jsonl:1: key 'view' is missing" ]
	[ ! -e ../out ]
}

@test "only one file is stdin" {
	make_scene
	cmp <("$BIN/miou-score" --truth truth.jsonl --compare other.jsonl pred.jsonl) \
		<("$BIN/miou-score" --truth truth.jsonl --compare - pred.jsonl <other.jsonl)
	cmp <("$BIN/miou-score" --truth truth.jsonl --parses parses.jsonl pred.jsonl) \
		<("$BIN/miou-score" --truth truth.jsonl --parses - pred.jsonl <parses.jsonl)
	cmp <("$BIN/miou-score" --truth truth.jsonl --whole whole.jsonl pred.jsonl) \
		<("$BIN/miou-score" --truth truth.jsonl --whole - pred.jsonl <whole.jsonl)
	for option in --compare --parses --whole; do
		run "$BIN/miou-score" --truth truth.jsonl $option - <pred.jsonl
		[ "$status" -eq 2 ]
		[ "${lines[0]}" = "miou-score: only one file can be stdin" ]
	done
}

@test "many pairs of one view and object take seconds" {
	seq 15000 | sed 's/.*/{"view":"v","ref":"t&","object":"o","segmentation":{"size":[1,1],"counts":[0,1]}}/' >t.jsonl
	sed 's/"t/"p/' t.jsonl >p.jsonl
	sed 's/"view":"v"/"view":"w"/' t.jsonl >w.jsonl
	[ "$(timeout 20 "$BIN/miou-score" --json --truth t.jsonl p.jsonl | jq .pairs)" = 29999 ]
	[ "$(cat t.jsonl w.jsonl | timeout 20 "$BIN/miou-score" --json --predicted-views --truth - w.jsonl | jq .pairs)" = 15000 ]
}

# Two objects beside each other in v1, the cup alone in v2; a sentence for each number of targets.
answers() {
	cat >at.jsonl <<-END
	{"view":"v1","object":"cup","segmentation":{"size":[1,8],"counts":[0,4,4]}}
	{"view":"v1","object":"plate","segmentation":{"size":[1,8],"counts":[4,4]}}
	{"view":"v2","object":"cup","segmentation":$four}
	{"view":"v2","object":"plate","segmentation":$none}
	END
	cat >as.jsonl <<-END
	{"ref":"one","object":"plate","text":"the plate","split":"test"}
	{"ref":"both","objects":["cup","plate"],"text":"both","split":"test","kind":"several"}
	{"ref":"fork","objects":[],"text":"the fork","split":"test","kind":"absent"}
	{"ref":"here","objects":["cup"],"text":"the left one","split":"test","kind":"view","view":"v2"}
	END
	cat >ap.jsonl <<-END
	{"view":"v1","ref":"one","segmentation":{"size":[1,8],"counts":[4,4]}}
	{"view":"v1","ref":"both","segmentation":{"size":[1,8],"counts":[0,5,3]}}
	{"view":"v2","ref":"both","segmentation":$four}
	{"view":"v1","ref":"fork","segmentation":$none}
	{"view":"v2","ref":"fork","segmentation":$two}
	{"view":"v1","ref":"here","segmentation":$two}
	END
}

@test "--answers: one, several and none, by kind" {
	answers
	run --separate-stderr "$BIN/miou-score" --answers --sentences as.jsonl --truth at.jsonl ap.jsonl
	[ "$status" -eq 0 ]
	[ -z "$stderr" ]
	# "both" in v1: 5 of 8 pixels, the cup covered, a quarter of the plate, which is not more than that
	diff - <(echo "$output") <<-END
	pairs     right      mIoU      oIoU   refused   F1@0.25    F1@0.5  means
	    6   50.00 %   60.42 %   59.09 %   16.67 %   61.11 %   61.11 %  all
	    2   50.00 %   50.00 %   50.00 %    0.00 %   50.00 %   50.00 %  one
	    2   50.00 %   81.25 %   75.00 %    0.00 %   83.33 %   83.33 %  several
	    2   50.00 %   50.00 %    0.00 %   50.00 %   50.00 %   50.00 %  none

	pairs     right      mIoU      oIoU   refused   F1@0.25    F1@0.5  kind
	    1  100.00 %  100.00 %  100.00 %    0.00 %  100.00 %  100.00 %  (unknown)
	    2   50.00 %   50.00 %    0.00 %   50.00 %   50.00 %   50.00 %  absent
	    2   50.00 %   81.25 %   75.00 %    0.00 %   83.33 %   83.33 %  several
	    1    0.00 %    0.00 %    0.00 %    0.00 %    0.00 %    0.00 %  view

	N-acc         50.00 %
	T-acc         75.00 %
	missing           1
	out of sight      1
	END
	[ "$("$BIN/miou-score" --answers --json --sentences as.jsonl --truth at.jsonl ap.jsonl | jq -c '[.all.pairs,.none.refused,.several.miou,.kinds.view.missing,.out_of_sight,.several.oiou,.n_acc,.t_acc]')" = '[6,0.5,0.8125,1,1,0.75,0.5,0.75]' ]
	# 13 of 22 pixels
	"$BIN/miou-score" --answers --json --sentences as.jsonl --truth at.jsonl ap.jsonl | jq -e '.all.oiou * 22 - 13 | fabs < 1e-12'
	# without sentences that mean nothing there is no accuracy of them
	"$BIN/miou-score" --answers --json --sentences <(grep -v fork as.jsonl) --truth at.jsonl <(grep -v fork ap.jsonl) | jq -e '.n_acc == null and .t_acc == 0.75'
	"$BIN/miou-score" --answers --sentences <(grep -v fork as.jsonl) --truth at.jsonl <(grep -v fork ap.jsonl) | grep -qx 'N-acc             -'
}

@test "--answers: the order of the files does not matter, nor threads or names in another alphabet" {
	answers
	"$BIN/miou-score" --answers --json --sentences as.jsonl --truth at.jsonl ap.jsonl >one
	"$BIN/miou-score" --answers --json --threads 7 --sentences as.jsonl --truth <(tac at.jsonl) <(tac ap.jsonl) >two
	cmp one two
	sed -i 's/"cup"/"чашка"/; s/"plate"/"Ω"/' at.jsonl as.jsonl
	sed -i 's/\["cup","plate"\]/["чашка","Ω"]/; s/,"plate"\]/,"Ω"]/' as.jsonl
	"$BIN/miou-score" --answers --json --sentences as.jsonl --truth at.jsonl ap.jsonl >three
	cmp one three
}

@test "--answers: warnings, --fail-under, and what does not go with it" {
	answers
	run --separate-stderr "$BIN/miou-score" --answers --sentences <(sed 's/\["cup"\]/["mug"]/' as.jsonl; echo) --truth at.jsonl \
		<(cat ap.jsonl; echo "{\"view\":\"v1\",\"ref\":\"x\",\"segmentation\":$two}")
	[ "$status" -eq 0 ]
	[[ "${stderr_lines[0]}" == *": 1 sentences mean an object that at.jsonl does not have" ]]
	[[ "${stderr_lines[1]}" == *": 1 predictions have no sentence's ref and were left out" ]]
	run --separate-stderr "$BIN/miou-score" --answers --fail-under 0.6 --sentences as.jsonl --truth at.jsonl ap.jsonl
	[ "$status" -eq 1 ]
	[ "$stderr" = "miou-score: right 0.5000 is below 0.6" ]
	run "$BIN/miou-score" --answers --truth at.jsonl ap.jsonl
	[ "$status" -eq 2 ]
	[ "${lines[0]}" = "miou-score: --answers needs --sentences" ]
	run "$BIN/miou-score" --answers --csv --sentences as.jsonl --truth at.jsonl ap.jsonl
	[ "$status" -eq 2 ]
	[ "${lines[0]}" = "miou-score: --answers goes with --truth, --sentences, --predicted-views, --json and --fail-under only" ]
	echo '{"ref":"x","objects":["mug"],"text":"mug","split":"test"}' >nothing.jsonl
	run --separate-stderr "$BIN/miou-score" --answers --sentences nothing.jsonl --truth at.jsonl ap.jsonl
	[ "$status" -eq 3 ]
	[ "$stderr" = "miou-score: at.jsonl: shows nothing that a sentence means: there is nothing to score" ]
	[ -z "$output" ]
}
