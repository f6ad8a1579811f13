#include "splat/tile.h"

#include "base/mem.h"
#include "base/threads.h"

#include <math.h>
#include <omp.h>

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
 * slope y +- width sqrt(1 - (y/h)^2), h its half height; right is greatest at y = peak. */
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

/* The tiles `row` that the ellipse of lane l meets. */
static struct tile_span row_span(
	const struct tile_grid *g, const struct ellipse *shape, double x, double y, unsigned row)
{
	const double tall = shape->half_height;
	double low = clamp(row * TILE_SIZE + 0.5 - y, -tall, tall);
	double high = clamp((row + 1) * TILE_SIZE - 0.5 - y, -tall, tall);
	double y_right = clamp(shape->peak, low, high), y_left = clamp(-shape->peak, low, high);
	/* a thousandth of a pixel covers the rounding of the ends */
	int first = first_tile(x + shape->slope * y_left - ellipse_half(shape, y_left) - 1e-3, g->width);
	int last = last_tile(x + shape->slope * y_right + ellipse_half(shape, y_right) + 1e-3, g->width);

	if (first > last)
		return (struct tile_span){1, 0};
	return (struct tile_span){(uint16_t)first, (uint16_t)last};
}

/* Which of the two tiles from `left` on are in a span. */
static unsigned span_mask(struct tile_span span, unsigned left)
{
	return (unsigned)(span.first <= left && left <= span.last) |
	       (unsigned)(span.first <= left + 1 && left + 1 <= span.last) << 1;
}

static int cover_many(const struct tile_grid *g, const struct project_batch *b, int l, unsigned top,
	unsigned bottom, uint32_t *cover, struct tile_spans *spans, uint32_t *tally, struct err *e)
{
	const unsigned rows = bottom - top + 1;
	const struct ellipse shape = ellipse_make(b, l);

	if (mem_grow((void **)&spans->items, &spans->capacity, spans->n + rows + 1, sizeof *spans->items,
		    "tile spans", e))
		return -1;
	*cover = TILE_MANY | (uint32_t)spans->n;
	spans->items[spans->n++] = (struct tile_span){(uint16_t)top, (uint16_t)rows};
	for (unsigned row = top; row <= bottom; row++) {
		struct tile_span span = row_span(g, &shape, b->x[l], b->y[l], row);
		spans->items[spans->n++] = span;
		for (unsigned k = span.first; k <= span.last; k++)
			tally[row * (unsigned)g->columns + k]++;
	}
	return 0;
}

int tile_cover(const struct tile_grid *g, const struct project_batch *b, int l, uint32_t *cover,
	struct tile_spans *spans, uint32_t *tally, struct err *e)
{
	const unsigned left = (unsigned)b->columns[0][l] / TILE_SIZE,
		       right = (unsigned)b->columns[1][l] / TILE_SIZE;
	const unsigned top = (unsigned)b->rows[0][l] / TILE_SIZE,
		       bottom = (unsigned)b->rows[1][l] / TILE_SIZE;
	const unsigned more_columns = right - left, more_rows = bottom - top;

	if (more_columns > 1 || more_rows > 1)
		return cover_many(g, b, l, top, bottom, cover, spans, tally, e);
	unsigned mask = 1 | more_columns << 1 | more_rows << 2;
	if (more_columns & more_rows) {
		const struct ellipse shape = ellipse_make(b, l);
		mask = span_mask(row_span(g, &shape, b->x[l], b->y[l], top), left) |
		       span_mask(row_span(g, &shape, b->x[l], b->y[l], bottom), left) << 2;
	}
	*cover = top | left << TILE_COLUMN_BIT | mask << TILE_MASK_BIT;
	/* all four, without asking which: a wrong guess costs more */
	tally += top * (unsigned)g->columns + left;
	tally[0] += mask & 1;
	tally[1] += mask >> 1 & 1;
	tally[g->columns] += mask >> 2 & 1;
	tally[g->columns + 1] += mask >> 3;
	return 0;
}

/* Where the lists begin. */
static size_t place_lists(size_t *start, const struct tile_grid *g, const uint32_t *tallies, int tally_count)
{
	const size_t tiles = (size_t)g->columns * (size_t)g->rows;
	size_t sum = 0;

	for (size_t k = 0; k < tiles; k++) {
		start[k] = sum;
		for (int i = 0; i < tally_count; i++)
			sum += tallies[(size_t)i * tile_tallies(g) + k];
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

enum {
	AHEAD = 24, /* Gaussians to fetch before their use */
	APART = 32, /* between what two threads write all the time: more than a cache line */
};

/* Lists that are being filled, by one thread. */
struct filling {
	uint32_t *entries;
	size_t *next;	     /* (tiles) where each goes on; then where what goes nowhere is put */
	size_t nowhere;	     /* which of `next` that is */
	unsigned begin, end; /* the band's tile rows */
	unsigned columns;
};

static void fill_many(const struct filling *f, const struct tile_span *cover, uint32_t index)
{
	const unsigned top = cover->first, bottom = top + cover->last;

	for (unsigned row = top < f->begin ? f->begin : top; row < bottom && row < f->end; row++) {
		const struct tile_span span = cover[1 + row - top];
		size_t *to = f->next + (size_t)row * f->columns;
		for (unsigned k = span.first; k <= span.last; k++)
			f->entries[to[k]++] = index;
	}
}

static void fill_one(const struct filling *f, size_t tile, unsigned bit, uint32_t index)
{
	size_t *to = f->next + (bit ? tile : f->nowhere);

	f->entries[*to] = index;
	*to += bit;
}

static void fill_band(const struct filling *f, const struct order_item *order, size_t n,
	const uint32_t *covers, const struct tile_spans *spans)
{
	const unsigned low = (1 << TILE_COLUMN_BIT) - 1, height = f->end - f->begin;

	for (size_t i = 0; i < n; i++) {
		const uint32_t index = order[i].index, cover = covers[index];
		if (i + AHEAD < n)
			__builtin_prefetch(&covers[order[i + AHEAD].index]);
		if (cover & TILE_MANY) {
			fill_many(f, spans[index / TILE_BLOCK].items + (cover & ~TILE_MANY), index);
			continue;
		}
		const unsigned row = cover & low;
		const size_t tile = (size_t)row * f->columns + (cover >> TILE_COLUMN_BIT & low);
		/* rows outside the band wrap around to above its height */
		unsigned mask = cover >> TILE_MASK_BIT &
				((row - f->begin < height ? 3 : 0) | (row + 1 - f->begin < height ? 12 : 0));
		/* all four, as in tile_cover */
		fill_one(f, tile, mask & 1, index);
		fill_one(f, tile + 1, mask >> 1 & 1, index);
		fill_one(f, tile + f->columns, mask >> 2 & 1, index);
		fill_one(f, tile + f->columns + 1, mask >> 3 & 1, index);
	}
}

int tile_bin(struct tile_lists *t, const struct tile_grid *g, const struct order_item *order, size_t n,
	const uint32_t *covers, const struct tile_spans *spans, const uint32_t *tallies, int tally_count,
	struct err *e)
{
	const size_t tiles = (size_t)g->columns * (size_t)g->rows;
	const int threads = threads_available();
	const size_t spare = (size_t)threads * APART;

	/* behind the starts are the places where each list goes on while it is filled */
	if (mem_room((void **)&t->start, &t->start_capacity, 2 * tiles + 1 + spare, sizeof *t->start,
		    "tile lists", e))
		return -1;
	size_t *next = t->start + tiles + 1, all = place_lists(t->start, g, tallies, tally_count);
	if (mem_room((void **)&t->entries, &t->entries_capacity, all + spare, sizeof *t->entries,
		    "tile lists", e))
		return -1;
	memcpy(next, t->start, tiles * sizeof *next);
	for (size_t i = 0; i < spare; i++)
		next[tiles + i] = all + i;
#pragma omp parallel num_threads(threads)
	{
		const int part = omp_get_thread_num(), parts = omp_get_num_threads();
		const struct filling f = {t->entries, next, tiles + (size_t)part * APART,
			band_begin(t, g, part, parts), band_begin(t, g, part + 1, parts),
			(unsigned)g->columns};
		fill_band(&f, order, n, covers, spans);
	}
	return 0;
}

void tile_free(struct tile_lists *t)
{
	mem_free_all(t->start, t->entries);
	*t = (struct tile_lists){0};
}
