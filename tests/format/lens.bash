# A scene, its cameras with a lens in place of the pinhole, and masks as they are on the photographs of that lens. BIN has the tools.

# made SIZE: a synthetic scene of that size, and its import, plain.
made() {
	"$BIN/gs-synth" -q --seed 3 --objects 3 --views 10 --size "$1" --gaussians 1500 -o made
	"$BIN/gs-import" -q -o plain made/point_cloud.ply
}

# bent MODEL PARAMETER...: the scene's COLMAP model, its one camera replaced by this, and what --undistort makes of it: flat.
bent() {
	local width height
	mkdir -p bent
	cp made/sparse/0/images.txt bent
	read -r width height < <(awk '!/^#/ { print $3, $4 }' made/sparse/0/cameras.txt)
	echo "1 $1 $width $height ${*:2}" >bent/cameras.txt
	rm -rf flat
	"$BIN/gs-import" --undistort --cameras bent -o flat made/point_cloud.ply
}

# twin: a scene whose views are those of plain, and their photographs those of bent.
twin() {
	mkdir -p twin
	jq --slurpfile flat flat/cameras.json 'map(. as $v | .lens = ($flat[0][] | select(.name == $v.name).lens))' plain/cameras.json >twin/cameras.json
}

# drawn MASKS: these masks of plain's views as masks of bent's photographs.
drawn() {
	"$BIN/mask-export" --distort --scene twin -o coco.json "$1"
	jq -c -n --slurpfile records "$1" --slurpfile coco coco.json \
		'$records | to_entries[] | .value + {segmentation: $coco[0].annotations[.key].segmentation}'
}

# iou TRUTH MASKS LEAST: every mask has its like, and IoU is at least that in the mean.
iou() { "$BIN/miou-score" --json --quiet --truth "$1" "$2" | jq -e --argjson least "$3" '.missing == 0 and .pairs > 0 and .miou >= $least'; }
