#include "formats/records/annotations_private.h"

#include "base/base64.h"
#include "base/file.h"
#include "base/mem.h"
#include "base/path.h"
#include "base/textfile.h"
#include "formats/images/png.h"
#include "formats/records/foreign.h"
#include "formats/records/json.h"

#include <math.h>
#include <stdio.h>

void annotations_free(struct annotations *a)
{
	for (size_t i = 0; i < a->n; i++) {
		mem_free_all(a->items[i].view, a->items[i].name, a->items[i].ref);
		rle_free(&a->items[i].mask);
		mask_place_free(a->items[i].boxes);
	}
	mem_free_all(a->items, a->view, a->picture);
	for (size_t i = 0; i < a->left_count; i++)
		free(a->left_out[i].kind);
	free(a->left_out);
	*a = (struct annotations){0};
}

/* LabelMe's mask: a PNG of the box of two points, whose first pixel is at the first. */
static int read_mask_shape(
	struct reading *r, const char *base64, const char *view, const char *label, struct err *e)
{
	const int left = (int)r->points[0], top = (int)r->points[1], right = (int)r->points[2],
		  bottom = (int)r->points[3];
	size_t n = 0;
	int height, width;
	SCOPED uint8_t *pixels = NULL;
	SCOPED_BY(rle_free) struct rle mask = {0};
	SCOPED void *bytes = base64_bytes(base64, &n, e);
	SCOPED_BY(file_release) FILE *in = bytes ? fmemopen(bytes, n + !n, "rb") : NULL;

	if (!in || png_take_mask(r->where, in, &pixels, &height, &width, e))
		return -1;
	if (left < 0 || top < 0 || left + width > r->width || top + height > r->height ||
		abs(right - left + 1 - width) > 1 || abs(bottom - top + 1 - height) > 1)
		return err_file(e, r->where,
			"its mask is %dx%d, but its points are %d,%d and %d,%d in a picture of %dx%d (width x height)",
			width, height, left, top, right, bottom, r->width, r->height);
	memset(r->mask, 0, (size_t)r->height * (size_t)r->width);
	for (int y = 0; y < height; y++)
		memcpy(r->mask + (size_t)(top + y) * (size_t)r->width + left,
			pixels + (size_t)y * (size_t)width, (size_t)width);
	struct annotation *on = reading_find(r, view, label, e);
	return -(!on || rle_encode(&mask, r->mask, r->height, r->width, e) || reading_unite(r, on, &mask, e));
}

static int read_shape(struct reading *r, const cJSON *shape, const char *view, struct err *e)
{
	const cJSON *points = json_get(shape, "points");
	const char *label, *type = "polygon", *mask = NULL;
	size_t count;

	reading_group(r, shape);
	if (json_string(shape, "label", 1, &label, r->where, e) < 0 ||
		json_string(shape, "shape_type", 0, &type, r->where, e) < 0 ||
		reading_points(r, points, &count, e))
		return -1;
	if (!strcmp(type, "mask"))
		return json_string(shape, "mask", 1, &mask, r->where, e) < 0 ? -1
		       : count != 2 ? err_file(e, r->where, "a mask without the two points of its box")
				    : read_mask_shape(r, mask, view, label, e);
	return reading_draw_shape(r, type, count, view, label, e);
}

/* LabelMe says the size of a picture that it also holds, or that lies beside it. A smaller or larger copy
 * will do there, and of a JPEG one that is turned, as cameras say in it that they were. */
static int check_picture(struct reading *r, const cJSON *root, struct err *e)
{
	const cJSON *data = json_get(root, "imageData");
	const int is_held = cJSON_IsString(data) && *data->valuestring;
	const char *picture = r->to->picture;
	enum picture_kind kind = PICTURE_NONE;
	int height = 0, width = 0;
	size_t n = 0;
	SCOPED void *bytes = is_held ? base64_bytes(data->valuestring, &n, e) : NULL;

	if (is_held && !bytes)
		return -1;
	const int is_beside =
		!is_held && file_exists(picture) && !file_is_dir(picture) && !file_is_pipe(picture);
	FILE *in = n ? fmemopen(bytes, n, "rb") : is_beside ? fopen(picture, "rb") : NULL;
	if (in) {
		kind = picture_size(in, &height, &width);
		fclose(in);
	}
	const int is_turned = kind == PICTURE_JPEG && rle_has_shape(width, height, r->height, r->width);
	if (kind == PICTURE_NONE || (height == r->height && width == r->width) ||
		(!is_held && (is_turned || rle_has_shape(height, width, r->height, r->width))))
		return 0;
	return err_file(e, r->where,
		"imageWidth and imageHeight are %dx%d, but %s is %dx%d: the labels are of another picture",
		r->width, r->height, is_held ? "the picture in imageData" : picture, width, height);
}

static int read_labelme(struct reading *r, const cJSON *root, struct err *e)
{
	const cJSON *shapes = json_get(root, "shapes"), *shape;
	const char *image;
	size_t i = 0;

	if (json_string(root, "imagePath", 1, &image, r->where, e) < 0 ||
		reading_size(r, root, "imageHeight", "imageWidth", e))
		return -1;
	const char *view = reading_picture(r, r->path, image, e);
	int bad = !view || check_picture(r, root, e);
	cJSON_ArrayForEach(shape, shapes)
	{
		snprintf(r->where, WHERE, "%s: shape %zu", r->path, i++);
		bad = bad || read_shape(r, shape, view, e);
	}
	return bad ? -1 : 0;
}

/* The "bbox" of an object, [left, top, right, bottom], where it has one. */
static int take_box(struct reading *r, const cJSON *object, struct annotation *on, struct err *e)
{
	const cJSON *list = json_get(object, "bbox");
	size_t count;

	if (!cJSON_IsArray(list))
		return 0;
	if (reading_points(r, list, &count, e))
		return -1;
	if (count != 2)
		return err_file(e, r->where, "key 'bbox' is not two corners");
	if (!on->boxes && !(on->boxes = mask_place_new(e)))
		return -1;
	return mask_place_add_box(on->boxes, r->points, e);
}

/* ISAT's, as LERF-OVS has it: a polygon of each object. */
static int read_object(struct reading *r, const cJSON *object, const char *view, struct err *e)
{
	const char *name;
	size_t count;

	if (json_string(object, "category", 1, &name, r->where, e) < 0 ||
		reading_points(r, json_get(object, "segmentation"), &count, e))
		return -1;
	struct annotation *on = reading_find(r, view, name, e);
	return on && !reading_draw(r, on, count, e) ? take_box(r, object, on, e) : -1;
}

/* Ref-LERF's: a PNG in the folder gt_mask beside that of the labels. */
static int read_pictured(
	struct reading *r, const char *json, const cJSON *object, const char *view, struct err *e)
{
	const char *name, *picture;

	if (json_string(object, "category", 1, &name, r->where, e) < 0 ||
		json_string(object, "segmentation", 1, &picture, r->where, e) < 0)
		return -1;
	if (path_leaves(picture))
		return err_file(
			e, r->where, "key 'segmentation': '%.200s' is not in the folder gt_mask", picture);
	SCOPED char *folder = file_dir(json, e),
		    *masks = folder ? file_join(folder, "../gt_mask", "", e) : NULL,
		    *path = masks ? file_join(masks, picture, "", e) : NULL;
	SCOPED uint8_t *pixels = NULL;
	SCOPED_BY(rle_free) struct rle mask = {0};
	int bad = !path || png_read_mask(path, &pixels, &r->height, &r->width, e) ||
		  rle_encode(&mask, pixels, r->height, r->width, e);
	struct annotation *on = bad ? NULL : reading_find(r, view, name, e);

	return !on || reading_unite(r, on, &mask, e) ? -1 : 0;
}

/* ISAT's, or where a file is given Ref-LERF's in it. */
static int read_objects(
	struct reading *r, const cJSON *root, const cJSON *objects, const char *json, struct err *e)
{
	const cJSON *info = json_get(root, "info"), *object;
	const char *image;
	size_t i = 0;

	if (json_string(info, "name", 1, &image, r->where, e) < 0 ||
		(!json && reading_size(r, info, "height", "width", e)))
		return -1;
	const char *view = reading_picture(r, r->path, image, e);
	int bad = !view;
	cJSON_ArrayForEach(object, objects)
	{
		snprintf(r->where, WHERE, "%s: object %zu", r->path, i++);
		bad = bad ||
		      (json ? read_pictured(r, json, object, view, e) : read_object(r, object, view, e));
	}
	return bad ? -1 : 0;
}

/* Ref-LERF's objects, whose outlines are pictures; NULL where the file is none of its. */
static const cJSON *ref_lerf_objects(const cJSON *root)
{
	const cJSON *list = json_get(root, "object");

	if (!list)
		list = json_get(root, "objects");
	return cJSON_IsArray(list) && cJSON_IsString(json_get(list->child, "segmentation")) ? list : NULL;
}

static int read_any(struct reading *r, const cJSON *root, const char *path, struct err *e)
{
	const cJSON *pictures = ref_lerf_objects(root);
	const int is_labelme = json_get(root, "shapes") && json_get(root, "imagePath"),
		  is_coco = json_get(root, "annotations") && json_get(root, "images");
	const cJSON *list = json_get(root, is_labelme ? "shapes" : "annotations");

	snprintf(r->where, WHERE, "%s", r->path);
	r->to->is_layered = is_labelme;
	if ((is_labelme || is_coco) && !cJSON_IsArray(list) && !cJSON_IsNull(list))
		return err_file(e, r->path, "key '%s' is not a list", list->string);
	if (is_labelme || cJSON_IsArray(json_get(root, "shapes")))
		return read_labelme(r, root, e);
	if (is_coco || cJSON_IsArray(list))
		return reading_annotations(r, root, e);
	if (pictures || (json_get(root, "info") && cJSON_IsArray(json_get(root, "objects"))))
		return read_objects(
			r, root, pictures ? pictures : json_get(root, "objects"), pictures ? path : NULL, e);
	return foreign_json(root, r->path, e)
		       ? -1
		       : err_file(e, r->path,
				 "no labels: neither LabelMe's JSON (shapes) nor COCO's (annotations) nor ISAT's or Ref-LERF's (objects)");
}

int annotations_read(struct annotations *a, const char *path, struct err *e)
{
	struct reading r = {.to = a, .path = file_name(path), .score = NAN, .group = NAN};
	SCOPED_BY(json_release) cJSON *root = json_read(path, e);

	*a = (struct annotations){0};
	const int bad = !root || read_any(&r, root, path, e);
	mem_free_all(r.flips, r.mask, r.points);
	return bad ? textfile_note(path, e) : 0;
}
