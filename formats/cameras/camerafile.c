#include "formats/cameras/camerafile.h"

#include "base/file.h"
#include "base/mem.h"
#include "base/path.h"
#include "base/textfile.h"
#include "formats/cameras/colmap.h"
#include "formats/cameras/transforms.h"
#include "formats/records/foreign.h"
#include "formats/records/json.h"
#include "geom/lens.h"
#include "geom/views.h"

#include <stdio.h>
#include <strings.h>

static int read_view(struct camera *c, const cJSON *item, const char *where, struct err *e)
{
	const char *image = NULL;
	double width, height, rows[9], centre[3], rotation[3][3];

	if (json_string(item, "img_name", 1, &image, where, e) < 0 ||
		json_number(item, "width", 1, &width, where, e) < 0 ||
		json_number(item, "height", 1, &height, where, e) < 0 ||
		json_number(item, "fx", 1, &c->fx, where, e) < 0 ||
		json_number(item, "fy", 1, &c->fy, where, e) < 0 ||
		(c->has_time = json_number(item, "time", 0, &c->time, where, e)) < 0 ||
		json_matrix(item, "position", 3, 0, centre, where, e) ||
		json_matrix(item, "rotation", 3, 3, rows, where, e))
		return -1;
	if (view_set_size(c, width, height))
		return err_file(e, where, "size %gx%g is not whole numbers in 1 to 65536", width, height);
	c->cx = width / 2;
	c->cy = height / 2;
	if (json_number(item, "cx", 0, &c->cx, where, e) < 0 ||
		json_number(item, "cy", 0, &c->cy, where, e) < 0)
		return -1;
	/* The file has camera to world. */
	for (int r = 0; r < 3; r++)
		for (int k = 0; k < 3; k++)
			rotation[r][k] = rows[3 * k + r];
	camera_set_centre(c, rotation, centre);
	c->image = view_image(image, e);
	return c->image ? 0 : -1;
}

/* The cameras.json of 3DGS: formats/cameras/cameras3dgs.md. */
static int parse_3dgs(struct cameras *c, const cJSON *list, const char *path, struct err *e)
{
	const cJSON *item;
	char where[512];

	c->views = mem_zalloc((size_t)cJSON_GetArraySize(list), sizeof *c->views, path, e);
	if (!c->views)
		return -1;
	cJSON_ArrayForEach(item, list)
	{
		snprintf(where, sizeof where, "%s: camera %zu", path, c->n);
		if (read_view(&c->views[c->n++], item, where, e))
			return -1;
	}
	return 0;
}

/* JSON, or what else the file is. */
static cJSON *read_json(const char *path, struct err *e)
{
	const char *name = file_name(path);
	cJSON *root = NULL;
	SCOPED char *text = NULL;
	size_t len;

	if (textfile_read(path, &text, &len, e))
		return NULL;
	if (strchr("{[", text[strspn(text, " \t\r\n")]))
		root = json_parse(text, len, name, e);
	else if (!foreign_file(name, FOREIGN_CAMERAS, text, len, e))
		err_file(e, name,
			"neither the folder of a COLMAP model, nor a 3DGS cameras.json or a transforms.json");
	return root;
}

/* A JSON file's views, for views_finish. */
static int add_json(struct cameras *c, const char *path, struct err *e)
{
	const char *name = file_name(path);
	SCOPED_BY(json_release) cJSON *root = read_json(path, e);
	const cJSON *frames = json_get(root, "frames"),
		    *image = json_get(root ? root->child : NULL, "img_name");

	if (!root || (!frames && !image && foreign_json(root, name, e)))
		return -1;
	return cJSON_IsArray(root) ? parse_3dgs(c, root, name, e) : transforms_add(c, root, name, e);
}

/* Blender's scenes have files of their own for views that nothing is trained with: the first there is beside
 * transforms_train.json. */
static int add_held_out(struct cameras *c, const char *path, struct err *e)
{
	static const char *const names[] = {"transforms_test.json", "transforms_val.json"};
	SCOPED char *dir = file_dir(path, e);

	if (!dir || strcasecmp(view_base(path), "transforms_train.json") != 0)
		return dir ? 0 : -1;
	for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
		SCOPED char *beside = path_alike(dir, names[i], e);
		const size_t first = c->n;
		if (beside && !file_exists(beside))
			continue;
		if (!beside || add_json(c, beside, e))
			return -1;
		for (size_t k = first; k < c->n; k++)
			c->views[k].split = SPLIT_TEST;
		break;
	}
	return 0;
}

int camerafile_read(struct cameras *c, const char *path, struct err *e)
{
	const char *name = file_name(path);
	int bad = -1;

	*c = (struct cameras){0};
	if (file_is_dir(path))
		bad = colmap_read(c, path, e);
	else
		bad = add_json(c, path, e) || add_held_out(c, path, e) || views_finish(c, name, e);
	if (!bad && !c->n)
		bad = err_file(e, name,
			"no views: a COLMAP model has them in images.bin or images.txt, a transforms.json in its frames");
	if (bad)
		cameras_free(c);
	return bad ? textfile_note(path, e) : 0;
}

int camerafile_need_pinholes(const struct cameras *c, const char *path, const char *images, struct err *e)
{
	size_t i = 0;

	while (i < c->n && !c->views[i].lens.model)
		i++;
	if (i == c->n)
		return 0;
	const struct camera *v = &c->views[i];
	const char *model = lens_model_name(v->lens.model);
	if (!file_is_dir(path))
		return err_file(e, file_name(path),
			"view '%s': camera model %s distorts: gs-import --undistort takes the pinhole of the same view",
			v->name, model);
	return err_file(e, file_name(path),
		"view '%s': camera model %s distorts: gs-import --undistort takes the pinhole of the same view, and so does 'colmap image_undistorter --image_path %s --input_path %s --output_path undistorted'",
		v->name, model, images ? images : "IMAGES", path);
}
