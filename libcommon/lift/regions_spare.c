#include "base/largest.h"
#include "base/mem.h"
#include "lift/regions.h"
#include "lift/regions_private.h"

/* Of the views, from which on candidates show a thing, and not a mistake that a few of them share. */
static const double least_views = 0.25;

/* A region's Gaussians are taken. */
static void own(const struct region *region, uint8_t *owned)
{
	for (size_t k = 0; k < region->n; k++)
		owned[region->members[k]] = 1;
}

/* Whether less than half of a region's weight, over all views, is owned: owned and total (N). */
static int is_free(const struct region *region, const uint8_t *owned, const double *total)
{
	double mine = 0, all = 0;

	for (size_t k = 0; k < region->n; k++) {
		all += total[region->members[k]];
		mine += owned[region->members[k]] ? total[region->members[k]] : 0;
	}
	return mine < all / 2;
}

/* Of a region the sum of q_s(R) over all sentences; 0 where too few views show it. */
static double find_support(const struct regions *r, const double *share, size_t region)
{
	size_t shown = 0, views = 0;
	double sum = 0;

	for (size_t v = 0; v < r->views; v++) {
		views += r->seen[v].marks != NULL;
		shown += r->regions[region].chosen[v] != REGIONS_NONE;
	}
	for (size_t s = 0; s < r->sentence_count; s++)
		sum += share[s * r->region_count + region];
	return (double)shown < least_views * (double)views ? 0 : sum;
}

int regions_find_spare(struct regions *r, const double *share, struct err *e)
{
	SCOPED uint8_t *owned = mem_zalloc(r->gaussians, sizeof *owned, "regions", e);
	SCOPED double *total = mem_zalloc(r->gaussians, sizeof *total, "regions", e);
	SCOPED double *support = mem_alloc(r->region_count, sizeof *support, "regions", e);
	r->spare = mem_alloc(r->region_count, sizeof *r->spare, "regions", e);
	const int bad = !owned || !total || !support || !r->spare;

	for (size_t v = 0; v < r->views && !bad; v++)
		seen_add(&r->seen[v], r->gaussians, total);
	for (size_t i = 0; i < r->region_count && !bad; i++)
		support[i] = find_support(r, share, i);
	for (size_t o = 0; o < r->object_count && !bad; o++)
		if (r->served[o] != REGIONS_NONE)
			own(&r->regions[r->served[o]], owned);
	for (size_t n = 0; n < r->region_count && !bad; n++) {
		const size_t best = best_of(support, r->region_count);
		if (support[best] > 0 && is_free(&r->regions[best], owned, total)) {
			own(&r->regions[best], owned);
			r->spare[r->spare_count++] = best;
		}
		support[best] = 0;
	}
	return bad ? -1 : 0;
}

const struct mask *regions_spare(const struct regions *r, size_t k, size_t view, double *score)
{
	const struct region *region = &r->regions[r->spare[k]];
	const size_t c = regions_find_candidate(r, region, view);

	*score = c == REGIONS_NONE ? 0 : (double)region->agreement[c];
	return c == REGIONS_NONE ? NULL : r->candidates[c].mask;
}
