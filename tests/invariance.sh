#!/usr/bin/env bash
# What must not matter: a small synthetic scene in other units, turned, shifted, with other names and in other orders goes through
# import, weigh, select, lift, render, locate and ask; the answers are compared with those of the scene as it is.
# usage: tests/invariance.sh BIN. Prints a Markdown table: masks that are equal to the byte, the mean intersection over union of all,
# how far boxes are off, in shares of their width, and questions that are answered by the same things. The status is 1 where
# anything is further off than its row allows. KEEP is a folder for what was made.
set -u
here=$(cd "$(dirname "$0")/.." && pwd)
bin=$(cd "$1" && pwd)
export PATH=$bin:$PATH OMP_WAIT_POLICY=passive OMP_NUM_THREADS=1 LC_ALL=C.UTF-8
work=${KEEP:-$(mktemp -d)}
mkdir -p "$work"
[ -n "${KEEP-}" ] || trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
questions='where is the blue cone?
the box to the left of the book
what is farthest from the cone?
the two boxes that are next to each other
how tall is the blue cone?
how high above the table is the book?'

# through FOLDER: everything, from its splats, cameras and records.
through() (
	cd "$1" || exit 1
	gs-import -q --cameras sparse/0 --test-views "$(cat test-views)" -o scene point_cloud.ply &&
		gs-weigh -q --packed --tolerance 0.05 -o weights scene &&
		text-encode -q --model "$here/tests/golden/bert" -o text sentences.jsonl &&
		pseudomask-select -q --scene scene --weights weights --spare spare -o masks candidates.jsonl &&
		{ [ ! -e is_reversed ] || { tac masks >reversed && mv reversed masks; }; } &&
		refer-lift -q --scene scene --weights weights --text text --masks masks --spare spare -o lifted &&
		refer-render -q --scene scene --text text --model lifted --split all -o rendered &&
		refer-locate -q --scene scene --text text --model lifted -o located &&
		refer-ask -q --scene scene --model lifted --encoder "$here/tests/golden/bert" --json . <<<"$questions" >asked
)

# moved FOLDER SCALE X,Y,Z W,X,Y,Z: base, scaled, turned, then shifted.
moved() {
	cp -r base "$1"
	awk -v s="$2" -v d="$3" -v q="$4" '
		BEGIN { split(d, t, ","); split(q, p, ",") }
		/^#/ || NF < 10 { print; next }
		{	# x_camera = R x + t, and x = Q^T (x_moved - d) / s: the rotation is R Q^T, the translation s t - R Q^T d
			w = $2 * p[1] + $3 * p[2] + $4 * p[3] + $5 * p[4]
			x = -$2 * p[2] + $3 * p[1] - $4 * p[4] + $5 * p[3]
			y = -$2 * p[3] + $3 * p[4] + $4 * p[1] - $5 * p[2]
			z = -$2 * p[4] - $3 * p[3] + $4 * p[2] + $5 * p[1]
			$6 = s * $6 - ((1 - 2 * (y * y + z * z)) * t[1] + 2 * (x * y - w * z) * t[2] + 2 * (x * z + w * y) * t[3])
			$7 = s * $7 - (2 * (x * y + w * z) * t[1] + (1 - 2 * (x * x + z * z)) * t[2] + 2 * (y * z - w * x) * t[3])
			$8 = s * $8 - (2 * (x * z - w * y) * t[1] + 2 * (y * z + w * x) * t[2] + (1 - 2 * (x * x + y * y)) * t[3])
			$2 = w; $3 = x; $4 = y; $5 = z
			print
		}' CONVFMT=%.17g OFMT=%.17g base/sparse/0/images.txt >"$1/sparse/0/images.txt"
	gs-transform -q --scale "$2" --rotate "$4" -o "$1/turned.ply" base/point_cloud.ply
	rows "$1/turned.ply" "$1/point_cloud.ply" -v d="$3" 'BEGIN { split(d, t, ",") } { $1 += t[1]; $2 += t[2]; $3 += t[3]; print }'
}

# rows FROM TO AWK...: a .ply as text, its positions in double, its rows as AWK prints them.
rows() {
	local from=$1 to=$2 header
	shift 2
	header=$(sed '/^end_header$/q' "$from" | tr -d '\0' | wc -c)
	{
		head -c "$header" "$from" | sed 's/^format .*/format ascii 1.0/; s/float \([xyz]\)$/double \1/'
		tail -c +$((header + 1)) "$from" | od -An -v -t f4 -w$((4 * $(head -c "$header" "$from" | grep -c ^property))) |
			awk -v CONVFMT=%.17g -v OFMT=%.17g "$@"
	} >"$to"
}

# again FOLDER: base, for its views or records to be changed.
again() {
	cp -r base "$1"
	rm -rf "$1"/{scene,weights,text,spare,masks,lifted,rendered,located,asked}
}

# row FOLDER SCALE LEAST MOST WHAT: a variant beside base. LEAST is the mean intersection over union of its masks, `equal` where all bytes
# have to be the same; MOST how far boxes may be off.
row() {
	local folder=$1 scale=$2 least=$3 most=$4 iou equal all box answers verdict=
	through "$folder" || { echo "$5: failed" >&2; failed=1; return; }
	[ ! -e "$folder/names" ] || sed -i -f "$folder/names" "$folder/rendered"
	for f in base "$folder"; do
		jq -c '[.view, .ref, .segmentation]' "$f/rendered" | sort >"$f/masks.txt"
		jq -r '[.question, .answered] + [.things[].name] + [.value // "" | capture("(?<n>[0-9.]+) times").n] | join("|")' "$f/asked" >"$f/answers.txt"
	done
	all=$(wc -l <base/masks.txt)
	equal=$(comm -12 base/masks.txt "$folder/masks.txt" | wc -l)
	iou=$(miou-score --json -q --truth base/rendered --predicted-views "$folder/rendered" | jq .miou)
	box=$(paste <(boxes base) <(boxes "$folder") | awk -v s="$scale" '{
		for (i = 2; i < 6; i++) { d = $(i + 5) / s - $i; d = (d < 0 ? -d : d) / $4; if (d > most) most = d } } END { printf "%.1e", most }')
	answers=$(diff base/answers.txt "$folder/answers.txt" | grep -c '^>')
	[ "$least" != equal ] || [ "$equal" = "$all" ] || verdict=FAILED:
	awk -v i="$iou" -v l="${least/equal/1}" -v b="$box" -v m="$most" -v a="$answers" 'BEGIN { exit !(i >= l && b <= m && a == 0) }' || verdict=FAILED:
	[ -z "$verdict" ] || failed=1
	printf '| %s%s | %d of %d | %.4f | %s | %d of %d |\n' "$verdict" "$5" "$equal" "$all" "$iou" "$box" \
		$(($(wc -l <base/answers.txt) - answers)) "$(wc -l <base/answers.txt)"
}
# Of a ref's box: the sides of its foot, the height, and how far it is from that of the first ref.
boxes() {
	jq -rs 'map(select(.oriented)) | sort_by(.ref) | .[0].oriented.centre as $c | .[] | [.ref, (.oriented.size[:2] | sort)[], .oriented.size[2],
		([.oriented.centre, $c] | transpose | map((.[0] - .[1]) * (.[0] - .[1])) | add | sqrt)] | @tsv' "$1/located"
}

# One more Gaussian hides the first view, so near to its camera that 0.2 leaves it out.
gs-synth -q --objects 5 --views 8 --size 80x60 --gaussians 3000 -o base || exit 1
mv base/point_cloud.ply clear.ply
rows clear.ply base/point_cloud.ply -v eye="$(awk '/^1 / { print $2, $3, $4, $5, $6, $7, $8 - 0.15 }' base/sparse/0/images.txt)" '
	BEGIN { split(eye, c) }
	NR == 1 {	# where the camera sees 0 0 0.15: -R^T t
		w = c[1]; x = -c[2]; y = -c[3]; z = -c[4]; kept = $0
		$1 = -((1 - 2 * (y * y + z * z)) * c[5] + 2 * (x * y - w * z) * c[6] + 2 * (x * z + w * y) * c[7])
		$2 = -(2 * (x * y + w * z) * c[5] + (1 - 2 * (x * x + z * z)) * c[6] + 2 * (y * z - w * x) * c[7])
		$3 = -(2 * (x * z - w * y) * c[5] + 2 * (y * z + w * x) * c[6] + (1 - 2 * (x * x + y * y)) * c[7])
		$19 = 5; $20 = $21 = $22 = log(0.05)
		print
		$0 = kept
	}
	{ print }'
sed -i 's/^element vertex 3000/element vertex 3001/' base/point_cloud.ply
failed=0
through base || exit 1
echo '| what is changed | masks that are equal | mean IoU | boxes are off by | questions with the same answer |'
echo '|---|---|---|---|---|'
for s in 0.001 0.04 1 30 1000; do
	moved s$s $s 0,0,0 1,0,0,0
	row s$s $s equal 1e-6 "scaled by $s"
done
# Boxes lie by the world's axes to two degrees.
moved turned 1 0,0,0 0.5,0.1,-0.7,0.5
row turned 1 equal 0.05 'turned'
# In double; the offset is whole, and what is left is rounded to float.
moved shifted 1 1000000,-524288,65536 1,0,0,0
row shifted 1 equal 1e-4 'shifted by 10^6'
moved all 0.04 400000,-3,70 0.5,0.1,-0.7,0.5
row all 0.04 equal 0.05 'scaled, turned and shifted'
again views
sed '/^#/d; /^$/d' base/sparse/0/images.txt | tac | sed 's/$/\n/' >views/sparse/0/images.txt
row views 1 equal 0 'order of the views'
# renamed FOLDER NAME...: views get other names.
renamed() {
	local folder=$1 i=0 name
	shift
	again "$folder"
	for name in "$@"; do
		echo "s/view_00$i/photo $name/" >&3
		echo "s/\"view\":\"photo $name\"/\"view\":\"view_00$i\"/" >&4
		i=$((i + 1))
	done 3>"$folder"/to 4>"$folder"/names
	sed -i -f "$folder/to" "$folder"/{sparse/0/images.txt,candidates.jsonl,test-views}
}
renamed names 1 Z e é Ω Ж а 見
row names 1 equal 0 'names of the views'
renamed others ю а 見 é Ω 9 z Ζ
row others 1 equal 0 'names of the views, and so their order'
again gaussians
awk '!rows { print; rows = /^end_header/; next } { row[n++] = $0 } END { for (i = 0; i < n; i++) print row[i * 7919 % n] }' \
	base/point_cloud.ply >gaussians/point_cloud.ply
row gaussians 1 equal 1e-6 'order of the Gaussians'
for file in sentences candidates; do
	again $file
	tac base/$file.jsonl >$file/$file.jsonl
	row $file 1 equal 0 "order of the $file"
done
again masks
touch masks/is_reversed
row masks 1 equal 0 'order of the masks'
exit $failed
