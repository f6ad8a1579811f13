#include "formats/annotations.h"

#include "base/file.h"
#include "base/mem.h"
#include "base/name.h"
#include "base/path.h"
#include "formats/foreign.h"
#include "formats/json.h"
#include "formats/png.h"
#include "geom/views.h"
#include "mask/polygon.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { CIRCLE = 64 /* corners that stand for a circle */, WHERE = 512 };

/* A file that is read; the last picture's size and memory to draw in. */
struct reading {
	struct annotations *to;
	const char *path;
	char where[WHERE]; /* "path: shape 3", for messages */
	int height, width;
	double score; /* of the detector's annotation that is read, or NAN */
	uint8_t *flips, *mask;
	double *points;
	size_t flips_room, mask_room, points_room;
};

void annotations_free(struct annotations *a)
{
	for (size_t i = 0; i < a->n; i++) {
		free(a->items[i].view);
		free(a->items[i].name);
		free(a->items[i].ref);
		rle_free(&a->items[i].mask);
		mask_place_free(a->items[i].boxes);
	}
	free(a->items);
	*a = (struct annotations){0};
}

/* A picture's name as a view: without folders of either kind of slash, and without the ending. */
static char *view_of(const char *image, struct err *e)
{
	const char *base = strrchr(image, '\\');
	char *stem = mem_strdup(view_base(base ? base + 1 : image), e);

	if (!stem)
		return NULL;
	stem[view_stem(stem)] = 0;
	char *view = name_to_view(stem, e);
	free(stem);
	return view;
}

static int set_size(
	struct reading *r, const cJSON *object, const char *height, const char *width, struct err *e)
{
	double h, w;

	if (json_number(object, height, 1, &h, r->where, e) < 0 ||
		json_number(object, width, 1, &w, r->where, e) < 0)
		return -1;
	if (h != floor(h) || w != floor(w) || fabs(h) > RLE_MAX_SIDE || fabs(w) > RLE_MAX_SIDE ||
		rle_check_size((int64_t)h, (int64_t)w, e))
		return err_set(
			e, ERR_FORMAT, "%s: %s and %s are no size of a picture", r->where, height, width);
	if (picture_check_size(r->where, "the picture", (size_t)w, (size_t)h, e))
		return -1;
	r->height = (int)h;
	r->width = (int)w;
	if (mem_room((void **)&r->flips, &r->flips_room, (size_t)h * (size_t)w, 1, "mask", e) ||
		mem_room((void **)&r->mask, &r->mask_room, (size_t)h * (size_t)w, 1, "mask", e))
		return -1;
	memset(r->flips, 0, (size_t)h * (size_t)w);
	return 0;
}

/* The annotation of a view and name: an earlier one, or a new one of the reading's size; a new one for each
 * thing that a detector found. NULL with *e. */
static struct annotation *find(struct reading *r, const char *view, const char *name, struct err *e)
{
	struct annotations *a = r->to;
	char fault[NAME_FAULT];
	const char *reason = name_fault(name, NAME_DATA, fault);

	for (size_t i = 0; i < a->n && isnan(r->score); i++)
		if (isnan(a->items[i].score) && !strcmp(a->items[i].view, view) &&
			!strcmp(a->items[i].name, name) && a->items[i].mask.height == r->height &&
			a->items[i].mask.width == r->width)
			return &a->items[i];
	if (reason) {
		err_set(e, ERR_FORMAT, "%s: the label %s", r->where, reason);
		return NULL;
	}
	if (mem_grow((void **)&a->items, &a->capacity, a->n + 1, sizeof *a->items, "annotations", e))
		return NULL;
	struct annotation *one = &a->items[a->n++];
	*one = (struct annotation){
		.view = mem_strdup(view, e), .name = mem_strdup(name, e), .score = r->score};
	const uint32_t none[] = {(uint32_t)(r->height * r->width)};
	return one->view && one->name && !rle_from_runs(&one->mask, none, 1, r->height, r->width, e) ? one
												     : NULL;
}

/* A list of numbers, or of pairs of numbers: *count points. */
static int take_points(struct reading *r, const cJSON *list, size_t *count, struct err *e)
{
	const size_t n = (size_t)cJSON_GetArraySize(list);
	const int is_flat = cJSON_IsArray(list) && cJSON_IsNumber(list->child);
	const cJSON *item;
	size_t at = 0;

	if (mem_room((void **)&r->points, &r->points_room, 2 * n, sizeof *r->points, "points", e))
		return -1;
	cJSON_ArrayForEach(item, list)
	{
		const cJSON *pair[2] = {is_flat ? item : item->child, is_flat	    ? NULL
								      : item->child ? item->child->next
										    : NULL};
		for (int k = 0; k < 2 - is_flat; k++) {
			if (!cJSON_IsNumber(pair[k]) || !(fabs(pair[k]->valuedouble) < 1e6))
				return err_set(e, ERR_FORMAT, "%s: a point is not two numbers", r->where);
			r->points[at++] = pair[k]->valuedouble;
		}
	}
	*count = at / 2;
	return at % 2 ? err_set(e, ERR_FORMAT, "%s: a point is not two numbers", r->where) : 0;
}

/* The corners of a rectangle, or of what stands for a circle by its middle and a point on it, in place of two
 * points. */
static int round_out(struct reading *r, int is_circle, size_t *count, struct err *e)
{
	const double x = r->points[0], y = r->points[1], u = r->points[2], v = r->points[3];
	const double corners[8] = {x, y, u, y, u, v, x, v}, radius = hypot(u - x, v - y);

	*count = is_circle ? CIRCLE : 4;
	if (mem_room((void **)&r->points, &r->points_room, 2 * *count, sizeof *r->points, "points", e))
		return -1;
	for (size_t i = 0; i < *count; i++) {
		const double turn = 2 * acos(-1) * (double)i / CIRCLE;
		r->points[2 * i] = is_circle ? x + radius * cos(turn) : corners[2 * i];
		r->points[2 * i + 1] = is_circle ? y + radius * sin(turn) : corners[2 * i + 1];
	}
	return 0;
}

/* Adds a mask of the picture's size to the annotation's. */
static int unite(struct annotation *on, const struct rle *mask, struct err *e)
{
	struct rle both;

	if (rle_unite(&both, &on->mask, mask, e))
		return -1;
	rle_free(&on->mask);
	on->mask = both;
	on->shapes++;
	return 0;
}

static int draw(struct reading *r, struct annotation *on, size_t count, struct err *e)
{
	struct rle mask;

	memset(r->mask, 0, (size_t)r->height * (size_t)r->width);
	polygon_fill(r->mask, r->flips, r->height, r->width, r->points, count);
	if (rle_encode(&mask, r->mask, r->height, r->width, e))
		return -1;
	const int bad = unite(on, &mask, e);
	rle_free(&mask);
	return bad;
}

static int read_shape(struct reading *r, const cJSON *shape, const char *view, struct err *e)
{
	const cJSON *points = cJSON_GetObjectItemCaseSensitive(shape, "points");
	const char *label, *type = "polygon";
	size_t count;

	if (json_string(shape, "label", 1, &label, r->where, e) < 0 ||
		json_string(shape, "shape_type", 0, &type, r->where, e) < 0 ||
		take_points(r, points, &count, e))
		return -1;
	const int is_circle = !strcmp(type, "circle"), is_box = !strcmp(type, "rectangle");
	if (!strcmp(type, "mask"))
		return err_set(e, ERR_FORMAT,
			"%s: a shape of type 'mask'; polygons, rectangles and circles are read", r->where);
	if ((is_circle || is_box) && count == 2 && round_out(r, is_circle, &count, e))
		return -1;
	if (count < 3 || (strcmp(type, "polygon") && !is_circle && !is_box)) {
		r->to->left_out++;
		return 0;
	}
	struct annotation *on = find(r, view, label, e);
	return on && !draw(r, on, count, e) ? 0 : -1;
}

static int read_labelme(struct reading *r, const cJSON *root, struct err *e)
{
	const cJSON *shapes = cJSON_GetObjectItemCaseSensitive(root, "shapes"), *shape;
	const char *image;
	size_t i = 0;

	if (json_string(root, "imagePath", 1, &image, r->where, e) < 0 ||
		set_size(r, root, "imageHeight", "imageWidth", e))
		return -1;
	char *view = view_of(image, e);
	int bad = !view;
	cJSON_ArrayForEach(shape, shapes)
	{
		snprintf(r->where, WHERE, "%s: shape %zu", r->path, i++);
		bad = bad || read_shape(r, shape, view, e);
	}
	free(view);
	return bad ? -1 : 0;
}

/* The "bbox" of an object, [left, top, right, bottom], where it has one. */
static int take_box(struct reading *r, const cJSON *object, struct annotation *on, struct err *e)
{
	const cJSON *list = cJSON_GetObjectItemCaseSensitive(object, "bbox");
	size_t count;

	if (!cJSON_IsArray(list))
		return 0;
	if (take_points(r, list, &count, e))
		return -1;
	if (count != 2)
		return err_set(e, ERR_FORMAT, "%s: key 'bbox' is not two corners", r->where);
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
		take_points(r, cJSON_GetObjectItemCaseSensitive(object, "segmentation"), &count, e))
		return -1;
	if (count < 3) {
		r->to->left_out++;
		return 0;
	}
	struct annotation *on = find(r, view, name, e);
	return on && !draw(r, on, count, e) ? take_box(r, object, on, e) : -1;
}

static int read_isat(struct reading *r, const cJSON *root, struct err *e)
{
	const cJSON *info = cJSON_GetObjectItemCaseSensitive(root, "info"), *object;
	const char *image;
	size_t i = 0;

	if (json_string(info, "name", 1, &image, r->where, e) < 0 || set_size(r, info, "height", "width", e))
		return -1;
	char *view = view_of(image, e);
	int bad = !view;
	cJSON_ArrayForEach(object, cJSON_GetObjectItemCaseSensitive(root, "objects"))
	{
		snprintf(r->where, WHERE, "%s: object %zu", r->path, i++);
		bad = bad || read_object(r, object, view, e);
	}
	free(view);
	return bad ? -1 : 0;
}

/* Draws a PNG's mask of a name: Ref-LERF has it in the folder gt_mask beside that of the labels. */
static int read_mask_picture(struct reading *r, const char *folder, const char *picture, const char *view,
	const char *name, struct err *e)
{
	if (path_leaves(picture))
		return err_set(e, ERR_FORMAT, "%s: key 'segmentation': '%.200s' is not in the folder gt_mask",
			r->where, picture);
	char *path = file_join(folder, picture, "", e);
	uint8_t *pixels = NULL;
	struct rle mask = {0};
	int bad = !path || png_read_mask(path, &pixels, &r->height, &r->width, e) ||
		  rle_encode(&mask, pixels, r->height, r->width, e);
	struct annotation *on = bad ? NULL : find(r, view, name, e);

	bad = !on || unite(on, &mask, e);
	free(path);
	free(pixels);
	rle_free(&mask);
	return bad ? -1 : 0;
}

static int read_ref_lerf(
	struct reading *r, const cJSON *root, const cJSON *objects, const char *json, struct err *e)
{
	const cJSON *object;
	const char *image, *name, *picture;
	size_t i = 0;

	if (json_string(cJSON_GetObjectItemCaseSensitive(root, "info"), "name", 1, &image, r->where, e) < 0)
		return -1;
	char *view = view_of(image, e), *folder = file_dir(json, e),
	     *masks = folder ? file_join(folder, "../gt_mask", "", e) : NULL;
	int bad = !view || !masks;
	cJSON_ArrayForEach(object, objects)
	{
		snprintf(r->where, WHERE, "%s: object %zu", r->path, i++);
		bad = bad || json_string(object, "category", 1, &name, r->where, e) < 0 ||
		      json_string(object, "segmentation", 1, &picture, r->where, e) < 0 ||
		      read_mask_picture(r, masks, picture, view, name, e);
	}
	free(view);
	free(folder);
	free(masks);
	return bad ? -1 : 0;
}

/* Ref-LERF's objects, whose outlines are pictures; NULL where the file is none of its. */
static const cJSON *ref_lerf_objects(const cJSON *root)
{
	const cJSON *list = cJSON_GetObjectItemCaseSensitive(root, "object");

	if (!list)
		list = cJSON_GetObjectItemCaseSensitive(root, "objects");
	return cJSON_IsArray(list) &&
			       cJSON_IsString(cJSON_GetObjectItemCaseSensitive(list->child, "segmentation"))
		       ? list
		       : NULL;
}

/* The item of a list whose "id" is that number, or NULL. */
static const cJSON *with_id(const cJSON *list, const cJSON *id)
{
	const cJSON *item;

	cJSON_ArrayForEach(item, list)
	{
		const cJSON *own = cJSON_GetObjectItemCaseSensitive(item, "id");
		if (cJSON_IsNumber(own) && cJSON_IsNumber(id) && own->valuedouble == id->valuedouble)
			return item;
	}
	return NULL;
}

static int take_runs(struct rle *rle, const cJSON *counts, int height, int width, struct err *e)
{
	const cJSON *item;
	size_t n = 0;

	if (cJSON_IsString(counts))
		return rle_from_string(rle, counts->valuestring, height, width, e);
	uint32_t *runs = mem_alloc((size_t)cJSON_GetArraySize(counts), sizeof *runs, "mask", e);
	if (!runs)
		return -1;
	cJSON_ArrayForEach(item, counts) runs[n++] =
		cJSON_IsNumber(item) && item->valuedouble >= 0 && item->valuedouble <= UINT32_MAX
			? (uint32_t)item->valuedouble
			: UINT32_MAX;
	const int bad = rle_from_runs(rle, runs, n, height, width, e);
	free(runs);
	return bad;
}

static int draw_runs(struct reading *r, struct annotation *on, const cJSON *counts, struct err *e)
{
	struct rle rle;

	if (take_runs(&rle, counts, r->height, r->width, e)) {
		const struct err inner = *e;
		return inner.code == ERR_FORMAT
			       ? err_set(e, ERR_FORMAT, "%s: %.300s", r->where, inner.message)
			       : -1;
	}
	const int bad = unite(on, &rle, e);
	rle_free(&rle);
	return bad;
}

/* Polygons, of which all are parts of the thing, or run lengths. */
static int read_segmentation(
	struct reading *r, const cJSON *item, const char *view, const char *name, struct err *e)
{
	const cJSON *segmentation = cJSON_GetObjectItemCaseSensitive(item, "segmentation"), *polygon;
	const cJSON *counts = cJSON_GetObjectItemCaseSensitive(segmentation, "counts");
	struct annotation *on = NULL;
	size_t count, before;

	if (!cJSON_GetArraySize(segmentation)) {
		r->to->left_out++;
		return 0;
	}
	if (!(on = find(r, view, name, e)))
		return -1;
	if (counts)
		return draw_runs(r, on, counts, e);
	before = on->shapes;
	cJSON_ArrayForEach(polygon, segmentation)
	{
		if (!cJSON_IsArray(polygon))
			return err_set(e, ERR_FORMAT,
				"%s: key 'segmentation' is neither polygons nor run lengths", r->where);
		if (take_points(r, polygon, &count, e) || draw(r, on, count, e))
			return -1;
	}
	on->shapes = before + 1;
	return 0;
}

/* "score": a number, or a list with one, as Grounded-SAM-2 writes it. */
static int read_score(struct reading *r, const cJSON *item, struct err *e)
{
	const cJSON *score = cJSON_GetObjectItemCaseSensitive(item, "score");

	if (cJSON_GetArraySize(score) == 1)
		score = score->child;
	r->score = NAN;
	if (!score || cJSON_IsNull(score))
		return 0;
	if (!cJSON_IsNumber(score) || !isfinite(score->valuedouble))
		return err_set(e, ERR_FORMAT, "%s: key 'score' is not a finite number", r->where);
	r->score = score->valuedouble;
	return 0;
}

/* The annotation that was read last gets the sentence that the detector was given, where the file says it. */
static int read_ref(struct reading *r, const cJSON *item, size_t before, struct err *e)
{
	struct annotations *a = r->to;
	const char *ref = NULL;
	char fault[NAME_FAULT];

	if (isnan(r->score) || a->n == before)
		return 0;
	if (json_string(item, "ref", 0, &ref, r->where, e) < 0)
		return -1;
	const char *reason = ref ? name_fault(ref, NAME_DATA, fault) : NULL;
	if (reason)
		return err_set(e, ERR_FORMAT, "%s: key 'ref' %s", r->where, reason);
	return ref && !(a->items[a->n - 1].ref = mem_strdup(ref, e)) ? -1 : 0;
}

static int read_mask(struct reading *r, const cJSON *item, const char *file, const char *name, struct err *e)
{
	const size_t before = r->to->n;
	char *view = view_of(file, e);
	const int bad = !view || read_score(r, item, e) || read_segmentation(r, item, view, name, e) ||
			read_ref(r, item, before, e);

	free(view);
	r->score = NAN;
	return bad ? -1 : 0;
}

static int read_annotation(struct reading *r, const cJSON *root, const cJSON *item, struct err *e)
{
	const cJSON *image = with_id(cJSON_GetObjectItemCaseSensitive(root, "images"),
		cJSON_GetObjectItemCaseSensitive(item, "image_id"));
	const cJSON *category = with_id(cJSON_GetObjectItemCaseSensitive(root, "categories"),
		cJSON_GetObjectItemCaseSensitive(item, "category_id"));
	const char *file, *name;

	if (!image || !category)
		return err_set(e, ERR_FORMAT, "%s: no %s has its '%s'", r->where,
			image ? "category" : "image", image ? "category_id" : "image_id");
	return json_string(image, "file_name", 1, &file, r->where, e) < 0 ||
			       json_string(category, "name", 1, &name, r->where, e) < 0 ||
			       set_size(r, image, "height", "width", e) || read_mask(r, item, file, name, e)
		       ? -1
		       : 0;
}

/* Grounded-SAM-2's: one picture, and what was found in it. */
static int read_found(struct reading *r, const cJSON *root, const cJSON *item, struct err *e)
{
	const char *file, *name;

	return json_string(root, "image_path", 1, &file, r->where, e) < 0 ||
			       json_string(item, "class_name", 1, &name, r->where, e) < 0 ||
			       set_size(r, root, "img_height", "img_width", e) ||
			       read_mask(r, item, file, name, e)
		       ? -1
		       : 0;
}

/* COCO's, or Grounded-SAM-2's. */
static int read_annotations(struct reading *r, const cJSON *root, struct err *e)
{
	const int is_found = cJSON_GetObjectItemCaseSensitive(root, "image_path") != NULL;
	const cJSON *item;
	size_t i = 0;

	cJSON_ArrayForEach(item, cJSON_GetObjectItemCaseSensitive(root, "annotations"))
	{
		snprintf(r->where, WHERE, "%s: annotation %zu", r->path, i++);
		if (is_found ? read_found(r, root, item, e) : read_annotation(r, root, item, e))
			return -1;
	}
	return 0;
}

static int read_any(struct reading *r, const cJSON *root, const char *path, struct err *e)
{
	const cJSON *pictures = ref_lerf_objects(root);
	const int is_labelme = cJSON_IsArray(cJSON_GetObjectItemCaseSensitive(root, "shapes"));

	snprintf(r->where, WHERE, "%s", r->path);
	if (is_labelme)
		return read_labelme(r, root, e);
	if (cJSON_IsArray(cJSON_GetObjectItemCaseSensitive(root, "annotations")))
		return read_annotations(r, root, e);
	if (pictures)
		return read_ref_lerf(r, root, pictures, path, e);
	if (cJSON_IsArray(cJSON_GetObjectItemCaseSensitive(root, "objects")))
		return read_isat(r, root, e);
	return foreign_json(root, r->path, e)
		       ? -1
		       : err_set(e, ERR_FORMAT,
				 "%s: no labels: neither LabelMe's JSON (shapes) nor COCO's (annotations) nor ISAT's or Ref-LERF's (objects)",
				 r->path);
}

int annotations_read(struct annotations *a, const char *path, struct err *e)
{
	struct reading r = {.to = a, .path = file_name(path), .score = NAN};
	cJSON *root = json_read(path, e);

	*a = (struct annotations){0};
	const int bad = !root || read_any(&r, root, path, e);
	cJSON_Delete(root);
	free(r.flips);
	free(r.mask);
	free(r.points);
	return bad ? -1 : 0;
}
