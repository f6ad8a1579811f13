#include "cmd/import/points.h"

#include "base/file.h"
#include "base/mem.h"
#include "formats/cameras/colmap.h"
#include "formats/splats/plyfile.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

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
	struct colmap_points p;
	struct err why;
	int bad = 0;

	if (colmap_points_read(&p, folder, &why)) {
		return why.code == ERR_SYSTEM ? err_set(e, why.code, "%s", why.message) : 0;
	}
	for (size_t i = 0; i < p.n && !bad; i++)
		bad = add(to, p.places + 3 * i, e);
	colmap_points_free(&p);
	return bad;
}

static int read_ply(struct points *to, struct file_map *map, struct err *e)
{
	struct plyfile f;
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
	plyfile_close(&f);
	return bad;
}

int points_read(float **points, size_t *n, const char *cameras, const double offset[3], struct err *e)
{
	static const char *const names[] = {"points3D.ply", "sparse_pc.ply", "input.ply"};
	struct points to = {.offset = offset};
	char *folder = file_is_dir(cameras) ? mem_strdup(cameras, e) : file_dir(cameras, e);
	int bad = !folder || (strcmp(cameras, "-") && read_colmap(&to, folder, e));

	for (size_t i = 0; !bad && !to.n && strcmp(cameras, "-") && i < sizeof names / sizeof *names; i++) {
		char *path = file_join(folder, names[i], "", e);
		struct file_map map = {0};
		struct err ignored;
		bad = !path;
		if (path && file_exists(path) && !file_map(path, &map, &ignored)) {
			bad = read_ply(&to, &map, e) != 0;
			file_unmap(&map);
		}
		free(path);
	}
	free(folder);
	*points = to.items;
	*n = to.n;
	return bad ? -1 : 0;
}
