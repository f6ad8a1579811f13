/* What is claimed for each object is rendered first, whether the weights come as rows of pixels or as tiles,
 * and then compared with the masks, pixel after pixel in their order. */
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
	const struct lift_weights *of;
	size_t pixels;
	int32_t *slots;		  /* (O) where the view has an object's mask, or LIFT_NOBODY */
	float *rendered;	  /* (n,P) of each mask's object: weights times shares */
	float *total;		  /* (P) all weights */
	struct overlap *overlaps; /* (blocks,n), less what the masks alone have */
};

/* Which mask's object has claimed a Gaussian, if any, and its share. */
static int32_t claimed(const struct work *work, int32_t gaussian, float *share)
{
	const struct lift_claim claim = work->l->claims[gaussian];

	*share = claim.share;
	return claim.object == LIFT_NOBODY ? LIFT_NOBODY : work->slots[claim.object];
}

static void render_pixel(const struct work *work, const struct view_weights *w, size_t pixel)
{
	double total = 0;

	for (int64_t k = w->indptr[pixel]; k < w->indptr[pixel + 1]; k++) {
		float share;
		const int32_t slot = claimed(work, w->index[k], &share);
		total += (double)w->weight[k];
		if (slot != LIFT_NOBODY)
			work->rendered[(size_t)slot * w->pixels + pixel] += w->weight[k] * share;
	}
	work->total[pixel] = (float)total;
}

/* One entry of a tile, by itself so that all of it stays in registers; corner: the tile's first pixel of what
 * is rendered. Returns where the levels of the next begin. */
__attribute__((noinline)) static const uint8_t *add_entry(const struct view_tiles_lookup *of, uint64_t map,
	const uint8_t *more, double *total, float share, float *corner)
{
	uint8_t level = 0;

	for (; map; map &= map - 1) {
		const int pixel = __builtin_ctzll(map);
		level = (uint8_t)(level + *more++);
		total[pixel] += (double)of->weight[level];
		if (corner)
			corner[of->pixel[pixel]] += of->weight[level] * share;
	}
	return more;
}

static void render_row(
	const struct work *work, const struct view_tiles *t, const struct view_tiles_lookup *of, int row)
{
	const uint8_t *more = t->levels + t->level_begin[row];

	for (int column = 0; column < t->across; column++) {
		const size_t tile = (size_t)row * (size_t)t->across + (size_t)column;
		const int x = column * VIEW_TILE, y = row * VIEW_TILE;
		const size_t first = (size_t)y * (size_t)t->width + (size_t)x;
		double total[VIEW_TILE_PIXELS] = {0};
		for (size_t i = t->begin[tile]; i < t->begin[tile + 1]; i++) {
			float share;
			const int32_t slot = claimed(work, t->ids[i], &share);
			more = add_entry(of, view_tiles_map(t, i), more, total, share,
				slot == LIFT_NOBODY ? NULL
						    : work->rendered + (size_t)slot * work->pixels + first);
		}
		for (int i = 0; i < VIEW_TILE_PIXELS; i++)
			if (x + i % VIEW_TILE < t->width && y + i / VIEW_TILE < t->height)
				work->total[first + (size_t)of->pixel[i]] = (float)total[i];
	}
}

static void render(const struct work *work)
{
	const struct view_tiles *t = work->of->tiles;

	if (!t) {
#pragma omp parallel for schedule(dynamic, BLOCK)
		for (size_t p = 0; p < work->pixels; p++)
			render_pixel(work, work->of->rows, p);
		return;
	}
	struct view_tiles_lookup of;
	view_tiles_lookup_make(&of, t);
#pragma omp parallel for schedule(dynamic)
	for (int row = 0; row < t->down; row++)
		render_row(work, t, &of, row);
}

/* How what is rendered of object k changes the overlap of its mask alone, in the pixels [from,to). */
static struct overlap compare(const struct work *work, const float *images, size_t k, size_t from, size_t to)
{
	const float *image = images + k * work->pixels, *rendered = work->rendered + k * work->pixels;
	struct overlap sum = {0, 0};

	for (size_t p = from; p < to; p++) {
		if (!(rendered[p] > 0))
			continue;
		const double mask = (double)image[p], a = (double)(rendered[p] / work->total[p]);
		sum.both += a < mask ? a : mask;
		sum.either += a > mask ? a - mask : 0;
	}
	return sum;
}

static double sum_image(const float *image, size_t pixels)
{
	double sum = 0;

	for (size_t p = 0; p < pixels; p++)
		if (image[p] > 0)
			sum += (double)image[p];
	return sum;
}

static double agreement_of(const struct work *work, const float *images, size_t blocks, size_t n, size_t k)
{
	double both = 0, either = sum_image(images + k * work->pixels, work->pixels);

	for (size_t b = 0; b < blocks; b++) {
		both += work->overlaps[b * n + k].both;
		either += work->overlaps[b * n + k].either;
	}
	return either > 0 ? both / either : 1;
}

int lift_agreement(const struct lift_objects *l, const struct lift_view *v, const struct lift_weights *of,
	const float *images, double *agreement, struct err *e)
{
	const size_t pixels = lift_weights_pixels(of), blocks = (pixels + BLOCK - 1) / BLOCK, n = v->n;
	struct work work = {l, of, pixels, mem_alloc(l->objects, sizeof *work.slots, "masks", e),
		mem_zalloc(n, pixels * sizeof *work.rendered, "masks", e),
		mem_alloc(pixels, sizeof *work.total, "masks", e),
		mem_alloc(blocks, n * sizeof *work.overlaps, "masks", e)};
	const int bad = !work.slots || !work.rendered || !work.total || !work.overlaps;

	for (size_t o = 0; o < l->objects && !bad; o++)
		work.slots[o] = LIFT_NOBODY;
	for (size_t k = 0; k < n && !bad; k++)
		work.slots[v->objects[k]] = (int32_t)k;
	if (!bad)
		render(&work);
#pragma omp parallel for schedule(dynamic) if (!bad)
	for (size_t b = 0; b < (bad ? 0 : blocks); b++)
		for (size_t k = 0; k < n; k++)
			work.overlaps[b * n + k] = compare(&work, images, k, b * BLOCK,
				(b + 1) * BLOCK < pixels ? (b + 1) * BLOCK : pixels);
	for (size_t k = 0; k < n && !bad; k++)
		agreement[k] = agreement_of(&work, images, blocks, n, k);
	free(work.slots);
	free(work.rendered);
	free(work.total);
	free(work.overlaps);
	return bad ? -1 : 0;
}
