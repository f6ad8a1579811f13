/* Shapes of labels as masks: points in the picture's pixels, drawn and put together by view and name. */
#include "formats/records/annotations_private.h"

#include "base/file.h"
#include "base/mem.h"
#include "base/name.h"
#include "formats/images/png.h"
#include "geom/views.h"
#include "mask/polygon.h"

#include <math.h>
#include <stdio.h>

enum { CIRCLE = 64 /* corners that stand for a circle */ };

/* How far beside the picture a point may be that a person set at its edge: this share of its longer side. */
static const double edge_share = 0.02;

/* A picture's name as a view: without folders of either kind of slash, and without the ending. */
static char *reading_view(const struct reading *r, const char *image, struct err *e)
{
	SCOPED char *path = view_image(image, e), *stem = path ? mem_strdup(view_base(path), e) : NULL;

	if (!stem)
		return NULL;
	stem[view_stem(stem)] = 0;
	if (!*stem)
		err_file(e, r->where, "its picture has no name: '%.200s'", image);
	return *stem ? name_to_view(stem, e) : NULL;
}

const char *reading_picture(struct reading *r, const char *json, const char *image, struct err *e)
{
	struct annotations *a = r->to;
	SCOPED char *path = mem_strdup(image, e), *folder = *json ? file_dir(json, e) : mem_strdup(".", e);

	for (char *p = path; p && *p; p++)
		*p = *p == '\\' ? '/' : *p;
	if (!a->view)
		a->view = reading_view(r, image, e);
	if (!a->picture && path && folder)
		a->picture = file_join(strchr(path, ':') ? "." : folder, path, "", e);
	return a->picture ? a->view : NULL;
}

int reading_size(struct reading *r, const cJSON *object, const char *height, const char *width, struct err *e)
{
	double h, w;

	if (json_number(object, height, 1, &h, r->where, e) < 0 ||
		json_number(object, width, 1, &w, r->where, e) < 0)
		return -1;
	if (h != floor(h) || w != floor(w) || fabs(h) > RLE_MAX_SIDE || fabs(w) > RLE_MAX_SIDE ||
		rle_check_size((int64_t)h, (int64_t)w, e))
		return err_file(e, r->where, "%s and %s are no size of a picture", height, width);
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

void reading_group(struct reading *r, const cJSON *item)
{
	static const char *const keys[] = {"group_id", "track_id", "instance_id"};
	const cJSON *found = NULL;

	for (size_t i = 0; i < sizeof keys / sizeof *keys && !cJSON_IsNumber(found); i++) {
		found = json_get(item, keys[i]);
		found = found ? found : json_get(json_get(item, "attributes"), keys[i]);
	}
	r->group = found && cJSON_IsNumber(found) ? found->valuedouble : NAN;
}

/* The annotation that a person's shape of this name goes on with; NULL where there is none. */
static struct annotation *find_earlier(const struct reading *r, const char *view, const char *name)
{
	struct annotations *a = r->to;

	for (size_t i = 0; i < a->n && isnan(r->score); i++)
		if (isnan(a->items[i].score) && !strcmp(a->items[i].view, view) &&
			!strcmp(a->items[i].name, name) && a->items[i].mask.height == r->height &&
			a->items[i].mask.width == r->width)
			return &a->items[i];
	return NULL;
}

struct annotation *reading_find(struct reading *r, const char *view, const char *label, struct err *e)
{
	struct annotations *a = r->to;
	char fault[NAME_FAULT];
	SCOPED char *copy = name_copy(label, e);
	if (!copy)
		return NULL;
	const char *name = name_trim(copy);
	const char *reason = name_fault(name, NAME_DATA, fault);
	struct annotation *earlier = find_earlier(r, view, name);

	if (earlier && fabs(earlier->group - r->group) > 0 && !name_is_nothing(name)) {
		err_file(e, r->where,
			"'%.80s' is here two things, numbers %g and %g of their group or track: things that are alike need labels of their own, as '%.80s 1' and '%.80s 2'",
			name, earlier->group, r->group, name, name);
		return NULL;
	}
	if (earlier)
		return earlier;
	if (reason) {
		err_file(e, r->where, "the label %s", reason);
		return NULL;
	}
	if (mem_grow((void **)&a->items, &a->capacity, a->n + 1, sizeof *a->items, "annotations", e))
		return NULL;
	struct annotation *one = &a->items[a->n++];
	*one = (struct annotation){.view = mem_strdup(view, e),
		.name = mem_strdup(name, e),
		.score = r->score,
		.group = r->group};
	const uint32_t none[] = {(uint32_t)(r->height * r->width)};
	return one->view && one->name && !rle_from_runs(&one->mask, none, 1, r->height, r->width, e) ? one
												     : NULL;
}

static int is_coordinate(const cJSON *item)
{
	return cJSON_IsNumber(item) && fabs(item->valuedouble) < 1e6;
}

int reading_points(struct reading *r, const cJSON *list, size_t *count, struct err *e)
{
	const size_t n = (size_t)cJSON_GetArraySize(list);
	const int is_flat = cJSON_IsArray(list) && cJSON_IsNumber(list->child);
	const cJSON *item;
	size_t at = 0;

	if (mem_room((void **)&r->points, &r->points_room, 2 * n, sizeof *r->points, "points", e))
		return -1;
	cJSON_ArrayForEach(item, list)
	{
		const cJSON *x = is_flat ? item : item->child;
		if (!is_coordinate(x) ||
			(!is_flat && (cJSON_GetArraySize(item) != 2 || !is_coordinate(x->next))))
			return err_file(e, r->where, "a point is not two numbers%s",
				cJSON_GetArraySize(item) > 2
					? ", but a list of more: is the outline nested too deep?"
					: "");
		r->points[at++] = x->valuedouble;
		if (!is_flat)
			r->points[at++] = x->next->valuedouble;
	}
	*count = at / 2;
	return at % 2 ? err_file(e, r->where, "a point is not two numbers") : 0;
}

/* The corners of a rectangle, or of what stands for a circle by its middle and a point on it. */
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

int reading_leave_out(struct reading *r, const char *kind, struct err *e)
{
	struct annotations *a = r->to;

	for (size_t i = 0; i < a->left_count; i++)
		if (!strcmp(a->left_out[i].kind, kind))
			return (int)(a->left_out[i].n++, 0);
	if (mem_grow((void **)&a->left_out, &a->left_capacity, a->left_count + 1, sizeof *a->left_out,
		    "kinds", e))
		return -1;
	a->left_out[a->left_count] = (struct annotations_left){mem_strdup(kind, e), 1};
	return a->left_out[a->left_count].kind ? (int)(a->left_count++, 0) : -1;
}

int reading_unite(struct reading *r, struct annotation *on, const struct rle *mask, struct err *e)
{
	struct rle both;

	if (!rle_area(mask))
		return reading_leave_out(r, "shapes without a pixel", e);
	if (rle_unite(&both, &on->mask, mask, e))
		return -1;
	rle_free(&on->mask);
	on->mask = both;
	on->shapes++;
	return 0;
}

/* Points of the picture, or a little beside it: not shares of it, nor of a picture of another size. */
static int check_points(const struct reading *r, const double *points, size_t count, struct err *e)
{
	const double least = -(1 + edge_share * fmax(r->width, r->height));
	int is_share = r->width > 1 && r->height > 1;

	for (size_t i = 0; i < count; i++) {
		const double x = points[2 * i], y = points[2 * i + 1];
		is_share = is_share && x >= 0 && x <= 1 && y >= 0 && y <= 1;
		if (x < least || y < least || x > r->width - least || y > r->height - least)
			return err_file(e, r->where,
				"its point %g,%g is outside the picture, %dx%d (width x height): is it of a picture of another size?",
				x, y, r->width, r->height);
	}
	return !is_share
		       ? 0
		       : err_file(e, r->where,
				 "all its points are within one pixel of the picture, %dx%d: are they shares of it, not pixels?",
				 r->width, r->height);
}

static int fill(struct reading *r, struct annotation *on, size_t count, struct err *e)
{
	SCOPED_BY(rle_free) struct rle mask = {0};

	memset(r->mask, 0, (size_t)r->height * (size_t)r->width);
	polygon_fill(r->mask, r->flips, r->height, r->width, r->points, count);
	if (rle_encode(&mask, r->mask, r->height, r->width, e))
		return -1;
	const int bad = reading_unite(r, on, &mask, e);
	on->is_outline = 1;
	return bad;
}

int reading_draw(struct reading *r, struct annotation *on, size_t count, struct err *e)
{
	if (count < 3)
		return reading_leave_out(r, "outlines of fewer than three corners", e);
	return check_points(r, r->points, count, e) ? -1 : fill(r, on, count, e);
}

int reading_draw_shape(
	struct reading *r, const char *type, size_t count, const char *view, const char *name, struct err *e)
{
	static const char *const types[] = {"rotation", "oriented_rectangle", "rotated_rectangle", "polygon",
		"rectangle", "circle", "quadrilateral"};
	enum { TURNED = 3 /* of them */, TYPES = sizeof types / sizeof *types };
	const int is_circle = !strcmp(type, "circle"), is_pair = count == 2;
	double middle[2] = {0};
	char kind[64];
	int k = 0;

	while (k < TYPES && strcmp(type, types[k]) != 0)
		k++;
	if (k == TYPES) {
		snprintf(kind, sizeof kind, "shapes of type '%.40s'", type);
		return reading_leave_out(r, kind, e);
	}
	const int is_made = is_pair && (is_circle || !strcmp(type, "rectangle"));
	if (count < 3 && !is_made)
		return reading_leave_out(r, "outlines of fewer than three corners", e);
	/* a rectangle that is turned may reach out of the picture, if its middle does not */
	for (size_t i = 0; i < 2 * count; i++)
		middle[i % 2] += r->points[i] / (double)count;
	if (check_points(r, k < TURNED ? middle : r->points, k < TURNED ? 1 : count, e) ||
		(is_made && round_out(r, is_circle, &count, e)))
		return -1;
	struct annotation *on = reading_find(r, view, name, e);
	return on ? fill(r, on, count, e) : -1;
}
