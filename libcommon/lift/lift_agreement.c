/* What is claimed for each object is rendered first, whether the weights come as rows of pixels or as tiles,
 * and then compared with the masks: a strip of the picture, which is a row of tiles, at a time. What is
 * rendered of a strip stays in the cache, and only where something was. */
#include "base/mem.h"
#include "base/threads.h"
#include "lift/lift_private.h"

#include <omp.h>
#include <stdlib.h>
#include <string.h>

/* Of an object's mask and what is rendered, over a strip: the mask alone is `either` where nothing is. */
struct overlap {
	double both, either;
};

struct work {
	const struct lift_objects *l;
	const struct lift_weights *of;
	const float *images;	  /* (n,P) */
	size_t n, pixels;	  /* of the picture */
	int32_t *slots;		  /* (O) where the view has an object's mask, or LIFT_NOBODY */
	struct overlap *overlaps; /* (strips,n), less what the masks alone have */
	char *is_touched;	  /* (threads,n) all 0 between strips */
};

/* A strip of rows, and one thread's room for it. */
struct strip {
	size_t first, pixels; /* of the picture; S, but for the last strip */
	float *rendered;      /* (n,S) of each mask's object: weights times shares; all 0 between strips */
	float *total;	      /* (S) all weights */
	char *is_touched;     /* (n) whether anything was rendered */
	size_t room;	      /* S */
};

/* Which mask's object has claimed a Gaussian, if any, and its share. */
static int32_t claimed(const struct work *work, int32_t gaussian, float *share)
{
	const struct lift_claim claim = work->l->claims[gaussian];

	*share = claim.share;
	return claim.object == LIFT_NOBODY ? LIFT_NOBODY : work->slots[claim.object];
}

static void render_pixels(const struct work *work, const struct strip *s)
{
	const struct view_weights *w = work->of->rows;

	for (size_t p = 0; p < s->pixels; p++) {
		double total = 0;
		for (int64_t k = w->indptr[s->first + p]; k < w->indptr[s->first + p + 1]; k++) {
			float share;
			const int32_t slot = claimed(work, w->index[k], &share);
			total += (double)w->weight[k];
			if (slot == LIFT_NOBODY)
				continue;
			s->rendered[(size_t)slot * s->room + p] += w->weight[k] * share;
			s->is_touched[slot] = 1;
		}
		s->total[p] = (float)total;
	}
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

static void render_tiles(
	const struct work *work, const struct view_tiles_lookup *of, int row, const struct strip *s)
{
	const struct view_tiles *t = work->of->tiles;
	const uint8_t *more = t->levels + t->level_begin[row];

	for (int column = 0; column < t->across; column++) {
		const size_t tile = (size_t)row * (size_t)t->across + (size_t)column;
		const int x = column * VIEW_TILE, y = row * VIEW_TILE;
		double total[VIEW_TILE_PIXELS] = {0};
		for (size_t i = t->begin[tile]; i < t->begin[tile + 1]; i++) {
			float share, *corner = NULL;
			const int32_t slot = claimed(work, t->ids[i], &share);
			if (slot != LIFT_NOBODY) {
				corner = s->rendered + (size_t)slot * s->room + x;
				s->is_touched[slot] = 1;
			}
			more = add_entry(of, view_tiles_map(t, i), more, total, share, corner);
		}
		for (int i = 0; i < VIEW_TILE_PIXELS; i++)
			if (x + i % VIEW_TILE < t->width && y + i / VIEW_TILE < t->height)
				s->total[(size_t)x + (size_t)of->pixel[i]] = (float)total[i];
	}
}

/* How what is rendered of object k changes the overlap of its mask alone. */
static struct overlap compare(const struct work *work, const struct strip *s, size_t k)
{
	const float *image = work->images + k * work->pixels + s->first,
		    *rendered = s->rendered + k * s->room;
	struct overlap sum = {0, 0};

	for (size_t p = 0; p < s->pixels; p++) {
		if (!(rendered[p] > 0))
			continue;
		const double mask = (double)image[p], a = (double)(rendered[p] / s->total[p]);
		sum.both += a < mask ? a : mask;
		sum.either += a > mask ? a - mask : 0;
	}
	return sum;
}

/* Strip `row`, and all is 0 again. */
static void take_strip(
	const struct work *work, const struct view_tiles_lookup *of, int row, const struct strip *s)
{
	if (of)
		render_tiles(work, of, row, s);
	else
		render_pixels(work, s);
	for (size_t k = 0; k < work->n; k++) {
		work->overlaps[(size_t)row * work->n + k] =
			s->is_touched[k] ? compare(work, s, k) : (struct overlap){0, 0};
		if (s->is_touched[k])
			memset(s->rendered + k * s->room, 0, s->room * sizeof *s->rendered);
		s->is_touched[k] = 0;
	}
}

static void take_strips(const struct work *work, struct lift_scratch *s, size_t room, int strips, int threads)
{
	struct view_tiles_lookup of;

	if (work->of->tiles)
		view_tiles_lookup_make(&of, work->of->tiles);
	memset(s->rendered, 0, (size_t)threads * work->n * room * sizeof *s->rendered);
#pragma omp parallel for schedule(dynamic) num_threads(threads)
	for (int row = 0; row < strips; row++) {
		const size_t mine = (size_t)omp_get_thread_num(), first = (size_t)row * room;
		take_strip(work, work->of->tiles ? &of : NULL, row,
			&(struct strip){first, work->pixels - first < room ? work->pixels - first : room,
				s->rendered + mine * work->n * room, s->total + mine * room,
				work->is_touched + mine * work->n, room});
	}
}

static double sum_image(const float *image, size_t pixels)
{
	double sum = 0;

	for (size_t p = 0; p < pixels; p++)
		if (image[p] > 0)
			sum += (double)image[p];
	return sum;
}

static double agreement_of(const struct work *work, int strips, size_t k)
{
	double both = 0, either = sum_image(work->images + k * work->pixels, work->pixels);

	for (size_t row = 0; row < (size_t)strips; row++) {
		both += work->overlaps[row * work->n + k].both;
		either += work->overlaps[row * work->n + k].either;
	}
	return either > 0 ? both / either : 1;
}

int lift_agreement(const struct lift_objects *l, const struct lift_view *v, const struct lift_weights *of,
	struct lift_scratch *s, double *agreement, struct err *e)
{
	const int strips = (of->height + VIEW_TILE - 1) / VIEW_TILE, threads = threads_available();
	const size_t n = v->n, room = (size_t)of->width * VIEW_TILE;
	struct work work = {l, of, s->images, n, (size_t)of->width * (size_t)of->height,
		mem_alloc(l->objects, sizeof *work.slots, "masks", e),
		mem_alloc((size_t)strips, n * sizeof *work.overlaps, "masks", e),
		mem_zalloc((size_t)threads, n, "masks", e)};
	const int bad =
		!work.slots || !work.overlaps || !work.is_touched ||
		lift_room((void **)&s->rendered, &s->rendered_room, (size_t)threads * n, room,
			sizeof *s->rendered, e) ||
		lift_room((void **)&s->total, &s->total_room, (size_t)threads, room, sizeof *s->total, e);

	for (size_t o = 0; o < l->objects && !bad; o++)
		work.slots[o] = LIFT_NOBODY;
	for (size_t k = 0; k < n && !bad; k++)
		work.slots[v->objects[k]] = (int32_t)k;
	if (!bad)
		take_strips(&work, s, room, strips, threads);
	for (size_t k = 0; k < n && !bad; k++)
		agreement[k] = agreement_of(&work, strips, k);
	free(work.slots);
	free(work.overlaps);
	free(work.is_touched);
	return bad ? -1 : 0;
}
