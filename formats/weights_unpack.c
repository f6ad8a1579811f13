/* The other way: the streams are decompressed and checked, and become tiles; these then become rows of
 * pixels. */
#include "formats/weights_pack.h"

#include "base/mem.h"

#include <stdlib.h>
#include <string.h>
#include <zstd.h>

enum { IDS, MAPS, LEVELS, PIXELS = VIEW_TILE_PIXELS };

/* The streams again, of which the second and the third become the tiles'. */
struct unpacking {
	const char *path;
	int64_t gaussians;
	struct view_tiles *to;
	uint8_t *data[WEIGHTS_STREAMS];
	size_t bytes[WEIGHTS_STREAMS];
	size_t at;	/* in the first stream */
	size_t entries; /* Gaussians of tiles */
};

static int broken(const struct unpacking *u, struct err *e)
{
	return err_set(e, ERR_FORMAT, "%s: packed weights are broken, after byte %zu of their Gaussians",
		u->path, u->at);
}

static int decompress_all(struct unpacking *u, const struct weights_pack *p, struct err *e)
{
	int bad[WEIGHTS_STREAMS];

	for (int s = 0; s < WEIGHTS_STREAMS; s++) {
		u->bytes[s] = p->bytes[s];
		u->data[s] = mem_alloc(p->bytes[s] + 1, 1, u->path, e);
		if (!u->data[s])
			return -1;
	}
#pragma omp parallel for schedule(dynamic)
	for (int s = WEIGHTS_STREAMS - 1; s >= 0; s--)
		bad[s] = ZSTD_decompress(u->data[s], p->bytes[s], p->data[s], p->packed[s]) != p->bytes[s];
	for (int s = 0; s < WEIGHTS_STREAMS; s++)
		if (bad[s])
			return broken(u, e);
	return 0;
}

static int take_number(struct unpacking *u, uint32_t *x, struct err *e)
{
	*x = 0;
	for (int shift = 0; shift < 35; shift += 7) {
		if (u->at == u->bytes[IDS])
			return broken(u, e);
		const uint8_t byte = u->data[IDS][u->at++];
		*x |= (uint32_t)(byte & 127) << shift;
		if (byte < 128)
			return 0;
	}
	return broken(u, e);
}

/* A tile's Gaussians, which rise. */
static int take_ids(struct unpacking *u, size_t tile, struct err *e)
{
	const size_t first = u->to->begin[tile];
	uint32_t count, more;
	int64_t id = 0;

	if (take_number(u, &count, e))
		return -1;
	if (count > u->entries - first)
		return broken(u, e);
	for (uint32_t g = 0; g < count; g++) {
		if (take_number(u, &more, e))
			return -1;
		id += more;
		if (id >= u->gaussians || (g && !more))
			return broken(u, e);
		u->to->ids[first + g] = (int32_t)id;
	}
	u->to->begin[tile + 1] = first + count;
	return 0;
}

/* The pixels of a tile that are in the picture. */
static uint64_t inside_of(const struct unpacking *u, int x, int y)
{
	uint64_t inside = 0;

	for (int i = 0; i < PIXELS; i++)
		inside |= (uint64_t)(x + i % VIEW_TILE < u->to->width && y + i / VIEW_TILE < u->to->height)
			  << i;
	return inside;
}

/* How many levels a row of tiles has. */
static int take_maps(struct unpacking *u, int row, struct err *e)
{
	u->to->level_begin[row + 1] = u->to->level_begin[row];
	for (int column = 0; column < u->to->across; column++) {
		const size_t tile = (size_t)row * (size_t)u->to->across + (size_t)column;
		const uint64_t inside = inside_of(u, column * VIEW_TILE, row * VIEW_TILE);
		for (size_t i = u->to->begin[tile]; i < u->to->begin[tile + 1]; i++) {
			const uint64_t map = view_tiles_map(u->to, i);
			if (!map || map & ~inside)
				return broken(u, e);
			u->to->level_begin[row + 1] += (size_t)__builtin_popcountll(map);
		}
	}
	return 0;
}

/* Reads and checks all but the levels, of which any are right. */
static int take_all(struct unpacking *u, struct err *e)
{
	const size_t tiles = (size_t)u->to->across * (size_t)u->to->down;

	u->entries = u->bytes[MAPS] / 8;
	u->to->maps = u->data[MAPS];
	u->to->ids = mem_alloc(u->entries, sizeof *u->to->ids, u->path, e);
	u->to->begin = mem_zalloc(tiles + 1, sizeof *u->to->begin, u->path, e);
	u->to->level_begin = mem_zalloc((size_t)u->to->down + 1, sizeof *u->to->level_begin, u->path, e);
	if (!u->to->ids || !u->to->begin || !u->to->level_begin)
		return -1;
	for (size_t t = 0; t < tiles; t++)
		if (take_ids(u, t, e))
			return -1;
	if (u->at != u->bytes[IDS] || 8 * u->to->begin[tiles] != u->bytes[MAPS])
		return broken(u, e);
	for (int row = 0; row < u->to->down; row++)
		if (take_maps(u, row, e))
			return -1;
	return u->to->level_begin[u->to->down] != u->bytes[LEVELS] ? broken(u, e) : 0;
}

/* How many weights each pixel of a tile has, whose corner is the first of the counts (P). The maps are summed
 * as columns of bits: plane b has bit b of all sums. */
static void count_tile(const struct view_tiles *t, size_t tile, int64_t *corner)
{
	uint64_t planes[64] = {0}, any = 0;

	for (size_t i = t->begin[tile]; i < t->begin[tile + 1]; i++) {
		uint64_t carry = view_tiles_map(t, i);
		any |= carry;
		for (int b = 0; carry; b++) {
			const uint64_t both = planes[b] & carry;
			planes[b] ^= carry;
			carry = both;
		}
	}
	const uint64_t most = t->begin[tile + 1] - t->begin[tile];
	for (; any; any &= any - 1) {
		const int bit = __builtin_ctzll(any);
		int64_t n = 0;
		for (int b = 0; most >> b; b++)
			n |= (int64_t)(planes[b] >> bit & 1) << b;
		corner[(int64_t)(bit / VIEW_TILE) * t->width + bit % VIEW_TILE] = n;
	}
}

/* The counts of a row of tiles, which are 0 before. */
static void count_row(const struct view_tiles *t, int row, int64_t *counts)
{
	for (int column = 0; column < t->across; column++)
		count_tile(t, (size_t)row * (size_t)t->across + (size_t)column,
			counts + (int64_t)row * VIEW_TILE * t->width + column * VIEW_TILE);
}

/* One Gaussian's weights in a tile, each to where its pixel's next one goes: corner is the tile's first
 * pixel. Returns where the levels of the next begin. By itself, so that all of it stays in registers. */
__attribute__((noinline)) static const uint8_t *put_gaussian_back(const struct view_tiles_lookup *of,
	uint64_t map, int32_t id, const uint8_t *more, int64_t *corner, int32_t *index, float *weight)
{
	uint8_t level = 0;

	for (; map; map &= map - 1) {
		const int64_t place = corner[of->pixel[__builtin_ctzll(map)]]++;
		level = (uint8_t)(level + *more++);
		index[place] = id;
		weight[place] = of->weight[level];
	}
	return more;
}

/* The weights of a row of tiles: ends (P). */
static void put_row(const struct view_tiles *t, const struct view_tiles_lookup *of, int row, int64_t *ends,
	int32_t *index, float *weight)
{
	const uint8_t *more = t->levels + t->level_begin[row];

	for (int column = 0; column < t->across; column++) {
		const size_t tile = (size_t)row * (size_t)t->across + (size_t)column;
		int64_t *corner = ends + (int64_t)row * VIEW_TILE * t->width + column * VIEW_TILE;
		for (size_t i = t->begin[tile]; i < t->begin[tile + 1]; i++)
			more = put_gaussian_back(
				of, view_tiles_map(t, i), t->ids[i], more, corner, index, weight);
	}
}

void weights_rows_free(struct weights_rows *r)
{
	free(r->indptr);
	free(r->index);
	free(r->weight);
	*r = (struct weights_rows){0};
}

/* Counted in place p + 1, a pixel's weights end where those of the next begin: sums give both, and when they
 * are put, each place moves from its pixel's beginning to its end, where the next begins. */
static int fill(const struct view_tiles *t, const char *path, struct weights_rows *to, struct err *e)
{
	const int64_t pixels = (int64_t)t->width * t->height;
	const size_t all = t->level_begin[t->down];
	struct view_tiles_lookup of;
	int64_t sum = 0;

	view_tiles_lookup_make(&of, t);
	if (mem_room((void **)&to->indptr, &to->indptr_room, (size_t)pixels + 1, sizeof *to->indptr, path,
		    e) ||
		mem_room((void **)&to->index, &to->index_room, all, sizeof *to->index, path, e) ||
		mem_room((void **)&to->weight, &to->weight_room, all, sizeof *to->weight, path, e))
		return -1;
	memset(to->indptr, 0, ((size_t)pixels + 1) * sizeof *to->indptr);
#pragma omp parallel for schedule(dynamic)
	for (int row = 0; row < t->down; row++)
		count_row(t, row, to->indptr + 1);
	for (int64_t p = 0; p < pixels; p++) {
		const int64_t n = to->indptr[p + 1];
		to->indptr[p + 1] = sum;
		sum += n;
	}
#pragma omp parallel for schedule(dynamic)
	for (int row = 0; row < t->down; row++)
		put_row(t, &of, row, to->indptr + 1, to->index, to->weight);
	return 0;
}

int weights_unpack_tiles(const struct weights_pack *p, int width, int height, int64_t gaussians,
	const char *path, struct view_tiles *to, struct err *e)
{
	struct unpacking u = {.path = path, .gaussians = gaussians, .to = to};

	*to = (struct view_tiles){.width = width,
		.height = height,
		.across = (width + VIEW_TILE - 1) / VIEW_TILE,
		.down = (height + VIEW_TILE - 1) / VIEW_TILE};
	const int bad = decompress_all(&u, p, e) || take_all(&u, e);
	free(u.data[IDS]);
	to->maps = u.data[MAPS];
	to->levels = u.data[LEVELS];
	if (bad)
		view_tiles_free(to);
	return bad ? -1 : 0;
}

int weights_unpack(const struct weights_pack *p, int width, int height, int64_t gaussians, const char *path,
	struct weights_rows *to, struct err *e)
{
	struct view_tiles tiles;

	if (weights_unpack_tiles(p, width, height, gaussians, path, &tiles, e))
		return -1;
	const int bad = fill(&tiles, path, to, e);
	view_tiles_free(&tiles);
	return bad;
}
