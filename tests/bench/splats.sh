#!/usr/bin/env bash
# PSNR of test views against the processor's seconds of gs-train, for sizes of photographs, numbers of Gaussians and degrees of the
# harmonics: BUILD/bench/splats.jsonl. Each point is a training of its own: what a training shows halfway is not what a shorter one ends
# with. With DATA of the desk, without it of a synthetic scene of 160x120.
. tests/bench/common.sh
results=$out/splats.jsonl scene=$out/scenes/splats steps="250 500 1000 2000"
[ -z "$FULL" ] || steps="500 1000 2000 4000 8000"
if [ -n "$DATA" ]; then
	given="--cameras $DATA/sparse/0 --images $DATA/images" whole=0.3333 half=0.1667 many=50000 few=15000
else
	given="--cameras $scene/sparse/0 --images $scene/images" whole=1 half=0.5 many=8000 few=2000
	rm -rf "$scene"
	logged "$out/log/gs-synth" gs-synth --seed 1 --objects 6 --views 41 --size 160x120 --gaussians 6000 -o "$scene" && $here/points.sh "$scene" ||
		die "no scene"
fi

# measure SERIES OPTION...: trainings of all lengths, judged at one size.
measure() {
	local series=$1 n log=$out/log/gs-train begin end
	shift
	for n in $steps; do
		begin=$(cut -d' ' -f16,17 /proc/$$/stat)
		logged "$log" gs-train $given --test-views every:8 --iterations "$n" "$@" -o "$out/trained.ply" || return
		end=$(cut -d' ' -f16,17 /proc/$$/stat)
		logged "$log.judged" gs-train $given --test-views every:8 --exposure never --init "$out/trained.ply" --iterations 0 --scale $whole -o "$out/judged.ply" || return
		awk -v series="$series" -v n="$n" -v begin="$begin" -v end="$end" -v hertz="$(getconf CLK_TCK)" 'BEGIN { split(begin, a); split(end, b) }
			/test views: PSNR/ { sub(/.*PSNR /, ""); psnr = $1 } /are shown and written/ { sub(/.*of which /, ""); gaussians = $1 }
			END { printf "{\"bench\":\"splats\",\"series\":\"%s\",\"steps\":%d,\"seconds\":%.2f,\"psnr\":%s,\"gaussians\":%d}\n", series, n, (b[1] + b[2] - a[1] - a[2]) / hertz, psnr, gaussians }' \
			"$log.judged" >>"$results"
	done
}

heading "splats: PSNR of test views, gs-train"
: >"$results"
measure "all of it" --scale $whole --gaussians $many &&
	measure "half the size" --scale $half --gaussians $many &&
	measure "few Gaussians" --scale $whole --gaussians $few &&
	measure "degree 0" --scale $whole --gaussians $many --degree 0 || die "gs-train failed"
rm -f "$out"/{trained,judged}.ply
{
	printf 'series\tsteps\tseconds\tPSNR, dB\tGaussians\n'
	jq -r '[.series, .steps, .seconds, .psnr, .gaussians] | @tsv' "$results"
} | table
{
	plot_head "Splats of photographs" "$many Gaussians at most, $few where they are few" "seconds of a processor" "PSNR of test views, dB" xlog
	jq -r '[.series, .seconds, .psnr] | @tsv' "$results"
} | plot splats-seconds
