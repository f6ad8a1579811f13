#include "formats/cameras/colmap_points.h"

#include "base/file.h"
#include "base/little.h"
#include "base/mem.h"
#include "base/textfile.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int add(struct colmap_points *p, size_t *room, const double place[3], const double color[3],
	const char *path, struct err *e)
{
	size_t places = *room, colors = *room;

	for (int k = 0; k < 3; k++)
		if (!isfinite(place[k]) || !(color[k] >= 0 && color[k] <= 255))
			return err_file(e, path,
				"point %zu: its place is not finite, or its colour not within 0 to 255",
				p->n);
	if (mem_grow((void **)&p->places, &places, p->n + 1, 3 * sizeof *p->places, path, e) ||
		mem_grow((void **)&p->colors, &colors, p->n + 1, 3, path, e))
		return -1;
	*room = places < colors ? places : colors;
	for (size_t k = 0; k < 3; k++) {
		p->places[3 * p->n + k] = place[k];
		p->colors[3 * p->n + k] = (uint8_t)color[k];
	}
	p->n++;
	return 0;
}

/* How many, and for each: id (u64), place (3 f64), colour (3 u8), error (f64), how many views (u64) with 8
 * bytes each. */
enum { ENTRY = 8 + 24 + 3 + 8 + 8 };

static int read_binary(struct colmap_points *p, const char *path, struct err *e)
{
	struct file_map map;
	size_t room = 0, at = 8;
	int bad = 0;

	if (file_map(path, &map, e))
		return -1;
	const uint64_t n = map.len < 8 ? 0 : little_get(map.data, 8);
	for (uint64_t i = 0; i < n && !bad; i++) {
		double place[3], color[3];
		uint64_t views = 0;
		const unsigned char *entry = map.data + at;
		if (map.len - at >= ENTRY)
			views = little_get(entry + ENTRY - 8, 8);
		if (map.len - at < ENTRY || views > (map.len - at - ENTRY) / 8) {
			bad = err_file(e, path, "the file ends at offset %zu, within point %llu of %llu",
				map.len, (unsigned long long)i, (unsigned long long)n);
			break;
		}
		for (size_t k = 0; k < 3; k++) {
			place[k] = little_get_f64(entry + 8 + 8 * k);
			color[k] = entry[32 + k];
		}
		bad = add(p, &room, place, color, path, e);
		at += ENTRY + 8 * (size_t)views;
	}
	if (!bad && map.len < 8)
		bad = err_file(e, path, "%zu bytes, too short for a COLMAP file", map.len);
	file_unmap(&map);
	return bad;
}

/* Lines of POINT3D_ID X Y Z R G B ERROR and more. */
static int read_text(struct colmap_points *p, const char *path, struct err *e)
{
	char *text = NULL;
	size_t length, room = 0;
	long number = 0;
	int bad = textfile_read(path, &text, &length, e);

	for (char *line = text; !bad && *line; number++) {
		char *end = line + strcspn(line, "\n"), *next = end + (*end != 0);
		double v[7];
		*end = 0;
		line += strspn(line, " \t\r");
		int fields = 0;
		for (char *after = line; *line && *line != '#' && fields < 7; fields++) {
			v[fields] = strtod(line, &after);
			if (after == line)
				break;
			line = after;
		}
		if (fields == 7)
			bad = add(p, &room, v + 1, v + 4, path, e);
		else if (*line && *line != '#')
			bad = err_set(e, ERR_FORMAT, "%s:%ld: not 'ID X Y Z R G B ERROR'", path, number + 1);
		line = next;
	}
	free(text);
	return bad;
}

int colmap_points_read(struct colmap_points *p, const char *dir, struct err *e)
{
	static const char *const suffixes[] = {".bin", ".txt"};
	int bad = 0;

	*p = (struct colmap_points){0};
	for (int i = 0; i < 2 && !bad && !p->n; i++) {
		char *path = file_join(dir, "points3D", suffixes[i], e);
		bad = path ? 0 : -1;
		if (path && file_exists(path))
			bad = i ? read_text(p, path, e) : read_binary(p, path, e);
		free(path);
	}
	if (bad)
		colmap_points_free(p);
	return bad ? -1 : 0;
}

void colmap_points_free(struct colmap_points *p)
{
	free(p->places);
	free(p->colors);
	*p = (struct colmap_points){0};
}
