/* The other way: the streams are decompressed and checked, and become tiles; these rows of pixels. */
#include "splat/weights_pack.h"

#include "base/mem.h"
#include "base/ones.h"

#include <zstd.h>

enum { IDS, MAPS, LEVELS, PIXELS = VIEW_TILE_PIXELS };

struct unpacking {
	const char *path;
	int64_t gaussians;
	struct weights_room *room;
	struct view_tiles *to; /* the room's */
	size_t bytes[WEIGHTS_STREAMS];
	size_t at;	/* in the first stream */
	size_t entries; /* Gaussians of tiles */
};

static int broken(const struct unpacking *u, struct err *e)
{
	return err_file(e, u->path, "packed weights are broken, after byte %zu of their Gaussians", u->at);
}

static int make_room(uint8_t **data, size_t *room, size_t bytes, const char *path, struct err *e)
{
	return mem_room((void **)data, room, bytes + 1, 1, path, e);
}

static int decompress_all(struct unpacking *u, const struct weights_pack *p, struct err *e)
{
	struct weights_room *r = u->room;
	int bad[WEIGHTS_STREAMS];

	memcpy(u->bytes, p->bytes, sizeof u->bytes);
	if (make_room(&r->ids, &r->ids_room, p->bytes[IDS], u->path, e) ||
		make_room(&u->to->maps, &r->maps_room, p->bytes[MAPS], u->path, e) ||
		make_room(&u->to->levels, &r->levels_room, p->bytes[LEVELS], u->path, e))
		return -1;
	uint8_t *const data[WEIGHTS_STREAMS] = {r->ids, u->to->maps, u->to->levels};
#pragma omp parallel for schedule(dynamic)
	for (int s = WEIGHTS_STREAMS - 1; s >= 0; s--)
		bad[s] = ZSTD_decompress(data[s], p->bytes[s], p->data[s], p->packed[s]) != p->bytes[s];
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
		const uint8_t byte = u->room->ids[u->at++];
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
			u->to->level_begin[row + 1] += ones(map);
		}
	}
	return 0;
}

/* Reads and checks all but the levels, of which any are right. */
static int take_all(struct unpacking *u, struct err *e)
{
	const size_t tiles = (size_t)u->to->across * (size_t)u->to->down;
	struct weights_room *r = u->room;

	u->entries = u->bytes[MAPS] / 8;
	if (mem_room((void **)&u->to->ids, &r->gaussians_room, u->entries, sizeof *u->to->ids, u->path, e) ||
		mem_room((void **)&u->to->begin, &r->begin_room, tiles + 1, sizeof *u->to->begin, u->path,
			e) ||
		mem_room((void **)&u->to->level_begin, &r->level_begin_room, (size_t)u->to->down + 1,
			sizeof *u->to->level_begin, u->path, e))
		return -1;
	u->to->begin[0] = u->to->level_begin[0] = 0;
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

void weights_room_free(struct weights_room *r)
{
	view_tiles_free(&r->tiles);
	mem_free_all(r->indptr, r->index, r->weight, r->ids);
	*r = (struct weights_room){0};
}

/* Counted in place p + 1, a pixel's weights end where those of the next begin: sums give both, and when they
 * are put, each place moves from its pixel's beginning to its end, where the next begins. */
static int fill(struct weights_room *to, const char *path, struct err *e)
{
	const struct view_tiles *t = &to->tiles;
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
	const char *path, struct weights_room *to, struct err *e)
{
	struct unpacking u = {.path = path, .gaussians = gaussians, .room = to, .to = &to->tiles};

	to->tiles.width = width;
	to->tiles.height = height;
	to->tiles.across = (width + VIEW_TILE - 1) / VIEW_TILE;
	to->tiles.down = (height + VIEW_TILE - 1) / VIEW_TILE;
	return -(decompress_all(&u, p, e) || take_all(&u, e));
}

int weights_unpack(const struct weights_pack *p, int width, int height, int64_t gaussians, const char *path,
	struct weights_room *to, struct err *e)
{
	return -(weights_unpack_tiles(p, width, height, gaussians, path, to, e) || fill(to, path, e));
}
