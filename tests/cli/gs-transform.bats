#!/usr/bin/env bats
# gs-transform. Options that every tool has are in common.bats; what the formats are, in format/ply.bats, spz.bats and sog.bats; whether
# a moved scene looks as it did, in unit/test_move.c.

setup() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	load ../format/files
	load ../format/foreign
	cd "$BATS_TEST_TMPDIR"
	splats_ply s.ply
}

# rows FILE [PROPERTY]: the numbers of a binary .ply that the tool wrote, a line a Gaussian; by default the means.
rows() {
	local size
	size=$(grep -aob end_header "$1" | cut -d: -f1)
	tail -c +$((size + 12)) "$1" | od -An -v -w68 -tf4 | awk -v from="${2:-1}" -v n="${3:-3}" '{
		for (k = from; k < from + n; k++) {
			v = sprintf("%.3f", $k) + 0
			printf("%s%g", (k > from ? " " : ""), (v == 0 ? 0 : v))
		}
		print ""
	}'
}

try() { "$BIN/gs-transform" "$@"; }

# mistake MESSAGE ARGUMENT...
mistake() {
	local message=$1
	shift
	says 2 "gs-transform: $message
Try 'gs-transform --help'." "$BIN/gs-transform" -o out.ply "$@" s.ply && [ ! -e out.ply ]
}

@test "a .ply of a .ply is the same scene" {
	try -o out.ply s.ply
	[ "$(rows out.ply)" = "$(printf '0 0 2\n1 0 3')" ]
	colmap model
	for f in s out; do "$BIN/gs-import" --cameras model -o "of_$f" $f.ply; done
	cmp of_s/splats.safetensors of_out/splats.safetensors
	try -o again.ply out.ply
	cmp out.ply again.ply
}

@test "through every format and back: means stay, to the format's step" {
	for file in a.splat a.spz b.spz c.spz a.glb a.sog; do
		case $file in a.spz) v=2 ;; b.spz) v=3 ;; *) v=4 ;; esac
		try --spz-version $v -o $file s.ply
		try -o out.ply $file
		[ "$(rows out.ply | sort)" = "$(printf '0 0 2\n1 0 3')" ]
	done
	[ "$(wc -c <a.splat)" = 64 ]
	[ "$(zcat a.spz | xxd -p -s 4 -l 1)$(zcat b.spz | xxd -p -s 4 -l 1)$(xxd -p -s 4 -l 1 c.spz)" = 020304 ]
}

@test "--format, and standard input and output" {
	try --format spz -o a.bin s.ply
	try -o a.spz s.ply
	cmp a.bin a.spz
	try --format spz -o - - <s.ply | cmp - a.spz
	says 2 "gs-transform: -o a.bin: not .ply, .splat, .spz, .glb or .sog, and --format is not given
Try 'gs-transform --help'." "$BIN/gs-transform" -o a.bin s.ply
	says 2 "gs-transform: -o -: not .ply, .splat, .spz, .glb or .sog, and --format is not given
Try 'gs-transform --help'." "$BIN/gs-transform" -o - s.ply
}

@test "--crop keeps what is in the box, its faces too" {
	try --crop 1,-1,2.5,2,1,3 -o out.ply s.ply
	[ "$(rows out.ply)" = "1 0 3" ]
	try -v --crop 5,5,5,6,6,6 -o out.ply s.ply 2>err
	[ "$(rows out.ply)" = "" ]
	grep -qx "gs-transform: 2 Gaussians are outside the box" err
}

@test "--drop-strays: those far from all others" {
	rows=()
	for x in 0 1 2 3 4 5 6 7 8 9; do for y in 0 1; do rows+=("$x $y 2 1 0.5 0 0 -3 -3 -3 1 0 0 0"); done; done
	splats_ply grid.ply "${rows[@]}" '60 0 2 1 0.5 0 0 -3 -3 -3 1 0 0 0'
	try -v --drop-strays -o out.ply grid.ply 2>err
	grep -qx "gs-transform: 1 Gaussians are strays" err
	[ "$(rows out.ply | wc -l)" = 20 ]
	not grep -q 60 <(rows out.ply)
}

@test "scale, rotation and shift, in this order; an axis and a quaternion say the same" {
	try --translate 1,2,-3 --rotate 0,0,2:90 --scale 2 -o out.ply s.ply
	[ "$(rows out.ply)" = "$(printf '1 2 1\n1 4 3')" ]
	# the first Gaussian's scale and rotation: log(2) more, and a quarter turn
	[ "$(rows out.ply 11 3 | head -n 1)" = "-2.307 -2.307 -2.307" ]
	[ "$(rows out.ply 14 4 | head -n 1)" = "0.707 0 0 0.707" ]
	try --translate 1,2,-3 --rotate 3,0,0,3 --scale 2 -o same.ply s.ply
	[ "$(rows same.ply 1 17)" = "$(rows out.ply 1 17)" ]
}

@test "--known: two points become as far apart as is known" {
	# 2 units apart, now 5: (1, 0, 3) becomes (2.5, 0, 7.5)
	try -v --known 0,0,1,0,0,3=5 -o out.ply s.ply 2>err
	[ "$(rows out.ply)" = "$(printf '0 0 5\n2.5 0 7.5')" ]
	grep -qx "gs-transform: everything is 2.5 times as large" err
	try --scale 2.5 -o same.ply s.ply
	cmp same.ply out.ply
}

# Cameras that look along x and down a little, whose x axes are level where z is up.
@test "--up-from: what is up for cameras becomes -y, then --rotate" {
	mkdir cameras
	printf '1 PINHOLE 40 30 50 51 20 15\n' >cameras/cameras.txt
	# camera axes in the world: x (0,-1,0), y (0,0,-1), z (1,0,0), and another turned about z
	printf '1 0.5 0.5 -0.5 0.5 0 0 0 1 a.jpg\n\n2 0 -0.707107 0 -0.707107 0 0 0 1 b.jpg\n\n' >cameras/images.txt
	try -v --up-from cameras -o out.ply s.ply 2>err
	up=$(sed -n 's/^gs-transform: up was //p' err)
	[ -n "$up" ]
	# its own up, turned likewise, is -y: a Gaussian there is
	splats_ply up.ply "$up 1 0.5 0 0 -3 -3 -3 1 0 0 0"
	try --up-from cameras -o out.ply up.ply
	[ "$(rows out.ply)" = "0 -1 0" ]
	try --up-from cameras --rotate 1,0,0:-90 -o out.ply up.ply
	[ "$(rows out.ply)" = "0 0 1" ]
	# distances stay
	try --up-from cameras -o out.ply s.ply
	rows out.ply | awk '{ d = $1 ^ 2 + $2 ^ 2 + $3 ^ 2; if (NR == 1 && (d < 3.99 || d > 4.01) || NR == 2 && (d < 9.98 || d > 10.02)) exit 1 }'
	says 4 "gs-transform: none: No such file or directory" "$BIN/gs-transform" --up-from none -o no.ply s.ply
	[ ! -e no.ply ]
}

@test "--up-from of a synthetic scene: its table is level" {
	"$BIN/gs-synth" -q --objects 3 --views 5 --size 32x24 --gaussians 1000 -o made
	try -v --up-from made/sparse/0 -o out.ply made/point_cloud.ply 2>err
	# up is z there
	awk '/up was/ { found = 1; exit !($6 > 0.99) } END { exit !found }' err
}

@test "there and back" {
	try --rotate 1,2,3:77 -o there.ply s.ply
	try --rotate 1,2,3:-77 -o back.ply there.ply
	[ "$(rows back.ply)" = "$(printf '0 0 2\n1 0 3')" ]
}

@test "a scene far from the origin keeps its place" {
	splats_ply far.ply '100000 0 50 1 0.5 0 0 -3 -3 -3 1 0 0 0' '100001 0 50 1 0.5 0 0 -3 -3 -3 1 0 0 0'
	try --translate -100000,0,0 --crop 100000.5,-1,0,200000,1,100 -o out.ply far.ply
	try -o near.ply out.ply
	"$BIN/gs-check" near.ply | grep -q ' 1 gaussians'
	# what is left of the offset makes positions doubles
	size=$(grep -aob end_header out.ply | cut -d: -f1)
	[ "$(tail -c +$((size + 12)) out.ply | od -An -w24 -tf8 -N 24 | tr -s ' ')" = " 1 0 50" ]
}

@test "what a format loses of very small, large and far scenes is told" {
	"$BIN/gs-synth" -q --objects 2 --views 2 --size 32x24 --gaussians 1000 -o made
	lost() { # FILE WHAT OPTION...
		local file=$1 what=$2
		shift 2
		try -o "$file" "$@" made/point_cloud.ply 2>err
		[[ $(cat err) == "gs-transform: warning: $file: "$what ]] || { cat err; return 1; }
	}
	small="*Gaussians are not within 4.5e-05 to 380, all that .spz has, and become larger or smaller: give the scene another unit with --scale, or write a .ply"
	off="places are rounded to steps of 0.*, and half of the Gaussians are smaller than 0.*: move the scene to the origin *"
	lost x.spz "$small" --scale 0.001
	lost x.spz "$small" --scale 100000
	lost x.spz "$off" --translate 1000000,0,0
	lost x.splat "$off" --translate 1000000,0,0
	for kept in "x.spz 1" "x.sog 1" "x.sog 0.001" "x.sog 1000" "x.splat 0.001" "x.splat 1000" "x.ply 0.001" "x.glb 1000"; do
		set -- $kept
		[ -z "$(try --scale "$2" -o "$1" made/point_cloud.ply 2>&1)" ]
	done
	[ -z "$(try --translate 1000000,0,0 -o x.glb made/point_cloud.ply 2>&1)" ]
	# smaller Gaussians, more fraction bits
	try -q --scale 0.005 -o small.spz made/point_cloud.ply
	[ "$(gunzip -c <small.spz | od -An -tu1 -j13 -N1)" -gt 16 ]
}

@test "mistakes" {
	for text in 1,2,3 1,2,3,4,5 a,2,3,4,5,6 2,0,0,1,1,1 '1,2,3,4,5, 6' 1,2,3,4,5,6,7 1,2,3,4,5,nan; do
		mistake "--crop: '$text' is not X0,Y0,Z0,X1,Y1,Z1, the least values first" --crop "$text"
	done
	for text in 1,2,3 0,0,0,0 0,0,0:90 1,2,3: :90 1,2:3 1,2,3:x 1,2,3,4,5; do
		mistake "--rotate: '$text' is not W,X,Y,Z or X,Y,Z:DEGREES, of a length" --rotate "$text"
	done
	for text in 1,2,3,4,5,6 1,2,3,4,5=6 1,2,3,1,2,3=1 0,0,0,1,1,1=0 0,0,0,1,1,1=-1 0,0,0,1,1,1= 0,0,0,1,1,1=x =1; do
		mistake "--known: '$text' is not X0,Y0,Z0,X1,Y1,Z1=LENGTH, two points and a length" --known "$text"
	done
	mistake "--known and --scale do not go together" --known 0,0,0,1,1,1=2 --scale 3
	for text in 1 1,2 1,2,3,4 x; do
		mistake "--translate: '$text' is not X,Y,Z" --translate "$text"
	done
}

@test "the input is not overwritten, and a failure leaves nothing" {
	cp s.ply before
	says 2 "gs-transform: -o ./s.ply would overwrite SPLATS s.ply
Try 'gs-transform --help'." "$BIN/gs-transform" -o ./s.ply s.ply
	cmp s.ply before
	head -c 300 s.ply >cut.ply
	not try -o out.ply cut.ply 2>err
	[ ! -e out.ply ]
	splats_ply wide.ply '9000000 0 2 1 0.5 0 0 -3 -3 -3 1 0 0 0'
	says 3 "gs-transform: out.spz: means beyond 8388606, or more than 4294967295 Gaussians, do not fit an .spz" \
		"$BIN/gs-transform" -o out.spz wide.ply
	[ ! -e out.spz ]
}

@test "Gaussians that nothing can be done with: a warning" {
	splats_ply bad.ply '0 0 2 1 0.5 0 0 -3 -3 -3 1 0 0 0' '0 0 2 1 0.5 0 0 -3 -3 -3 0 0 0 0'
	says 0 "gs-transform: warning: bad.ply: left out 1 of 2 Gaussians: 0 not finite, 1 with a zero quaternion" \
		"$BIN/gs-transform" -o out.ply bad.ply
	says 0 "" "$BIN/gs-transform" -q -o out.ply bad.ply
}

# Fails where the command succeeds.
not() { ! "$@"; }
