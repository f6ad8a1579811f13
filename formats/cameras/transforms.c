#include "formats/cameras/transforms.h"

#include "base/compare.h"
#include "base/mem.h"
#include "formats/records/json.h"
#include "geom/lens.h"
#include "geom/views.h"

#include <math.h>
#include <stdio.h>
#include <strings.h>

/* COLMAP's numbers of models. */
enum { OPENCV = 4, OPENCV_FISHEYE, FULL_OPENCV };

/* The file_path lists of one split, sorted. */
struct names {
	size_t n, capacity;
	char **items;
};

/* A frame's own value, else the file's. */
static int either_number(const cJSON *frame, const cJSON *root, const char *key, double *value,
	const char *where, struct err *e)
{
	int got = json_number(frame, key, 0, value, where, e);

	return got ? got : json_number(root, key, 0, value, where, e);
}

/* The number of a distortion parameter, 0 where it is absent. */
static int read_coefficient(const cJSON *frame, const cJSON *root, const char *key, double *value,
	const char *where, struct err *e)
{
	*value = 0;
	return either_number(frame, root, key, value, where, e) < 0 ? -1 : 0;
}

/* nerfstudio's k4 of a perspective is no parameter of COLMAP's, k5 and k6 need FULL_OPENCV. */
static int check_coefficients(int is_full, const double *k, const char *where, struct err *e)
{
	for (int i = 3; i < 6 && !is_full; i++)
		if (k[i] != 0)
			return err_file(e, where,
				"key 'k%d': %g, which is read with camera_model FULL_OPENCV only", i + 1,
				k[i]);
	return 0;
}

/* Of the distortion in the files' keys, after fx, fy, cx and cy. */
static int read_distortion(struct lens *l, const cJSON *frame, const cJSON *root, int is_fisheye, int is_full,
	const char *where, struct err *e)
{
	static const char *const keys[] = {"k1", "k2", "k3", "k4", "k5", "k6", "p1", "p2"},
				 list[] = "distortion_params";
	double k[8], *to = l->parameters + 4;

	for (int i = 0; i < 8; i++)
		if (read_coefficient(frame, root, keys[i], &k[i], where, e))
			return -1;
	const cJSON *own = json_member(frame, list) ? frame : root;
	if (json_member(own, list)) { /* nerfstudio's: k1 to k4, p1, p2 */
		double all[6];
		if (json_matrix(own, list, 6, 0, all, where, e))
			return -1;
		memcpy(k, all, 4 * sizeof *k);
		memcpy(k + 6, all + 4, 2 * sizeof *k);
	}
	if (is_fisheye) {
		memcpy(to, k, 4 * sizeof *k);
		l->model = lens_model_numbered(OPENCV_FISHEYE);
		return 0;
	}
	const double ordered[8] = {k[0], k[1], k[6], k[7], k[2], k[3], k[4], k[5]};
	memcpy(to, ordered, sizeof ordered);
	l->model = is_full || k[2] != 0 ? lens_model_numbered(FULL_OPENCV) : lens_model_numbered(OPENCV);
	return check_coefficients(is_full, k, where, e);
}

/* What distorts, into c's lens; nothing where that is a pinhole. */
static int read_lens(
	struct camera *c, const cJSON *frame, const cJSON *root, const char *where, struct err *e)
{
	struct lens l = {.width = c->width, .height = c->height, .parameters = {c->fx, c->fy, c->cx, c->cy}};
	const char *model = "OPENCV";

	if (json_string(json_member(frame, "camera_model") ? frame : root, "camera_model", 0, &model, where,
		    e) < 0)
		return -1;
	const int is_named_so = strcasecmp(model, "PERSPECTIVE") != 0;
	const struct lens_model *m =
		is_named_so ? lens_model_named(model, strlen(model)) : lens_model_numbered(0);
	if (!m || m > lens_model_numbered(FULL_OPENCV))
		return err_file(e, where, "key 'camera_model': '%.40s' is not a perspective camera", model);
	const cJSON *own = json_member(frame, "is_fisheye");
	const int is_fisheye = m == lens_model_numbered(OPENCV_FISHEYE) ||
			       cJSON_IsTrue(own ? own : json_get(root, "is_fisheye"));
	if (read_distortion(&l, frame, root, is_fisheye, m == lens_model_numbered(FULL_OPENCV), where, e))
		return -1;
	if (lens_is_distorted(&l))
		c->lens = l;
	return 0;
}

/* A focal length in pixels, or from the field of view in radians over `extent` pixels: 1, 0 without. */
static int read_focal(const cJSON *frame, const cJSON *root, const char *focal, const char *angle,
	double extent, double *out, const char *where, struct err *e)
{
	double radians;
	int got = either_number(frame, root, focal, out, where, e);

	if (got)
		return got;
	got = either_number(frame, root, angle, &radians, where, e);
	if (got > 0) {
		if (!(radians > 0 && radians < 3.14159))
			return err_file(e, where, "key '%s': %g is not an angle in (0, pi)", angle, radians);
		*out = extent / 2 / tan(radians / 2);
	}
	return got;
}

/* Whether there are focal lengths in pixels, which Blender's files do not have. */
static int has_focal(const cJSON *frame, const cJSON *root)
{
	return json_get(frame, "fl_x") || json_get(root, "fl_x");
}

static int read_intrinsics(
	struct camera *c, const cJSON *frame, const cJSON *root, const char *where, struct err *e)
{
	double width = 0, height = 0;
	int got;

	if (either_number(frame, root, "w", &width, where, e) < 0 ||
		either_number(frame, root, "h", &height, where, e) < 0)
		return -1;
	if ((width == 0 || height == 0) && !has_focal(frame, root))
		return err_file(e, where,
			"key '%s' is missing, as in Blender's transforms: jq '. + {w: 800, h: 800}' adds the size of the photographs",
			width == 0 ? "w" : "h");
	if (width == 0 || height == 0)
		return err_file(e, where, "key '%s' is missing", width == 0 ? "w" : "h");
	if (view_set_size(c, width, height))
		return err_file(e, where, "size %gx%g is not whole numbers in 1 to 65536", width, height);
	got = read_focal(frame, root, "fl_x", "camera_angle_x", width, &c->fx, where, e);
	if (got <= 0)
		return got ? -1 : err_file(e, where, "neither 'fl_x' nor 'camera_angle_x'");
	c->fy = c->fx;
	c->cx = width / 2;
	c->cy = height / 2;
	if (read_focal(frame, root, "fl_y", "camera_angle_y", height, &c->fy, where, e) < 0 ||
		either_number(frame, root, "cx", &c->cx, where, e) < 0 ||
		either_number(frame, root, "cy", &c->cy, where, e) < 0)
		return -1;
	return read_lens(c, frame, root, where, e);
}

static int read_frame(
	struct camera *c, const cJSON *frame, const cJSON *root, const char *where, struct err *e)
{
	const cJSON *matrix = json_get(frame, "transform_matrix");
	int rows = cJSON_GetArraySize(matrix) == 3 ? 3 : 4; /* the last row is optional */
	double m[4][4] = {[3] = {0, 0, 0, 1}}, rotation[3][3];
	const char *image = NULL;

	if (json_string(frame, "file_path", 1, &image, where, e) < 0 ||
		(c->has_time = json_number(frame, "time", 0, &c->time, where, e)) < 0 ||
		read_intrinsics(c, frame, root, where, e) ||
		json_matrix(frame, "transform_matrix", rows, 4, m[0], where, e))
		return -1;
	if (m[3][0] != 0 || m[3][1] != 0 || m[3][2] != 0 || m[3][3] != 1)
		return err_file(e, where, "key 'transform_matrix': the last row is not 0 0 0 1");
	/* Camera to world, y up and z backward: the second and third axis change sign (0 does not). */
	for (int r = 0; r < 3; r++)
		for (int k = 0; k < 3; k++)
			rotation[r][k] = r ? 0 - m[k][r] : m[k][r];
	camera_set_centre(c, rotation, (double[]){m[0][3], m[1][3], m[2][3]});
	c->image = view_image(image, e);
	return c->image ? 0 : -1;
}

/* Adds a list of file paths: 1 where it is there. */
static int add_names(struct names *names, const cJSON *root, const char *key, const char *path, struct err *e)
{
	const cJSON *list = json_member(root, key), *item;

	if (!list)
		return 0;
	if (!cJSON_IsArray(list))
		return err_file(e, path, "key '%s' is not a list", key);
	cJSON_ArrayForEach(item, list)
	{
		if (!cJSON_IsString(item))
			return err_file(e, path, "key '%s' is not a list of strings", key);
		if (mem_grow((void **)&names->items, &names->capacity, names->n + 1, sizeof *names->items,
			    path, e))
			return -1;
		if (!(names->items[names->n] = view_image(item->valuestring, e)))
			return -1;
		names->n++;
	}
	if (names->n)
		qsort(names->items, names->n, sizeof *names->items, compare_string);
	return 1;
}

static int is_named(const struct names *names, const char *image)
{
	return names->n && bsearch(&image, names->items, names->n, sizeof *names->items, compare_string);
}

/* Of views from `first` on: test views are those listed as such, and those that a list of training views
 * lacks. */
static int read_splits(struct cameras *c, size_t first, const cJSON *root, const char *path, struct err *e)
{
	struct names train = {0}, test = {0};
	int has_train = add_names(&train, root, "train_filenames", path, e), bad = has_train < 0;

	bad = bad || add_names(&test, root, "test_filenames", path, e) < 0 ||
	      add_names(&test, root, "val_filenames", path, e) < 0;
	for (size_t i = first; !bad && i < c->n; i++) {
		struct camera *v = &c->views[i];
		if (is_named(&test, v->image) || (has_train && !is_named(&train, v->image)))
			v->split = SPLIT_TEST;
	}
	mem_free_strings(train.items, train.n);
	mem_free_strings(test.items, test.n);
	return -bad;
}

/* What frames may leave to the file, without copies: each frame looks these up. */
static cJSON *common_members(const cJSON *root, const char *path, struct err *e)
{
	static const char *const keys[] = {"camera_model", "is_fisheye", "distortion_params", "k1", "k2",
		"k3", "k4", "k5", "k6", "p1", "p2", "w", "h", "fl_x", "fl_y", "camera_angle_x",
		"camera_angle_y", "cx", "cy"};
	cJSON *common = cJSON_CreateObject();
	int is_whole = common != NULL;

	for (size_t i = 0; i < sizeof keys / sizeof *keys && is_whole; i++) {
		cJSON *item = json_get(root, keys[i]);
		is_whole = !item || cJSON_AddItemReferenceToObject(common, keys[i], item);
	}
	if (is_whole)
		return common;
	cJSON_Delete(common);
	err_set(e, ERR_SYSTEM, "%s: out of memory", path);
	return NULL;
}

static int read_frames(
	struct cameras *c, const cJSON *frames, const cJSON *common, const char *path, struct err *e)
{
	const cJSON *frame;
	char where[512];
	size_t i = 0, room = c->n;

	if (mem_grow((void **)&c->views, &room, c->n + (size_t)cJSON_GetArraySize(frames), sizeof *c->views,
		    path, e))
		return -1;
	cJSON_ArrayForEach(frame, frames)
	{
		snprintf(where, sizeof where, "%s: frame %zu", path, i++);
		c->views[c->n] = (struct camera){0};
		if (read_frame(&c->views[c->n++], frame, common, where, e))
			return -1;
	}
	return 0;
}

int transforms_add(struct cameras *c, const cJSON *root, const char *path, struct err *e)
{
	const cJSON *frames = json_get(root, "frames");
	const size_t first = c->n;

	if (!frames)
		return err_file(e, path,
			"neither a transforms.json, which has a key 'frames', nor a 3DGS cameras.json, which is a list");
	if (!cJSON_IsArray(frames))
		return err_file(e, path, "key 'frames' is not a list");
	SCOPED_BY(json_release) cJSON *common = common_members(root, path, e);
	return -(!common || read_frames(c, frames, common, path, e) || read_splits(c, first, root, path, e));
}
