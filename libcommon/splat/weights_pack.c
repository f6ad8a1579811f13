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

void weights_packer_free(struct weights_packer *t)
{
	mem_free_all(t->ids, t->spare, t->levels, t->slot);
	*t = (struct weights_packer){0};
}

int weights_packer_start(struct weights_packer *t, size_t list, struct err *e)
{
	t->n = 0;
	if (mem_room((void **)&t->ids, &t->room[0], list, sizeof *t->ids, "weights", e) ||
		mem_room((void **)&t->spare, &t->room[1], list, sizeof *t->spare, "weights", e) ||
		mem_room((void **)&t->levels, &t->room[2], list, sizeof *t->levels, "weights", e) ||
		mem_room((void **)&t->slot, &t->room[3], list, sizeof *t->slot, "weights", e))
		return -1;
	memset(t->slot, -1, list * sizeof *t->slot);
	return 0;
}

uint8_t *weights_packer_levels(struct weights_packer *t, size_t place, uint32_t id)
{
	if (t->slot[place] < 0) {
		memset(t->levels[t->n], 0, PIXELS);
		t->slot[place] = (int32_t)t->n;
		t->ids[t->n] = (uint64_t)id << 32 | t->n;
		t->n++;
	}
	return t->levels[t->slot[place]];
}

/* Sorts by the bits from `shift` on, stably: one pass of a radix sort. */
static void sort_pass(const uint64_t *from, uint64_t *to, size_t n, int shift)
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

static void sort_ids(struct weights_packer *t, size_t gaussians)
{
	for (int shift = 0; shift < 32 && (gaussians - 1) >> shift; shift += 8) {
		uint64_t *sorted = t->spare;
		sort_pass(t->ids, sorted, t->n, 32 + shift);
		t->spare = t->ids;
		t->ids = sorted;
	}
}

int weights_packer_end(struct weights_packer *t, size_t gaussians, struct weights_pack *row, struct err *e)
{
	uint32_t before = 0;
	int bad = put_number(row, (uint32_t)t->n, e);

	if (t->n)
		sort_ids(t, gaussians);
	for (size_t i = 0; i < t->n && !bad; i++) {
		const uint32_t id = (uint32_t)(t->ids[i] >> 32), slot = (uint32_t)t->ids[i];
		bad = put_number(row, id - before, e) || put_gaussian(row, t->levels[slot], e);
		before = id;
	}
	return bad ? -1 : 0;
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
