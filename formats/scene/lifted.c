#include "formats/scene/lifted.h"

#include "base/mem.h"
#include "formats/arrays/metalist.h"
#include "formats/arrays/precision.h"
#include "formats/arrays/safetensors.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { VERSION_READ = 1, SHARE_STEPS = 255, MAX_WIDTH = 65536 };

/* A tensor of that many items at most; its count in *n. */
static const struct st_tensor *need_list(
	const struct safetensors *st, const char *name, enum st_dtype dtype, size_t *n, struct err *e)
{
	const struct st_tensor *t = safetensors_need(st, name, dtype, 1, (int64_t[]){-1}, e);

	if (t)
		*n = (size_t)t->shape[0];
	return t;
}

/* Offsets of lists: one more entry than there are `of`, at most INT32_MAX of these. */
static int read_offsets(const struct safetensors *st, const char *name, const char *of, int64_t **offsets,
	size_t *n, struct err *e)
{
	const struct st_tensor *t = need_list(st, name, ST_I64, n, e);

	if (!t)
		return -1;
	if (*n < 1 || *n > INT32_MAX) {
		err_set(e, ERR_FORMAT, "%s: tensor '%s': has %zu entries, expected 1 more than %s", st->path,
			name, *n, of);
		*n = 0;
		return -1;
	}
	*offsets = mem_alloc(*n, sizeof **offsets, st->path, e);
	if (*offsets)
		memcpy(*offsets, t->data, t->bytes);
	--*n;
	return *offsets ? 0 : -1;
}

static int check_index(const struct lifted *l, const char *path, struct err *e)
{
	for (size_t o = 0; o < l->objects; o++)
		for (int64_t k = l->indptr[o]; k < l->indptr[o + 1]; k++)
			if (l->index[k] < 0 || (size_t)l->index[k] >= l->gaussians ||
				(k > l->indptr[o] && l->index[k] <= l->index[k - 1]))
				return err_set(e, ERR_FORMAT,
					"%s: tensor 'index': item %lld does not rise within 0 to %lld, in object %zu",
					path, (long long)k, (long long)l->gaussians - 1, o);
	return 0;
}

static int read_shares(struct lifted *l, const struct safetensors *st, struct err *e)
{
	size_t count;
	const struct st_tensor *index = need_list(st, "index", ST_I32, &count, e), *share;

	if (!index || !(share = safetensors_need(st, "share", ST_U8, 1, (int64_t[]){(int64_t)count}, e)))
		return -1;
	l->index = mem_alloc(count, sizeof *l->index, st->path, e);
	l->share = mem_alloc(count, sizeof *l->share, st->path, e);
	if (!l->index || !l->share)
		return -1;
	memcpy(l->index, index->data, index->bytes);
	for (size_t k = 0; k < count; k++) {
		const int step = ((const uint8_t *)share->data)[k];
		if (!step)
			return err_set(e, ERR_FORMAT, "%s: tensor 'share': item %zu is 0", st->path, k);
		l->share[k] = (float)step / SHARE_STEPS;
	}
	return metalist_check_offsets("indptr", l->indptr, l->objects, (int64_t)count, "shares", st->path,
		       e) || check_index(l, st->path, e)
		       ? -1
		       : 0;
}

static int read_objects(struct lifted *l, const struct safetensors *st, struct err *e)
{
	if (read_offsets(st, "indptr", "objects", &l->indptr, &l->objects, e))
		return -1;
	const int64_t shape[] = {(int64_t)l->objects};
	const struct st_tensor *confidence = safetensors_need(st, "confidence", ST_F32, 1, shape, e);
	l->confidence = confidence ? mem_alloc(l->objects, sizeof *l->confidence, st->path, e) : NULL;
	if (!l->confidence)
		return -1;
	memcpy(l->confidence, confidence->data, confidence->bytes);
	for (size_t o = 0; o < l->objects; o++)
		if (!(l->confidence[o] >= 0 && l->confidence[o] <= 1))
			return err_set(e, ERR_FORMAT, "%s: tensor 'confidence': item %zu is not in 0 to 1",
				st->path, o);
	l->names = metalist_read(st, "names", l->objects, "objects", e);
	return !l->names || metalist_check_names(l->names, l->objects, 0, "names", st->path, e) ||
			       metalist_check_unique(l->names, l->objects, "names", st->path, e) ||
			       read_shares(l, st, e)
		       ? -1
		       : 0;
}

static int read_middle(struct lifted *l, const struct safetensors *st, size_t rows, struct err *e)
{
	const int64_t shape[] = {(int64_t)rows, l->width};

	if (!safetensors_need(st, "middle", ST_F16, 2, shape, e))
		return -1;
	l->middle = mem_alloc(rows, (size_t)l->width * sizeof *l->middle, st->path, e);
	return !l->middle ? -1
			  : precision_get(st, "middle", PRECISION_F16, PRECISION_ROWS, rows, (size_t)l->width,
				    l->middle, e);
}

static int read_words(struct lifted *l, const struct safetensors *st, struct err *e)
{
	const struct st_tensor *words = safetensors_need(st, "words", ST_F16, 2, (int64_t[]){-1, -1}, e);

	if (!words)
		return -1;
	if (words->shape[1] < 1 || words->shape[1] > MAX_WIDTH)
		return err_set(e, ERR_FORMAT, "%s: tensor 'words': width %lld is not in 1 to %d", st->path,
			(long long)words->shape[1], MAX_WIDTH);
	const size_t rows = (size_t)words->shape[0];
	l->width = (int)words->shape[1];
	l->words = mem_alloc(rows, (size_t)l->width * sizeof *l->words, st->path, e);
	if (!l->words ||
		precision_get(
			st, "words", PRECISION_F16, PRECISION_ROWS, rows, (size_t)l->width, l->words, e) ||
		metalist_check_offsets(
			"offsets", l->offsets, l->sentences, (int64_t)rows, "words", st->path, e))
		return -1;
	return safetensors_find(st, "middle") ? read_middle(l, st, rows, e) : 0;
}

static int read_sentences(struct lifted *l, const struct safetensors *st, struct err *e)
{
	if (read_offsets(st, "offsets", "sentences", &l->offsets, &l->sentences, e))
		return -1;
	const int64_t shape[] = {(int64_t)l->sentences};
	const struct st_tensor *object = safetensors_need(st, "object", ST_I32, 1, shape, e);
	l->object = object ? mem_alloc(l->sentences, sizeof *l->object, st->path, e) : NULL;
	if (!l->object)
		return -1;
	memcpy(l->object, object->data, object->bytes);
	for (size_t r = 0; r < l->sentences; r++)
		if (l->object[r] < 0 || (size_t)l->object[r] >= l->objects)
			return err_set(e, ERR_FORMAT, "%s: tensor 'object': item %zu is %d, of %zu objects",
				st->path, r, l->object[r], l->objects);
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
static int check_parts(
	const float *x, size_t n, int may_be_0, const char *name, const char *path, struct err *e)
{
	for (size_t k = 0; k < n; k++)
		if (!((x[k] > 0 || (may_be_0 && x[k] >= 0)) && x[k] <= 1))
			return err_set(
				e, ERR_CHECK, "%s: tensor '%s': item %zu is %g", path, name, k, (double)x[k]);
	return 0;
}

/* Shares in whole steps; the least is one, as a Gaussian with none is not listed. */
static uint8_t *pack_shares(const struct lifted *l, const char *path, struct err *e)
{
	const size_t count = (size_t)l->indptr[l->objects];
	uint8_t *steps = mem_alloc(count, 1, path, e);

	for (size_t k = 0; k < count && steps; k++) {
		const long step = lrintf(l->share[k] * SHARE_STEPS);
		steps[k] = (uint8_t)(step < 1 ? 1 : step);
	}
	return steps;
}

static int write_all(const struct lifted *l, const struct origin *origin, const uint8_t *share,
	const struct precision_matrix *words, const struct precision_matrix *middle, const char *path,
	const char *options, struct err *e)
{
	const int64_t objects = (int64_t)l->objects, sentences = (int64_t)l->sentences;
	const int64_t count = l->indptr[objects];
	struct st_tensor tensors[8] = {
		{.name = "indptr", .dtype = ST_I64, .dims = 1, .shape = {objects + 1}, .data = l->indptr},
		{.name = "offsets", .dtype = ST_I64, .dims = 1, .shape = {sentences + 1}, .data = l->offsets},
		{.name = "index", .dtype = ST_I32, .dims = 1, .shape = {count}, .data = l->index},
		{.name = "object", .dtype = ST_I32, .dims = 1, .shape = {sentences}, .data = l->object},
		{.name = "confidence", .dtype = ST_F32, .dims = 1, .shape = {objects}, .data = l->confidence},
		words->tensors[0],
		{.name = "share", .dtype = ST_U8, .dims = 1, .shape = {count}, .data = share},
	};
	const size_t used = l->middle ? 8 : 7;
	char *names = metalist_print(l->names, l->objects), *texts = metalist_print(l->texts, l->sentences);
	char *pieces = metalist_print(l->pieces, l->sentences), gaussians[32];
	int bad;

	if (l->middle)
		tensors[7] = middle->tensors[0];
	snprintf(gaussians, sizeof gaussians, "%zu", l->gaussians);
	if (names && texts && pieces) {
		const struct st_meta meta[] = {{"format", "refer.lifted"}, {"version", "1"},
			{"tool", "refer-lift"}, {"options", options}, {"seed", "0"}, {"gaussians", gaussians},
			{"scene", fingerprint_text(&origin->scene)},
			{"encoder", fingerprint_text(&origin->encoder)}, {"names", names}, {"texts", texts},
			{"pieces", pieces}};
		bad = safetensors_write(path, tensors, used, meta, sizeof meta / sizeof *meta, e);
	} else {
		bad = err_set(e, ERR_SYSTEM, "%s: out of memory", path);
	}
	free(names);
	free(texts);
	free(pieces);
	return bad;
}

int lifted_write(const struct lifted *l, const struct origin *origin, const char *path, const char *options,
	struct err *e)
{
	struct precision_matrix words = {0}, middle = {0};
	uint8_t *share = NULL;
	int bad = check_parts(l->confidence, l->objects, 1, "confidence", path, e) ||
		  check_parts(l->share, (size_t)l->indptr[l->objects], 0, "share", path, e) ||
		  !(share = pack_shares(l, path, e)) ||
		  precision_put(&words, "words", PRECISION_F16, PRECISION_ROWS,
			  (size_t)l->offsets[l->sentences], (size_t)l->width, l->words, path, e) ||
		  (l->middle &&
			  precision_put(&middle, "middle", PRECISION_F16, PRECISION_ROWS,
				  (size_t)l->offsets[l->sentences], (size_t)l->width, l->middle, path, e)) ||
		  write_all(l, origin, share, &words, &middle, path, options, e);

	precision_free(&words);
	precision_free(&middle);
	free(share);
	return bad ? -1 : 0;
}

int lifted_add_sentences(
	struct lifted *l, const struct text *t, const size_t *object, const char *const *names, struct err *e)
{
	const size_t width = (size_t)t->width, words = (size_t)t->offsets[t->n];

	l->width = t->width;
	l->names = mem_zalloc(l->objects, sizeof *l->names, "objects", e);
	l->object = mem_alloc(t->n, sizeof *l->object, "sentences", e);
	l->texts = mem_zalloc(t->n, sizeof *l->texts, "sentences", e);
	l->pieces = mem_zalloc(t->n, sizeof *l->pieces, "sentences", e);
	l->offsets = mem_zalloc(t->n + 1, sizeof *l->offsets, "sentences", e);
	l->words = mem_alloc(words, width * sizeof *l->words, "sentences", e);
	if (t->middle)
		l->middle = mem_alloc(words, width * sizeof *l->middle, "sentences", e);
	if (!l->names || !l->object || !l->texts || !l->pieces || !l->offsets || !l->words ||
		(t->middle && !l->middle))
		return -1;
	for (size_t o = 0; o < l->objects; o++)
		if (!(l->names[o] = mem_strdup(names[o], e)))
			return -1;
	for (size_t i = 0; i < t->n; i++) {
		if (object[i] == LIFTED_NONE)
			continue;
		const size_t to = l->sentences++, from = (size_t)t->offsets[i];
		const size_t count = (size_t)t->offsets[i + 1] - from, at = (size_t)l->offsets[to];
		l->object[to] = (int32_t)object[i];
		memcpy(l->words + at * width, t->words + from * width, count * width * sizeof *l->words);
		if (t->middle)
			memcpy(l->middle + at * width, t->middle + from * width,
				count * width * sizeof *l->middle);
		l->offsets[to + 1] = (int64_t)(at + count);
		if (!(l->texts[to] = mem_strdup(t->texts[i], e)) ||
			!(l->pieces[to] = mem_strdup(t->pieces[i], e)))
			return -1;
	}
	return 0;
}
