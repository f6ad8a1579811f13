#include "base/mem.h"
#include "lift/regions_private.h"

#include <stdlib.h>

enum { WORD = 64 };

int regions_sums_make(struct regions_sums *s, size_t gaussians, struct err *e)
{
	*s = (struct regions_sums){.index = mem_alloc(gaussians, sizeof *s->index, "regions", e),
		.sum = mem_alloc(gaussians, sizeof *s->sum, "regions", e),
		.all = mem_alloc(gaussians, sizeof *s->all, "regions", e),
		.shown = mem_zalloc(gaussians, sizeof *s->shown, "regions", e),
		.bits = mem_zalloc(gaussians / WORD + 1, sizeof *s->bits, "regions", e)};
	if (s->index && s->sum && s->all && s->shown && s->bits)
		return 0;
	regions_sums_free(s);
	return -1;
}

void regions_sums_free(struct regions_sums *s)
{
	free(s->index);
	free(s->sum);
	free(s->all);
	free(s->shown);
	free(s->bits);
	*s = (struct regions_sums){0};
}

static void add(struct regions_sums *s, const struct shares *shares)
{
	for (size_t k = 0; k < shares->n; k++) {
		const size_t i = (size_t)shares->index[k];
		s->shown[i] += shares->share[k];
		s->bits[i / WORD] |= (uint64_t)1 << i % WORD;
	}
}

static void list(struct regions_sums *s, size_t gaussians)
{
	s->n = 0;
	for (size_t word = 0; word <= gaussians / WORD; word++) {
		for (uint64_t left = s->bits[word]; left; left &= left - 1) {
			const size_t i = word * WORD + (size_t)__builtin_ctzll(left);
			s->index[s->n] = (int32_t)i;
			s->sum[s->n] = s->shown[i];
			s->all[s->n++] = 0;
			s->shown[i] = 0;
		}
		s->bits[word] = 0;
	}
}

void regions_sum(struct regions_sums *s, const struct regions *r, const size_t *chosen)
{
	for (size_t v = 0; v < r->views; v++)
		if (chosen[v] != REGIONS_NONE)
			add(s, &r->candidates[chosen[v]].shares);
	list(s, r->gaussians);
	for (size_t v = 0; v < r->views; v++) {
		const float *weight = r->weight + v * r->gaussians;
		for (size_t k = 0; k < s->n && chosen[v] != REGIONS_NONE; k++)
			s->all[k] += weight[s->index[k]];
	}
}
