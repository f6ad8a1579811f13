/* COCO's annotations, and those of Grounded-SAM-2's detections. */
#include "formats/records/annotations_private.h"

#include "base/mem.h"
#include "base/name.h"
#include "base/names.h"
#include "formats/records/masks.h"
#include "geom/views.h"

#include <math.h>
#include <stdio.h>

/* Whether ids are the same: texts, or numbers, which may be written as texts. */
static int is_id(const cJSON *a, const cJSON *b)
{
	const cJSON *ids[2] = {a, b};
	double numbers[2];

	for (int i = 0; i < 2; i++) {
		const char *text = cJSON_GetStringValue(ids[i]);
		char *end = NULL;
		numbers[i] = cJSON_IsNumber(ids[i]) ? ids[i]->valuedouble : text ? strtod(text, &end) : NAN;
		numbers[i] = end && (end == text || *end) ? NAN : numbers[i];
	}
	return numbers[0] == numbers[1] || (cJSON_IsString(a) && cJSON_Compare(a, b, 1));
}

/* The item of a list whose "id" is that of the object's "KIND_id"; NULL with *e where none is, or two
 * different ones. */
static const cJSON *with_id(const struct reading *r, const cJSON *root, const char *list, const cJSON *object,
	const char *key, struct err *e)
{
	const cJSON *item, *found = NULL, *items = json_get(root, list), *id = json_get(object, key);
	SCOPED char *text = id ? cJSON_PrintUnformatted(id) : NULL;

	cJSON_ArrayForEach(item, items)
	{
		if (!is_id(json_get(item, "id"), id))
			continue;
		if (found && !cJSON_Compare(found, item, 1)) {
			err_file(e, r->where, "two of the file's %s have its '%s', %.80s", list, key, text);
			return NULL;
		}
		found = found ? found : item;
	}
	if (!found)
		err_file(e, r->where, "none of the file's %d %s has its '%s', %.80s: is the file whole?",
			cJSON_GetArraySize(items), list, key, text ? text : "which is missing");
	return found;
}

/* Run lengths say whose size they are of themselves. */
static int check_size(const struct reading *r, const cJSON *size, struct err *e)
{
	const cJSON *h = cJSON_GetArrayItem(size, 0), *w = cJSON_GetArrayItem(size, 1);

	if (!cJSON_IsArray(size) || cJSON_GetArraySize(size) != 2 || !cJSON_IsNumber(h) || !cJSON_IsNumber(w))
		return err_file(e, r->where, "key 'segmentation.size' is not [height,width]");
	if (h->valuedouble == r->height && w->valuedouble == r->width)
		return 0;
	return err_file(e, r->where,
		"key 'segmentation.size' is %gx%g, but its picture is %dx%d (width x height)%s",
		w->valuedouble, h->valuedouble, r->width, r->height,
		h->valuedouble == r->width && w->valuedouble == r->height
			? ": height and width are exchanged in one of them"
			: "");
}

static int draw_runs(struct reading *r, struct annotation *on, const cJSON *item, struct err *e)
{
	const cJSON *segmentation = json_get(item, "segmentation");
	const cJSON *counts = json_get(segmentation, "counts");
	SCOPED_BY(rle_free) struct rle rle = {0};

	if (check_size(r, json_get(segmentation, "size"), e))
		return -1;
	if (masks_take_counts(&rle, counts, r->height, r->width, r->where, e))
		return -1;
	return reading_unite(r, on, &rle, e);
}

/* Programs write y before x. The annotation's "bbox", [left, top, width, height] or two corners, has then
 * most corners of the polygon when they are exchanged, and few as they are. */
static int check_order(const struct reading *r, const cJSON *item, size_t count, struct err *e)
{
	const double beside = 1 + 0.01 * fmax(r->width, r->height);
	size_t inside[2] = {0, 0};
	double b[4];

	if (json_numbers(json_get(item, "bbox"), 4, b))
		return 0;
	for (size_t i = 0; i < 2 * count; i++) {
		const size_t k = i % 2;
		const double x = r->points[i] - b[0], y = r->points[i + 1 - 2 * k] - b[1];
		inside[k] += x >= -beside && y >= -beside && x <= fmax(b[2], b[2] - b[0]) + beside &&
			     y <= fmax(b[3], b[3] - b[1]) + beside;
	}
	return inside[1] < 0.9 * (double)count || inside[0] > 0.5 * (double)count
		       ? 0
		       : err_file(e, r->where,
				 "its points have y before x, as its 'bbox' shows: they go [x,y,x,y, ...]");
}

/* Polygons, of which all are parts of the thing, or run lengths. */
static int read_segmentation(
	struct reading *r, const cJSON *item, const char *view, const char *name, struct err *e)
{
	const cJSON *segmentation = json_get(item, "segmentation"), *polygon;
	const cJSON *counts = json_get(segmentation, "counts");
	struct annotation *on = NULL;
	size_t count, before;

	if (!cJSON_GetArraySize(segmentation)) {
		const int is_box = cJSON_GetArraySize(json_get(item, "bbox"));
		return reading_leave_out(r,
			is_box ? "boxes (key 'bbox') without an outline" : "annotations without an outline",
			e);
	}
	if (!(on = reading_find(r, view, name, e)))
		return -1;
	if (counts)
		return draw_runs(r, on, item, e);
	before = on->shapes;
	cJSON_ArrayForEach(polygon, segmentation)
	{
		if (!cJSON_IsArray(polygon))
			return err_file(
				e, r->where, "key 'segmentation' is neither polygons nor run lengths");
		if (reading_points(r, polygon, &count, e) || check_order(r, item, count, e) ||
			reading_draw(r, on, count, e))
			return -1;
	}
	on->shapes = on->shapes > before ? before + 1 : before;
	return 0;
}

/* "score": a number, or a list with one, as Grounded-SAM-2 writes it. */
static int read_score(struct reading *r, const cJSON *item, struct err *e)
{
	const cJSON *score = json_get(item, "score");

	if (cJSON_GetArraySize(score) == 1)
		score = score->child;
	r->score = NAN;
	if (!score || cJSON_IsNull(score))
		return 0;
	if (!cJSON_IsNumber(score) || !isfinite(score->valuedouble))
		return err_file(e, r->where, "key 'score' is not a finite number");
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
		return err_file(e, r->where, "key 'ref' %s", reason);
	return ref && !(a->items[a->n - 1].ref = mem_strdup(ref, e)) ? -1 : 0;
}

static int read_mask(struct reading *r, const cJSON *item, const char *view, const char *name, struct err *e)
{
	const size_t before = r->to->n;
	reading_group(r, item);
	const int bad = read_score(r, item, e) || read_segmentation(r, item, view, name, e) ||
			read_ref(r, item, before, e);

	r->score = NAN;
	return bad ? -1 : 0;
}

/* The views of all pictures, as gs-import names those of photographs of these paths. */
struct coco {
	size_t n;
	char **files, **views;
};

static void coco_free(struct coco *c)
{
	mem_free_strings(c->files, c->n);
	mem_free_strings(c->views, c->n);
}

static int check_twice(const struct reading *r, const struct coco *c, struct err *e)
{
	size_t twice, earlier;

	if (names_find_twice(c->files, sizeof *c->files, 0, c->n, &twice, &earlier, e))
		return -1;
	return twice == NAMES_NONE
		       ? 0
		       : err_file(e, r->path,
				 "images %zu and %zu have one file_name, '%.300s': their labels would be of one view",
				 earlier, twice, c->files[twice]);
}

static int name_views(struct reading *r, const cJSON *images, struct coco *c, struct err *e)
{
	const cJSON *image;
	const size_t n = (size_t)cJSON_GetArraySize(images);

	c->files = mem_zalloc(n, sizeof *c->files, "images", e);
	c->views = mem_zalloc(n, sizeof *c->views, "images", e);
	if (!c->files || !c->views)
		return -1;
	cJSON_ArrayForEach(image, images)
	{
		const char *file;
		snprintf(r->where, WHERE, "%s: image %zu", r->path, c->n);
		if (json_string(image, "file_name", 1, &file, r->where, e) < 0 ||
			!(c->files[c->n++] = view_image(file, e)))
			return -1;
		if (!*view_base(c->files[c->n - 1]))
			return err_file(e, r->where, "key 'file_name' has no name: '%.200s'", file);
	}
	return -(check_twice(r, c, e) ||
		 views_name((const char *const *)c->files, c->n, c->views, r->path, e));
}

static int read_annotation(
	struct reading *r, const struct coco *c, const cJSON *root, const cJSON *item, struct err *e)
{
	const cJSON *before, *image = with_id(r, root, "images", item, "image_id", e);
	const cJSON *category = image ? with_id(r, root, "categories", item, "category_id", e) : NULL;
	const char *name;
	size_t at = 0;

	if (!category)
		return -1;
	for (before = json_get(root, "images")->child; before != image; before = before->next)
		at++;
	return -(json_string(category, "name", 1, &name, r->where, e) < 0 ||
		 reading_size(r, image, "height", "width", e) || read_mask(r, item, c->views[at], name, e));
}

/* Grounded-SAM-2's: one picture, and what was found in it. */
static int read_found(struct reading *r, const cJSON *root, const cJSON *item, struct err *e)
{
	const char *file, *name;

	if (json_string(root, "image_path", 1, &file, r->where, e) < 0 ||
		json_string(item, "class_name", 1, &name, r->where, e) < 0 ||
		reading_size(r, root, "img_height", "img_width", e))
		return -1;
	const char *view = reading_picture(r, "", file, e);
	return view ? read_mask(r, item, view, name, e) : -1;
}

int reading_annotations(struct reading *r, const cJSON *root, struct err *e)
{
	const int is_found = json_get(root, "image_path") != NULL;
	const cJSON *item;
	SCOPED_BY(coco_free) struct coco c = {0};
	size_t i = 0;
	r->to->is_layered = 1;
	int bad = !is_found && name_views(r, json_get(root, "images"), &c, e);

	cJSON_ArrayForEach(item, json_get(root, "annotations"))
	{
		snprintf(r->where, WHERE, "%s: annotation %zu", r->path, i++);
		bad = bad ||
		      (is_found ? read_found(r, root, item, e) : read_annotation(r, &c, root, item, e));
	}
	return bad ? -1 : 0;
}
