#include "cmd/import/import.h"

#include "base/mem.h"
#include "base/quantile.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>

/* Of those that are looked up, and how few of either tell nothing. */
enum { SAMPLES = 20000, LEAST = 100, PARTS = 20, HALF = 1 << 20 };

/* Space in cubes: points' are numbered by x, y and z. */
struct grid {
	float middle[3];
	double side;
};

static uint64_t cube_at(const struct grid *g, const float *point, int dx, int dy, int dz)
{
	const int step[3] = {dx, dy, dz};
	uint64_t cube = 0;

	for (int k = 0; k < 3; k++) {
		const double at = floor(((double)point[k] - (double)g->middle[k]) / g->side) + step[k];
		cube = cube << 21 | (uint64_t)(int64_t)(fmin(fmax(at, 1 - HALF), HALF - 1) + HALF);
	}
	return cube;
}

static int by_number(const void *a, const void *b)
{
	const uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;

	return (x > y) - (x < y);
}

/* The share of points that have one of the others in their cube or one beside it. */
static int find_share(const struct grid *g, const float *points, size_t n, const float *others, size_t m,
	double *share, struct err *e)
{
	const size_t step = (n + SAMPLES - 1) / SAMPLES;
	SCOPED uint64_t *cubes = mem_alloc(m, sizeof *cubes, "points", e);
	size_t near = 0, all = 0;

	if (!cubes)
		return -1;
	for (size_t i = 0; i < m; i++)
		cubes[i] = cube_at(g, others + 3 * i, 0, 0, 0);
	qsort(cubes, m, sizeof *cubes, by_number);
	for (size_t i = 0; i < n; i += step, all++) {
		int found = 0;
		for (int c = 0; c < 27 && !found; c++) {
			const uint64_t cube = cube_at(g, points + 3 * i, c / 9 - 1, c / 3 % 3 - 1, c % 3 - 1);
			found = bsearch(&cube, cubes, m, sizeof *cubes, by_number) != NULL;
		}
		near += (size_t)found;
	}
	*share = fmax(*share, (double)near / (double)all);
	return 0;
}

/* The points' middle, and cubes of a part of the distance from it that half of them have. */
static int make_grid(struct grid *g, const float *points, size_t n, struct err *e)
{
	SCOPED struct quantile_item *items = mem_alloc(n, sizeof *items, "points", e);

	for (int k = 0; k < 4 && items; k++) {
		for (size_t i = 0; i < n; i++) {
			const float *p = points + 3 * i;
			double squares = 0;
			for (int j = 0; j < 3; j++)
				squares += ((double)p[j] - (double)g->middle[j]) *
					   ((double)p[j] - (double)g->middle[j]);
			items[i] = (struct quantile_item){k < 3 ? (double)p[k] : sqrt(squares), 1};
		}
		const double half = quantile_weighted(items, n, 0.5);
		if (k < 3)
			g->middle[k] = (float)half;
		else
			g->side = half / PARTS;
	}
	return items ? 0 : -1;
}

int point_frame_find(double *share, const struct scene *s, const char *cameras, struct err *e)
{
	const float *means = s->splats.means;
	const size_t m = s->splats.n;
	struct grid g = {0};
	float *points;
	size_t n;

	*share = 1;
	int bad = points_read(&points, &n, cameras, s->offset, e);
	if (!bad && n >= LEAST && m >= LEAST) {
		bad = make_grid(&g, points, n, e);
		if (!bad && g.side > 0) {
			*share = 0;
			bad = find_share(&g, points, n, means, m, share, e) ||
			      find_share(&g, means, m, points, n, share, e);
		}
	}
	free(points);
	return bad ? -1 : 0;
}
