#include "base/mem.h"
#include "lift/marks.h"
#include "lift/regions_private.h"

int regions_sums_make(struct regions_sums *s, size_t gaussians, struct err *e)
{
	*s = (struct regions_sums){.index = mem_alloc(gaussians, sizeof *s->index, "regions", e),
		.sum = mem_alloc(gaussians, sizeof *s->sum, "regions", e),
		.all = mem_alloc(gaussians, sizeof *s->all, "regions", e),
		.shown = mem_zalloc(gaussians, sizeof *s->shown, "regions", e),
		.marks = marks_make(gaussians, e)};
	if (s->index && s->sum && s->all && s->shown && s->marks)
		return 0;
	regions_sums_free(s);
	return -1;
}

void regions_sums_free(struct regions_sums *s)
{
	mem_free_all(s->index, s->sum, s->all, s->shown, s->marks);
	*s = (struct regions_sums){0};
}

enum { PARTS = 16 };

static void add(struct regions_sums *s, const struct shares *shares)
{
	for (size_t k = 0; k < shares->n; k++) {
		const size_t i = (size_t)shares->index[k];
		s->shown[i] += shares->share[k];
		marks_add(s->marks, i);
	}
}

static void list(struct regions_sums *s, size_t gaussians)
{
	s->n = marks_take(s->marks, gaussians, s->index);
	for (size_t k = 0; k < s->n; k++) {
		s->sum[k] = s->shown[s->index[k]];
		s->all[k] = 0;
		s->shown[s->index[k]] = 0;
	}
}

void regions_sum(struct regions_sums *s, const struct regions *r, const size_t *chosen)
{
	for (size_t v = 0; v < r->views; v++)
		if (chosen[v] != REGIONS_NONE)
			add(s, &r->candidates[chosen[v]].shares);
	list(s, r->gaussians);
	/* a Gaussian's sum is in the order of the views, whoever makes it */
#pragma omp parallel for schedule(dynamic)
	for (size_t part = 0; part < PARTS; part++)
		for (size_t v = 0; v < r->views; v++)
			for (size_t k = s->n * part / PARTS;
				k < s->n * (part + 1) / PARTS && chosen[v] != REGIONS_NONE; k++)
				s->all[k] += seen_weight(&r->seen[v], (size_t)s->index[k]);
}
