#include "splat/tile.h"

#include "base/mem.h"
#include "base/threads.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

struct tile_grid tile_grid(int width, int height)
{
	return (struct tile_grid){
		width, height, (width + TILE_SIZE - 1) / TILE_SIZE, (height + TILE_SIZE - 1) / TILE_SIZE};
}

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

static struct ellipse ellipse_make(const struct project_batch *b, int l)
{
	double l11 = b->l11[l], l21 = b->l21[l], l22 = b->l22[l], half_height = b->radius[l] / l22;

	return (struct ellipse){.slope = -l21 / l11,
		.half_height = half_height,
		.width = b->radius[l] / l11,
		.peak = -l21 * half_height / sqrt(l21 * l21 + l22 * l22)};
}

static double ellipse_half(const struct ellipse *l, double y)
{
	double r = y / l->half_height, s = 1 - r * r;

	return s > 0 ? l->width * sqrt(s) : 0;
}

static void count(const struct tile_grid *g, unsigned row, struct tile_span span, uint32_t *tally)
{
	for (unsigned k = span.first; k <= span.last; k++)
		tally[row * (unsigned)g->columns + k]++;
}

int tile_cover(const struct tile_grid *g, const struct project_batch *b, int l, struct tile_cover *cover,
	struct tile_spans *spans, uint32_t *tally, struct err *e)
{
	const unsigned left = (unsigned)b->columns[0][l] / TILE_SIZE,
		       right = (unsigned)b->columns[1][l] / TILE_SIZE;
	const unsigned top = (unsigned)b->rows[0][l] / TILE_SIZE,
		       bottom = (unsigned)b->rows[1][l] / TILE_SIZE;
	const struct tile_span box = {(uint16_t)left, (uint16_t)right};

	*cover = (struct tile_cover){.top = top, .rows = bottom - top + 1, .is_same = 1, .span = box};
	if (top == bottom || left == right) {
		for (unsigned row = top; row <= bottom; row++)
			count(g, row, box, tally);
		return 0;
	}
	if (mem_grow((void **)&spans->items, &spans->capacity, spans->n + cover->rows, sizeof *spans->items,
		    "tile spans", e))
		return -1;
	cover->is_same = 0;
	cover->at = (uint32_t)spans->n;
	const struct ellipse shape = ellipse_make(b, l);
	const double x = b->x[l], y = b->y[l], tall = shape.half_height;
	for (unsigned row = top; row <= bottom; row++) {
		double low = clamp(row * TILE_SIZE + 0.5 - y, -tall, tall);
		double high = clamp((row + 1) * TILE_SIZE - 0.5 - y, -tall, tall);
		double y_right = clamp(shape.peak, low, high), y_left = clamp(-shape.peak, low, high);
		/* a thousandth of a pixel covers the rounding of the ends */
		int first =
			first_tile(x + shape.slope * y_left - ellipse_half(&shape, y_left) - 1e-3, g->width);
		int last =
			last_tile(x + shape.slope * y_right + ellipse_half(&shape, y_right) + 1e-3, g->width);
		struct tile_span span = {1, 0};
		if (first <= last)
			span = (struct tile_span){(uint16_t)first, (uint16_t)last};
		spans->items[spans->n++] = span;
		count(g, row, span, tally);
	}
	return 0;
}

/* Where the lists begin. */
static size_t place_lists(size_t *start, size_t tiles, const uint32_t *tallies, int tally_count)
{
	size_t sum = 0;

	for (size_t k = 0; k < tiles; k++) {
		start[k] = sum;
		for (int i = 0; i < tally_count; i++)
			sum += tallies[(size_t)i * tiles + k];
	}
	start[tiles] = sum;
	return sum;
}

/* Of `parts` bands of tile rows with about equally many entries, where band `part` begins. */
static unsigned band_begin(const struct tile_lists *t, const struct tile_grid *g, int part, int parts)
{
	size_t columns = (size_t)g->columns, all = t->start[columns * (size_t)g->rows];
	unsigned row = 0;

	while (row < (unsigned)g->rows && t->start[row * columns] < all / (size_t)parts * (size_t)part)
		row++;
	return part == parts ? (unsigned)g->rows : row;
}

enum { AHEAD = 24 }; /* Gaussians to fetch before their use */

/* Appends to the lists of tile rows `begin` to `end` - 1; next (tiles) is where each goes on. */
static void fill_band(uint32_t *entries, size_t *next, const struct tile_grid *g, unsigned begin,
	unsigned end, const struct order_item *order, size_t n, const struct tile_cover *covers,
	const struct tile_spans *spans)
{
	for (size_t i = 0; i < n; i++) {
		const uint32_t index = order[i].index;
		const struct tile_cover cover = covers[index];
		unsigned row = cover.top, bottom = cover.top + cover.rows;
		if (i + AHEAD < n)
			__builtin_prefetch(&covers[order[i + AHEAD].index]);
		if (bottom > end)
			bottom = end;
		for (row = row < begin ? begin : row; row < bottom; row++) {
			struct tile_span span =
				cover.is_same ? cover.span
					      : spans[index / TILE_BLOCK].items[cover.at + row - cover.top];
			size_t *to = next + (size_t)row * (size_t)g->columns;
			for (unsigned k = span.first; k <= span.last; k++)
				entries[to[k]++] = index;
		}
	}
}

int tile_bin(struct tile_lists *t, const struct tile_grid *g, const struct order_item *order, size_t n,
	const struct tile_cover *covers, const struct tile_spans *spans, const uint32_t *tallies,
	int tally_count, struct err *e)
{
	const size_t tiles = (size_t)g->columns * (size_t)g->rows;
	const int threads = threads_available();

	/* the second half is where each list goes on while it is filled */
	if (mem_room(
		    (void **)&t->start, &t->start_capacity, 2 * tiles + 1, sizeof *t->start, "tile lists", e))
		return -1;
	size_t *next = t->start + tiles + 1, all = place_lists(t->start, tiles, tallies, tally_count);
	if (mem_room((void **)&t->entries, &t->entries_capacity, all, sizeof *t->entries, "tile lists", e))
		return -1;
	memcpy(next, t->start, tiles * sizeof *next);
#pragma omp parallel num_threads(threads)
	{
		const int part = omp_get_thread_num(), parts = omp_get_num_threads();
		fill_band(t->entries, next, g, band_begin(t, g, part, parts),
			band_begin(t, g, part + 1, parts), order, n, covers, spans);
	}
	return 0;
}

void tile_free(struct tile_lists *t)
{
	free(t->start);
	free(t->entries);
	*t = (struct tile_lists){0};
}
