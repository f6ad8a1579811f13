#include "formats/scene/lifted.h"

#include "base/mem.h"
#include "formats/arrays/arrays_in.h"
#include "formats/arrays/precision.h"

#include <math.h>

enum { VERSION_READ = 1, SHARE_STEPS = 255 };

static void read_shares(struct lifted *l, struct arrays_in *in)
{
	size_t count = 0;

	l->index = arrays_in_vector(in, "index", ST_I32, -1, &count);
	SCOPED uint8_t *steps = arrays_in_vector(in, "share", ST_U8, (int64_t)count, NULL);
	l->share = steps ? mem_alloc(count, sizeof *l->share, in->st->path, in->e) : NULL;
	in->bad |= !l->share;
	for (size_t k = 0; k < count && !in->bad; k++) {
		if (!steps[k])
			in->bad = err_file(in->e, in->st->path, "tensor 'share': item %zu is 0", k);
		l->share[k] = (float)steps[k] / SHARE_STEPS;
	}
	arrays_in_check_offsets(in, "indptr", l->indptr, l->objects, count, "shares");
	arrays_in_check_index(in, l->index, l->indptr, l->objects, l->gaussians, "object");
}

static void read_objects(struct lifted *l, struct arrays_in *in)
{
	l->indptr = arrays_in_offsets(in, "indptr", "objects", &l->objects);
	l->confidence = arrays_in_vector(in, "confidence", ST_F32, (int64_t)l->objects, NULL);
	for (size_t o = 0; o < l->objects && !in->bad; o++)
		if (!(l->confidence[o] >= 0 && l->confidence[o] <= 1))
			in->bad = err_file(
				in->e, in->st->path, "tensor 'confidence': item %zu is not in 0 to 1", o);
	l->names = arrays_in_list(in, "names", l->objects, "objects");
	arrays_in_check_names(in, l->names, l->objects, 0, "names");
	arrays_in_check_unique(in, l->names, l->objects, "names");
	if (safetensors_find(in->st, "cut"))
		l->cut = arrays_in_vector(in, "cut", ST_F32, (int64_t)l->objects, NULL);
	for (size_t o = 0; o < l->objects && l->cut && !in->bad; o++)
		if (!(l->cut[o] > 0 && l->cut[o] < 1))
			in->bad = err_file(
				in->e, in->st->path, "tensor 'cut': item %zu is not above 0 and below 1", o);
	read_shares(l, in);
}

/* Words by one of the encoder's layers, of `rows` and the width. */
static float *read_layer(const struct lifted *l, struct arrays_in *in, const char *name, size_t rows)
{
	const size_t width = (size_t)l->width;
	float *to = in->bad ? NULL : mem_alloc(rows, width * sizeof *to, in->st->path, in->e);

	in->bad = !to || precision_get(in->st, name, PRECISION_F16, PRECISION_ROWS, rows, width, to, in->e);
	return to;
}

static void read_sentences(struct lifted *l, struct arrays_in *in)
{
	size_t words;

	l->offsets = arrays_in_offsets(in, "offsets", "sentences", &l->sentences);
	l->object = arrays_in_vector(in, "object", ST_I32, (int64_t)l->sentences, NULL);
	for (size_t r = 0; r < l->sentences && !in->bad; r++)
		if (l->object[r] < 0 || (size_t)l->object[r] >= l->objects)
			in->bad = err_file(in->e, in->st->path,
				"tensor 'object': item %zu is %d, of %zu objects", r, l->object[r],
				l->objects);
	l->width = arrays_in_width(in, "words", ST_F16, &words);
	l->words = read_layer(l, in, "words", words);
	arrays_in_check_offsets(in, "offsets", l->offsets, l->sentences, words, "words");
	if (safetensors_find(in->st, "middle"))
		l->middle = read_layer(l, in, "middle", words);
	l->texts = arrays_in_list(in, "texts", l->sentences, "sentences");
	l->pieces = arrays_in_list(in, "pieces", l->sentences, "sentences");
	arrays_in_check_pieces(in, l->pieces, l->offsets, l->sentences);
}

int lifted_take(struct lifted *l, struct origin *origin, const struct safetensors *st, struct err *e)
{
	struct arrays_in in;

	*l = (struct lifted){0};
	arrays_in_begin(&in, st, "refer.lifted", VERSION_READ, e);
	l->gaussians = arrays_in_count(&in, "gaussians");
	in.bad = in.bad || origin_read(origin, st, e);
	read_objects(l, &in);
	read_sentences(l, &in);
	return in.bad ? -1 : 0;
}

int lifted_read(struct lifted *l, struct origin *origin, const char *path, struct err *e)
{
	SCOPED_BY(safetensors_close) struct safetensors st = {0};

	*l = (struct lifted){0};
	if (safetensors_open(&st, path, e))
		return -1;
	return lifted_take(l, origin, &st, e);
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
	check_parts(&out, l->cut, l->cut ? l->objects : 0, 0, "cut");
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
	if (l->cut)
		arrays_out_put(&out, st_vector("cut", ST_F32, objects, l->cut));
	precision_put(&out, "words", PRECISION_F16, PRECISION_ROWS, rows, width, l->words);
	put_shares(&out, l);
	if (l->middle)
		precision_put(&out, "middle", PRECISION_F16, PRECISION_ROWS, rows, width, l->middle);
	return arrays_out_end(&out);
}
