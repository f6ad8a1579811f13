#include "cmd/feature/feature_query.h"

#include "base/file.h"
#include "base/mem.h"
#include "base/path.h"
#include "formats/arrays/npz.h"
#include "formats/arrays/safetensors.h"
#include "lift/query_rules.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static int take_shape(
	struct query_vectors *v, size_t n, size_t found, size_t channels, const char *path, struct err *e)
{
	size_t bytes;

	if (found != channels)
		return err_set(e, ERR_FORMAT, "%s: vectors of %zu channels, the features have %zu", path,
			found, channels);
	if (mem_size(channels, sizeof *v->values, &bytes))
		return err_set(e, ERR_SYSTEM, "%s: vectors do not fit in memory", path);
	*v = (struct query_vectors){n, channels, mem_alloc(n, bytes, "vectors", e)};
	return v->values ? 0 : -1;
}

/* An array, which is closed; messages call it `name`. */
static int take_array(
	struct query_vectors *v, struct npy *a, const char *name, size_t channels, struct err *e)
{
	int bad = a->dims == 2 ? take_shape(v, a->shape[0], a->shape[1], channels, name, e)
			       : err_set(e, ERR_FORMAT, "%s: has %d dimensions, not 2: texts and channels",
					 name, a->dims);

	if (!bad)
		npy_floats(a, 0, a->count, v->values);
	npy_close(a);
	return bad;
}

static int read_npy(struct query_vectors *v, const char *path, size_t channels, struct err *e)
{
	struct npy a;

	return npy_open(&a, path, e) || take_array(v, &a, path, channels, e) ? -1 : 0;
}

static int read_npz(struct query_vectors *v, const char *path, size_t channels, struct err *e)
{
	static const char *const names[] = {"vectors", "arr_0"};
	struct npz z;
	struct npy a;
	SCOPED char *called = NULL;

	if (npz_open(&z, path, e))
		return -1;
	const char *name = npz_main(&z, names, sizeof names / sizeof *names, e);
	const int bad =
		!name || npz_array(&z, name, "", &a, &called, e) || take_array(v, &a, called, channels, e);
	npz_close(&z);
	return bad ? -1 : 0;
}

/* The tensor that has the vectors; NULL with *e. */
static const struct st_tensor *find_tensor(const struct safetensors *st, struct err *e)
{
	const char *format = safetensors_meta(st, "format");
	const struct st_tensor *found = NULL;
	size_t count = 0;

	if (format && !strcmp(format, "refer.text"))
		return safetensors_need(st, "sentences", ST_F32, 2, (int64_t[]){-1, -1}, e);
	for (size_t i = 0; i < st->n; i++)
		if (st->tensors[i].dims == 2) {
			found = &st->tensors[i];
			count++;
		}
	if (count == 1)
		return found;
	err_set(e, ERR_FORMAT, "%s: has %zu tensors of two dimensions, not 1", st->path, count);
	return NULL;
}

static int read_safetensors(struct query_vectors *v, const char *path, size_t channels, struct err *e)
{
	SCOPED_BY(safetensors_close) struct safetensors st = {0};

	if (safetensors_open(&st, path, e))
		return -1;
	const struct st_tensor *t = find_tensor(&st, e);
	int bad = !t || take_shape(v, (size_t)t->shape[0], (size_t)t->shape[1], channels, st.path, e);
	if (!bad && safetensors_to_float(t, v->values, v->n * channels, e))
		bad = err_prefix(e, st.path);
	return bad ? -1 : 0;
}

/* Checks and scales what was read; frees it where that was bad, or is not finite. */
static int finish(struct query_vectors *v, int bad, const char *path, struct err *e)
{
	for (size_t i = 0; !bad && i < v->n * v->channels; i++)
		if (!isfinite(v->values[i]))
			bad = err_set(e, ERR_FORMAT, "%s: vector %zu is not finite", file_name(path),
				i / v->channels);
	if (!bad)
		query_unit(v->values, v->n, v->channels);
	else
		query_vectors_free(v);
	return bad ? -1 : 0;
}

int query_vectors_read(struct query_vectors *v, const char *path, size_t channels, struct err *e)
{
	*v = (struct query_vectors){0};
	const int bad = path_ends(path, ".npy")	  ? read_npy(v, path, channels, e)
			: path_ends(path, ".npz") ? read_npz(v, path, channels, e)
						  : read_safetensors(v, path, channels, e);
	return finish(v, bad, path, e);
}

int query_vectors_of_text(
	struct query_vectors *v, const struct text *text, const char *path, size_t channels, struct err *e)
{
	*v = (struct query_vectors){0};
	const int bad = take_shape(v, text->n, (size_t)text->width, channels, file_name(path), e);
	if (!bad)
		memcpy(v->values, text->sentences, text->n * channels * sizeof *v->values);
	return finish(v, bad, path, e);
}

void query_vectors_free(struct query_vectors *v)
{
	free(v->values);
	*v = (struct query_vectors){0};
}
