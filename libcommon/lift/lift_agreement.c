#include "base/mem.h"
#include "lift/lift_private.h"

#include <stdlib.h>

enum { BLOCK = 1024 }; /* pixels whose sums one thread adds up */

/* Of an object's mask and what is rendered, over a block: the mask alone is `either` where nothing is. */
struct overlap {
	double both, either;
};

struct work {
	const struct lift_objects *l;
	const struct view_weights *w;
	const float *images; /* (n,P) */
	size_t n;
	int32_t *slots;		  /* (O) where the view has an object's mask, or LIFT_NOBODY */
	float *rendered;	  /* (blocks,n) of a pixel, 0 between pixels */
	int32_t *met;		  /* (blocks,n) the objects that are rendered in a pixel */
	struct overlap *overlaps; /* (blocks,n), less what the masks alone have */
};

/* One pixel: what is rendered, and how it changes the overlaps of the masks alone. */
static void add_pixel(const struct work *work, size_t pixel, size_t block)
{
	const struct view_weights *w = work->w;
	const size_t at = block * work->n;
	float *rendered = work->rendered + at;
	int32_t *met = work->met + at;
	size_t n = 0;
	double total = 0;

	for (int64_t k = w->indptr[pixel]; k < w->indptr[pixel + 1]; k++) {
		const struct lift_claim claim = work->l->claims[w->index[k]];
		const int32_t slot = claim.object == LIFT_NOBODY ? LIFT_NOBODY : work->slots[claim.object];
		const float part = w->weight[k] * claim.share;
		total += (double)w->weight[k];
		if (slot == LIFT_NOBODY || !(part > 0))
			continue;
		if (!(rendered[slot] > 0))
			met[n++] = slot;
		rendered[slot] += part;
	}
	for (size_t k = 0; k < n; k++) {
		struct overlap *to = &work->overlaps[at + (size_t)met[k]];
		const double mask = (double)work->images[(size_t)met[k] * w->pixels + pixel];
		const double a = (double)(rendered[met[k]] / (float)total);
		to->both += a < mask ? a : mask;
		to->either += a > mask ? a - mask : 0;
		rendered[met[k]] = 0;
	}
}

static double sum_image(const float *image, size_t pixels)
{
	double sum = 0;

	for (size_t p = 0; p < pixels; p++)
		sum += (double)image[p];
	return sum;
}

static double agreement_of(const struct work *work, size_t blocks, size_t k)
{
	double both = 0, either = sum_image(work->images + k * work->w->pixels, work->w->pixels);

	for (size_t b = 0; b < blocks; b++) {
		both += work->overlaps[b * work->n + k].both;
		either += work->overlaps[b * work->n + k].either;
	}
	return either > 0 ? both / either : 1;
}

int lift_agreement(const struct lift_objects *l, const struct lift_view *v, const struct view_weights *w,
	const float *images, double *agreement, struct err *e)
{
	const size_t blocks = (w->pixels + BLOCK - 1) / BLOCK;
	struct work work = {l, w, images, v->n, mem_alloc(l->objects, sizeof *work.slots, "masks", e),
		mem_zalloc(blocks, v->n * sizeof *work.rendered, "masks", e),
		mem_alloc(blocks, v->n * sizeof *work.met, "masks", e),
		mem_zalloc(blocks, v->n * sizeof *work.overlaps, "masks", e)};
	const int bad = !work.slots || !work.rendered || !work.met || !work.overlaps;

	for (size_t o = 0; o < l->objects && !bad; o++)
		work.slots[o] = LIFT_NOBODY;
	for (size_t k = 0; k < v->n && !bad; k++)
		work.slots[v->objects[k]] = (int32_t)k;
#pragma omp parallel for schedule(dynamic) if (!bad)
	for (size_t b = 0; b < (bad ? 0 : blocks); b++)
		for (size_t p = b * BLOCK; p < (b + 1) * BLOCK && p < w->pixels; p++)
			add_pixel(&work, p, b);
	for (size_t k = 0; k < v->n && !bad; k++)
		agreement[k] = agreement_of(&work, blocks, k);
	free(work.slots);
	free(work.rendered);
	free(work.met);
	free(work.overlaps);
	return bad ? -1 : 0;
}
