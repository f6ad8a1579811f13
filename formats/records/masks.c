#include "formats/records/masks.h"

#include "base/file.h"
#include "base/jsontext.h"
#include "base/mem.h"
#include "base/number.h"
#include "base/path.h"
#include "formats/images/png.h"
#include "formats/records/json.h"
#include "geom/views.h"

#include <math.h>

/* Gives a key's error its file and line. */
static int key_err(struct err *e, const char *where, const char *key)
{
	const struct err inner = *e;

	return inner.code == ERR_FORMAT ? err_file(e, where, "key '%s': %s", key, inner.message) : -1;
}

static int read_visible(const struct jsonl *j, const cJSON *object, double *visible, struct err *e)
{
	if (jsonl_number(j, object, "visible", visible, e))
		return -1;
	if (*visible < 0 || *visible > 1)
		return jsonl_err(j, e, "key 'visible' is not within 0 to 1");
	return 0;
}

static int read_boxes(const struct jsonl *j, const cJSON *boxes, struct mask_place *place, struct err *e)
{
	const cJSON *item;
	double box[4];
	size_t i = 0;

	if (!cJSON_IsArray(boxes))
		return jsonl_err(j, e, "key 'boxes' is not a list");
	cJSON_ArrayForEach(item, boxes)
	{
		if (json_numbers(item, 4, box))
			return jsonl_err(j, e, "key 'boxes': item %zu is not [left,top,right,bottom]", i);
		if (mask_place_add_box(place, box, e))
			return -1;
		i++;
	}
	return 0;
}

static int read_place(const struct jsonl *j, const cJSON *object, struct mask *m, struct err *e)
{
	const cJSON *peak = json_member(object, "peak"), *boxes = json_member(object, "boxes"),
		    *time = json_member(object, "time"), *when = json_member(object, "when");

	if (!peak && !boxes && !time && !when)
		return 0;
	if (!(m->place = mask_place_new(e)))
		return -1;
	if (peak) {
		if (json_numbers(peak, 2, m->place->peak))
			return jsonl_err(j, e, "key 'peak' is not [column,row]");
		m->place->has_peak = 1;
	}
	if (time && (m->place->has_time = json_number(object, "time", 1, &m->place->time, j->where, e)) < 0)
		return -1;
	if (when && json_numbers(when, 2, m->place->when))
		return jsonl_err(j, e, "key 'when' is not [from,to]");
	m->place->has_when = when != NULL;
	return boxes ? read_boxes(j, boxes, m->place, e) : 0;
}

int masks_take_counts(
	struct rle *mask, const cJSON *counts, int height, int width, const char *where, struct err *e)
{
	const int is_list = cJSON_IsArray(counts);
	const cJSON *item;
	size_t n = 0;

	if (!is_list && !cJSON_IsString(counts))
		return err_file(e, where, "key 'segmentation.counts' is not a string or a list");
	SCOPED uint32_t *runs =
		is_list ? mem_alloc((size_t)cJSON_GetArraySize(counts), sizeof *runs, "mask", e) : NULL;
	if (is_list && !runs)
		return -1;
	cJSON_ArrayForEach(item, counts)
	{
		const double x = item->valuedouble;
		if (!cJSON_IsNumber(item) || !(x >= 0 && x <= UINT32_MAX) || x != floor(x))
			return err_file(e, where,
				"key 'segmentation.counts': item %zu is not a whole number in 0 to %lld", n,
				(long long)UINT32_MAX);
		runs[n++] = (uint32_t)x;
	}
	const int bad = is_list ? rle_from_runs(mask, runs, n, height, width, e)
				: rle_from_string(mask, counts->valuestring, height, width, e);
	if (!bad && rle_is_by_rows(mask))
		return err_file(e, where,
			"its run lengths go along rows, as its shape shows; COCO's go down columns: encode the transposed mask (in NumPy order='F')");
	return bad ? key_err(e, where, "segmentation.counts") : 0;
}

static int read_segmentation(
	const struct jsonl *j, const cJSON *segmentation, struct rle *mask, struct err *e)
{
	const cJSON *size = json_get(segmentation, "size");
	const cJSON *counts = json_get(segmentation, "counts");
	const cJSON *h = cJSON_GetArrayItem(size, 0), *w = cJSON_GetArrayItem(size, 1);

	if (!cJSON_IsObject(segmentation))
		return jsonl_err(j, e, "key 'segmentation' is not an object");
	if (!cJSON_IsArray(size) || cJSON_GetArraySize(size) != 2 || !cJSON_IsNumber(h) || !cJSON_IsNumber(w))
		return jsonl_err(j, e, "key 'segmentation.size' is not [height,width]");
	/* within int, or not a size anyway; the fraction is lost only where valuedouble differs */
	if (h->valuedouble != h->valueint || w->valuedouble != w->valueint)
		return jsonl_err(j, e, "key 'segmentation.size' is not two whole numbers");
	if (rle_check_size(h->valueint, w->valueint, e))
		return key_err(e, j->where, "segmentation.size");
	return masks_take_counts(mask, counts, h->valueint, w->valueint, j->where, e);
}

static int read_image(const struct jsonl *j, const char *name, struct rle *mask, struct err *e)
{
	SCOPED uint8_t *pixels = NULL;
	int height, width;

	if (j->in != stdin && path_leaves(name))
		return jsonl_err(j, e, "key 'path': '%.200s' is not in the folder of this file", name);
	SCOPED char *dir = file_dir(j->path, e);
	SCOPED char *path = dir ? file_join(dir, name, "", e) : NULL;

	if (!path || png_read_mask(path, &pixels, &height, &width, e))
		return -1;
	return rle_encode(mask, pixels, height, width, e) ? key_err(e, j->where, "path") : 0;
}

static int read_names(const struct jsonl *j, const cJSON *object, struct mask *m, struct err *e)
{
	char *names[3] = {NULL, NULL, NULL};
	const int bad = jsonl_name(j, object, "view", NAME_VIEW, 1, &names[0], e) ||
			jsonl_name(j, object, "ref", NAME_DATA, 0, &names[1], e) ||
			jsonl_name(j, object, "object", NAME_DATA, 0, &names[2], e);

	m->view = names[0];
	m->ref = names[1];
	m->object = names[2];
	return bad;
}

static int read_record(const struct jsonl *j, const cJSON *object, struct mask *m, struct err *e)
{
	const cJSON *segmentation = json_member(object, "segmentation");
	const char *path = NULL;

	if (read_names(j, object, m, e) || jsonl_number(j, object, "score", &m->score, e) ||
		read_visible(j, object, &m->visible, e) || read_place(j, object, m, e))
		return -1;
	if (!m->ref && !m->object)
		return jsonl_err(j, e, "neither key 'ref' nor key 'object'");
	if (json_string(object, "path", 0, &path, j->where, e) < 0)
		return -1;
	if (segmentation && path)
		return jsonl_err(j, e, "both key 'segmentation' and key 'path'");
	if (path)
		return read_image(j, path, &m->rle, e);
	if (!segmentation)
		return jsonl_err(j, e, "neither key 'segmentation' nor key 'path'");
	return read_segmentation(j, segmentation, &m->rle, e);
}

int masks_next(struct jsonl *j, struct mask *m, struct err *e)
{
	SCOPED_BY(json_release) cJSON *object = NULL;

	*m = (struct mask){0};
	const int got = jsonl_next(j, &object, e);
	if (got <= 0)
		return got;
	if (!read_record(j, object, m, e))
		return 1;
	mask_free(m);
	return -1;
}

int masks_read_lines(struct masks *set, long **lines, const char *path, struct err *e)
{
	SCOPED_BY(jsonl_close) struct jsonl j = {0};
	struct mask m;
	size_t capacity = 0;
	int got;

	*set = (struct masks){0};
	*lines = NULL;
	if (jsonl_open(&j, path, e))
		return -1;
	while ((got = masks_next(&j, &m, e)) > 0) {
		if (masks_add(set, &m, e) ||
			mem_grow((void **)lines, &capacity, set->n, sizeof **lines, j.path, e)) {
			got = -1;
			break;
		}
		(*lines)[set->n - 1] = j.line_number;
	}
	if (!got)
		return 0;
	masks_free(set);
	free(*lines);
	*lines = NULL;
	return -1;
}

int masks_read(struct masks *set, const char *path, struct err *e)
{
	SCOPED long *lines = NULL;
	return masks_read_lines(set, &lines, path, e);
}

int masks_pool(struct pool *p, const struct masks *set, const long *lines, const char *path, struct err *e)
{
	size_t bad, first;

	if (pool_make(p, set->items, set->n, e))
		return -1;
	if (!pool_check_sizes(p, &bad, &first))
		return 0;
	pool_free(p);
	const struct mask *a = &set->items[bad], *b = &set->items[first];
	return err_set(e, ERR_FORMAT, "%s:%ld: a mask of %dx%d, but view '%s' has %dx%d on line %ld",
		file_name(path), lines[bad], a->rle.width, a->rle.height, a->view, b->rle.width,
		b->rle.height, lines[first]);
}

int masks_check_shape(const struct mask *m, const char *of, int height, int width, const char *path,
	long line, struct err *e)
{
	char where[1024];

	if (!mask_check_shape(m->view, &m->rle, of, height, width, e))
		return 0;
	snprintf(where, sizeof where, "%s:%ld", file_name(path), line);
	return err_prefix(e, where);
}

/* *at: the view of a scene, whose names (names) are these, that a mask is of by its name or by its
 * photograph's (view_part), which the mask then has; NAMES_NONE where there is none. */
static int find_view(
	struct mask *m, const struct names *names, const struct cameras *c, size_t *at, struct err *e)
{
	const char *part;
	int is_so = 0;

	if ((*at = names_find(names, m->view)) != NAMES_NONE)
		return 0;
	/* a picture's name, without its ending and the eight digits that Label Studio puts before it */
	const int is_marked = strspn(m->view, "0123456789abcdef") == 8 && m->view[8] == '-';
	SCOPED char *own = mem_strdup(m->view + 9 * is_marked, e);
	if (!own)
		return -1;
	own[view_stem(own)] = 0;
	is_so = (*at = names_find(names, own)) != NAMES_NONE;
	for (size_t v = 0; v < c->n && *at == NAMES_NONE; v++)
		if (c->views[v].source && (is_so = view_part(c->views[v].source, m->view, &part, e)) > 0)
			*at = v;
		else if (is_so < 0)
			return -1;
	if (is_so <= 0)
		return 0;
	char *name = mem_strdup(c->views[*at].name, e);
	free((char *)m->view);
	m->view = name;
	return name ? 0 : -1;
}

int masks_check_refs(const struct masks *set, const char *path, char *const *refs, char *const *objects,
	size_t sentences, struct err *e)
{
	SCOPED_BY(names_free) struct names names = {0}, called = {0};
	SCOPED const char **all = mem_alloc(sentences + set->n, sizeof *all, "names", e);
	int bad = !all || names_make(&names, refs, sizeof *refs, 0, sentences, e);

	for (size_t i = 0; i < sentences && all; i++)
		all[i] = objects[i];
	for (size_t i = 0; i < set->n && !bad; i++) {
		const struct mask *m = &set->items[i];
		all[sentences + i] = m->object;
		const size_t at = m->ref ? names_find(&names, m->ref) : NAMES_NONE;
		if (at != NAMES_NONE && m->object && *objects[at] && strcmp(m->object, objects[at]))
			bad = err_file(e, file_name(path),
				"a mask of view '%s' is of object '%s', but its ref '%s' is a sentence of '%s': leave out the key that is wrong",
				m->view, m->object, m->ref, objects[at]);
	}
	return bad || names_make(&called, all, sizeof *all, 0, sentences + set->n, e) ||
			       names_check_spelling(&called, file_name(path), e)
		       ? -1
		       : 0;
}

/* Leaves out the masks of views that the scene lacks: COLMAP may have left photographs out. Of all masks it
 * is an error. */
static int leave_out(struct masks *set, long *lines, size_t *views, const char *path,
	const struct names *names, const struct report *to, struct err *e)
{
	char few[NAMES_FEW];
	size_t kept = 0, first = set->n;

	for (size_t i = 0; i < set->n; i++) {
		first = views[i] == NAMES_NONE && first == set->n ? i : first;
		kept += views[i] != NAMES_NONE;
	}
	if (kept == set->n)
		return 0;
	const struct mask *lost = &set->items[first];
	if (!kept)
		return err_set(e, ERR_FORMAT, "%s:%ld: key 'view': the scene has no view '%.300s'%s%s",
			file_name(path), lines[first], lost->view, names_few(names, few),
			strstr(lost->view, ".rf.")
				? ": Roboflow renames pictures, and may stretch and turn them: export without that, and rename the views"
			: lost->object && names_find(names, lost->object) != NAMES_NONE
				? ": 'object' names one: are the two exchanged?"
				: "");
	report_warn(to,
		"%s:%ld: the scene has no view '%.300s': %zu of %zu masks, of views that it lacks, are left out",
		file_name(path), lines[first], lost->view, set->n - kept, set->n);
	kept = 0;
	for (size_t i = 0; i < set->n; i++) {
		if (views[i] == NAMES_NONE) {
			mask_free(&set->items[i]);
			continue;
		}
		set->items[kept] = set->items[i];
		lines[kept] = lines[i];
		views[kept++] = views[i];
	}
	set->n = kept;
	return 0;
}

/* Of many masks hardly half cover half of their view, unless black and white are exchanged. */
static void warn_of_areas(const struct masks *set, const char *path, const struct report *to)
{
	size_t large = 0, empty = 0;

	for (size_t i = 0; i < set->n; i++) {
		const struct rle *rle = &set->items[i].rle;
		large += 2 * rle_area(rle) > (size_t)rle->height * (size_t)rle->width;
		empty += !rle_area(rle);
	}
	if (set->n && empty == set->n)
		report_warn(to, "%s: none of its %zu masks has a pixel", file_name(path), set->n);
	if (set->n >= 8 && 2 * large > set->n)
		report_warn(to,
			"%s: %zu of %zu masks cover more than half of their view: are they inverted, black where the thing is?",
			file_name(path), large, set->n);
}

int masks_views(struct masks *set, long *lines, const char *path, const struct cameras *cameras,
	size_t *views, const struct report *to, struct err *e)
{
	SCOPED_BY(names_free) struct names names = {0};
	int bad = names_make(
		&names, cameras->views, sizeof *cameras->views, offsetof(struct camera, name), cameras->n, e);

	for (size_t i = 0; i < set->n && !bad; i++) {
		size_t at;
		bad = find_view(&set->items[i], &names, cameras, &at, e);
		if (views)
			views[i] = at;
		if (!bad && at != NAMES_NONE && (views || !cameras->views[at].lens.model))
			bad = masks_check_shape(&set->items[i], "the view", cameras->views[at].height,
				cameras->views[at].width, path, lines[i], e);
	}
	if (views && !bad)
		warn_of_areas(set, path, to);
	return bad || (views && set->n && leave_out(set, lines, views, path, &names, to, e)) ? -1 : 0;
}

static void put_number(FILE *out, const char *before, double x)
{
	char text[NUMBER_SIZE];

	fprintf(out, "%s%s", before, number_text(text, x));
}

static void put_place(FILE *out, const struct mask_place *p)
{
	if (p->has_peak)
		jsonl_put_numbers(out, ",\"peak\":[", p->peak, 2);
	for (size_t i = 0; i < p->box_count; i++)
		jsonl_put_numbers(out, i ? ",[" : ",\"boxes\":[[", p->boxes[i], 4);
	if (p->box_count)
		fputc(']', out);
	if (p->has_time)
		put_number(out, ",\"time\":", p->time);
	if (p->has_when)
		jsonl_put_numbers(out, ",\"when\":[", p->when, 2);
}

/* What is known of a mask but whose it is. */
static int put_shape(FILE *out, const struct mask *m, struct err *e)
{
	SCOPED char *counts = rle_to_string(&m->rle, e);

	if (!counts)
		return -1;
	if (!isnan(m->score))
		put_number(out, ",\"score\":", m->score);
	if (!isnan(m->visible))
		put_number(out, ",\"visible\":", m->visible);
	if (m->place)
		put_place(out, m->place);
	fprintf(out, ",\"segmentation\":{\"size\":[%d,%d],\"counts\":", m->rle.height, m->rle.width);
	jsontext_quote(out, counts);
	fputc('}', out);
	return 0;
}

int masks_put_parts(FILE *out, const struct mask *m, const struct mask *parts, size_t n, struct err *e)
{
	jsonl_put_string(out, "{\"view\":", m->view);
	if (m->ref)
		jsonl_put_string(out, ",\"ref\":", m->ref);
	if (m->object)
		jsonl_put_string(out, ",\"object\":", m->object);
	if (put_shape(out, m, e))
		return -1;
	for (size_t k = 0; k < n; k++) {
		jsonl_put_string(out, k ? "},{\"object\":" : ",\"parts\":[{\"object\":", parts[k].object);
		if (put_shape(out, &parts[k], e))
			return -1;
	}
	fputs(n ? "}]}\n" : "}\n", out);
	return ferror(out) ? err_errno(e, "write") : 0;
}

int masks_put(FILE *out, const struct mask *m, struct err *e)
{
	return masks_put_parts(out, m, NULL, 0, e);
}
