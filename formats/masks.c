#include "formats/masks.h"

#include "base/file.h"
#include "base/mem.h"
#include "base/names.h"
#include "base/number.h"
#include "formats/png.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

void mask_record_free(struct mask_record *r)
{
	free(r->view);
	free(r->ref);
	free(r->object);
	rle_free(&r->mask);
	*r = (struct mask_record){0};
}

/* Gives a key's error its file and line. */
static int key_err(const struct jsonl *j, struct err *e, const char *key)
{
	struct err inner = *e;

	if (inner.code != ERR_FORMAT)
		return -1;
	return jsonl_err(j, e, "key '%s': %s", key, inner.message);
}

static int read_visible(const struct jsonl *j, const cJSON *object, double *visible, struct err *e)
{
	if (jsonl_number(j, object, "visible", visible, e))
		return -1;
	if (*visible < 0 || *visible > 1)
		return jsonl_err(j, e, "key 'visible' is not within 0 to 1");
	return 0;
}

/* COCO's uncompressed list of lengths. */
static int read_list(
	const struct jsonl *j, const cJSON *list, struct rle *mask, int height, int width, struct err *e)
{
	const cJSON *item;
	size_t i = 0;
	uint32_t *runs = mem_alloc((size_t)cJSON_GetArraySize(list), sizeof *runs, "mask", e);

	if (!runs)
		return -1;
	cJSON_ArrayForEach(item, list)
	{
		double x = item->valuedouble;
		if (!cJSON_IsNumber(item) || !(x >= 0 && x <= UINT32_MAX) || x != floor(x)) {
			free(runs);
			return jsonl_err(j, e,
				"key 'segmentation.counts': item %zu is not a whole number in 0 to %lld", i,
				(long long)UINT32_MAX);
		}
		runs[i++] = (uint32_t)x;
	}
	int bad = rle_from_runs(mask, runs, i, height, width, e);
	free(runs);
	return bad ? key_err(j, e, "segmentation.counts") : 0;
}

static int read_segmentation(
	const struct jsonl *j, const cJSON *segmentation, struct rle *mask, struct err *e)
{
	const cJSON *size = cJSON_GetObjectItemCaseSensitive(segmentation, "size");
	const cJSON *counts = cJSON_GetObjectItemCaseSensitive(segmentation, "counts");
	const cJSON *h = cJSON_GetArrayItem(size, 0), *w = cJSON_GetArrayItem(size, 1);

	if (!cJSON_IsObject(segmentation))
		return jsonl_err(j, e, "key 'segmentation' is not an object");
	if (!cJSON_IsArray(size) || cJSON_GetArraySize(size) != 2 || !cJSON_IsNumber(h) || !cJSON_IsNumber(w))
		return jsonl_err(j, e, "key 'segmentation.size' is not [height,width]");
	/* within int, or not a size anyway; the fraction is lost only where valuedouble differs */
	if (h->valuedouble != h->valueint || w->valuedouble != w->valueint)
		return jsonl_err(j, e, "key 'segmentation.size' is not two whole numbers");
	if (rle_check_size(h->valueint, w->valueint, e))
		return key_err(j, e, "segmentation.size");
	if (cJSON_IsArray(counts))
		return read_list(j, counts, mask, h->valueint, w->valueint, e);
	if (!cJSON_IsString(counts))
		return jsonl_err(j, e, "key 'segmentation.counts' is not a string or a list");
	if (rle_from_string(mask, counts->valuestring, h->valueint, w->valueint, e))
		return key_err(j, e, "segmentation.counts");
	return 0;
}

static int read_image(const struct jsonl *j, const char *name, struct rle *mask, struct err *e)
{
	uint8_t *pixels;
	int height, width, bad = -1;
	char *dir = file_dir(j->path, e);
	char *path = dir ? file_join(dir, name, "", e) : NULL;

	if (path && !png_read_mask(path, &pixels, &height, &width, e)) {
		bad = rle_encode(mask, pixels, height, width, e);
		free(pixels);
		if (bad)
			key_err(j, e, "path");
	}
	free(dir);
	free(path);
	return bad;
}

static int read_record(const struct jsonl *j, const cJSON *object, struct mask_record *r, struct err *e)
{
	const cJSON *segmentation = cJSON_GetObjectItemCaseSensitive(object, "segmentation");
	const char *path = NULL;

	if (jsonl_name(j, object, "view", NAME_VIEW, 1, &r->view, e) ||
		jsonl_name(j, object, "ref", NAME_DATA, 0, &r->ref, e) ||
		jsonl_name(j, object, "object", NAME_DATA, 0, &r->object, e) ||
		jsonl_number(j, object, "score", &r->score, e) || read_visible(j, object, &r->visible, e))
		return -1;
	if (!r->ref && !r->object)
		return jsonl_err(j, e, "neither key 'ref' nor key 'object'");
	if (jsonl_string(j, object, "path", 0, &path, e) < 0)
		return -1;
	if (cJSON_IsNull(segmentation))
		segmentation = NULL;
	if (segmentation && path)
		return jsonl_err(j, e, "both key 'segmentation' and key 'path'");
	if (path)
		return read_image(j, path, &r->mask, e);
	if (!segmentation)
		return jsonl_err(j, e, "neither key 'segmentation' nor key 'path'");
	return read_segmentation(j, segmentation, &r->mask, e);
}

int masks_next(struct jsonl *j, struct mask_record *r, struct err *e)
{
	cJSON *object;

	*r = (struct mask_record){0};
	int got = jsonl_next(j, &object, e);
	if (got <= 0)
		return got;
	int bad = read_record(j, object, r, e);
	cJSON_Delete(object);
	if (!bad)
		return 1;
	mask_record_free(r);
	return -1;
}

int masks_read_lines(struct mask_set *set, long **lines, const char *path, struct err *e)
{
	struct jsonl j;
	struct mask_record r;
	void *records = NULL, *numbers = NULL;
	size_t capacity = 0;
	int got;

	*set = (struct mask_set){0};
	*lines = NULL;
	if (jsonl_open(&j, path, e))
		return -1;
	while ((got = masks_next(&j, &r, e)) > 0) {
		if (mem_grow(&records, &set->capacity, set->n + 1, sizeof r, j.path, e) ||
			mem_grow(&numbers, &capacity, set->n + 1, sizeof **lines, j.path, e)) {
			mask_record_free(&r);
			got = -1;
			break;
		}
		((struct mask_record *)records)[set->n] = r;
		((long *)numbers)[set->n++] = j.line_number;
	}
	jsonl_close(&j);
	set->records = records;
	if (got < 0) {
		masks_free(set);
		free(numbers);
		return -1;
	}
	*lines = numbers;
	return 0;
}

int masks_read(struct mask_set *set, const char *path, struct err *e)
{
	long *lines;
	int bad = masks_read_lines(set, &lines, path, e);

	free(lines);
	return bad;
}

void masks_free(struct mask_set *set)
{
	for (size_t i = 0; i < set->n; i++)
		mask_record_free(&set->records[i]);
	free(set->records);
	*set = (struct mask_set){0};
}

int masks_pool(struct pool *p, const struct mask_set *set, const long *lines, const char *path, struct err *e)
{
	size_t bad, first;
	struct pool_record *records = mem_alloc(set->n, sizeof *records, "masks", e);

	*p = (struct pool){0};
	if (!records)
		return -1;
	for (size_t i = 0; i < set->n; i++) {
		const struct mask_record *r = &set->records[i];
		records[i] = (struct pool_record){
			r->view, r->ref, r->object, &r->mask, isnan(r->score) ? 1 : r->score};
	}
	int failed = pool_make(p, records, set->n, e);
	free(records);
	if (failed || !pool_check_sizes(p, &bad, &first))
		return failed;
	pool_free(p);
	const struct mask_record *a = &set->records[bad], *b = &set->records[first];
	return err_set(e, ERR_FORMAT, "%s:%ld: a mask of %dx%d, but view '%s' has %dx%d on line %ld",
		file_name(path), lines[bad], a->mask.width, a->mask.height, a->view, b->mask.width,
		b->mask.height, lines[first]);
}

int masks_views(const struct mask_set *set, const long *lines, const char *path,
	const struct cameras *cameras, size_t *views, struct err *e)
{
	struct names names;
	int bad = names_make(
		&names, cameras->views, sizeof *cameras->views, offsetof(struct camera, name), cameras->n, e);

	for (size_t i = 0; i < set->n && !bad; i++) {
		views[i] = names_find(&names, set->records[i].view);
		if (views[i] == NAMES_NONE)
			bad = err_set(e, ERR_FORMAT, "%s:%ld: key 'view': the scene has no view '%s'",
				file_name(path), lines[i], set->records[i].view);
	}
	names_free(&names);
	return bad;
}

static void put_number(FILE *out, const char *before, double x)
{
	char text[NUMBER_SIZE];

	fprintf(out, "%s%s", before, number_text(text, x));
}

int masks_put(FILE *out, const struct mask_record *r, struct err *e)
{
	char *counts = rle_to_string(&r->mask, e);
	int bad = -1;

	if (!counts)
		return -1;
	if (jsonl_put_string(out, "{\"view\":", r->view, e) ||
		(r->ref && jsonl_put_string(out, ",\"ref\":", r->ref, e)) ||
		(r->object && jsonl_put_string(out, ",\"object\":", r->object, e)))
		goto done;
	if (!isnan(r->score))
		put_number(out, ",\"score\":", r->score);
	if (!isnan(r->visible))
		put_number(out, ",\"visible\":", r->visible);
	fprintf(out, ",\"segmentation\":{\"size\":[%d,%d],\"counts\":", r->mask.height, r->mask.width);
	if (jsonl_put_string(out, "", counts, e))
		goto done;
	fputs("}}\n", out);
	bad = ferror(out) ? err_errno(e, "write") : 0;
done:
	free(counts);
	return bad;
}
