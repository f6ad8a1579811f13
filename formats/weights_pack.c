/* Neighbouring pixels see the same Gaussians, by weights that differ little. So a tile of 8 by 8 pixels has a
 * list of its Gaussians once, for each a bit for every pixel, and along a Gaussian's pixels the differences
 * of its weights, which deflate makes small. */
#include "formats/weights_pack.h"

#include "base/mem.h"

#include <libdeflate.h>
#include <stdlib.h>
#include <string.h>

enum { IDS, MAPS, LEVELS, PIXELS = WEIGHTS_TILE * WEIGHTS_TILE, EFFORT = 1 };

static int put_byte(struct weights_pack *p, int stream, unsigned byte, struct err *e)
{
	if (p->bytes[stream] == p->room[stream] &&
		mem_grow((void **)&p->data[stream], &p->room[stream], p->bytes[stream] + 1, 1, "weights", e))
		return -1;
	p->data[stream][p->bytes[stream]++] = (uint8_t)byte;
	return 0;
}

/* Seven bits a byte, the lowest first; the last has its highest bit clear. */
static int put_number(struct weights_pack *p, uint32_t x, struct err *e)
{
	for (; x > 127; x >>= 7)
		if (put_byte(p, IDS, (x & 127) | 128, e))
			return -1;
	return put_byte(p, IDS, x, e);
}

static int put_gaussian(struct weights_pack *p, const uint8_t levels[PIXELS], struct err *e)
{
	uint64_t map = 0;
	unsigned before = 0;

	for (int i = 0; i < PIXELS; i++) {
		if (!levels[i])
			continue;
		map |= (uint64_t)1 << i;
		if (put_byte(p, LEVELS, (levels[i] - before) & 255, e))
			return -1;
		before = levels[i];
	}
	for (int k = 0; k < 8; k++)
		if (put_byte(p, MAPS, map >> 8 * k & 255, e))
			return -1;
	return 0;
}

/* The Gaussians of one tile. */
struct tile {
	size_t n;
	int32_t *ids, *spare;	   /* (n), as they are met or rising; and room for as many */
	int32_t last;		   /* the largest id of the picture */
	uint8_t (*levels)[PIXELS]; /* (n) as they are met */
	int32_t *slot;		   /* (N) where each is met, -1 */
};

/* Sorts by the bits from `shift` on, stably: one pass of a radix sort. */
static void sort_pass(const int32_t *from, int32_t *to, size_t n, int shift)
{
	size_t place[256] = {0}, sum = 0;

	for (size_t i = 0; i < n; i++)
		place[from[i] >> shift & 255]++;
	for (int k = 0; k < 256; k++) {
		const size_t count = place[k];
		place[k] = sum;
		sum += count;
	}
	for (size_t i = 0; i < n; i++)
		to[place[from[i] >> shift & 255]++] = from[i];
}

static void sort_ids(struct tile *t)
{
	for (int shift = 0; shift < 32 && t->last >> shift; shift += 8) {
		int32_t *sorted = t->spare;
		sort_pass(t->ids, sorted, t->n, shift);
		t->spare = t->ids;
		t->ids = sorted;
	}
}

static int put_tile(struct weights_pack *p, struct tile *t, struct err *e)
{
	int32_t before = 0;
	int bad = put_number(p, (uint32_t)t->n, e);

	sort_ids(t);
	for (size_t i = 0; i < t->n && !bad; i++) {
		bad = put_number(p, (uint32_t)(t->ids[i] - before), e) ||
		      put_gaussian(p, t->levels[t->slot[t->ids[i]]], e);
		before = t->ids[i];
	}
	for (size_t i = 0; i < t->n; i++)
		t->slot[t->ids[i]] = -1;
	return bad ? -1 : 0;
}

struct picture {
	int width, height;
	const int64_t *indptr;
	const int32_t *index;
	const uint8_t *level;
};

static void meet(struct tile *t, int32_t id, int pixel, uint8_t level)
{
	if (t->slot[id] < 0) {
		memset(t->levels[t->n], 0, PIXELS);
		t->slot[id] = (int32_t)t->n;
		t->ids[t->n++] = id;
	}
	t->levels[t->slot[id]][pixel] = level;
}

/* The tile whose corner is at column x and row y. */
static void take_tile(struct tile *t, const struct picture *v, int x, int y)
{
	t->n = 0;
	for (int i = 0; i < PIXELS; i++) {
		const int column = x + i % WEIGHTS_TILE, row = y + i / WEIGHTS_TILE;
		if (column >= v->width || row >= v->height)
			continue;
		const int64_t at = (int64_t)row * v->width + column;
		for (int64_t k = v->indptr[at]; k < v->indptr[at + 1]; k++)
			if (v->level[k])
				meet(t, v->index[k], i, v->level[k]);
	}
}

/* Room for the largest tile. */
static int tile_make(struct tile *t, const struct picture *v, struct err *e)
{
	const int64_t pixels = (int64_t)v->width * v->height;
	size_t most = 0;

	for (int64_t p = 0; p < pixels; p++) {
		const size_t n = (size_t)(v->indptr[p + 1] - v->indptr[p]);
		most = n > most ? n : most;
	}
	for (int64_t k = 0; k < v->indptr[pixels]; k++)
		t->last = v->index[k] > t->last ? v->index[k] : t->last;
	most *= PIXELS;
	t->ids = mem_alloc(most, sizeof *t->ids, "weights", e);
	t->spare = mem_alloc(most, sizeof *t->spare, "weights", e);
	t->levels = mem_alloc(most, sizeof *t->levels, "weights", e);
	t->slot = mem_alloc((size_t)t->last + 1, sizeof *t->slot, "weights", e);
	if (!t->ids || !t->spare || !t->levels || !t->slot)
		return -1;
	memset(t->slot, -1, ((size_t)t->last + 1) * sizeof *t->slot);
	return 0;
}

static int deflate_stream(struct weights_pack *p, int stream, struct err *e)
{
	struct libdeflate_compressor *by = libdeflate_alloc_compressor(EFFORT);

	if (!by)
		return err_set(e, ERR_SYSTEM, "weights: out of memory");
	const size_t room = libdeflate_zlib_compress_bound(by, p->bytes[stream]);
	uint8_t *out = mem_alloc(room, 1, "weights", e);
	if (out) {
		p->packed[stream] = libdeflate_zlib_compress(
			by, p->data[stream] ? p->data[stream] : out, p->bytes[stream], out, room);
		free(p->data[stream]);
		p->data[stream] = out;
	}
	libdeflate_free_compressor(by);
	return out ? 0 : -1;
}

static int deflate_all(struct weights_pack *p, struct err *e)
{
	struct err errors[WEIGHTS_STREAMS];
	int bad[WEIGHTS_STREAMS];

#pragma omp parallel for schedule(dynamic)
	for (int s = 0; s < WEIGHTS_STREAMS; s++)
		bad[s] = deflate_stream(p, s, &errors[s]);
	for (int s = 0; s < WEIGHTS_STREAMS; s++)
		if (bad[s]) {
			*e = errors[s];
			return -1;
		}
	return 0;
}

/* A row of tiles, as streams that are not deflated yet. */
static int pack_row(struct weights_pack *p, struct tile *t, const struct picture *v, int row, struct err *e)
{
	for (int x = 0; x < v->width; x += WEIGHTS_TILE) {
		take_tile(t, v, x, row * WEIGHTS_TILE);
		if (put_tile(p, t, e))
			return -1;
	}
	return 0;
}

static int append(struct weights_pack *p, const struct weights_pack *row, struct err *e)
{
	for (int s = 0; s < WEIGHTS_STREAMS; s++) {
		if (mem_grow((void **)&p->data[s], &p->room[s], p->bytes[s] + row->bytes[s], 1, "weights", e))
			return -1;
		if (row->bytes[s])
			memcpy(p->data[s] + p->bytes[s], row->data[s], row->bytes[s]);
		p->bytes[s] += row->bytes[s];
	}
	return 0;
}

/* The rows by many threads, each into streams of its own. */
static int pack_rows(struct weights_pack *rows, int count, const struct picture *v, struct err *e)
{
	int bad = 0;

#pragma omp parallel reduction(| : bad)
	{
		struct tile t = {0};
		struct err own;
		bad = tile_make(&t, v, &own);
#pragma omp for schedule(dynamic)
		for (int row = 0; row < count; row++)
			bad |= bad ? -1 : pack_row(&rows[row], &t, v, row, &own);
		free(t.ids);
		free(t.spare);
		free(t.levels);
		free(t.slot);
	}
	return bad ? err_set(e, ERR_SYSTEM, "weights: out of memory") : 0;
}

int weights_pack(struct weights_pack *p, int width, int height, const int64_t *indptr, const int32_t *index,
	const uint8_t *level, struct err *e)
{
	const struct picture v = {width, height, indptr, index, level};
	const int count = (height + WEIGHTS_TILE - 1) / WEIGHTS_TILE;
	struct weights_pack *rows = mem_zalloc((size_t)count, sizeof *rows, "weights", e);
	int bad = !rows || pack_rows(rows, count, &v, e);

	*p = (struct weights_pack){0};
	for (int row = 0; row < count && rows; row++) {
		bad = bad || append(p, &rows[row], e);
		weights_pack_free(&rows[row]);
	}
	free(rows);
	return bad || deflate_all(p, e) ? -1 : 0;
}

void weights_pack_free(struct weights_pack *p)
{
	for (int s = 0; s < WEIGHTS_STREAMS; s++)
		free(p->data[s]);
	*p = (struct weights_pack){0};
}

/* The streams again, and what the first two say. */
struct unpacking {
	const char *path;
	int width, height, across, down; /* of the picture, and in tiles */
	int64_t gaussians;
	uint8_t *data[WEIGHTS_STREAMS];
	size_t bytes[WEIGHTS_STREAMS];
	size_t at;	/* in the first stream */
	size_t entries; /* Gaussians of tiles */
	int32_t *ids;	/* (entries) */
	size_t *tiles;	/* (tiles + 1) where the entries of each begin */
	size_t *levels; /* (rows of tiles + 1) where their levels begin */
};

static int broken(const struct unpacking *u, struct err *e)
{
	return err_set(e, ERR_FORMAT, "%s: packed weights are broken, after byte %zu of their Gaussians",
		u->path, u->at);
}

static int inflate_stream(struct unpacking *u, const struct weights_pack *p, int s)
{
	struct libdeflate_decompressor *by = libdeflate_alloc_decompressor();
	const int bad = !by || libdeflate_zlib_decompress(by, p->data[s], p->packed[s], u->data[s],
				       p->bytes[s], NULL) != LIBDEFLATE_SUCCESS;

	libdeflate_free_decompressor(by);
	return bad;
}

static int inflate_all(struct unpacking *u, const struct weights_pack *p, struct err *e)
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
		bad[s] = inflate_stream(u, p, s);
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
	const size_t first = u->tiles[tile];
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
		u->ids[first + g] = (int32_t)id;
	}
	u->tiles[tile + 1] = first + count;
	return 0;
}

static uint64_t map_at(const struct unpacking *u, size_t entry)
{
	const uint8_t *byte = u->data[MAPS] + 8 * entry;
	uint64_t map = 0;

	for (int k = 0; k < 8; k++)
		map |= (uint64_t)byte[k] << 8 * k;
	return map;
}

/* The pixels of a tile that are in the picture. */
static uint64_t inside_of(const struct unpacking *u, int x, int y)
{
	uint64_t inside = 0;

	for (int i = 0; i < PIXELS; i++)
		inside |= (uint64_t)(x + i % WEIGHTS_TILE < u->width && y + i / WEIGHTS_TILE < u->height)
			  << i;
	return inside;
}

/* How many levels a row of tiles has. */
static int take_maps(struct unpacking *u, int row, struct err *e)
{
	u->levels[row + 1] = u->levels[row];
	for (int column = 0; column < u->across; column++) {
		const size_t tile = (size_t)row * (size_t)u->across + (size_t)column;
		const uint64_t inside = inside_of(u, column * WEIGHTS_TILE, row * WEIGHTS_TILE);
		for (size_t i = u->tiles[tile]; i < u->tiles[tile + 1]; i++) {
			const uint64_t map = map_at(u, i);
			if (!map || map & ~inside)
				return broken(u, e);
			u->levels[row + 1] += (size_t)__builtin_popcountll(map);
		}
	}
	return 0;
}

/* Reads and checks all but the levels, of which any are right. */
static int take_all(struct unpacking *u, struct err *e)
{
	const size_t tiles = (size_t)u->across * (size_t)u->down;

	u->entries = u->bytes[MAPS] / 8;
	u->ids = mem_alloc(u->entries, sizeof *u->ids, u->path, e);
	u->tiles = mem_zalloc(tiles + 1, sizeof *u->tiles, u->path, e);
	u->levels = mem_zalloc((size_t)u->down + 1, sizeof *u->levels, u->path, e);
	if (!u->ids || !u->tiles || !u->levels)
		return -1;
	for (size_t t = 0; t < tiles; t++)
		if (take_ids(u, t, e))
			return -1;
	if (u->at != u->bytes[IDS] || 8 * u->tiles[tiles] != u->bytes[MAPS])
		return broken(u, e);
	for (int row = 0; row < u->down; row++)
		if (take_maps(u, row, e))
			return -1;
	return u->levels[u->down] != u->bytes[LEVELS] ? broken(u, e) : 0;
}

/* How many weights each pixel of a tile has, whose corner is the first of the counts (P). The maps are summed
 * as columns of bits: plane b has bit b of all sums. */
static void count_tile(const struct unpacking *u, size_t tile, int64_t *corner)
{
	uint64_t planes[64] = {0}, any = 0;

	for (size_t i = u->tiles[tile]; i < u->tiles[tile + 1]; i++) {
		uint64_t carry = map_at(u, i);
		any |= carry;
		for (int b = 0; carry; b++) {
			const uint64_t both = planes[b] & carry;
			planes[b] ^= carry;
			carry = both;
		}
	}
	const uint64_t most = u->tiles[tile + 1] - u->tiles[tile];
	for (; any; any &= any - 1) {
		const int bit = __builtin_ctzll(any);
		int64_t n = 0;
		for (int b = 0; most >> b; b++)
			n |= (int64_t)(planes[b] >> bit & 1) << b;
		corner[(int64_t)(bit / WEIGHTS_TILE) * u->width + bit % WEIGHTS_TILE] = n;
	}
}

/* The counts of a row of tiles, which are 0 before. */
static void count_row(const struct unpacking *u, int row, int64_t *counts)
{
	for (int column = 0; column < u->across; column++)
		count_tile(u, (size_t)row * (size_t)u->across + (size_t)column,
			counts + (int64_t)row * WEIGHTS_TILE * u->width + column * WEIGHTS_TILE);
}

/* What each level is, and where each pixel of a tile is from its corner: looked up, as a division costs more
 * than all else that a weight takes. */
struct lookup {
	float weight[256];
	int64_t pixel[PIXELS];
};

static void lookup_make(struct lookup *l, int width)
{
	for (int k = 0; k < 256; k++)
		l->weight[k] = (float)k / 255;
	for (int i = 0; i < PIXELS; i++)
		l->pixel[i] = (int64_t)(i / WEIGHTS_TILE) * width + i % WEIGHTS_TILE;
}

/* One Gaussian's weights in a tile, each to where its pixel's next one goes: corner is the tile's first
 * pixel. Returns where the levels of the next begin. By itself, so that all of it stays in registers. */
__attribute__((noinline)) static const uint8_t *put_gaussian_back(const struct lookup *of, uint64_t map,
	int32_t id, const uint8_t *more, int64_t *corner, int32_t *index, float *weight)
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
static void put_row(const struct unpacking *u, const struct lookup *of, int row, int64_t *ends,
	int32_t *index, float *weight)
{
	const uint8_t *more = u->data[LEVELS] + u->levels[row];

	for (int column = 0; column < u->across; column++) {
		const size_t tile = (size_t)row * (size_t)u->across + (size_t)column;
		int64_t *corner = ends + (int64_t)row * WEIGHTS_TILE * u->width + column * WEIGHTS_TILE;
		for (size_t i = u->tiles[tile]; i < u->tiles[tile + 1]; i++)
			more = put_gaussian_back(of, map_at(u, i), u->ids[i], more, corner, index, weight);
	}
}

/* Counted in place p + 1, a pixel's weights end where those of the next begin: sums give both, and when they
 * are put, each place moves from its pixel's beginning to its end, where the next begins. */
static int fill(struct unpacking *u, int64_t *indptr, int32_t **index, float **weight, struct err *e)
{
	const int64_t pixels = (int64_t)u->width * u->height;
	struct lookup of;
	int64_t sum = 0;

	lookup_make(&of, u->width);
	memset(indptr, 0, ((size_t)pixels + 1) * sizeof *indptr);
	*index = mem_alloc(u->bytes[LEVELS], sizeof **index, u->path, e);
	*weight = mem_alloc(u->bytes[LEVELS], sizeof **weight, u->path, e);
	if (!*index || !*weight)
		return -1;
#pragma omp parallel for schedule(dynamic)
	for (int row = 0; row < u->down; row++)
		count_row(u, row, indptr + 1);
	for (int64_t p = 0; p < pixels; p++) {
		const int64_t n = indptr[p + 1];
		indptr[p + 1] = sum;
		sum += n;
	}
#pragma omp parallel for schedule(dynamic)
	for (int row = 0; row < u->down; row++)
		put_row(u, &of, row, indptr + 1, *index, *weight);
	return 0;
}

int weights_unpack(const struct weights_pack *p, int width, int height, int64_t gaussians, const char *path,
	int64_t *indptr, int32_t **index, float **weight, struct err *e)
{
	struct unpacking u = {.path = path,
		.width = width,
		.height = height,
		.across = (width + WEIGHTS_TILE - 1) / WEIGHTS_TILE,
		.down = (height + WEIGHTS_TILE - 1) / WEIGHTS_TILE,
		.gaussians = gaussians};

	*index = NULL;
	*weight = NULL;
	const int bad = inflate_all(&u, p, e) || take_all(&u, e) || fill(&u, indptr, index, weight, e);
	for (int s = 0; s < WEIGHTS_STREAMS; s++)
		free(u.data[s]);
	free(u.ids);
	free(u.tiles);
	free(u.levels);
	if (!bad)
		return 0;
	free(*index);
	free(*weight);
	*index = NULL;
	*weight = NULL;
	return -1;
}
