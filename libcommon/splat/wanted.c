#include "splat/wanted.h"

#include "base/mem.h"

#include <math.h>

/* Standard deviations to where a <= 1 falls below 1/255, sqrt(2 log 255) = 3.3290, rounded up. */
#define DEVIATIONS 3.33
/* Of the low pass, in pixels, sqrt(0.3), and what rounding may add. */
#define LOW_PASS (0.5478 * DEVIATIONS + 1)

static double length(const double *row)
{
	return sqrt(row[0] * row[0] + row[1] * row[1] + row[2] * row[2]);
}

/* A row of the Jacobian times the rotation is f / z (r_k - t r_2), t within the lens's limits; the Gaussian's
 * standard deviation along it is at most that length times its largest scale. */
static void find_reach(struct wanted *w, const struct project_lens *lens)
{
	const double focal[2] = {lens->fx, lens->fy};

	for (int k = 0; k < 2; k++) {
		const double t = fmax(fabs(lens->low[k]), fabs(lens->high[k]));
		w->reach[k] = DEVIATIONS * fabs(focal[k]) *
			      (length(lens->world_to_camera[k]) + t * length(lens->world_to_camera[2]));
	}
}

static size_t corner(const struct tile_grid *g, size_t column, size_t row)
{
	return row * ((size_t)g->columns + 1) + column;
}

/* Tiles first to last in both directions. */
static int meets(const struct wanted *w, const struct tile_grid *g, size_t left, size_t right, size_t top,
	size_t bottom)
{
	return w->sums[corner(g, right + 1, bottom + 1)] + w->sums[corner(g, left, top)] !=
	       w->sums[corner(g, left, bottom + 1)] + w->sums[corner(g, right + 1, top)];
}

int wanted_tile(const struct wanted *w, const struct tile_grid *g, size_t k)
{
	const size_t column = k % (size_t)g->columns, row = k / (size_t)g->columns;

	return w->is_all || meets(w, g, column, column, row, row);
}

int wanted_lane(const struct wanted *w, const struct tile_grid *g, const struct project_batch *b, int l)
{
	return w->is_all ||
	       meets(w, g, (size_t)b->columns[0][l] / TILE_SIZE, (size_t)b->columns[1][l] / TILE_SIZE,
		       (size_t)b->rows[0][l] / TILE_SIZE, (size_t)b->rows[1][l] / TILE_SIZE);
}

/* Tiles of the pixels from `low` to `high`, as far as the picture goes. Returns 0 where there are none; what
 * is not a number may be anywhere. */
static int find_tiles(double low, double high, int size, size_t *first, size_t *last)
{
	if (high < 0 || low > size)
		return 0;
	*first = low > 0 ? (size_t)low / TILE_SIZE : 0;
	*last = high < size - 1 ? (size_t)high / TILE_SIZE : (size_t)(size - 1) / TILE_SIZE;
	return *first <= *last;
}

int wanted_reach(const struct wanted *w, const struct tile_grid *g, const struct splats *s,
	const struct project_lens *lens, size_t i)
{
	const float *mean = s->means + 3 * i, *scale = s->scales + 3 * i;
	const double(*turn)[4] = lens->world_to_camera;
	size_t left, right, top, bottom;

	const double x = turn[0][0] * mean[0] + turn[0][1] * mean[1] + turn[0][2] * mean[2] + turn[0][3];
	const double y = turn[1][0] * mean[0] + turn[1][1] * mean[1] + turn[1][2] * mean[2] + turn[1][3];
	const double z = turn[2][0] * mean[0] + turn[2][1] * mean[1] + turn[2][2] * mean[2] + turn[2][3];
	if (z < 0)
		return 0;
	const float two = scale[0] > scale[1] ? scale[0] : scale[1], most = two > scale[2] ? two : scale[2];
	const double per_z = 1 / z, size = (double)most * per_z;
	const double centre_x = lens->fx * x * per_z + lens->cx, centre_y = lens->fy * y * per_z + lens->cy;
	const double reach_x = w->reach[0] * size + LOW_PASS, reach_y = w->reach[1] * size + LOW_PASS;
	return find_tiles(centre_x - reach_x, centre_x + reach_x, g->width, &left, &right) &&
	       find_tiles(centre_y - reach_y, centre_y + reach_y, g->height, &top, &bottom) &&
	       meets(w, g, left, right, top, bottom);
}

/* One more for each tile of a lane's rectangle, at its last corner. */
static void mark(struct wanted *w, const struct tile_grid *g, const struct project_batch *b, int l)
{
	for (int row = b->rows[0][l] / TILE_SIZE; row <= b->rows[1][l] / TILE_SIZE; row++)
		for (int column = b->columns[0][l] / TILE_SIZE; column <= b->columns[1][l] / TILE_SIZE;
			column++)
			w->sums[corner(g, (size_t)column + 1, (size_t)row + 1)] = 1;
}

static void mark_all(struct wanted *w, const struct tile_grid *g, const struct splats *s,
	const struct project_lens *lens, const struct kernels *kernels, const uint8_t *is_wanted)
{
	struct project_batch b __attribute__((aligned(64))) = {0};

	for (size_t i = 0; i < s->n;) {
		int lanes = 0;
		for (; i < s->n && lanes < PROJECT_LANES; i++)
			if (is_wanted[i] && project_take(&b, s, i, lanes))
				lanes++;
		kernels->project(lens, &b, lanes);
		for (int l = 0; l < lanes; l++)
			if (b.seen[l])
				mark(w, g, &b, l);
	}
}

int wanted_find(struct wanted *w, const struct tile_grid *g, const struct splats *s,
	const struct project_lens *lens, const struct kernels *kernels, const uint8_t *is_wanted,
	struct err *e)
{
	const size_t columns = (size_t)g->columns + 1, rows = (size_t)g->rows + 1;

	w->is_all = !is_wanted;
	if (w->is_all)
		return 0;
	if (mem_room((void **)&w->sums, &w->room, columns * rows, sizeof *w->sums, "tiles", e))
		return -1;
	memset(w->sums, 0, columns * rows * sizeof *w->sums);
	find_reach(w, lens);
	mark_all(w, g, s, lens, kernels, is_wanted);
	for (size_t row = 1; row < rows; row++)
		for (size_t column = 1; column < columns; column++)
			w->sums[corner(g, column, row)] += w->sums[corner(g, column - 1, row)] +
							   w->sums[corner(g, column, row - 1)] -
							   w->sums[corner(g, column - 1, row - 1)];
	return 0;
}

void wanted_free(struct wanted *w)
{
	free(w->sums);
	*w = (struct wanted){0};
}
