#include "cmd/import/import.h"

#include "base/compare.h"
#include "base/file.h"
#include "base/mem.h"
#include "base/quantile.h"
#include "formats/cameras/colmap.h"
#include "formats/splats/plyfile.h"

#include <math.h>
#include <stdint.h>

struct points {
	float *items; /* (n,3) */
	size_t n, capacity;
	const double *offset;
};

static int add(struct points *to, const double *at, struct err *e)
{
	if (!isfinite(at[0] + at[1] + at[2]))
		return 0;
	if (mem_grow((void **)&to->items, &to->capacity, to->n + 1, 3 * sizeof *to->items, "points", e))
		return -1;
	for (int k = 0; k < 3; k++)
		to->items[3 * to->n + (size_t)k] = (float)(at[k] - to->offset[k]);
	to->n++;
	return 0;
}

static int read_colmap(struct points *to, const char *folder, struct err *e)
{
	SCOPED_BY(colmap_points_free) struct colmap_points p = {0};
	struct err why;
	int bad = 0;

	if (colmap_points_read(&p, folder, &why))
		return why.code == ERR_SYSTEM ? err_set(e, why.code, "%s", why.message) : 0;
	for (size_t i = 0; i < p.n && !bad; i++)
		bad = add(to, p.places + 3 * i, e);
	return bad;
}

static int read_ply(struct points *to, struct file_map *map, struct err *e)
{
	SCOPED_BY(plyfile_close) struct plyfile f = {0};
	struct err ignored;
	double row[64];
	int bad = 0;

	if (plyfile_open(&f, "points", map, &ignored))
		return 0;
	const struct plyfile_element *vertex = f.n ? &f.elements[0] : NULL;
	const long x = vertex ? plyfile_property(vertex, "x") : -1,
		   y = x < 0 ? -1 : plyfile_property(vertex, "y"),
		   z = y < 0 ? -1 : plyfile_property(vertex, "z");
	for (size_t i = 0; z >= 0 && vertex->n <= 64 && !bad && i < vertex->rows; i++) {
		if (plyfile_row(&f, vertex, i, row, &ignored))
			break;
		bad = add(to, (const double[]){row[x], row[y], row[z]}, e);
	}
	return bad;
}

int points_read(float **points, size_t *n, const char *cameras, const double offset[3], struct err *e)
{
	static const char *const names[] = {"points3D.ply", "sparse_pc.ply", "input.ply"};
	struct points to = {.offset = offset};
	SCOPED char *folder = file_is_dir(cameras) ? mem_strdup(cameras, e) : file_dir(cameras, e);
	int bad = !folder || (strcmp(cameras, "-") && read_colmap(&to, folder, e));

	for (size_t i = 0; !bad && !to.n && strcmp(cameras, "-") && i < sizeof names / sizeof *names; i++) {
		SCOPED char *path = file_join(folder, names[i], "", e);
		struct file_map map = {0};
		struct err ignored;
		bad = !path;
		if (path && file_exists(path) && !file_map(path, &map, &ignored)) {
			bad = read_ply(&to, &map, e) != 0;
			file_unmap(&map);
		}
	}
	*points = to.items;
	*n = to.n;
	return bad ? -1 : 0;
}

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
	qsort(cubes, m, sizeof *cubes, compare_u64);
	for (size_t i = 0; i < n; i += step, all++) {
		int found = 0;
		for (int c = 0; c < 27 && !found; c++) {
			const uint64_t cube = cube_at(g, points + 3 * i, c / 9 - 1, c / 3 % 3 - 1, c % 3 - 1);
			found = bsearch(&cube, cubes, m, sizeof *cubes, compare_u64) != NULL;
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
	SCOPED float *points = NULL;
	size_t n;

	*share = 1;
	if (points_read(&points, &n, cameras, s->offset, e))
		return -1;
	if (n < LEAST || m < LEAST)
		return 0;
	if (make_grid(&g, points, n, e))
		return -1;
	if (!(g.side > 0))
		return 0;
	*share = 0;
	return find_share(&g, points, n, means, m, share, e) || find_share(&g, means, m, points, n, share, e);
}
