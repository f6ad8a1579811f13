#include "base/mem.h"
#include "lift/lift_private.h"

#include <stdlib.h>

enum { BLOCK = 1024 }; /* pixels whose sums one thread adds up */

/* Of an object's mask and what is rendered, over a block. */
struct overlap {
	double both, either;
};

struct work {
	int32_t *slots;		  /* (O) where the view has an object's mask, or LIFT_NOBODY */
	float *rendered;	  /* (blocks,n) of a pixel */
	struct overlap *overlaps; /* (blocks,n) */
};

static void add_pixel(const struct lift_objects *l, const struct lift_view *v, const struct view_weights *w,
	const struct work *work, size_t pixel, const float *images, float *rendered, struct overlap *overlaps)
{
	double total = 0;

	for (int64_t k = w->indptr[pixel]; k < w->indptr[pixel + 1]; k++) {
		const struct lift_claim claim = l->claims[w->index[k]];
		total += (double)w->weight[k];
		if (claim.object != LIFT_NOBODY && work->slots[claim.object] != LIFT_NOBODY)
			rendered[work->slots[claim.object]] += w->weight[k] * claim.share;
	}
	for (size_t k = 0; k < v->n; k++) {
		const float mask = images[k * w->pixels + pixel];
		const float a = total > 0 ? rendered[k] / (float)total : 0;
		overlaps[k].both += (double)(a < mask ? a : mask);
		overlaps[k].either += (double)(a < mask ? mask : a);
		rendered[k] = 0;
	}
}

int lift_agreement(const struct lift_objects *l, const struct lift_view *v, const struct view_weights *w,
	const float *images, double *agreement, struct err *e)
{
	const size_t blocks = (w->pixels + BLOCK - 1) / BLOCK;
	struct work work = {mem_alloc(l->objects, sizeof *work.slots, "masks", e),
		mem_zalloc(blocks, v->n * sizeof *work.rendered, "masks", e),
		mem_zalloc(blocks, v->n * sizeof *work.overlaps, "masks", e)};
	const int bad = !work.slots || !work.rendered || !work.overlaps;

	for (size_t o = 0; o < l->objects && !bad; o++)
		work.slots[o] = LIFT_NOBODY;
	for (size_t k = 0; k < v->n && !bad; k++)
		work.slots[v->objects[k]] = (int32_t)k;
#pragma omp parallel for schedule(dynamic) if (!bad)
	for (size_t b = 0; b < (bad ? 0 : blocks); b++)
		for (size_t p = b * BLOCK; p < (b + 1) * BLOCK && p < w->pixels; p++)
			add_pixel(l, v, w, &work, p, images, work.rendered + b * v->n,
				work.overlaps + b * v->n);
	for (size_t k = 0; k < v->n && !bad; k++) {
		struct overlap sum = {0, 0};
		for (size_t b = 0; b < blocks; b++) {
			sum.both += work.overlaps[b * v->n + k].both;
			sum.either += work.overlaps[b * v->n + k].either;
		}
		agreement[k] = sum.either > 0 ? sum.both / sum.either : 1;
	}
	free(work.slots);
	free(work.rendered);
	free(work.overlaps);
	return bad ? -1 : 0;
}
