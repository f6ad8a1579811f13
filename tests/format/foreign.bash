# Helpers that make files of other programs: the smallest, with one thing changed. `load files` first.

# The properties of a 3DGS .ply of SH degree 0, without normals.
ply_names='x y z f_dc_0 f_dc_1 f_dc_2 opacity scale_0 scale_1 scale_2 rot_0 rot_1 rot_2 rot_3'

# ply_header COUNT [NAMES] [FORMAT]
ply_header() {
	printf 'ply\nformat %s 1.0\nelement vertex %s\n' "${3:-ascii}" "$1"
	printf 'property float %s\n' ${2:-$ply_names}
	echo end_header
}

# splats_ply FILE [ROW]...: an ascii .ply with these rows, by default two Gaussians.
splats_ply() {
	local file=$1
	shift
	[ $# -gt 0 ] || set -- '0 0 2 1 0.5 0 0 -3 -3 -3 1 0 0 0' '1 0 3 0 0.5 1 2 -2 -3 -4 0.5 0.5 0.5 0.5'
	{ ply_header $#; printf '%s\n' "$@"; } >"$file"
}

# colmap DIR: a text model of three views, b.jpg, a.jpg and c.jpg.
colmap() {
	mkdir -p "$1"
	printf '# cameras\n1 PINHOLE 40 30 50 51 20 15\n2 SIMPLE_PINHOLE 40 30 50 20 15\n' >"$1/cameras.txt"
	{
		printf '# images\n1 1 0 0 0 0 0 2 1 b.jpg\n1.5 2.5 -1 3 4 7\n'
		printf '2 0 0 0 2 1 0 2 2 a.jpg\n\n'
		printf '3 1 0 0 0 0 1 2 1 c.jpg\n'
	} >"$1/images.txt"
}

# camera3dgs [KEY=VALUE]...: an entry of a 3DGS cameras.json; VALUE is JSON, an empty one leaves the key out.
camera3dgs() {
	entry 'id img_name width height position rotation fy fx cx cy time' id=0 'img_name="b"' width=40 height=30 'position=[1,2,3]' \
		'rotation=[[0,0,1],[1,0,0],[0,1,0]]' fy=51 fx=50 "$@"
}

# frame [KEY=VALUE]...: a frame of a transforms.json.
frame() {
	entry 'file_path transform_matrix w h fl_x fl_y cx cy camera_angle_x camera_angle_y camera_model is_fisheye distortion_params k1 k2 k3 k4 p1 p2 time' \
		'file_path="images/b.png"' 'transform_matrix=[[1,0,0,1],[0,1,0,2],[0,0,1,3],[0,0,0,1]]' "$@"
}

# transforms [KEY=VALUE]...: a transforms.json, by default of one frame.
transforms() {
	entry 'w h fl_x fl_y cx cy camera_angle_x camera_angle_y camera_model is_fisheye distortion_params k1 k2 k3 k4 k5 k6 p1 p2
		train_filenames val_filenames test_filenames frames' w=40 h=30 fl_x=50 fl_y=51 cx=19 cy=14 "frames=[$(frame)]" "$@"
}

# entry KEYS [KEY=VALUE]...: a JSON object; the last value of a key counts, an empty one leaves it out.
entry() {
	local keys=$1 key assignment line=
	local -A value
	shift
	for assignment; do value[${assignment%%=*}]=${assignment#*=}; done
	for key in $keys; do
		[ -z "${value[$key]:-}" ] || line+=${line:+,}\"$key\":${value[$key]}
	done
	printf '{%s}' "$line"
}

# imported KEY...: those keys of the views of scene/cameras.json, a line a view.
imported() {
	local keys
	keys=$(printf ',.%s' "$@")
	jq -c ".[] | [${keys#,}]" scene/cameras.json
}
