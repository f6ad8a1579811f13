#include "formats/scene/lifted.h"

#include "base/mem.h"
#include "formats/arrays/metalist.h"
#include "formats/arrays/precision.h"
#include "formats/arrays/safetensors.h"

#include <math.h>
#include <stdlib.h>

enum { VERSION_READ = 1, SHARE_STEPS = 255, MAX_WIDTH = 65536 };

static int read_shares(struct lifted *l, const struct safetensors *st, struct err *e)
{
	size_t count;

	if (!(l->index = safetensors_copy(st, "index", ST_I32, 1, (int64_t[]){-1}, &count, e)))
		return -1;
	const struct st_tensor *share =
		safetensors_need(st, "share", ST_U8, 1, (int64_t[]){(int64_t)count}, e);
	if (!share || !(l->share = mem_alloc(count, sizeof *l->share, st->path, e)))
		return -1;
	for (size_t k = 0; k < count; k++) {
		const int step = ((const uint8_t *)share->data)[k];
		if (!step)
			return err_file(e, st->path, "tensor 'share': item %zu is 0", k);
		l->share[k] = (float)step / SHARE_STEPS;
	}
	return -(metalist_check_offsets(
			 "indptr", l->indptr, l->objects, (int64_t)count, "shares", st->path, e) ||
		 metalist_check_index(l->index, l->indptr, l->objects, l->gaussians, "object", st->path, e));
}

static int read_objects(struct lifted *l, const struct safetensors *st, struct err *e)
{
	if (!(l->indptr = metalist_offsets(st, "indptr", "objects", &l->objects, e)))
		return -1;
	const int64_t shape[] = {(int64_t)l->objects};
	if (!(l->confidence = safetensors_copy(st, "confidence", ST_F32, 1, shape, NULL, e)))
		return -1;
	for (size_t o = 0; o < l->objects; o++)
		if (!(l->confidence[o] >= 0 && l->confidence[o] <= 1))
			return err_file(e, st->path, "tensor 'confidence': item %zu is not in 0 to 1", o);
	l->names = metalist_read(st, "names", l->objects, "objects", e);
	return -(!l->names || metalist_check_names(l->names, l->objects, 0, "names", st->path, e) ||
		 metalist_check_unique(l->names, l->objects, "names", st->path, e) || read_shares(l, st, e));
}

/* Words by one of the encoder's layers, of `rows` and the width. NULL with *e. */
static float *read_layer(
	const struct lifted *l, const struct safetensors *st, const char *name, size_t rows, struct err *e)
{
	const size_t width = (size_t)l->width;
	float *to = NULL;

	if (safetensors_need(st, name, ST_F16, 2, (int64_t[]){(int64_t)rows, l->width}, e))
		to = mem_alloc(rows, width * sizeof *to, st->path, e);
	if (to && precision_get(st, name, PRECISION_F16, PRECISION_ROWS, rows, width, to, e)) {
		free(to);
		return NULL;
	}
	return to;
}

static int read_words(struct lifted *l, const struct safetensors *st, struct err *e)
{
	const struct st_tensor *words = safetensors_need(st, "words", ST_F16, 2, (int64_t[]){-1, -1}, e);

	if (!words)
		return -1;
	if (words->shape[1] < 1 || words->shape[1] > MAX_WIDTH)
		return err_file(e, st->path, "tensor 'words': width %lld is not in 1 to %d",
			(long long)words->shape[1], MAX_WIDTH);
	const size_t rows = (size_t)words->shape[0];
	l->width = (int)words->shape[1];
	if (!(l->words = read_layer(l, st, "words", rows, e)) ||
		metalist_check_offsets(
			"offsets", l->offsets, l->sentences, (int64_t)rows, "words", st->path, e))
		return -1;
	if (safetensors_find(st, "middle") && !(l->middle = read_layer(l, st, "middle", rows, e)))
		return -1;
	return 0;
}

static int read_sentences(struct lifted *l, const struct safetensors *st, struct err *e)
{
	if (!(l->offsets = metalist_offsets(st, "offsets", "sentences", &l->sentences, e)))
		return -1;
	const int64_t shape[] = {(int64_t)l->sentences};
	if (!(l->object = safetensors_copy(st, "object", ST_I32, 1, shape, NULL, e)))
		return -1;
	for (size_t r = 0; r < l->sentences; r++)
		if (l->object[r] < 0 || (size_t)l->object[r] >= l->objects)
			return err_file(e, st->path, "tensor 'object': item %zu is %d, of %zu objects", r,
				l->object[r], l->objects);
	if (read_words(l, st, e) || !(l->texts = metalist_read(st, "texts", l->sentences, "sentences", e)) ||
		!(l->pieces = metalist_read(st, "pieces", l->sentences, "sentences", e)))
		return -1;
	return metalist_check_pieces(l->pieces, l->offsets, l->sentences, st->path, e);
}

int lifted_take(struct lifted *l, struct origin *origin, const struct safetensors *st, struct err *e)
{
	long long gaussians = 0;

	*l = (struct lifted){0};
	int bad = safetensors_need_format(st, "refer.lifted", VERSION_READ, e) ||
		  safetensors_meta_int(st, "gaussians", 0, INT32_MAX, &gaussians, e) ||
		  origin_read(origin, st, e);
	l->gaussians = (size_t)gaussians;
	bad = bad || read_objects(l, st, e) || read_sentences(l, st, e);
	if (bad)
		lifted_free(l);
	return bad ? -1 : 0;
}

int lifted_read(struct lifted *l, struct origin *origin, const char *path, struct err *e)
{
	struct safetensors st;

	*l = (struct lifted){0};
	if (safetensors_open(&st, path, e))
		return -1;
	int bad = lifted_take(l, origin, &st, e);
	safetensors_close(&st);
	return bad;
}

/* All above 0, or 0 where it may be, and at most 1. */
static void check_parts(struct arrays_out *out, const float *x, size_t n, int may_be_0, const char *name)
{
	for (size_t k = 0; k < n && !out->bad; k++)
		if (!((x[k] > 0 || (may_be_0 && x[k] >= 0)) && x[k] <= 1))
			out->bad = err_set(out->e, ERR_CHECK, "%s: tensor '%s': item %zu is %g", out->path,
				name, k, (double)x[k]);
}

/* Shares in whole steps; the least is one, as a Gaussian with none is not listed. */
static void put_shares(struct arrays_out *out, const struct lifted *l)
{
	const size_t count = (size_t)l->indptr[l->objects];
	uint8_t *steps = arrays_out_memory(out, count, 1);

	for (size_t k = 0; k < count && steps; k++) {
		const long step = lrintf(l->share[k] * SHARE_STEPS);
		steps[k] = (uint8_t)(step < 1 ? 1 : step);
	}
	arrays_out_put(out, st_vector("share", ST_U8, (int64_t)count, steps));
}

int lifted_write(const struct lifted *l, const struct origin *origin, const char *path, const char *options,
	struct err *e)
{
	const int64_t objects = (int64_t)l->objects, sentences = (int64_t)l->sentences;
	const size_t rows = (size_t)l->offsets[sentences], width = (size_t)l->width;
	struct arrays_out out;

	arrays_out_begin(&out, path, "refer.lifted", "1", "refer-lift", options, 0, e);
	check_parts(&out, l->confidence, l->objects, 1, "confidence");
	check_parts(&out, l->share, (size_t)l->indptr[objects], 0, "share");
	arrays_out_text(&out, "gaussians", arrays_out_print(&out, "%zu", l->gaussians));
	origin_put(&out, origin);
	arrays_out_list(&out, "names", l->names, l->objects);
	arrays_out_list(&out, "texts", l->texts, l->sentences);
	arrays_out_list(&out, "pieces", l->pieces, l->sentences);
	arrays_out_put(&out, st_vector("indptr", ST_I64, objects + 1, l->indptr));
	arrays_out_put(&out, st_vector("offsets", ST_I64, sentences + 1, l->offsets));
	arrays_out_put(&out, st_vector("index", ST_I32, l->indptr[objects], l->index));
	arrays_out_put(&out, st_vector("object", ST_I32, sentences, l->object));
	arrays_out_put(&out, st_vector("confidence", ST_F32, objects, l->confidence));
	precision_put(&out, "words", PRECISION_F16, PRECISION_ROWS, rows, width, l->words);
	put_shares(&out, l);
	if (l->middle)
		precision_put(&out, "middle", PRECISION_F16, PRECISION_ROWS, rows, width, l->middle);
	return arrays_out_end(&out);
}
