/* Neighbouring pixels see the same Gaussians, by weights that differ little. So a tile of 8 by 8 pixels has a
 * list of its Gaussians once, for each a bit for every pixel, and along a Gaussian's pixels the differences
 * of its weights, which deflate makes small. */
#include "formats/weights_pack.h"

#include "base/mem.h"

#include <libdeflate.h>
#include <stdlib.h>
#include <string.h>

enum { IDS, MAPS, LEVELS, PIXELS = VIEW_TILE_PIXELS, EFFORT = 1 };

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
		const int column = x + i % VIEW_TILE, row = y + i / VIEW_TILE;
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
	for (int x = 0; x < v->width; x += VIEW_TILE) {
		take_tile(t, v, x, row * VIEW_TILE);
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
	const int count = (height + VIEW_TILE - 1) / VIEW_TILE;
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
