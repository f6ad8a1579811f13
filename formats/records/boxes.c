#include "formats/records/boxes.h"

#include "base/file.h"
#include "base/mem.h"
#include "formats/records/json.h"
#include "formats/records/jsonl.h"
#include "geom/rotation.h"
#include "mask/mask_index.h"

#include <math.h>

static void record_free(void *record)
{
	const struct box_record *r = record;

	mem_free_all(r->ref, r->object);
}

void boxes_free(struct box_set *s)
{
	for (size_t i = 0; i < s->n; i++)
		record_free(&s->records[i]);
	free(s->records);
	*s = (struct box_set){0};
}

static int read_turned(const struct jsonl *j, const cJSON *object, struct box *b, struct err *e)
{
	const cJSON *o = json_get(object, "oriented");
	double q[4], size[3], m[3][3];

	if (!cJSON_IsObject(o))
		return jsonl_err(j, e, "key 'oriented' is not an object");
	if (json_matrix(o, "centre", 3, 0, b->centre, j->where, e) ||
		json_matrix(o, "quat", 4, 0, q, j->where, e) ||
		json_matrix(o, "size", 3, 0, size, j->where, e))
		return -1;
	double length = hypot(hypot(q[0], q[1]), hypot(q[2], q[3]));
	if (!(fabs(length - 1) < 1e-3))
		return jsonl_err(j, e, "key 'quat' is not of length 1");
	rotation_of_quat(q, m);
	for (int k = 0; k < 3; k++) {
		if (!(size[k] >= 0))
			return jsonl_err(j, e, "key 'size' has something below 0");
		b->half[k] = size[k] / 2;
		for (int d = 0; d < 3; d++)
			b->axes[k][d] = m[d][k];
	}
	return 0;
}

static int read_boxes(const struct jsonl *j, const cJSON *object, struct box_record *r, struct err *e)
{
	double low[3], high[3];

	r->is_empty = !json_member(object, "min") && !json_member(object, "max") &&
		      !json_member(object, "oriented");
	if (r->is_empty)
		return 0;
	if (json_matrix(object, "min", 3, 0, low, j->where, e) ||
		json_matrix(object, "max", 3, 0, high, j->where, e))
		return -1;
	for (int k = 0; k < 3; k++)
		if (low[k] > high[k])
			return jsonl_err(j, e, "key 'min' is above 'max'");
	r->aligned = box_between(low, high);
	return read_turned(j, object, &r->turned, e);
}

static int read_record(const struct jsonl *j, const cJSON *object, void *record, struct err *e)
{
	struct box_record *r = record;
	double time;
	const int has_time = json_number(object, "time", 0, &time, j->where, e);

	if (has_time < 0 || jsonl_name(j, object, "ref", NAME_DATA, 0, &r->ref, e) ||
		jsonl_name(j, object, "object", NAME_DATA, 0, &r->object, e) ||
		jsonl_number(j, object, "score", &r->score, e))
		return -1;
	if (!r->ref && !r->object)
		return jsonl_err(j, e, "neither key 'ref' nor key 'object'");
	if (has_time)
		snprintf(r->time, sizeof r->time, "%.17g", time);
	return read_boxes(j, object, r, e);
}

struct mask *boxes_names(const struct box_set *s, struct err *e)
{
	struct mask *names = mem_alloc(s->n, sizeof *names, "boxes", e);

	for (size_t i = 0; names && i < s->n; i++)
		names[i] = (struct mask){
			.view = s->records[i].time, .ref = s->records[i].ref, .object = s->records[i].object};
	return names;
}

static int check_unique(const struct box_set *s, const long *lines, const char *path, struct err *e)
{
	SCOPED struct mask *names = boxes_names(s, e);
	struct mask_index x;
	size_t earlier, later;
	int bad = !names || mask_index_make(&x, names, s->n, MASK_BY_REF, e);

	if (!bad) {
		const int found = mask_index_twice(&x, &earlier, &later);
		mask_index_free(&x);
		if (found)
			bad = err_set(e, ERR_FORMAT, "%s:%ld: %s '%s' is already on line %ld", path,
				lines[later], names[later].ref ? "ref" : "object",
				names[later].ref ? names[later].ref : names[later].object, lines[earlier]);
	}
	return bad ? -1 : 0;
}

int boxes_read(struct box_set *s, const char *path, struct err *e)
{
	SCOPED_BY(jsonl_close) struct jsonl j = {0};
	SCOPED long *lines = NULL;

	*s = (struct box_set){0};
	if (jsonl_open(&j, path, e))
		return -1;
	int bad = jsonl_records(
		&j, sizeof *s->records, read_record, record_free, (void **)&s->records, &s->n, &lines, e);
	if (!bad && !s->n)
		bad = err_file(e, file_name(path), "holds no boxes");
	bad = bad || check_unique(s, lines, file_name(path), e);
	return bad ? -1 : 0;
}

/* ,"key":[x,...] with twelve digits: a thousandth of a unit a million kilounits from the origin. */
static void put_list(FILE *out, const char *before, const double *x, int n)
{
	fputs(before, out);
	for (int k = 0; k < n; k++)
		fprintf(out, "%s%.12g", k ? "," : "[", x[k] + 0.0);
	fputc(']', out);
}

static void put_boxes(FILE *out, const struct box_record *r)
{
	double low[3], high[3], q[4], m[3][3], size[3];

	if (r->is_empty) {
		fputs(",\"centre\":null,\"min\":null,\"max\":null,\"oriented\":null", out);
		return;
	}
	box_bounds(&r->aligned, low, high);
	for (int k = 0; k < 3; k++) {
		size[k] = 2 * r->turned.half[k];
		for (int d = 0; d < 3; d++)
			m[d][k] = r->turned.axes[k][d];
	}
	rotation_to_quat(m, q);
	put_list(out, ",\"centre\":", r->aligned.centre, 3);
	put_list(out, ",\"min\":", low, 3);
	put_list(out, ",\"max\":", high, 3);
	put_list(out, ",\"oriented\":{\"centre\":", r->turned.centre, 3);
	put_list(out, ",\"quat\":", q, 4);
	put_list(out, ",\"size\":", size, 3);
	fputc('}', out);
}

static void put_parts(FILE *out, const struct box_record *r)
{
	for (size_t k = 0; k < r->part_count; k++) {
		fputs(k ? "," : ",\"parts\":[", out);
		jsonl_put_string(out, "{\"object\":", r->parts[k].object);
		fprintf(out, ",\"score\":%.6g", r->parts[k].score);
		put_boxes(out, &r->parts[k]);
		fputs(k + 1 == r->part_count ? "}]" : "}", out);
	}
}

void boxes_put(FILE *out, const struct box_record *r, const struct box_gaussians *of)
{
	if (r->ref)
		jsonl_put_string(out, "{\"ref\":", r->ref);
	if (r->object)
		jsonl_put_string(out, r->ref ? ",\"object\":" : "{\"object\":", r->object);
	if (r->label)
		fprintf(out, ",\"label\":%d,\"colour\":[%d,%d,%d]", r->label, r->colour[0], r->colour[1],
			r->colour[2]);
	if (!isnan(r->score))
		fprintf(out, ",\"score\":%.6g", r->score);
	if (*r->time)
		fprintf(out, ",\"time\":%s", r->time);
	if (of)
		fprintf(out, ",\"count\":%zu", of->n);
	put_boxes(out, r);
	put_parts(out, r);
	if (of) {
		fputs(",\"gaussians\":[", out);
		for (size_t i = 0; i < of->n; i++)
			fprintf(out, "%s%d", i ? "," : "", (int)of->ids[i]);
		fputc(']', out);
	}
	fputs("}\n", out);
}
