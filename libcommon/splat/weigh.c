#include "base/mem.h"
#include "base/threads.h"
#include "splat/kernels.h"
#include "splat/render.h"
#include "splat/view.h"
#include "splat/weigh_tile.h"

#include <omp.h>

/* The rows of a tile's pixels stand far apart in the matrix, and how long they are is known only when all
 * are blended. Blending twice, first for the lengths, is cheaper than keeping all weights until then. */

/* For each pixel of tile k how many weights it has, in indptr, one place on. */
static void count_tile(const struct render_view *v, size_t k, struct render_weights *w)
{
	struct blend_tile t __attribute__((aligned(64)));
	const struct place at = place_of_tile(&v->grid, k);
	const uint32_t *list = v->tiles.entries + v->tiles.start[k];

	blend_start(&t, at.x, at.y, at.columns, at.rows, 0);
	kernels_of(v->level)->counts(&t, v->projected, list, v->tiles.start[k + 1] - v->tiles.start[k]);
	for (int y = 0; y < at.rows; y++)
		for (int x = 0; x < at.columns; x++)
			w->indptr[place_pixel(&v->grid, at, x, y) + 1] = t.count[blend_place(x, y)];
}

/* Distributes a block's rows over those of the matrix; next (16) is where each pixel's goes on. */
static void scatter(const struct weigh_tile *t, int64_t *next, struct render_weights *w)
{
	for (size_t k = 0; k < t->rows.n; k++) {
		const float *row = t->rows.weights[k];
		const int32_t index = (int32_t)t->list[t->rows.places[k]];
		for (unsigned left = t->rows.lanes[k]; left; left &= left - 1) {
			const int l = __builtin_ctz(left);
			const int64_t place = next[l]++;
			w->index[place] = index;
			w->weight[place] = row[l];
		}
	}
}

/* Fills the rows of a tile's pixels; -1 in place of the weights that were left out at their ends. */
static void weigh_pixels(
	struct weigh_tile *t, const struct render_limits *limits, struct render_weights *w, float *dropped)
{
	const struct tile_grid *grid = &t->view->grid;
	int64_t next[TILE_PIXELS] = {0};

	place_fetch(grid, t->at, w->transmittance);
	for (int y = 0; y < t->at.rows; y++)
		for (int x = 0; x < t->at.columns; x++)
			next[blend_place(x, y)] = w->indptr[place_pixel(grid, t->at, x, y)];
	for (int b = 0; b < BLEND_BLOCKS; b++) {
		weigh_tile_block(t, b, limits);
		scatter(t, next + b * BLEND_LANES, w);
	}
	for (int y = 0; y < t->at.rows; y++)
		for (int x = 0; x < t->at.columns; x++) {
			const int64_t end = w->indptr[place_pixel(grid, t->at, x, y) + 1];
			for (int64_t k = next[blend_place(x, y)]; k < end; k++)
				w->weight[k] = -1;
		}
	place_plane(grid, t->at, t->pixels.transmittance, w->transmittance);
	if (dropped)
		place_plane(grid, t->at, t->dropped, dropped);
}

/* Closes the gaps of what is marked by -1. */
static void close_gaps(struct render_weights *w, size_t pixels)
{
	int64_t kept = 0, begin = 0;

	for (size_t p = 0; p < pixels; p++) {
		int64_t end = w->indptr[p + 1];
		for (int64_t i = begin; i < end && w->weight[i] >= 0; i++) {
			w->index[kept] = w->index[i];
			w->weight[kept++] = w->weight[i];
		}
		begin = end;
		w->indptr[p + 1] = kept;
	}
}

static int weigh_tiles(const struct render_view *v, const struct render_limits *limits,
	struct render_weights *w, float *dropped, struct err *e)
{
	const size_t tiles = (size_t)v->grid.columns * (size_t)v->grid.rows;
	int failed = 0;

#pragma omp parallel num_threads(threads_available()) reduction(| : failed)
	{
		SCOPED_BY(weigh_tile_free) struct weigh_tile t __attribute__((aligned(64))) = {.n = 0};
		struct err mine;
#pragma omp for schedule(dynamic)
		for (size_t k = 0; k < tiles; k++) {
			failed = failed || weigh_tile_start(&t, v, k, &mine);
			if (!failed)
				weigh_pixels(&t, limits, w, dropped);
		}
		if (failed) {
#pragma omp critical
			*e = mine;
		}
	}
	return failed ? -1 : 0;
}

int render_weights_within(const struct render_view *v, const struct render_limits *limits,
	struct render_weights *w, float *dropped, struct err *e)
{
	const size_t pixels = (size_t)v->grid.width * (size_t)v->grid.height,
		     tiles = (size_t)v->grid.columns * (size_t)v->grid.rows;

	if (mem_room((void **)&w->indptr, &w->indptr_room, pixels + 1, sizeof *w->indptr, "weights", e) ||
		mem_room((void **)&w->transmittance, &w->transmittance_room, pixels, sizeof *w->transmittance,
			"weights", e))
		goto fail;
#pragma omp parallel for schedule(dynamic) num_threads(threads_available())
	for (size_t k = 0; k < tiles; k++)
		count_tile(v, k, w);
	w->indptr[0] = 0;
	for (size_t p = 0; p < pixels; p++)
		w->indptr[p + 1] += w->indptr[p];
	const size_t all = (size_t)w->indptr[pixels];
	if (mem_room((void **)&w->index, &w->index_room, all, sizeof *w->index, "weights", e) ||
		mem_room((void **)&w->weight, &w->weight_room, all, sizeof *w->weight, "weights", e) ||
		weigh_tiles(v, limits, w, dropped, e))
		goto fail;
	if (limits->tolerance > 0 || limits->least > 0)
		close_gaps(w, pixels);
	return 0;
fail:
	render_weights_free(w);
	return -1;
}

int render_weights_again(const struct render_view *v, struct render_weights *w, struct err *e)
{
	return render_weights_within(v, &(struct render_limits){0}, w, NULL, e);
}

int render_weights(const struct render_view *v, struct render_weights *w, struct err *e)
{
	*w = (struct render_weights){0};
	return render_weights_again(v, w, e);
}

void render_weights_free(struct render_weights *w)
{
	mem_free_all(w->indptr, w->index, w->weight, w->transmittance);
	*w = (struct render_weights){0};
}
