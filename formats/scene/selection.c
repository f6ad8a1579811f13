#include "formats/scene/selection.h"

#include "base/mem.h"
#include "formats/arrays/arrays_in.h"
#include "formats/arrays/arrays_out.h"

enum { VERSION_READ = 1 };

void selection_free(struct selection *s)
{
	mem_free_strings(s->refs, s->n);
	mem_free_all(s->indptr, s->index);
	*s = (struct selection){0};
}

int selection_take(struct selection *s, const struct safetensors *st, struct err *e)
{
	struct arrays_in in;
	size_t items;

	*s = (struct selection){0};
	arrays_in_begin(&in, st, "refer.selection", VERSION_READ, e);
	s->gaussians = arrays_in_count(&in, "gaussians");
	in.bad = in.bad || fingerprint_read(&s->scene, st, "scene", e);
	s->indptr = arrays_in_offsets(&in, "indptr", "sentences", &s->n);
	s->index = arrays_in_vector(&in, "index", ST_I32, -1, &items);
	s->refs = arrays_in_list(&in, "refs", s->n, "sentences");
	arrays_in_check_names(&in, s->refs, s->n, 0, "refs");
	arrays_in_check_unique(&in, s->refs, s->n, "refs");
	arrays_in_check_offsets(&in, "indptr", s->indptr, s->n, items, "items");
	arrays_in_check_index(&in, s->index, s->indptr, s->n, s->gaussians, "sentence");
	return in.bad ? -1 : 0;
}

int selection_read(struct selection *s, const char *path, struct err *e)
{
	SCOPED_BY(safetensors_close) struct safetensors st = {0};

	*s = (struct selection){0};
	if (safetensors_open(&st, path, e))
		return -1;
	return selection_take(s, &st, e);
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
