#include "formats/scene/selection.h"

#include "base/mem.h"
#include "formats/arrays/arrays_out.h"
#include "formats/arrays/metalist.h"

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

static int read_tensors(struct selection *s, const struct safetensors *st, struct err *e)
{
	size_t n, items;

	if (!(s->indptr = metalist_offsets(st, "indptr", "sentences", &n, e)) ||
		!(s->index = safetensors_copy(st, "index", ST_I32, 1, (int64_t[]){-1}, &items, e)))
		return -1;
	s->refs = metalist_read(st, "refs", n, "sentences", e);
	s->n = s->refs ? n : 0;
	return -(!s->refs || metalist_check_names(s->refs, n, 0, "refs", st->path, e) ||
		 metalist_check_unique(s->refs, n, "refs", st->path, e) ||
		 metalist_check_offsets("indptr", s->indptr, n, (int64_t)items, "items", st->path, e) ||
		 metalist_check_index(s->index, s->indptr, n, s->gaussians, "sentence", st->path, e));
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
	struct arrays_out out;

	arrays_out_begin(&out, path, "refer.selection", "1", "feature-query", options, 0, e);
	arrays_out_text(&out, "gaussians", arrays_out_print(&out, "%zu", s->gaussians));
	arrays_out_text(&out, "scene", fingerprint_text(&s->scene));
	arrays_out_list(&out, "refs", s->refs, s->n);
	arrays_out_put(&out, st_vector("indptr", ST_I64, n + 1, s->indptr));
	arrays_out_put(&out, st_vector("index", ST_I32, s->indptr[n], s->index));
	return arrays_out_end(&out);
}
