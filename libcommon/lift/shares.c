#include "lift/shares.h"

#include "base/mem.h"
#include "base/ones.h"
#include "lift/marks.h"
#include "mask/bits.h"
#include "splat/backproject.h"

/* A view's weights by tiles, made ready to be summed over masks: levels in place of their differences, where
 * those of each entry begin, and the sum of them. */
struct tile_levels {
	const struct view_tiles *tiles;
	size_t *begin;	 /* (entries) */
	uint8_t *levels; /* weights in 1/255 */
	uint16_t *total; /* (entries) at most 64 times 255 */
};

static void tile_levels_free(struct tile_levels *l)
{
	mem_free_all(l->begin, l->levels, l->total);
	*l = (struct tile_levels){0};
}

/* The levels of so many differences; returns their sum. */
static uint32_t take_entry(const uint8_t *restrict differences, uint8_t *restrict levels, size_t n)
{
	uint32_t total = 0;
	uint8_t level = 0;

	for (size_t k = 0; k < n; k++) {
		level = (uint8_t)(level + differences[k]);
		levels[k] = level;
		total += level;
	}
	return total;
}

/* The entries of a row of tiles. */
static void take_row(const struct tile_levels *l, int row)
{
	const struct view_tiles *t = l->tiles;
	const size_t first = (size_t)row * (size_t)t->across;
	size_t at = t->level_begin[row];

	for (size_t i = t->begin[first], end = t->begin[first + (size_t)t->across]; i < end; i++) {
		const size_t n = ones(view_tiles_map(t, i));
		l->begin[i] = at;
		l->total[i] = (uint16_t)take_entry(t->levels + at, l->levels + at, n);
		at += n;
	}
}

static int tile_levels_make(struct tile_levels *l, const struct view_tiles *t, struct err *e)
{
	const size_t entries = t->begin[(size_t)t->across * (size_t)t->down];

	*l = (struct tile_levels){t, mem_alloc(entries, sizeof *l->begin, "weights", e),
		mem_alloc(t->level_begin[t->down], 1, "weights", e),
		mem_alloc(entries, sizeof *l->total, "weights", e)};
	if (!l->begin || !l->levels || !l->total) {
		tile_levels_free(l);
		return -1;
	}
#pragma omp parallel for schedule(dynamic)
	for (int row = 0; row < t->down; row++)
		take_row(l, row);
	return 0;
}

/* The sum over the pixels of a tile that have a bit, of an entry's levels. */
static uint32_t tile_levels_sum(const struct tile_levels *l, size_t entry, uint64_t bits)
{
	const uint64_t map = view_tiles_map(l->tiles, entry);
	uint32_t sum = 0;

	if (!(map & bits))
		return 0;
	if (!(map & ~bits))
		return l->total[entry];
	const uint8_t *level = l->levels + l->begin[entry];
	for (uint64_t left = map; left; left &= left - 1)
		sum += *level++ & -(uint32_t)(bits >> __builtin_ctzll(left) & 1);
	return sum;
}

/* One thread's: sums of all Gaussians, and which of them are above 0. All 0 between masks. */
struct sums {
	uint64_t *marks;
	uint64_t *levels; /* (N) from tiles: in 1/255; else NULL */
	float *sum;	  /* (N) from rows, and */
	float *image;	  /* (P) the mean of the masks */
};

static int sums_make(struct sums *s, const struct view_matrix *w, struct err *e)
{
	*s = (struct sums){.marks = marks_make(w->gaussians, e)};
	if (!s->marks)
		return -1;
	if (w->tiles) {
		s->levels = mem_zalloc(w->gaussians, sizeof *s->levels, "masks", e);
		return s->levels ? 0 : -1;
	}
	s->sum = mem_zalloc(w->gaussians, sizeof *s->sum, "masks", e);
	s->image = mem_alloc(w->rows.pixels, sizeof *s->image, "masks", e);
	return s->sum && s->image ? 0 : -1;
}

static void sums_free(struct sums *s)
{
	mem_free_all(s->marks, s->levels, s->sum, s->image);
}

/* Pixels in their order. */
static void add_image(struct sums *s, const struct view_weights *w)
{
	for (size_t p = 0; p < w->pixels; p++) {
		if (!(s->image[p] > 0))
			continue;
		for (int64_t k = w->indptr[p]; k < w->indptr[p + 1]; k++) {
			const size_t i = (size_t)w->index[k];
			s->sum[i] += w->weight[k] * s->image[p];
			if (s->sum[i] > 0)
				marks_add(s->marks, i);
		}
	}
}

static void add_rows(struct sums *s, const struct view_matrix *w, const struct shares_masks *m)
{
	const size_t pixels = w->rows.pixels, tiles = bits_tiles(w->height, w->width);

	memset(s->image, 0, pixels * sizeof *s->image);
	for (size_t k = 0; k < m->count; k++)
		bits_add_tiles(m->bits + k * tiles, w->height, w->width, s->image);
	for (size_t p = 0; p < pixels && m->count > 1; p++)
		s->image[p] /= (float)m->count;
	add_image(s, &w->rows);
}

/* A mask's bits of one tile, not all 0. */
static void add_tile(struct sums *s, const struct tile_levels *of, size_t tile, uint64_t bits)
{
	const struct view_tiles *t = of->tiles;

	for (size_t i = t->begin[tile]; i < t->begin[tile + 1]; i++) {
		const uint32_t sum = tile_levels_sum(of, i, bits);
		if (!sum)
			continue;
		s->levels[t->ids[i]] += sum;
		marks_add(s->marks, (size_t)t->ids[i]);
	}
}

static void add_tiles(struct sums *s, const struct tile_levels *of, const struct shares_masks *m)
{
	const size_t tiles = (size_t)of->tiles->across * (size_t)of->tiles->down;

	for (size_t k = 0; k < m->count; k++)
		for (size_t tile = 0; tile < tiles; tile++)
			if (m->bits[k * tiles + tile])
				add_tile(s, of, tile, m->bits[k * tiles + tile]);
}

/* Moves the sums into a row, in the order of the Gaussians. */
static void take(struct sums *s, size_t gaussians, size_t masks, struct shares *row)
{
	row->n = marks_take(s->marks, gaussians, row->index);
	for (size_t k = 0; k < row->n; k++) {
		const size_t i = (size_t)row->index[k];
		if (s->levels) {
			row->share[k] = (float)((double)s->levels[i] / (255 * (double)masks));
			s->levels[i] = 0;
		} else {
			row->share[k] = s->sum[i];
			s->sum[i] = 0;
		}
	}
}

static int make_row(struct shares *row, struct sums *s, const struct view_matrix *w,
	const struct tile_levels *levels, const struct shares_masks *m, struct err *e)
{
	if (w->tiles)
		add_tiles(s, levels, m);
	else
		add_rows(s, w, m);
	const size_t n = marks_count(s->marks, w->gaussians);
	*row = (struct shares){.index = mem_alloc(n, sizeof *row->index, "masks", e),
		.share = mem_alloc(n, sizeof *row->share, "masks", e)};
	if (!row->index || !row->share)
		return -1;
	take(s, w->gaussians, m->count, row);
	return 0;
}

static int make_rows(struct shares *rows, const struct view_matrix *w, const struct tile_levels *levels,
	const struct shares_masks *masks, size_t count, struct err *e)
{
	int failed = 0;

#pragma omp parallel reduction(| : failed) if (count > 1)
	{
		struct err mine;
		SCOPED_BY(sums_free) struct sums s = {0};
		failed = sums_make(&s, w, &mine) != 0;
#pragma omp for schedule(dynamic)
		for (size_t k = 0; k < count; k++)
			failed = failed || make_row(&rows[k], &s, w, levels, &masks[k], &mine);
		if (failed) {
#pragma omp critical
			*e = mine;
		}
	}
	return failed ? -1 : 0;
}

static int weigh_tiles(float *weight, size_t gaussians, const struct tile_levels *levels, struct err *e)
{
	const struct view_tiles *t = levels->tiles;
	SCOPED uint64_t *sum = mem_zalloc(gaussians, sizeof *sum, "views", e);

	if (!sum)
		return -1;
	for (size_t i = 0, n = t->begin[(size_t)t->across * (size_t)t->down]; i < n; i++)
		sum[t->ids[i]] += levels->total[i];
	for (size_t i = 0; i < gaussians; i++)
		weight[i] = (float)((double)sum[i] / 255);
	return 0;
}

static int weigh_rows(float *weight, const struct view_weights *w, struct err *e)
{
	SCOPED double *sum = mem_zalloc(w->gaussians, sizeof *sum, "views", e);

	if (!sum)
		return -1;
	backproject_weight(w, sum);
	for (size_t i = 0; i < w->gaussians; i++)
		weight[i] = (float)sum[i];
	return 0;
}

int shares_make(float *weight, struct shares *rows, const struct view_matrix *w,
	const struct shares_masks *masks, size_t count, struct err *e)
{
	SCOPED_BY(tile_levels_free) struct tile_levels levels = {0};

	for (size_t k = 0; k < count; k++)
		rows[k] = (struct shares){0};
	const int bad = (w->tiles ? tile_levels_make(&levels, w->tiles, e) ||
						weigh_tiles(weight, w->gaussians, &levels, e)
				  : weigh_rows(weight, &w->rows, e)) ||
			make_rows(rows, w, &levels, masks, count, e);
	for (size_t k = 0; k < count && bad; k++)
		shares_free(&rows[k]);
	return bad ? -1 : 0;
}

void shares_free(struct shares *row)
{
	mem_free_all(row->index, row->share);
	*row = (struct shares){0};
}
