#include "formats/scene/selection.h"

#include "base/mem.h"
#include "formats/arrays/metalist.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { VERSION_READ = 1 };

void selection_free(struct selection *s)
{
	metalist_free(s->refs, s->n);
	free(s->indptr);
	free(s->index);
	*s = (struct selection){0};
}

static int check_index(const struct selection *s, const char *path, struct err *e)
{
	for (size_t r = 0; r < s->n; r++)
		for (int64_t k = s->indptr[r]; k < s->indptr[r + 1]; k++)
			if (s->index[k] < 0 || (size_t)s->index[k] >= s->gaussians ||
				(k > s->indptr[r] && s->index[k] <= s->index[k - 1]))
				return err_set(e, ERR_FORMAT,
					"%s: tensor 'index': item %lld does not rise within 0 to %lld, in sentence %zu",
					path, (long long)k, (long long)s->gaussians - 1, r);
	return 0;
}

static int read_tensors(struct selection *s, const struct safetensors *st, struct err *e)
{
	const int64_t any = -1;
	const struct st_tensor *indptr = safetensors_need(st, "indptr", ST_I64, 1, &any, e);
	const struct st_tensor *index = indptr ? safetensors_need(st, "index", ST_I32, 1, &any, e) : NULL;

	if (!index)
		return -1;
	if (indptr->shape[0] < 1 || indptr->shape[0] > INT32_MAX)
		return err_set(e, ERR_FORMAT,
			"%s: tensor 'indptr': has %lld entries, expected 1 more than sentences", st->path,
			(long long)indptr->shape[0]);
	const size_t n = (size_t)indptr->shape[0] - 1;
	s->indptr = mem_alloc(n + 1, sizeof *s->indptr, st->path, e);
	s->index = mem_alloc((size_t)index->shape[0], sizeof *s->index, st->path, e);
	if (!s->indptr || !s->index)
		return -1;
	memcpy(s->indptr, indptr->data, indptr->bytes);
	memcpy(s->index, index->data, index->bytes);
	s->refs = metalist_read(st, "refs", n, "sentences", e);
	s->n = s->refs ? n : 0;
	if (!s->refs || metalist_check_names(s->refs, n, 0, "refs", st->path, e) ||
		metalist_check_unique(s->refs, n, "refs", st->path, e) ||
		metalist_check_offsets("indptr", s->indptr, n, index->shape[0], "items", st->path, e))
		return -1;
	return check_index(s, st->path, e);
}

int selection_take(struct selection *s, const struct safetensors *st, struct err *e)
{
	long long gaussians = 0;

	*s = (struct selection){0};
	int bad = safetensors_need_format(st, "refer.selection", VERSION_READ, e) ||
		  safetensors_meta_int(st, "gaussians", 0, INT32_MAX, &gaussians, e) ||
		  fingerprint_read(&s->scene, st, "scene", e);
	s->gaussians = (size_t)gaussians;
	bad = bad || read_tensors(s, st, e);
	if (bad)
		selection_free(s);
	return bad ? -1 : 0;
}

int selection_read(struct selection *s, const char *path, struct err *e)
{
	struct safetensors st;

	*s = (struct selection){0};
	if (safetensors_open(&st, path, e))
		return -1;
	const int bad = selection_take(s, &st, e);
	safetensors_close(&st);
	return bad;
}

int selection_write(const struct selection *s, const char *path, const char *options, struct err *e)
{
	const int64_t n = (int64_t)s->n;
	const struct st_tensor tensors[] = {
		{.name = "indptr", .dtype = ST_I64, .dims = 1, .shape = {n + 1}, .data = s->indptr},
		{.name = "index", .dtype = ST_I32, .dims = 1, .shape = {s->indptr[n]}, .data = s->index},
	};
	char *refs = metalist_print(s->refs, s->n), gaussians[24];

	if (!refs)
		return err_set(e, ERR_SYSTEM, "%s: out of memory", path);
	snprintf(gaussians, sizeof gaussians, "%zu", s->gaussians);
	const struct st_meta meta[] = {{"format", "refer.selection"}, {"version", "1"},
		{"tool", "feature-query"}, {"options", options}, {"seed", "0"}, {"gaussians", gaussians},
		{"scene", fingerprint_text(&s->scene)}, {"refs", refs}};
	const int bad = safetensors_write(path, tensors, 2, meta, sizeof meta / sizeof *meta, e);
	free(refs);
	return bad;
}
