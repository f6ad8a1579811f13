#include "formats/records/foreign.h"

#include "base/path.h"
#include "formats/records/json.h"

#include <stdio.h>
#include <string.h>
#include <strings.h>

enum { MEMBERS = 3 };

/* A way out is a format: %s is the file's name, %b that without its ending. */
#define CONVERT "'npx @playcanvas/splat-transform %s %b.ply' converts it"
#define EXPORT "export the scene as a .ply where it was made"
#define MODEL "export them as a COLMAP model"
#define TRAINED_WITH "give the COLMAP model or transforms.json that the scene was trained with"

/* JSON that has these members; a list is told by those of its first item. */
struct kind {
	int is_list;
	const char *members[MEMBERS];
	const char *what, *way_out;
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
	{0, {"sfm_data_version", "views", NULL}, "cameras of OpenMVG or Meshroom", MODEL},
	{0, {"version", "views", "poses"}, "cameras of Meshroom", MODEL},
	{1, {"cameras", "shots", NULL}, "cameras of OpenSfM or OpenDroneMap",
		"'ns-process-data odm' makes a transforms.json of them"},
	{0, {"poses", "K", NULL}, "cameras of Record3D",
		"'ns-process-data record3d' makes a transforms.json of the capture"},
	{1, {"file_path", "transform", NULL}, "cameras of nerfstudio's 'ns-export cameras'",
		"give the transforms.json that it trained with, and put its dataparser_transforms.json beside the splats"},
	{0, {"camera_path", "render_height", NULL}, "a camera path of nerfstudio's viewer", TRAINED_WITH},
	{0, {"keyframes", "camera_type", NULL}, "a camera path of nerfstudio's viewer", TRAINED_WITH},
	{0, {"path", "time", NULL}, "a camera path of instant-ngp", TRAINED_WITH},
	{1, {"position", "target", NULL}, "a camera path of SuperSplat", TRAINED_WITH},
	{0, {"camera_angle_x", "frames", NULL}, "cameras, a transforms.json of Blender",
		"gs-import --cameras reads it, once it has \"w\" and \"h\""},
	{0, {"frames", NULL, NULL}, "cameras, a transforms.json", "gs-import --cameras reads it"},
	{1, {"img_name", "rotation", NULL}, "cameras of 3DGS", "gs-import --cameras reads them"},
	{1, {"world_to_camera", "split", NULL}, "the cameras of a scene folder",
		"name the folder in its place where a scene is wanted"},
};

#define CHECKPOINT                                                                                           \
	"a checkpoint, not a .ply",                                                                          \
		"nerfstudio writes one by 'ns-export gaussian-splat', 3DGS into point_cloud/iteration_N"
#define POINTS "not a .ply", "points3D of COLMAP are no trained scene; 3DGS trains one from them"

/* Files that are known by how their name ends, or by how they begin. */
static const struct {
	enum foreign_place place;
	const char *ending, *begin, *what, *way_out;
} files[] = {
	{FOREIGN_SPLATS, ".ksplat", NULL, "a .ksplat file, not a .ply", CONVERT},
	{FOREIGN_SPLATS, ".lcc", NULL, "a .lcc file, not a .ply", CONVERT},
	{FOREIGN_SPLATS, ".lcc2", NULL, "a .lcc2 file, not a .ply", CONVERT},
	{FOREIGN_SPLATS, ".ssproj", NULL, "a project of SuperSplat, not a .ply",
		"open it there, and export the scene as a .ply"},
	{FOREIGN_SPLATS, ".usdz", NULL, "a scene of USD, not a .ply", EXPORT},
	{FOREIGN_SPLATS, ".usda", "#usda ", "a scene of USD, not a .ply", EXPORT},
	{FOREIGN_SPLATS, ".usdc", "PXR-USDC", "a scene of USD, not a .ply", EXPORT},
	{FOREIGN_SPLATS, ".usd", NULL, "a scene of USD, not a .ply", EXPORT},
	{FOREIGN_SPLATS, ".html", NULL, "a page of a viewer, not a .ply", EXPORT},
	{FOREIGN_SPLATS, ".safetensors", NULL, "arrays, not a .ply", EXPORT},
	{FOREIGN_SPLATS, ".obj", NULL, "a mesh, not a trained scene", FOREIGN_TRAIN},
	{FOREIGN_SPLATS, ".las", "LASF", "a point cloud, not a trained scene", FOREIGN_TRAIN},
	{FOREIGN_SPLATS, ".pcd", "# .PCD", "a point cloud, not a trained scene", FOREIGN_TRAIN},
	{FOREIGN_SPLATS, ".json", NULL, "JSON, not splats",
		"cameras are for --cameras, and SOG's JSON is called meta.json"},
	{FOREIGN_SPLATS, ".ckpt", NULL, CHECKPOINT},
	{FOREIGN_SPLATS, ".pth", NULL, CHECKPOINT},
	{FOREIGN_SPLATS, ".pt", NULL, CHECKPOINT},
	{FOREIGN_SPLATS, ".bin", NULL, POINTS},
	{FOREIGN_SPLATS, ".txt", NULL, POINTS},
	{FOREIGN_CAMERAS, ".csv", "#name,", "a table (.csv), as RealityCapture exports",
		"'ns-process-data realitycapture --csv %s' makes a transforms.json, or " MODEL},
	{FOREIGN_CAMERAS, ".xml", "<", "XML, as Metashape exports",
		"'ns-process-data metashape --xml %s' makes a transforms.json, or " MODEL},
	{FOREIGN_CAMERAS, ".psx", NULL, "a project of Metashape", MODEL},
	{FOREIGN_CAMERAS, ".out", "# Bundle file", "cameras of Bundler", TRAINED_WITH},
	{FOREIGN_CAMERAS, ".nvm", "NVM_V3", "cameras of VisualSFM", TRAINED_WITH},
	{FOREIGN_CAMERAS, ".npy", "\x93NUMPY", "an array of NumPy, as LLFF's poses_bounds.npy",
		"give the COLMAP model that it was made from, sparse/0"},
	{FOREIGN_CAMERAS, ".npz", "PK\3\4", "an archive", TRAINED_WITH},
	{FOREIGN_CAMERAS, ".db", "SQLite format 3", "COLMAP's database, which has no poses",
		"give the folder of its model, sparse/0"},
	{FOREIGN_CAMERAS, ".bin", NULL, "a part of a COLMAP model", "give the model's folder"},
	{FOREIGN_CAMERAS, ".txt", NULL, "a text file",
		"of a COLMAP model, give the folder with cameras.txt and images.txt"},
	{FOREIGN_CAMERAS, ".ply", "ply", "a .ply, which has no cameras", TRAINED_WITH},
};

int foreign_say(const char *name, const char *what, const char *way_out, struct err *e)
{
	const char *dot = strrchr(name, '.');
	const int stem = (int)(dot ? (size_t)(dot - name) : strlen(name));
	char text[512];
	size_t n = 0;

	for (; *way_out && n < sizeof text - 1; way_out++)
		if (*way_out == '%')
			n += (size_t)snprintf(text + n, 160, "%.*s", *++way_out == 'b' ? stem : 159, name);
		else
			text[n++] = *way_out;
	text[n] = 0;
	return err_file(e, name, "%s: %s", what, text);
}

static int has_members(const cJSON *object, const struct kind *k)
{
	for (int i = 0; i < MEMBERS && k->members[i]; i++)
		if (!json_get(object, k->members[i]))
			return 0;
	return 1;
}

int foreign_json(const cJSON *root, const char *name, struct err *e)
{
	const int is_list = cJSON_IsArray(root);
	const cJSON *object = is_list ? root->child : root;

	for (size_t i = 0; cJSON_IsObject(object) && i < sizeof kinds / sizeof *kinds; i++)
		if (kinds[i].is_list == is_list && has_members(object, &kinds[i]))
			return foreign_say(name, kinds[i].what, kinds[i].way_out, e);
	return 0;
}

int foreign_file(const char *name, enum foreign_place place, const void *data, size_t len, struct err *e)
{
	for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
		const size_t n = files[i].begin ? strlen(files[i].begin) : 0;
		if (files[i].place == place && (path_ends(name, files[i].ending) ||
						       (n && n <= len && !memcmp(data, files[i].begin, n))))
			return foreign_say(name, files[i].what, files[i].way_out, e);
	}
	return 0;
}
