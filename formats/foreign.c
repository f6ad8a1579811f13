#include "formats/foreign.h"

#include "base/path.h"

#include <stdio.h>
#include <string.h>

enum { MEMBERS = 3 };

/* JSON that has these members; a list is told by those of its first item. */
struct kind {
	int is_list;
	const char *members[MEMBERS];
	const char *what, *way_out; /* a format for the file's name */
};

static const struct kind kinds[] = {
	{0, {"annotations", "images", NULL}, "COCO annotations",
		"'mask-import -o masks.jsonl %s' makes mask records of them"},
	{0, {"shapes", "imagePath", NULL}, "a LabelMe file",
		"'mask-import -o masks.jsonl %s' makes mask records of it"},
	{1, {"image_id", "segmentation", NULL}, "COCO results",
		"a mask record needs the names of its view and object in place of their numbers"},
	{0, {"transform", "scale", NULL}, "nerfstudio's dataparser_transforms.json",
		"it goes beside the splats or the transforms.json, and is found there"},
	{0, {"info", "objects", NULL}, "labels of ISAT",
		"'mask-import -o masks.jsonl %s' makes mask records of them"},
	{0, {"info", "object", NULL}, "labels of Ref-LERF",
		"'mask-import -o masks.jsonl %s' makes mask records of their pictures in gt_mask"},
	{0, {"t_00", "t_23", "fx"}, "a camera of Polycam",
		"'ns-process-data polycam' makes a transforms.json of the scan"},
	{0, {"sfm_data_version", "views", NULL}, "cameras of OpenMVG or Meshroom",
		"export them as a COLMAP model"},
	{0, {"version", "views", "poses"}, "cameras of Meshroom", "export them as a COLMAP model"},
	{0, {"camera_angle_x", "frames", NULL}, "cameras, a transforms.json of Blender",
		"gs-import --cameras reads it, once it has \"w\" and \"h\""},
	{0, {"frames", NULL, NULL}, "cameras, a transforms.json", "gs-import --cameras reads it"},
	{1, {"img_name", "rotation", NULL}, "cameras of 3DGS", "gs-import --cameras reads them"},
	{1, {"world_to_camera", "split", NULL}, "the cameras of a scene folder",
		"name the folder in its place where a scene is wanted"},
};

static int has_members(const cJSON *object, const struct kind *k)
{
	for (int i = 0; i < MEMBERS && k->members[i]; i++)
		if (!cJSON_GetObjectItemCaseSensitive(object, k->members[i]))
			return 0;
	return 1;
}

int foreign_json(const cJSON *root, const char *name, struct err *e)
{
	const int is_list = cJSON_IsArray(root);
	const cJSON *object = is_list ? root->child : root;
	char way_out[256];

	for (size_t i = 0; cJSON_IsObject(object) && i < sizeof kinds / sizeof *kinds; i++) {
		const struct kind *k = &kinds[i];
		const char *place = strstr(k->way_out, "%s");
		if (k->is_list != is_list || !has_members(object, k))
			continue;
		if (place)
			snprintf(way_out, sizeof way_out, "%.*s%.120s%s", (int)(place - k->way_out),
				k->way_out, name, place + 2);
		else
			snprintf(way_out, sizeof way_out, "%s", k->way_out);
		return err_set(e, ERR_FORMAT, "%s: %s: %s", name, k->what, way_out);
	}
	return 0;
}

int foreign_splats(const char *name, struct err *e)
{
	static const char *const converted[] = {".ksplat", ".lcc", ".lcc2"};
	const char *kind = NULL;
	const size_t n = strlen(name);

	for (size_t i = 0; i < sizeof converted / sizeof *converted; i++)
		if (path_ends(name, converted[i]))
			kind = converted[i];
	if (kind)
		return err_set(e, ERR_FORMAT,
			"%s: a %s file, not a .ply: 'npx @playcanvas/splat-transform %s %.*s.ply' converts it",
			name, kind, name, (int)(path_ends(name, kind) ? n - strlen(kind) : n), name);
	if (path_ends(name, ".ckpt") || path_ends(name, ".pth") || path_ends(name, ".pt"))
		return err_set(e, ERR_FORMAT,
			"%s: a checkpoint, not a .ply: nerfstudio writes one by 'ns-export gaussian-splat', 3DGS into point_cloud/iteration_N",
			name);
	if (path_ends(name, ".bin") || path_ends(name, ".txt"))
		return err_set(e, ERR_FORMAT,
			"%s: not a .ply: points3D of COLMAP are no trained scene; 3DGS trains one from them",
			name);
	return 0;
}

int foreign_vertices(const struct plyfile *f, const struct plyfile_element *vertex, struct err *e)
{
	const int is_trained =
		plyfile_property(vertex, "scale_0") >= 0 || plyfile_property(vertex, "packed_position") >= 0;
	const struct plyfile_element *face = plyfile_find(f, "face");

	if (!is_trained && plyfile_property(vertex, "x") >= 0 && plyfile_property(vertex, "opacity") < 0)
		return err_set(e, ERR_FORMAT,
			"%s: a %s, not a trained scene: it has points without scale and opacity; 3D Gaussian Splatting trains a scene from them, point_cloud/iteration_N/point_cloud.ply",
			f->path, face && face->rows ? "mesh" : "point cloud");
	if (plyfile_property(vertex, "filter_3D") >= 0)
		return err_set(e, ERR_FORMAT,
			"%s: a scene of Mip-Splatting (property 'filter_3D'), which 3DGS's rendering gets wrong: its 'python create_fused_ply.py -m MODEL --output_ply fused.ply' makes one that is right",
			f->path);
	if (f->is_mip)
		return err_set(e, ERR_FORMAT,
			"%s: trained for another way of rendering ('SplatRenderMode: mip'), which would be wrong here: train it without that mode",
			f->path);
	return 0;
}
