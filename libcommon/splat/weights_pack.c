/* Neighbouring pixels see the same Gaussians, by weights that differ little. So a tile of 8 by 8 pixels has a
 * list of its Gaussians once, for each a bit for every pixel, and along a Gaussian's pixels the differences
 * of its weights, which zstd makes small. */
#include "splat/weights_pack.h"

#include "base/mem.h"
#include "base/ones.h"

#include <zstd.h>

enum { IDS, MAPS, LEVELS, PIXELS = VIEW_TILE_PIXELS, EFFORT = 1 };

const char *const weights_stream_name[WEIGHTS_STREAMS] = {"ids", "maps", "levels"};

/* Room for `more` bytes of a stream; NULL with *e. */
static uint8_t *more_room(struct weights_pack *p, int stream, size_t more, struct err *e)
{
	if (p->room[stream] - p->bytes[stream] < more && mem_grow((void **)&p->data[stream], &p->room[stream],
								 p->bytes[stream] + more, 1, "weights", e))
		return NULL;
	return p->data[stream] + p->bytes[stream];
}

/* Seven bits a byte, the lowest first; the last has its highest bit clear. */
static int put_number(struct weights_pack *p, uint32_t x, struct err *e)
{
	uint8_t *to = more_room(p, IDS, 5, e), *end = to;

	if (!to)
		return -1;
	for (; x > 127; x >>= 7)
		*end++ = (uint8_t)((x & 127) | 128);
	*end++ = (uint8_t)x;
	p->bytes[IDS] += (size_t)(end - to);
	return 0;
}

/* Bit i: byte i is not 0. */
static uint64_t find_set(const uint8_t levels[PIXELS])
{
	const uint64_t low = 0x7f7f7f7f7f7f7f7f;
	uint64_t map = 0;

	for (int k = 0; k < 8; k++) {
		uint64_t bytes = 0;
		for (int i = 0; i < 8; i++)
			bytes |= (uint64_t)levels[8 * k + i] << 8 * i;
		bytes = ((((bytes & low) + low) | bytes) & ~low) >> 7;
		/* the lowest bits of the bytes, side by side */
		map |= (bytes * 0x0102040810204080) >> 56 << 8 * k;
	}
	return map;
}

static int put_gaussian(struct weights_pack *p, const uint8_t levels[PIXELS], struct err *e)
{
	const uint64_t map = find_set(levels);
	uint8_t *maps = more_room(p, MAPS, 8, e), *to = more_room(p, LEVELS, PIXELS, e);
	unsigned before = 0;

	if (!maps || !to)
		return -1;
	for (int k = 0; k < 8; k++)
		maps[k] = (uint8_t)(map >> 8 * k);
	for (uint64_t left = map; left; left &= left - 1) {
		const unsigned level = levels[__builtin_ctzll(left)];
		*to++ = (uint8_t)(level - before);
		before = level;
	}
	p->bytes[MAPS] += 8;
	p->bytes[LEVELS] += ones(map);
	return 0;
}

int weights_packer_make(struct weights_packer *t, size_t gaussians, struct err *e)
{
	*t = (struct weights_packer){
		.gaussians = gaussians, .slot = mem_alloc(gaussians, sizeof *t->slot, "weights", e)};
	if (!t->slot)
		return -1;
	memset(t->slot, -1, gaussians * sizeof *t->slot);
	return 0;
}

void weights_packer_free(struct weights_packer *t)
{
	mem_free_all(t->ids, t->spare, t->levels, t->slot);
	*t = (struct weights_packer){0};
}

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

static void sort_ids(struct weights_packer *t)
{
	for (int shift = 0; shift < 32 && (t->gaussians - 1) >> shift; shift += 8) {
		int32_t *sorted = t->spare;
		sort_pass(t->ids, sorted, t->n, shift);
		t->spare = t->ids;
		t->ids = sorted;
	}
}

static int put_tile(struct weights_pack *p, struct weights_packer *t, struct err *e)
{
	int32_t before = 0;
	int bad = put_number(p, (uint32_t)t->n, e);

	if (t->n)
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

/* Room for a tile with so many weights. */
static int make_room(struct weights_packer *t, size_t weights, struct err *e)
{
	return mem_room((void **)&t->ids, &t->room[0], weights, sizeof *t->ids, "weights", e) ||
	       mem_room((void **)&t->spare, &t->room[1], weights, sizeof *t->spare, "weights", e) ||
	       mem_room((void **)&t->levels, &t->room[2], weights, sizeof *t->levels, "weights", e);
}

static void meet(struct weights_packer *t, int32_t id, int pixel, uint8_t level)
{
	if (t->slot[id] < 0) {
		memset(t->levels[t->n], 0, PIXELS);
		t->slot[id] = (int32_t)t->n;
		t->ids[t->n++] = id;
	}
	t->levels[t->slot[id]][pixel] = level;
}

/* The tile whose corner is at column x and row y. */
static int take_tile(struct weights_packer *t, const struct weights_picture *v, int x, int y, struct err *e)
{
	const int right = x + VIEW_TILE < v->width ? x + VIEW_TILE : v->width,
		  bottom = y + VIEW_TILE < v->height ? y + VIEW_TILE : v->height;
	int64_t weights = 0;

	for (int row = y; row < bottom; row++)
		weights +=
			v->indptr[(int64_t)row * v->width + right] - v->indptr[(int64_t)row * v->width + x];
	t->n = 0;
	if (make_room(t, (size_t)weights, e))
		return -1;
	for (int row = y; row < bottom; row++)
		for (int column = x; column < right; column++) {
			const int64_t at = (int64_t)row * v->width + column;
			for (int64_t k = v->indptr[at]; k < v->indptr[at + 1]; k++) {
				const uint8_t level = (uint8_t)(v->weight[k] * 255 + 0.5f);
				if (level)
					meet(t, v->index[k], (row - y) * VIEW_TILE + column - x, level);
			}
		}
	return 0;
}

int weights_pack_part(
	struct weights_pack *rows, struct weights_packer *t, const struct weights_picture *v, struct err *e)
{
	for (int y = 0; y < v->height; y += VIEW_TILE)
		for (int x = 0; x < v->width; x += VIEW_TILE)
			if (take_tile(t, v, x, y, e) || put_tile(&rows[y / VIEW_TILE], t, e))
				return -1;
	return 0;
}

/* A stream of all rows, one after another, as one frame. */
static int compress_rows(ZSTD_CCtx *by, struct weights_pack *p, const struct weights_pack *rows, int count,
	int stream, struct err *e)
{
	ZSTD_outBuffer out = {p->data[stream], p->room[stream], 0};
	size_t left = ZSTD_CCtx_setPledgedSrcSize(by, p->bytes[stream]);

	for (int row = 0; row <= count && !ZSTD_isError(left); row++) {
		const struct weights_pack *from = row < count ? &rows[row] : NULL;
		ZSTD_inBuffer in = {from ? from->data[stream] : NULL, from ? from->bytes[stream] : 0, 0};
		do /* there is room for all of it */
			left = ZSTD_compressStream2(by, &out, &in, from ? ZSTD_e_continue : ZSTD_e_end);
		while (!ZSTD_isError(left) && (from ? in.pos < in.size : left));
	}
	if (ZSTD_isError(left))
		return err_set(e, ERR_SYSTEM, "weights: %s", ZSTD_getErrorName(left));
	p->packed[stream] = out.pos;
	return 0;
}

static int compress_stream(
	struct weights_pack *p, const struct weights_pack *rows, int count, int stream, struct err *e)
{
	p->bytes[stream] = 0;
	for (int row = 0; row < count; row++)
		p->bytes[stream] += rows[row].bytes[stream];
	if (mem_room((void **)&p->data[stream], &p->room[stream], ZSTD_compressBound(p->bytes[stream]), 1,
		    "weights", e))
		return -1;
	ZSTD_CCtx *by = ZSTD_createCCtx();
	if (!by)
		return err_set(e, ERR_SYSTEM, "weights: out of memory");
	ZSTD_CCtx_setParameter(by, ZSTD_c_compressionLevel, EFFORT);
	ZSTD_CCtx_setParameter(by, ZSTD_c_checksumFlag, 1);
	const int bad = compress_rows(by, p, rows, count, stream, e);
	ZSTD_freeCCtx(by);
	return bad;
}

int weights_pack_join(struct weights_pack *p, struct weights_pack *rows, int count, struct err *e)
{
	struct err errors[WEIGHTS_STREAMS];
	int bad[WEIGHTS_STREAMS];

#pragma omp parallel for schedule(dynamic)
	for (int s = WEIGHTS_STREAMS - 1; s >= 0; s--)
		bad[s] = compress_stream(p, rows, count, s, &errors[s]);
	for (int row = 0; row < count; row++)
		memset(rows[row].bytes, 0, sizeof rows[row].bytes);
	for (int s = 0; s < WEIGHTS_STREAMS; s++)
		if (bad[s]) {
			*e = errors[s];
			return -1;
		}
	return 0;
}

void weights_pack_free(struct weights_pack *p)
{
	for (int s = 0; s < WEIGHTS_STREAMS; s++)
		free(p->data[s]);
	*p = (struct weights_pack){0};
}
