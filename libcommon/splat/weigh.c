#include "base/mem.h"
#include "base/threads.h"
#include "splat/kernels.h"
#include "splat/place.h"
#include "splat/render.h"
#include "splat/view.h"

#include <omp.h>

/* The rows of a tile's pixels stand far apart in the matrix, and how long they are is known only when all
 * are blended. Blending twice, first for the lengths, is cheaper than keeping all records: they are half as
 * large as the matrix again. */

/* What the matrix is of: pixels from (x, y) on, all of the picture or a part of it. */
struct frame {
	int x, y;
	struct tile_grid grid; /* as if the part were a picture */
};

/* Tile k of the frame: where it is in it, and of the picture. */
static struct place place_in(const struct render_view *v, const struct frame *f, size_t k, size_t *tile)
{
	const struct place at = place_of_tile(&f->grid, k);

	*tile = (size_t)((f->y + at.y) / TILE_SIZE) * (size_t)v->grid.columns +
		(size_t)((f->x + at.x) / TILE_SIZE);
	return at;
}

static const uint32_t *tile_list(const struct render_view *v, size_t k, size_t *n)
{
	*n = v->tiles.start[k + 1] - v->tiles.start[k];
	return v->tiles.entries + v->tiles.start[k];
}

/* For each pixel of a tile how many weights it has (in indptr, one place on) and what is left. */
static void count_tile(const struct render_view *v, const struct frame *f, size_t k, struct render_weights *w)
{
	struct blend_tile t __attribute__((aligned(64)));
	size_t n, tile;
	const struct place at = place_in(v, f, k, &tile);
	const uint32_t *list = tile_list(v, tile, &n);

	place_fetch(&f->grid, at, w->transmittance);
	blend_start(&t, f->x + at.x, f->y + at.y, at.columns, at.rows, 0);
	kernels_of(v->level)->counts(&t, v->projected, list, n);
	place_plane(&f->grid, at, t.transmittance, w->transmittance);
	for (int y = 0; y < at.rows; y++)
		for (int x = 0; x < at.columns; x++)
			w->indptr[place_pixel(&f->grid, at, x, y) + 1] = t.count[blend_place(x, y)];
}

/* Distributes records over the rows of the matrix; next is where each pixel's goes on. */
static void scatter(struct blend_records *records, int64_t *next, struct render_weights *w)
{
	const float *weight = records->weights;

	for (size_t i = 0; i < records->count; i++) {
		struct blend_record one = records->items[i];
		int64_t *block = next + one.block * BLEND_LANES;
		for (unsigned left = one.lanes; left; left &= left - 1) {
			int64_t place = block[__builtin_ctz(left)]++;
			w->index[place] = one.index;
			w->weight[place] = *weight++;
		}
	}
	records->count = records->weight_count = 0;
}

/* `records` has room for RECORD_CHUNKS chunks. */
static void weigh_tile(const struct render_view *v, const struct frame *f, size_t k,
	struct blend_records *records, struct render_weights *w)
{
	struct blend_tile t __attribute__((aligned(64)));
	int64_t next[TILE_PIXELS];
	size_t n, tile, done = 0;
	const struct place at = place_in(v, f, k, &tile);
	const uint32_t *list = tile_list(v, tile, &n);

	for (int y = 0; y < at.rows; y++)
		for (int x = 0; x < at.columns; x++)
			next[blend_place(x, y)] = w->indptr[place_pixel(&f->grid, at, x, y)];
	blend_start(&t, f->x + at.x, f->y + at.y, at.columns, at.rows, 0);
	while (done < n) {
		done += kernels_of(v->level)->weights(&t, v->projected, list + done, n - done, records);
		scatter(records, next, w);
	}
}

/* Room for a few chunks, so that the records stay in the cache: (threads). */
enum { RECORD_CHUNKS = 2 };

static void records_free(struct blend_records *records, int threads)
{
	for (int i = 0; records && i < threads; i++)
		mem_free_all(records[i].items, records[i].weights);
	free(records);
}

static struct blend_records *records_make(int threads, struct err *e)
{
	struct blend_records *records = mem_zalloc((size_t)threads, sizeof *records, "weights", e);

	for (int i = 0; records && i < threads; i++) {
		struct blend_records *r = &records[i];
		r->capacity = RECORD_CHUNKS * BLEND_RECORD_ROOM;
		r->weight_capacity = RECORD_CHUNKS * BLEND_WEIGHT_ROOM;
		r->items = mem_alloc(r->capacity, sizeof *r->items, "weights", e);
		r->weights = mem_alloc(r->weight_capacity, sizeof *r->weights, "weights", e);
		if (!r->items || !r->weights) {
			records_free(records, threads);
			return NULL;
		}
	}
	return records;
}

static int weigh_frame(
	const struct render_view *v, const struct frame *f, struct render_weights *w, struct err *e)
{
	const size_t pixels = (size_t)f->grid.width * (size_t)f->grid.height,
		     tiles = (size_t)f->grid.columns * (size_t)f->grid.rows;
	const int threads = threads_available();
	struct blend_records *records = records_make(threads, e);

	if (!records ||
		mem_room((void **)&w->indptr, &w->indptr_room, pixels + 1, sizeof *w->indptr, "weights", e) ||
		mem_room((void **)&w->transmittance, &w->transmittance_room, pixels, sizeof *w->transmittance,
			"weights", e))
		goto fail;
#pragma omp parallel for schedule(dynamic) num_threads(threads)
	for (size_t k = 0; k < tiles; k++)
		count_tile(v, f, k, w);
	w->indptr[0] = 0;
	for (size_t p = 0; p < pixels; p++)
		w->indptr[p + 1] += w->indptr[p];
	const size_t all = (size_t)w->indptr[pixels];
	if (mem_room((void **)&w->index, &w->index_room, all, sizeof *w->index, "weights", e) ||
		mem_room((void **)&w->weight, &w->weight_room, all, sizeof *w->weight, "weights", e))
		goto fail;
#pragma omp parallel for schedule(dynamic) num_threads(threads)
	for (size_t k = 0; k < tiles; k++)
		weigh_tile(v, f, k, &records[omp_get_thread_num()], w);
	records_free(records, threads);
	return 0;
fail:
	records_free(records, threads);
	render_weights_free(w);
	return -1;
}

int render_weights_again(const struct render_view *v, struct render_weights *w, struct err *e)
{
	const struct frame all = {0, 0, v->grid};

	return weigh_frame(v, &all, w, e);
}

int render_weights_part(
	const struct render_view *v, const struct render_part *part, struct render_weights *w, struct err *e)
{
	const struct frame f = {part->x, part->y, tile_grid(part->width, part->height)};

	return weigh_frame(v, &f, w, e);
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
