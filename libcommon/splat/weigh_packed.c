#include "splat/weigh_packed.h"

#include "base/mem.h"
#include "base/threads.h"
#include "splat/view.h"
#include "splat/weigh_tile.h"

#include <omp.h>

enum { HALVES = TILE_SIZE / VIEW_TILE, HALF_BLOCKS = VIEW_TILE / BLEND_SIDE };

/* One thread's. */
struct weigh_room {
	struct weigh_tile tile __attribute__((aligned(64)));
	struct weights_packer packer;
};

/* Of a row of the rasteriser's tiles. */
struct counted {
	size_t weights, covered;
};

size_t weigh_covered(const float *transmittance, size_t pixels)
{
	size_t covered = 0;

	for (size_t p = 0; p < pixels; p++)
		covered += transmittance[p] < 0.5F;
	return covered;
}

/* Packs what is not 0 of a block's rows; (x, y) is its corner in the packed tile. */
static void pack_block(struct weigh_room *r, int x, int y)
{
	const struct blend_rows *rows = &r->tile.rows;

	for (size_t k = 0; k < rows->n; k++) {
		uint8_t levels[BLEND_LANES];
		uint64_t halves[2];
		for (int l = 0; l < BLEND_LANES; l++)
			levels[l] = (uint8_t)(int)(rows->weights[k][l] * 255 + 0.5F);
		memcpy(halves, levels, sizeof halves);
		if (!(halves[0] | halves[1]))
			continue;
		uint8_t *to =
			weights_packer_levels(&r->packer, rows->places[k], r->tile.list[rows->places[k]]);
		for (int row = 0; row < BLEND_SIDE; row++)
			memcpy(to + (y + row) * VIEW_TILE + x, levels + row * BLEND_SIDE, BLEND_SIDE);
	}
}

/* The packed tile in column x and row y of those that the tile has. */
static int pack_part(struct weigh_room *r, int x, int y, const struct render_limits *limits,
	struct counted *counted, struct weights_pack *row, struct err *e)
{
	if (weights_packer_start(&r->packer, r->tile.n, e))
		return -1;
	for (int i = 0; i < HALF_BLOCKS * HALF_BLOCKS; i++) {
		const int across = i % HALF_BLOCKS, down = i / HALF_BLOCKS,
			  b = (y * HALF_BLOCKS + down) * BLEND_SIDE + x * HALF_BLOCKS + across;
		counted->weights += weigh_tile_block(&r->tile, b, limits);
		pack_block(r, across * BLEND_SIDE, down * BLEND_SIDE);
	}
	return weights_packer_end(&r->packer, r->tile.view->gaussians, row, e);
}

/* What all rows have in common. */
struct packing {
	const struct render_view *view;
	const struct render_limits *limits;
	float *dropped;		   /* (P) */
	struct weights_pack *rows; /* of packed tiles */
	struct counted *counted;   /* (rows of tiles) */
};

static int pack_tile(
	const struct packing *p, struct weigh_room *r, size_t k, struct counted *counted, struct err *e)
{
	struct weigh_tile *t = &r->tile;

	if (weigh_tile_start(t, p->view, k, e))
		return -1;
	for (int y = 0; y * VIEW_TILE < t->at.rows; y++)
		for (int x = 0; x * VIEW_TILE < t->at.columns; x++)
			if (pack_part(r, x, y, p->limits, counted, &p->rows[t->at.y / VIEW_TILE + y], e))
				return -1;
	for (int y = 0; y < t->at.rows; y++)
		for (int x = 0; x < t->at.columns; x++)
			counted->covered += weigh_covered(&t->pixels.transmittance[blend_place(x, y)], 1);
	place_plane(&p->view->grid, t->at, t->dropped, p->dropped);
	return 0;
}

static int pack_row(const struct packing *p, struct weigh_room *r, int row, struct err *e)
{
	const size_t columns = (size_t)p->view->grid.columns;

	for (size_t k = 0; k < columns; k++)
		if (pack_tile(p, r, (size_t)row * columns + k, &p->counted[row], e))
			return -1;
	return 0;
}

static void free_rooms(struct weighed_packed *w)
{
	for (int k = 0; k < w->room_count; k++) {
		weigh_tile_free(&w->rooms[k].tile);
		weights_packer_free(&w->rooms[k].packer);
	}
	free(w->rooms);
	w->rooms = NULL;
	w->room_count = 0;
}

static void free_rows(struct weighed_packed *w)
{
	for (int k = 0; k < w->row_count; k++)
		weights_pack_free(&w->rows[k]);
	free(w->rows);
	w->rows = NULL;
	w->row_count = 0;
}

void weighed_packed_free(struct weighed_packed *w)
{
	weights_pack_free(&w->pack);
	free_rooms(w);
	free_rows(w);
}

static int make_room(struct weighed_packed *w, int rows, int threads, struct err *e)
{
	if (rows > w->row_count) {
		free_rows(w);
		w->rows = mem_zalloc((size_t)rows, sizeof *w->rows, "weights", e);
		w->row_count = w->rows ? rows : 0;
	}
	if (threads > w->room_count) {
		free_rooms(w);
		w->rooms = mem_zalloc((size_t)threads, sizeof *w->rooms, "weights", e);
		w->room_count = w->rooms ? threads : 0;
	}
	return w->rows && w->rooms ? 0 : -1;
}

static int pack_rows(const struct packing *p, struct weigh_room *rooms, int threads, struct err *e)
{
	int failed = 0;

#pragma omp parallel num_threads(threads) reduction(| : failed)
	{
		struct err mine;
		struct weigh_room *r = &rooms[omp_get_thread_num()];
#pragma omp for schedule(dynamic)
		for (int row = 0; row < p->view->grid.rows; row++)
			failed = failed || pack_row(p, r, row, &mine);
		if (failed) {
#pragma omp critical
			*e = mine;
		}
	}
	return failed ? -1 : 0;
}

int weigh_packed(struct weighed_packed *to, const struct render_view *v, const struct render_limits *limits,
	float *dropped, struct err *e)
{
	const int count = (v->grid.height + VIEW_TILE - 1) / VIEW_TILE, threads = threads_available();
	SCOPED struct counted *counted = mem_zalloc((size_t)v->grid.rows, sizeof *counted, "weights", e);
	int bad = !counted || make_room(to, count, threads, e);
	const struct packing p = {v, limits, dropped, to->rows, counted};

	bad = bad || pack_rows(&p, to->rooms, threads, e) || weights_pack_join(&to->pack, to->rows, count, e);
	to->weights = to->covered = 0;
	for (int k = 0; k < v->grid.rows && !bad; k++) {
		to->weights += counted[k].weights;
		to->covered += counted[k].covered;
	}
	return bad ? -1 : 0;
}
