#include "splat/tile.h"

#include "base/mem.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>

/* Tiles first to last of one tile row. */
struct span {
	uint32_t entry;
	uint16_t row, first, last;
};

/* One task's Gaussians: their spans in order, and how many entries each tile gets from them. */
struct share {
	size_t begin, end;
	struct span *spans;
	size_t count, capacity;
	uint32_t
		*tally; /* (tiles); then where the share's next entry of a tile goes, less the tile's start */
	struct err err;
};

/* The tile of the first pixel centre at or after x, and of the last at or before it; within [0, size). */
static int first_tile(double x, int size)
{
	double pixel = x - 0.5;

	if (!(pixel > 0))
		return 0;
	if (pixel > size - 1)
		return (size - 1) / TILE_SIZE + 1;
	int whole = (int)pixel;
	return (whole + (whole < pixel)) / TILE_SIZE;
}

static int last_tile(double x, int size)
{
	double pixel = x - 0.5;

	return !(pixel >= 0) ? -1 : pixel >= size ? (size - 1) / TILE_SIZE : (int)pixel / TILE_SIZE;
}

static double clamp(double x, double low, double high)
{
	return x < low ? low : x > high ? high : x;
}

/* The ellipse's reach in x over the rows y_low to y_high (offsets from its centre). At height y it spans
 * slope y +- width sqrt(1 - (y/h)^2), h its half height; right is greatest at y = peak and falls away on both
 * sides. */
struct ellipse {
	double slope, width, half_height, peak;
};

static void ellipse_make(struct ellipse *l, const struct projected *p)
{
	l->slope = -p->l21 / p->l11;
	l->half_height = p->radius / p->l22;
	l->width = p->radius / p->l11;
	l->peak = -p->l21 * l->half_height / sqrt(p->l21 * p->l21 + p->l22 * p->l22);
}

static double ellipse_half(const struct ellipse *l, double y)
{
	double r = y / l->half_height, s = 1 - r * r;

	return s > 0 ? l->width * sqrt(s) : 0;
}

static int add_spans(
	struct share *share, const struct projected *p, uint32_t entry, int width, int height, int columns)
{
	int top = first_tile(p->y - p->half_height, height),
	    bottom = last_tile(p->y + p->half_height, height);
	int left = first_tile(p->x - p->half_width, width), right = last_tile(p->x + p->half_width, width);
	struct ellipse l;

	if (top > bottom || left > right)
		return 0;
	if (mem_grow((void **)&share->spans, &share->capacity, share->count + (size_t)(bottom - top) + 1,
		    sizeof *share->spans, "tile spans", &share->err))
		return -1;
	ellipse_make(&l, p);
	for (int row = top; row <= bottom; row++) {
		int first = left, last = right;
		if (top < bottom && left < right) {
			double low = clamp(row * TILE_SIZE + 0.5 - p->y, -l.half_height, l.half_height);
			double high =
				clamp((row + 1) * TILE_SIZE - 0.5 - p->y, -l.half_height, l.half_height);
			double y_right = clamp(l.peak, low, high), y_left = clamp(-l.peak, low, high);
			/* a thousandth of a pixel covers the rounding of the ends */
			first = first_tile(p->x + l.slope * y_left - ellipse_half(&l, y_left) - 1e-3, width);
			last = last_tile(p->x + l.slope * y_right + ellipse_half(&l, y_right) + 1e-3, width);
		}
		if (first > last)
			continue;
		share->spans[share->count++] =
			(struct span){entry, (uint16_t)row, (uint16_t)first, (uint16_t)last};
		for (int k = first; k <= last; k++)
			share->tally[row * columns + k]++;
	}
	return 0;
}

/* From tallies to places: each tile's entries come share after share, so that they stay front to back. */
static int place_entries(struct tile_lists *t, struct share *shares, int share_count, struct err *e)
{
	size_t tiles = (size_t)t->columns * (size_t)t->rows, sum = 0;

	for (size_t k = 0; k < tiles; k++) {
		size_t here = 0;
		t->start[k] = sum;
		for (int i = 0; i < share_count; i++) {
			uint32_t tally = shares[i].tally[k];
			shares[i].tally[k] = (uint32_t)here;
			here += tally;
		}
		sum += here;
	}
	t->start[tiles] = sum;
	t->entries = mem_alloc(sum, sizeof *t->entries, "tile lists", e);
	if (!t->entries)
		return -1;
#pragma omp parallel for schedule(static, 1)
	for (int i = 0; i < share_count; i++) {
		struct share *share = &shares[i];
		for (size_t k = 0; k < share->count; k++) {
			const struct span *span = &share->spans[k];
			for (int column = span->first; column <= span->last; column++) {
				size_t tile = (size_t)span->row * (size_t)t->columns + (size_t)column;
				t->entries[t->start[tile] + share->tally[tile]++] = span->entry;
			}
		}
	}
	return 0;
}

int tile_build(
	struct tile_lists *t, const struct projected *p, size_t n, int width, int height, struct err *e)
{
	int share_count = omp_get_max_threads(), bad = 0;
	int columns = (width + TILE_SIZE - 1) / TILE_SIZE, rows = (height + TILE_SIZE - 1) / TILE_SIZE;
	size_t tiles = (size_t)columns * (size_t)rows;

	*t = (struct tile_lists){.columns = columns, .rows = rows};
	t->start = mem_alloc(tiles + 1, sizeof *t->start, "tile lists", e);
	struct share *shares = mem_zalloc((size_t)share_count, sizeof *shares, "tile lists", e);
	bad = !t->start || !shares;
	for (int i = 0; !bad && i < share_count; i++) {
		shares[i].begin = n / (size_t)share_count * (size_t)i;
		shares[i].end = i + 1 < share_count ? n / (size_t)share_count * (size_t)(i + 1) : n;
		shares[i].tally = mem_zalloc(tiles, sizeof *shares[i].tally, "tile lists", e);
		bad = !shares[i].tally;
	}
	if (bad)
		goto done;
#pragma omp parallel for schedule(static, 1)
	for (int i = 0; i < share_count; i++)
		for (size_t k = shares[i].begin; k < shares[i].end; k++)
			if (add_spans(&shares[i], &p[k], (uint32_t)k, width, height, columns))
				break;
	for (int i = 0; !bad && i < share_count; i++)
		if (shares[i].err.code) {
			*e = shares[i].err;
			bad = 1;
		}
	bad = bad || place_entries(t, shares, share_count, e);
done:
	for (int i = 0; shares && i < share_count; i++) {
		free(shares[i].spans);
		free(shares[i].tally);
	}
	free(shares);
	if (bad)
		tile_free(t);
	return bad ? -1 : 0;
}

void tile_free(struct tile_lists *t)
{
	free(t->start);
	free(t->entries);
	*t = (struct tile_lists){0};
}
