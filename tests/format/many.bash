# Files with many entries, in $work: make_KIND N NAME. Sourced by tests/format/many.bats and tests/bench/readers.sh.

# st FILE: the JSON header on stdin as a safetensors file without data.
st() {
	local length i bytes=
	cat >"$work/header"
	length=$(wc -c <"$work/header")
	for ((i = 0; i < 8; i++)); do bytes+=$(printf '\\%03o' $((length >> 8 * i & 255))); done
	{ printf '%b' "$bytes"; cat "$work/header"; } >"$1"
}

# lines N FORMAT: the format with the number for each @, for 1 to N.
lines() {
	awk -v n="$1" -v format="$2" 'BEGIN {
		k = split(format, part, "@")
		for (i = 1; i <= n; i++) {
			line = part[1]
			for (j = 2; j <= k; j++) line = line i part[j]
			print line
		}
	}'
}

# listed N FORMAT: the same with commas between.
listed() {
	lines "$1" "$2" | sed '$!s/$/,/'
}

# view: what a view of a scene has besides its name.
view='"width":2,"height":2,"fx":5,"fy":5,"cx":1,"cy":1,"world_to_camera":[[1,0,0,0],[0,1,0,0],[0,0,1,2],[0,0,0,1]],"split":"train","image":null'
mask='"segmentation":{"size":[2,2],"counts":[0,4]}'

make_tensors() { # each with a checksum among the metadata
	{
		printf '{"__metadata__":{'
		listed "$1" '"crc32.t@":"00000000"'
		printf '},'
		listed "$1" '"t@":{"dtype":"F32","shape":[0],"data_offsets":[0,0]}'
		printf '}'
	} | st "$work/$2"
}
make_views() { { echo '['; listed "$1" '{"name":"v@",'"$view"'}'; echo ']'; } >"$work/$2"; }
make_cameras3dgs() {
	{
		echo '['
		listed "$1" '{"id":@,"img_name":"v@","width":2,"height":2,"position":[0,0,0],"rotation":[[1,0,0],[0,1,0],[0,0,1]],"fx":5,"fy":5}'
		echo ']'
	} >"$work/$2"
}
make_transforms() {
	{
		echo '{"fl_x":5,"fl_y":5,"cx":1,"cy":1,"w":2,"h":2,"frames":['
		listed "$1" '{"file_path":"v@.png","transform_matrix":[[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]}'
		echo '],"test_filenames":['
		listed "$1" '"v@.png"'
		echo ']}'
	} >"$work/$2"
}
make_colmap() {
	mkdir -p "$work/$2"
	lines "$1" '@ PINHOLE 2 2 5 5 1 1' >"$work/$2/cameras.txt"
	lines "$1" '@ 1 0 0 0 0 0 0 @ v@.png' | sed G >"$work/$2/images.txt"
}
make_sentences() { lines "$1" '{"ref":"r@","object":"o@","text":"a cup"}' >"$work/$2"; }
make_masks() { lines "$1" '{"view":"v@","ref":"r@","object":"o@",'"$mask"'}' >"$work/$2"; }
make_boxes() {
	lines "$1" '{"ref":"r@","object":"o@","min":[0,0,0],"max":[1,1,1],"oriented":{"centre":[0,0,0],"quat":[1,0,0,0],"size":[1,1,1]}}' \
		>"$work/$2"
}
ply_fields='x y z f_dc_0 f_dc_1 f_dc_2 opacity scale_0 scale_1 scale_2 rot_0 rot_1 rot_2 rot_3'
make_properties() { # a header may have 1 MiB: less than 100,000 properties
	{
		printf 'ply\nformat binary_little_endian 1.0\nelement vertex 0\n'
		printf 'property float %s\n' $ply_fields
		lines $(($1 / 2)) 'property char @'
		echo end_header
	} >"$work/$2"
}
make_elements() { # as above
	{
		printf 'ply\nformat binary_little_endian 1.0\n'
		lines $(($1 / 2)) 'element @ 0'
		echo element vertex 0
		printf 'property float %s\n' $ply_fields
		echo end_header
	} >"$work/$2"
}
make_truth() { make_masks "$@"; }
make_pool() { make_masks "$@"; }
make_box_truth() { make_boxes "$@"; }
