/* A tile of the picture at a time: what is claimed for each object is rendered, and then compared with the
 * masks, where there is anything of it. */
#include "base/mem.h"
#include "lift/lift_private.h"
#include "mask/bits.h"

#include <math.h>

enum { PIXELS = VIEW_TILE_PIXELS };
_Static_assert((int)BITS_TILE == (int)VIEW_TILE, "masks and weights are cut into the same tiles");

/* Of an object's mask and what is rendered: the mask alone is `either` where nothing is. */
struct overlap {
	double both, either;
	/* Pixels between a cut and the next, inside the mask and outside; the first are above the first. */
	int inside[LIFT_CUTS], outside[LIFT_CUTS];
};

struct work {
	const struct lift_objects *l;
	const struct lift_view *v;
	const struct view_matrix *w;
	int across, down; /* tiles */
	int32_t *slots;	  /* (O) where the view has an object's mask, or LIFT_NOBODY */
	struct view_tiles_lookup of;
};

/* What is rendered of a tile, by one thread. */
struct drawn {
	double total[PIXELS];	  /* all weights */
	float (*objects)[PIXELS]; /* (n) weights times shares of each mask's object; 0 between tiles */
	int32_t *touched;	  /* (n) those that are not all 0, and */
	size_t touched_count;	  /* how many */
	char *is_touched;	  /* (n) */
	struct overlap *overlaps; /* (n) less what the masks alone have, over a row of tiles */
};

static void drawn_free(struct drawn *d)
{
	mem_free_all(d->objects, d->touched, d->is_touched);
}

static int drawn_make(struct drawn *d, size_t n, struct err *e)
{
	*d = (struct drawn){.objects = mem_zalloc(n, sizeof *d->objects, "masks", e),
		.touched = mem_alloc(n, sizeof *d->touched, "masks", e),
		.is_touched = mem_zalloc(n, 1, "masks", e)};
	return d->objects && d->touched && d->is_touched ? 0 : -1;
}

/* Where a Gaussian's weights times *share go; NULL: nowhere. */
static float *find_place(const struct work *work, struct drawn *d, int32_t gaussian, float *share)
{
	const struct lift_claim claim = work->l->claims[gaussian];
	const int32_t slot = claim.object == LIFT_NOBODY ? LIFT_NOBODY : work->slots[claim.object];

	*share = claim.share;
	if (slot == LIFT_NOBODY)
		return NULL;
	if (!d->is_touched[slot])
		d->touched[d->touched_count++] = slot;
	d->is_touched[slot] = 1;
	return d->objects[slot];
}

static void draw_pixel(const struct work *work, struct drawn *d, size_t p, size_t pixel)
{
	const struct view_weights *w = &work->w->rows;

	for (int64_t k = w->indptr[p]; k < w->indptr[p + 1]; k++) {
		float share, *place = find_place(work, d, w->index[k], &share);
		d->total[pixel] += (double)w->weight[k];
		if (place)
			place[pixel] += w->weight[k] * share;
	}
}

static void draw_rows(const struct work *work, struct drawn *d, int row, int column)
{
	for (int i = 0; i < PIXELS; i++) {
		const int x = column * VIEW_TILE + i % VIEW_TILE, y = row * VIEW_TILE + i / VIEW_TILE;
		if (x < work->w->width && y < work->w->height)
			draw_pixel(work, d, (size_t)y * (size_t)work->w->width + (size_t)x, (size_t)i);
	}
}

/* One entry of a tile, all in registers. Returns where the next one's levels begin. */
__attribute__((noinline)) static const uint8_t *draw_entry(const struct view_tiles_lookup *of, uint64_t map,
	const uint8_t *more, double *total, float share, float *place)
{
	uint8_t level = 0;

	for (; map; map &= map - 1) {
		const int pixel = __builtin_ctzll(map);
		level = (uint8_t)(level + *more++);
		total[pixel] += (double)of->weight[level];
		if (place)
			place[pixel] += of->weight[level] * share;
	}
	return more;
}

static const uint8_t *draw_tile(const struct work *work, struct drawn *d, size_t tile, const uint8_t *more)
{
	const struct view_tiles *t = work->w->tiles;

	for (size_t i = t->begin[tile]; i < t->begin[tile + 1]; i++) {
		float share, *place = find_place(work, d, t->ids[i], &share);
		more = draw_entry(&work->of, view_tiles_map(t, i), more, d->total, share, place);
	}
	return more;
}

/* The mean of an object's masks, in a tile. */
static void fill_mask(const struct work *work, size_t k, size_t tile, float mask[PIXELS])
{
	const size_t tiles = (size_t)work->across * (size_t)work->down, begin = work->v->starts[k],
		     end = work->v->starts[k + 1];

	memset(mask, 0, PIXELS * sizeof *mask);
	for (size_t m = begin; m < end; m++)
		for (uint64_t left = work->v->bits[m * tiles + tile]; left; left &= left - 1)
			mask[__builtin_ctzll(left)]++;
	for (int i = 0; i < PIXELS && end - begin > 1; i++)
		mask[i] /= (float)(end - begin);
}

/* How what is rendered of object k changes the overlap of its mask alone. */
static void compare(const struct work *work, struct drawn *d, size_t k, size_t tile)
{
	struct overlap *sum = &d->overlaps[k];
	float mask[PIXELS];

	fill_mask(work, k, tile, mask);
	for (int i = 0; i < PIXELS; i++) {
		if (!(d->objects[k][i] > 0))
			continue;
		const double m = (double)mask[i], a = (double)d->objects[k][i] / d->total[i];
		sum->both += a < m ? a : m;
		sum->either += a > m ? a - m : 0;
		const double below = (double)(LIFTED_CUT - d->objects[k][i]) / LIFT_CUT_STEP;
		const int cut = below > 0 ? (int)ceil(below) : 0;
		if (cut < LIFT_CUTS)
			++*(m >= 0.5 ? &sum->inside[cut] : &sum->outside[cut]);
	}
}

static void take_row(const struct work *work, struct drawn *d, int row)
{
	const struct view_tiles *t = work->w->tiles;
	const uint8_t *more = t ? t->levels + t->level_begin[row] : NULL;

	for (int column = 0; column < work->across; column++) {
		const size_t tile = (size_t)row * (size_t)work->across + (size_t)column;
		memset(d->total, 0, sizeof d->total);
		if (t)
			more = draw_tile(work, d, tile, more);
		else
			draw_rows(work, d, row, column);
		for (size_t i = 0; i < d->touched_count; i++) {
			const size_t k = (size_t)d->touched[i];
			compare(work, d, k, tile);
			memset(d->objects[k], 0, sizeof d->objects[k]);
			d->is_touched[k] = 0;
		}
		d->touched_count = 0;
	}
}

/* overlaps (rows of tiles,n), zeroed. */
static int take_rows(const struct work *work, struct overlap *overlaps, struct err *e)
{
	const size_t n = work->v->n;
	int failed = 0;

#pragma omp parallel reduction(| : failed)
	{
		struct err mine;
		SCOPED_BY(drawn_free) struct drawn d = {0};
		failed = drawn_make(&d, n, &mine) != 0;
#pragma omp for schedule(dynamic)
		for (int row = 0; row < work->down; row++) {
			d.overlaps = overlaps + (size_t)row * n;
			if (!failed)
				take_row(work, &d, row);
		}
		if (failed) {
#pragma omp critical
			*e = mine;
		}
	}
	return failed ? -1 : 0;
}

/* The sum of the mean of an object's masks. */
static double area_of(const struct work *work, size_t k)
{
	const size_t tiles = (size_t)work->across * (size_t)work->down,
		     masks = work->v->starts[k + 1] - work->v->starts[k];
	const uint8_t *bits = (const uint8_t *)(work->v->bits + work->v->starts[k] * tiles);

	return (double)bits_common(bits, bits, masks * tiles * sizeof *work->v->bits) / (double)masks;
}

static double agreement_of(const struct work *work, const struct overlap *overlaps, size_t k)
{
	double both = 0, either = area_of(work, k);

	for (size_t row = 0; row < (size_t)work->down; row++) {
		both += overlaps[row * work->v->n + k].both;
		either += overlaps[row * work->v->n + k].either;
	}
	return either > 0 ? both / either : 1;
}

static void fit_cuts(const struct work *work, const struct overlap *overlaps, size_t k, float *fit)
{
	double both = 0, either = area_of(work, k);

	for (int cut = 0; cut < LIFT_CUTS; cut++) {
		for (size_t row = 0; row < (size_t)work->down; row++) {
			both += overlaps[row * work->v->n + k].inside[cut];
			either += overlaps[row * work->v->n + k].outside[cut];
		}
		fit[cut] = either > 0 ? (float)(both / either) : 1;
	}
}

int lift_agreement(const struct lift_objects *l, const struct lift_view *v, const struct view_matrix *w,
	double *agreement, float (*fit)[LIFT_CUTS], struct err *e)
{
	struct work work = {l, v, w, (w->width + VIEW_TILE - 1) / VIEW_TILE,
		(w->height + VIEW_TILE - 1) / VIEW_TILE,
		.slots = mem_alloc(l->objects, sizeof *work.slots, "masks", e)};
	SCOPED struct overlap *overlaps = mem_zalloc((size_t)work.down, v->n * sizeof *overlaps, "masks", e);
	int bad = !work.slots || !overlaps;

	for (size_t o = 0; o < l->objects && !bad; o++)
		work.slots[o] = LIFT_NOBODY;
	for (size_t k = 0; k < v->n && !bad; k++)
		work.slots[v->objects[k]] = (int32_t)k;
	if (w->tiles)
		view_tiles_lookup_make(&work.of, w->tiles);
	bad = bad || take_rows(&work, overlaps, e);
	for (size_t k = 0; k < v->n && !bad; k++) {
		agreement[k] = agreement_of(&work, overlaps, k);
		fit_cuts(&work, overlaps, k, fit[k]);
	}
	free(work.slots);
	return bad ? -1 : 0;
}
