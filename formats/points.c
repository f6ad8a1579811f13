#include "formats/points.h"

#include "base/file.h"
#include "base/little.h"
#include "base/mem.h"
#include "base/path.h"
#include "formats/plyfile.h"

#include <math.h>
#include <stdio.h>
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

/* A count; of each point an id, its place, a colour and an error, and a count of pairs of numbers and these.
 */
static int read_binary(struct points *to, const struct file_map *map, struct err *e)
{
	enum { FIXED = 51, PAIR = 8, PLACE = 8 };
	const unsigned char *p = map->data, *end = p + map->len;
	double at[3];

	for (p += map->len < 8 ? 0 : 8; end - p >= FIXED;) {
		const uint64_t pairs = little_get(p + FIXED - 8, 8);
		for (int k = 0; k < 3; k++) {
			const uint64_t bits = little_get(p + PLACE + 8 * k, 8);
			memcpy(&at[k], &bits, sizeof bits);
		}
		if (add(to, at, e))
			return -1;
		p += FIXED;
		if (pairs > (size_t)(end - p) / PAIR)
			return 0;
		p += pairs * PAIR;
	}
	return 0;
}

/* ID X Y Z ... in each line. */
static int read_text(struct points *to, const struct file_map *map, struct err *e)
{
	const char *line = (const char *)map->data, *end = line + map->len;
	char start[160];
	double at[3];

	for (; line < end; line++) {
		const char *newline = memchr(line, '\n', (size_t)(end - line));
		const size_t n = (size_t)((newline ? newline : end) - line);
		snprintf(start, sizeof start, "%.*s", (int)(n < sizeof start ? n : sizeof start - 1), line);
		if (sscanf(start, "%*s %lf %lf %lf", &at[0], &at[1], &at[2]) == 3 && add(to, at, e))
			return -1;
		line += n;
	}
	return 0;
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
	static const char *const names[] = {
		"points3D.bin", "points3D.txt", "points3D.ply", "sparse_pc.ply", "input.ply"};
	struct points to = {.offset = offset};
	char *folder = file_is_dir(cameras) ? mem_strdup(cameras, e) : file_dir(cameras, e);
	int bad = !folder;

	for (size_t i = 0; !bad && !to.n && strcmp(cameras, "-") && i < sizeof names / sizeof *names; i++) {
		char *path = file_join(folder, names[i], "", e);
		struct file_map map = {0};
		struct err ignored;
		bad = !path;
		if (path && file_exists(path) && !file_map(path, &map, &ignored)) {
			bad = (path_ends(path, ".bin")		? read_binary(&to, &map, e)
				      : path_ends(path, ".txt") ? read_text(&to, &map, e)
								: read_ply(&to, &map, e)) != 0;
			file_unmap(&map);
		}
		free(path);
	}
	free(folder);
	*points = to.items;
	*n = to.n;
	return bad ? -1 : 0;
}
