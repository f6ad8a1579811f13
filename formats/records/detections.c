#include "formats/records/detections.h"

#include "base/mem.h"
#include "base/number.h"
#include "formats/records/json.h"
#include "formats/records/jsonl.h"
#include "geom/views.h"

#include <math.h>

static void release(void *record)
{
	const struct detection *d = record;

	mem_free_all((char *)d->view, (char *)d->name);
}

void detections_free(struct detections *d)
{
	for (size_t i = 0; i < d->n; i++)
		release(&d->items[i]);
	free(d->items);
	*d = (struct detections){0};
}

static int read_box(const struct jsonl *j, const cJSON *object, struct detection *d, struct err *e)
{
	double size[2];

	if (json_matrix(object, "size", 2, 0, size, j->where, e) ||
		json_matrix(object, "box", 4, 0, d->box, j->where, e))
		return -1;
	for (int k = 0; k < 2; k++)
		if (!(size[k] >= 1 && size[k] <= VIEW_SIZE_MAX) || size[k] != floor(size[k]))
			return jsonl_err(
				j, e, "key 'size' is not two whole numbers from 1 to %d", VIEW_SIZE_MAX);
	for (int k = 0; k < 4; k++)
		d->box[k] = fmin(fmax(d->box[k], 0), size[!(k % 2)]);
	if (!(d->box[0] < d->box[2] && d->box[1] < d->box[3]))
		return jsonl_err(j, e, "key 'box' is not [left,top,right,bottom] of a part of the picture");
	d->height = (int)size[0];
	d->width = (int)size[1];
	return 0;
}

static int read_record(const struct jsonl *j, const cJSON *object, void *record, struct err *e)
{
	struct detection *d = record;
	char *names[2] = {NULL, NULL};
	const int bad = jsonl_name(j, object, "view", NAME_VIEW, 1, &names[0], e) ||
			jsonl_name(j, object, "class", NAME_DATA, 0, &names[1], e);

	d->view = names[0];
	d->name = names[1];
	if (bad || jsonl_number(j, object, "score", &d->score, e))
		return -1;
	if (isnan(d->score))
		d->score = 1;
	if (!(d->score >= 0 && d->score <= 1))
		return jsonl_err(j, e, "key 'score' is not within 0 to 1");
	return read_box(j, object, d, e);
}

int detections_read(struct detections *d, const char *path, struct err *e)
{
	SCOPED_BY(jsonl_close) struct jsonl j = {0};

	*d = (struct detections){0};
	return -(jsonl_open(&j, path, e) || jsonl_records(&j, sizeof *d->items, read_record, release,
						    (void **)&d->items, &d->n, NULL, e));
}

int detections_put(FILE *out, const struct detection *d, struct err *e)
{
	char text[NUMBER_SIZE];

	jsonl_put_string(out, "{\"view\":", d->view);
	if (d->name)
		jsonl_put_string(out, ",\"class\":", d->name);
	fprintf(out, ",\"score\":%s,\"size\":[%d,%d]", number_text(text, d->score), d->height, d->width);
	jsonl_put_numbers(out, ",\"box\":[", d->box, 4);
	fputs("}\n", out);
	return ferror(out) ? err_errno(e, "write") : 0;
}
