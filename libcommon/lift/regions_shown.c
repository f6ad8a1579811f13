#include "base/mem.h"
#include "lift/regions_private.h"

#include <stdlib.h>
#include <string.h>

static void fill(struct regions_shown *s, const struct regions *r)
{
	for (size_t c = 0; c < r->count; c++)
		for (size_t k = 0; k < r->candidates[c].shares.n; k++) {
			const size_t at = s->begin[r->candidates[c].shares.index[k]]++;
			s->candidate[at] = (int32_t)c;
			s->share[at] = r->candidates[c].shares.share[k];
		}
}

int regions_shown_make(struct regions_shown *s, const struct regions *r, struct err *e)
{
	size_t entries = 0;

	for (size_t c = 0; c < r->count; c++)
		entries += r->candidates[c].shares.n;
	*s = (struct regions_shown){.begin = mem_zalloc(r->gaussians + 1, sizeof *s->begin, "regions", e),
		.candidate = mem_alloc(entries, sizeof *s->candidate, "regions", e),
		.share = mem_alloc(entries, sizeof *s->share, "regions", e),
		.slabs = mem_alloc(r->count, REGIONS_SLABS * sizeof *s->slabs, "regions", e)};
	if (!s->begin || !s->candidate || !s->share || !s->slabs) {
		regions_shown_free(s);
		return -1;
	}
	for (size_t c = 0; c < r->count; c++)
		for (size_t k = 0; k < r->candidates[c].shares.n; k++)
			s->begin[r->candidates[c].shares.index[k] + 1]++;
	for (size_t i = 0; i < r->gaussians; i++)
		s->begin[i + 1] += s->begin[i];
	fill(s, r);
	/* each is now where the next one began */
	memmove(s->begin + 1, s->begin, r->gaussians * sizeof *s->begin);
	s->begin[0] = 0;
	return 0;
}

void regions_shown_free(struct regions_shown *s)
{
	free(s->begin);
	free(s->candidate);
	free(s->share);
	free(s->slabs);
	*s = (struct regions_shown){0};
}

void regions_overlap(struct regions_shown *s, size_t count, const int32_t *members, size_t n, double *both)
{
#pragma omp parallel for schedule(dynamic)
	for (size_t slab = 0; slab < REGIONS_SLABS; slab++) {
		double *sum = s->slabs + slab * count;
		memset(sum, 0, count * sizeof *sum);
		for (size_t k = n * slab / REGIONS_SLABS; k < n * (slab + 1) / REGIONS_SLABS; k++)
			for (size_t at = s->begin[members[k]]; at < s->begin[members[k] + 1]; at++)
				sum[s->candidate[at]] += (double)s->share[at];
	}
	for (size_t c = 0; c < count; c++) {
		both[c] = 0;
		for (size_t slab = 0; slab < REGIONS_SLABS; slab++)
			both[c] += s->slabs[slab * count + c];
	}
}
