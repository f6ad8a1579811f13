#!/usr/bin/env bats
# Files of other programs, as formats/records/foreign.md has them: each is named for what it is, with the way out.

setup() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	load files
	load foreign
	cd "$BATS_TEST_TMPDIR"
	colmap model
}

# no_splats FILE REASON: gs-import refuses it.
no_splats() {
	says 3 "gs-import: $1: $2" "$BIN/gs-import" --cameras model -o scene "$1"
	[ ! -e scene ]
}

# json TEXT REASON: what reads mask records and what reads cameras refuses it, on one line or several.
json() {
	printf '%s\n' "$1" >f.json
	refused "$2"
	jq . f.json >several.json
	mv several.json f.json
	refused "$2"
}

refused() {
	splats_ply s.ply
	says 3 "gs-import: f.json: $1" "$BIN/gs-import" --cameras f.json -o scene s.ply
	says 3 "pseudomask-select: f.json: $1" "$BIN/pseudomask-select" -o out f.json
	says 3 "miou-score: f.json: $1" "$BIN/miou-score" --truth f.json f.json
	[ ! -e out ] && [ ! -e scene ]
}

@test "Ref-LERF's labels" {
	json '{"info":{"name":"a.jpg"},"object":[{"category":"cup"}]}' "labels of Ref-LERF: 'mask-import -o masks.jsonl f.json' makes mask records of their pictures in gt_mask"
}

@test "what stands in for a file that was not fetched" {
	while IFS='|' read -r text reason; do
		printf '%s\n' "$text" 'oid sha256:0' >x.ply
		no_splats x.ply "$reason"
		for tool in text-encode text-parse pseudomask-select; do
			says 3 "$tool: x.ply: $reason" "$BIN/$tool" -o out x.ply
		done
		says 1 "x.ply: $reason" "$BIN/gs-check" x.ply
	done <<-'END'
		version https://git-lfs.github.com/spec/v1|a pointer of Git LFS, not the file: 'git lfs pull' fetches it
		<!DOCTYPE html><html lang="en">|a web page, not the file: download it again
		<?xml version="1.0"?> <Error><Code>AccessDenied</Code></Error>|a server's message, not the file: download it again
		{"message": "Not Found", "status": "404"}|a server's message, not the file: download it again
		404: Not Found|a server's message, not the file: download it again
	END
	splats_ply s.ply
	gzip -c s.ply >s.gz
	no_splats s.gz "not an .spz file: it does not begin with 'NGSP'; gunzip unpacks what else it may be"
	"$BIN/gs-transform" -o s.sog s.ply
	sed 's/meta\.json/meta.text/g' s.sog >s.zip
	for kind in ply splat spz sog; do
		tar -cf "t.$kind" s.ply
		no_splats "t.$kind" "a tar archive, not the file: 'tar -xf' unpacks it"
		bzip2 -c s.ply >"b.$kind"
		no_splats "b.$kind" "packed by bzip2, not the file: 'bunzip2' unpacks it"
		cp s.zip "z.$kind"
		no_splats "z.$kind" "no file 'meta.json' in the zip: unzip it if it is a packed file"
	done
	head -c 320 /dev/zero | tr '\0' '\377' >x.splat
	no_splats x.splat "none of its 10 Gaussians can be used: 10 have a value that is not finite, 0 a zero quaternion"
	head -c 128 /dev/zero | tr '\0' '?' >>x.splat
	no_splats x.splat "not a .splat: 10 of 14 Gaussians are not finite"
	printf '%0320d' 0 >x.splat
	no_splats x.splat "not a .splat: 0 of 10 Gaussians are not finite, and it begins as text"
}

@test "splats in other containers: the command that converts them" {
	for kind in ksplat lcc lcc2; do
		printf 'xxxxxxxxxxxxxxxx' >"a.b.$kind"
		no_splats "a.b.$kind" "a .$kind file, not a .ply: 'npx @playcanvas/splat-transform a.b.$kind a.b.ply' converts it"
	done
	echo x >step.ckpt
	no_splats step.ckpt "a checkpoint, not a .ply: nerfstudio writes one by 'ns-export gaussian-splat', 3DGS into point_cloud/iteration_N"
	echo x >points3D.bin
	no_splats points3D.bin "not a .ply: points3D of COLMAP are no trained scene; 3DGS trains one from them"
	while IFS='|' read -r file reason; do
		echo x >"$file"
		no_splats "$file" "$reason"
	done <<-'END'
		a.gltf|a glTF of several files, not a .glb: export the scene as a .glb or .ply where it was made
		a.ssproj|a project of SuperSplat, not a .ply: open it there, and export the scene as a .ply
		a.USDZ|a scene of USD, not a .ply: export the scene as a .ply where it was made
		a.html|a page of a viewer, not a .ply: export the scene as a .ply where it was made
		a.las|a point cloud, not a trained scene: give a scene that 3D Gaussian Splatting trained
		a.json|JSON, not splats: cameras are for --cameras, and SOG's JSON is called meta.json
	END
	echo x >other
	no_splats other "not a PLY file: the first line is not 'ply' and nothing else"
}

@test "a .ply of points, a mesh, and scenes that are to be rendered in another way" {
	{ ply_header 1 'x y z red green blue'; echo 0 0 0 1 1 1; } >points.ply
	no_splats points.ply "a point cloud, not a trained scene: it has points without scale and rotation; 3D Gaussian Splatting trains a scene from them, point_cloud/iteration_N/point_cloud.ply"
	{ ply_header 1 'x y z' | sed 's/end_header/element face 1\nproperty list uchar int vertex_indices\nend_header/'; echo 0 0 0; echo 3 0 0 0; } >mesh.ply
	no_splats mesh.ply "a mesh, not a trained scene: it has points without scale and rotation; 3D Gaussian Splatting trains a scene from them, point_cloud/iteration_N/point_cloud.ply"
	{ ply_header 1 "$ply_names filter_3D"; echo 0 0 2 1 0.5 0 0 -3 -3 -3 1 0 0 0 0.1; } >mip.ply
	no_splats mip.ply "a scene of Mip-Splatting (property 'filter_3D'), which 3DGS's rendering gets wrong: its 'python create_fused_ply.py -m MODEL --output_ply fused.ply' makes one that is right"
}

@test "a .ply of another method is named for it" {
	local train="give a scene that 3D Gaussian Splatting trained"
	while IFS='|' read -r names reason; do
		ply_header 0 "$names" >f.ply
		no_splats f.ply "$reason"
	done <<-END
		${ply_names/scale_2/}|flat Gaussians of 2DGS, with two scales, which are rendered in another way: $train
		${ply_names/f_dc_0/f_offset_0 f_anchor_feat_0}|anchors of Scaffold-GS, which its networks make Gaussians of: $train
		${ply_names/f_dc_0 f_dc_1 f_dc_2/f_0 f_1 f_2}|features of SAGA without colours (property 'f_0'): give its scene_point_cloud.ply
		${ply_names/f_dc_0 f_dc_1 f_dc_2/red green blue}|Gaussians with colours in place of spherical harmonics (property 'red'): 'ns-export gaussian-splat --ply-color-mode sh_coeffs' writes these
		$ply_names trbf_center|Gaussians that move (property 'trbf_center'): $train
	END
	ply_header 0 | sed 's/float opacity/ushort opacity/' >f.ply
	no_splats f.ply "property 'opacity' has whole numbers, half floats or codes of a packed scene: export it with floats where it was made"
}

@test "comments that say how a scene is to be rendered: in any case, and the last one counts" {
	splats_ply s.ply
	for mode in 'SplatRenderMode: mip' 'splatrendermode:Mip' 'antialiased 1' 'Antialiased: true' 'train_flags antialiasing'; do
		sed "s/^element vertex/comment SplatRenderMode: default\n comment  $mode\n&/" s.ply >mode.ply
		no_splats mode.ply "trained for another way of rendering ('$mode'), which would be wrong here: train it without that mode"
		sed "s/^element vertex/comment $mode\ncomment antialiased 0\ncomment other mip\n&/" s.ply >mode.ply
		"$BIN/gs-check" mode.ply
	done
}

@test "camera files of other programs: what they are, and the way out" {
	splats_ply s.ply
	local trained="give the COLMAP model or transforms.json that the scene was trained with"
	while IFS='|' read -r file text reason; do
		printf "$text" >"$file"
		says 3 "gs-import: $file: $reason" "$BIN/gs-import" --cameras "$file" -o scene s.ply
	done <<-END
		a.csv|name,x|a table (.csv), as RealityCapture exports: 'ns-process-data realitycapture --csv a.csv' makes a transforms.json, or export them as a COLMAP model
		a.xml|x|XML, as Metashape exports: 'ns-process-data metashape --xml a.xml' makes a transforms.json, or export them as a COLMAP model
		bundle|# Bundle file v0.3|cameras of Bundler: $trained
		a.npy|\\x93NUMPY\\x01|an array of NumPy, as LLFF's poses_bounds.npy: give the COLMAP model that it was made from, sparse/0
		database.db|x|COLMAP's database, which has no poses: give the folder of its model, sparse/0
		model.zip|x|a zip: unzip it, and give its folder
		images.txt|x|a text file: of a COLMAP model, give the folder with cameras.txt and images.txt
		images.bin|x|a part of a COLMAP model: give the model's folder
		other|x|neither the folder of a COLMAP model, nor a 3DGS cameras.json or a transforms.json
		l.json|[{"id":1,"annotations":[],"data":{}}]|an export of Label Studio: export it as COCO there, or its brush masks as PNG
		s.json|[{"segmentation":{},"predicted_iou":1}]|masks of Segment Anything, which have no names: mask-import reads those of Grounded-SAM-2, which have
		b.json|[{"value":0,"label":"background"}]|boxes of Grounded-Segment-Anything, without masks: mask-import reads the masks of Grounded-SAM-2
		r.json|{"K":[1],"poses":[]}|cameras of Record3D: 'ns-process-data record3d' makes a transforms.json of the capture
		n.json|[{"file_path":"a","transform":[]}]|cameras of nerfstudio's 'ns-export cameras': give the transforms.json that it trained with, and put its dataparser_transforms.json beside the splats
		p.json|{"camera_path":[],"render_height":1}|a camera path of nerfstudio's viewer: $trained
		o.json|[{"cameras":{},"shots":{}}]|cameras of OpenSfM or OpenDroneMap: 'ns-process-data odm' makes a transforms.json of them
	END
}

@test "JSON of other programs, in place of mask records and of cameras" {
	json '{"images":[],"annotations":[],"categories":[]}' "COCO annotations: 'mask-import -o masks.jsonl f.json' makes mask records of them"
	json '{"version":"5","shapes":[],"imagePath":"a.jpg"}' "a LabelMe file: 'mask-import -o masks.jsonl f.json' makes mask records of it"
	json '[{"image_id":1,"category_id":2,"segmentation":{}}]' "COCO results: a mask record needs the names of its view and object in place of their numbers"
	json '{"transform":[[1,0,0,0]],"scale":1}' "nerfstudio's dataparser_transforms.json: it goes beside the splats or the transforms.json, and is found there"
	json '{"t_00":1,"t_23":2,"fx":3}' "a camera of Polycam: 'ns-process-data polycam' makes a transforms.json of the scan"
	json '{"sfm_data_version":"0.3","views":[]}' "cameras of OpenMVG or Meshroom: export them as a COLMAP model"
	json '[{"name":"a","world_to_camera":[],"split":"train"}]' "the cameras of a scene folder: name the folder in its place where a scene is wanted"
}

@test "cameras in place of mask records" {
	transforms >f.json
	says 3 "pseudomask-select: f.json: cameras, a transforms.json: gs-import --cameras reads it" "$BIN/pseudomask-select" -o out f.json
	printf '[%s]' "$(camera3dgs)" >f.json
	says 3 "pseudomask-select: f.json: cameras of 3DGS: gs-import --cameras reads them" "$BIN/pseudomask-select" -o out f.json
	# of JSON that nobody knows, what is wrong with it
	echo '[1]' >f.json
	says 3 "pseudomask-select: f.json: a list, not one on each line: 'jq -c .[] f.json' writes it so" "$BIN/pseudomask-select" -o out f.json
	printf '{\n"a": 1}\n' >f.json
	says 3 "pseudomask-select: f.json: an object over several lines, not one on each line: 'jq -c . f.json' writes it so" "$BIN/pseudomask-select" -o out f.json
}

@test "Blender's transforms do not have the size of the photographs" {
	splats_ply s.ply
	echo '{"camera_angle_x":0.69,"frames":[{"file_path":"./train/r_0","transform_matrix":[[1,0,0,1],[0,1,0,2],[0,0,1,3],[0,0,0,1]]}]}' >f.json
	says 3 "gs-import: f.json: frame 0: key 'w' is missing, as in Blender's transforms: jq '. + {w: 800, h: 800}' adds the size of the photographs" \
		"$BIN/gs-import" --cameras f.json -o scene s.ply
	jq '. + {w: 800, h: 800}' f.json >sized.json
	"$BIN/gs-import" --cameras sized.json -o scene s.ply
}
