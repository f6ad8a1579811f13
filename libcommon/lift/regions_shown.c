#include "base/mem.h"
#include "lift/regions_private.h"

/* The Gaussians are cut into parts, which do not meet. */
enum { PARTS = 32 };

/* The first entry of a row of Gaussian i or a later one. */
static size_t find_entry(const struct shares *row, size_t i)
{
	size_t begin = 0, end = row->n;

	while (begin < end) {
		const size_t middle = begin + (end - begin) / 2;
		if ((size_t)row->index[middle] < i)
			begin = middle + 1;
		else
			end = middle;
	}
	return begin;
}

static void fill_part(struct regions_shown *s, const struct regions *r, size_t from, size_t to)
{
	for (size_t c = 0; c < r->count; c++) {
		const struct shares *row = &r->candidates[c].shares;
		for (size_t k = find_entry(row, from); k < row->n && (size_t)row->index[k] < to; k++) {
			const size_t at = s->begin[row->index[k]]++;
			s->candidate[at] = (int32_t)c;
			s->share[at] = row->share[k];
		}
	}
}

static void count_part(struct regions_shown *s, const struct regions *r, size_t from, size_t to)
{
	for (size_t c = 0; c < r->count; c++) {
		const struct shares *row = &r->candidates[c].shares;
		for (size_t k = find_entry(row, from); k < row->n && (size_t)row->index[k] < to; k++)
			s->begin[row->index[k] + 1]++;
	}
}

static void fill(struct regions_shown *s, const struct regions *r)
{
	const size_t n = r->gaussians;

#pragma omp parallel for schedule(dynamic)
	for (size_t p = 0; p < PARTS; p++)
		count_part(s, r, n * p / PARTS, n * (p + 1) / PARTS);
	for (size_t i = 0; i < n; i++)
		s->begin[i + 1] += s->begin[i];
#pragma omp parallel for schedule(dynamic)
	for (size_t p = 0; p < PARTS; p++)
		fill_part(s, r, n * p / PARTS, n * (p + 1) / PARTS);
	/* each is now where the next one began */
	memmove(s->begin + 1, s->begin, n * sizeof *s->begin);
	s->begin[0] = 0;
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
	fill(s, r);
	return 0;
}

void regions_shown_free(struct regions_shown *s)
{
	mem_free_all(s->begin, s->candidate, s->share, s->slabs);
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
