#include "formats/cameras/colmap_private.h"

#include "base/file.h"
#include "base/little.h"
#include "base/mem.h"
#include "base/path.h"
#include "geom/lens.h"
#include "geom/views.h"

#include <math.h>

/* A place in a binary file. */
struct cursor {
	const char *path;
	struct file_map map;
	size_t at;
};

int colmap_set_camera(struct colmap_entry *c, const struct lens_model *m, double width, double height,
	const double *params, const char *path, struct err *e)
{
	const int n = lens_model_parameters(m), focals = lens_model_focals(m);
	struct lens lens = {.model = m};

	for (int i = 0; i < n; i++)
		if (!isfinite(lens.parameters[i] = params[i]))
			return err_file(
				e, path, "camera %lu: parameter %d is not finite", (unsigned long)c->id, i);
	if (view_set_size(&c->camera, width, height))
		return err_file(e, path, "camera %lu: size %gx%g is not whole numbers in 1 to 65536",
			(unsigned long)c->id, width, height);
	lens.width = c->camera.width;
	lens.height = c->camera.height;
	c->camera.fx = params[0];
	c->camera.fy = params[focals - 1];
	c->camera.cx = params[focals];
	c->camera.cy = params[focals + 1];
	if (lens_is_distorted(&lens))
		c->camera.lens = lens;
	return 0;
}

int colmap_add_entry(
	struct colmap_entries *all, const struct colmap_entry *c, const char *path, struct err *e)
{
	if (mem_grow((void **)&all->items, &all->capacity, all->n + 1, sizeof *c, path, e))
		return -1;
	all->items[all->n++] = *c;
	return 0;
}

static int by_id(const void *a, const void *b)
{
	const struct colmap_entry *x = a, *y = b;

	return (x->id > y->id) - (x->id < y->id);
}

static int sort_entries(struct colmap_entries *all, const char *path, struct err *e)
{
	if (all->n)
		qsort(all->items, all->n, sizeof *all->items, by_id);
	for (size_t i = 0; i + 1 < all->n; i++)
		if (all->items[i].id == all->items[i + 1].id)
			return err_file(e, path, "camera %lu appears twice", (unsigned long)all->items[i].id);
	return 0;
}

int colmap_add_view(struct cameras *c, size_t *capacity, const struct colmap_entries *all,
	const double pose[7], uint32_t camera, const char *image, const char *path, struct err *e)
{
	struct camera v;
	double length = sqrt(pose[0] * pose[0] + pose[1] * pose[1] + pose[2] * pose[2] + pose[3] * pose[3]);
	struct colmap_entry key = {.id = camera};
	const struct colmap_entry *l = all->n ? bsearch(&key, all->items, all->n, sizeof key, by_id) : NULL;

	if (!l)
		return err_file(
			e, path, "image '%.200s': no camera %lu in the model", image, (unsigned long)camera);
	if (!isfinite(length) || length < 1e-12)
		return err_file(e, path, "image '%.200s': its rotation is zero or not finite", image);
	double w = pose[0] / length, x = pose[1] / length, y = pose[2] / length, z = pose[3] / length;
	double m[4][4] = {
		{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y), pose[4]},
		{2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x), pose[5]},
		{2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y), pose[6]},
		{0, 0, 0, 1},
	};
	v = l->camera;
	memcpy(v.world_to_camera, m, sizeof m);
	v.image = view_image(image, e);
	if (!v.image)
		return -1;
	if (mem_grow((void **)&c->views, capacity, c->n + 1, sizeof v, path, e)) {
		free(v.image);
		return -1;
	}
	c->views[c->n++] = v;
	return 0;
}

/* The next `bytes` bytes, or NULL with *e. */
static const unsigned char *take(
	struct cursor *in, size_t bytes, const char *what, uint64_t index, struct err *e)
{
	if (bytes > in->map.len - in->at) {
		err_file(e, in->path, "the file ends at offset %zu, within %s %llu", in->map.len, what,
			(unsigned long long)index);
		return NULL;
	}
	in->at += bytes;
	return in->map.data + in->at - bytes;
}

/* Opens a binary file and reads its number of entries, each of at least `entry` bytes. */
static int open_binary(struct cursor *in, const char *path, size_t entry, uint64_t *count, struct err *e)
{
	*in = (struct cursor){.path = path};
	if (file_map(path, &in->map, e))
		return -1;
	if (in->map.len < 8)
		return err_file(e, path, "%zu bytes, too short for a COLMAP file", in->map.len);
	*count = little_get(in->map.data, 8);
	in->at = 8;
	if (*count > (in->map.len - 8) / entry)
		return err_file(e, path, "%llu entries at offset 0 do not fit a file of %zu bytes",
			(unsigned long long)*count, in->map.len);
	return 0;
}

static int check_end(const struct cursor *in, struct err *e)
{
	if (in->at == in->map.len)
		return 0;
	return err_file(
		e, in->path, "%zu bytes after the last entry, from offset %zu", in->map.len - in->at, in->at);
}

static int read_cameras_binary(struct colmap_entries *all, struct cursor *in, const char *path, struct err *e)
{
	uint64_t count = 0;

	if (open_binary(in, path, 24 + 3 * 8, &count, e))
		return -1;
	for (uint64_t i = 0; i < count; i++) {
		const unsigned char *p = take(in, 24, "camera entry", i, e);
		double params[LENS_PARAMETERS] = {0};
		if (!p)
			return -1;
		struct colmap_entry l = {.id = (uint32_t)little_get(p, 4)};
		const uint32_t id = (uint32_t)little_get(p + 4, 4);
		const struct lens_model *model = lens_model_numbered(id);
		double width = (double)little_get(p + 8, 8), height = (double)little_get(p + 16, 8);
		if (!model)
			return err_file(e, path, "camera %lu: model id %ld at offset %zu is unknown",
				(unsigned long)l.id, (long)(int32_t)id, in->at - 20);
		p = take(in, 8 * (size_t)lens_model_parameters(model), "camera entry", i, e);
		if (!p)
			return -1;
		for (int k = 0; k < lens_model_parameters(model); k++)
			params[k] = little_get_f64(p + 8 * k);
		if (colmap_set_camera(&l, model, width, height, params, path, e) ||
			colmap_add_entry(all, &l, path, e))
			return -1;
	}
	return check_end(in, e);
}

static int read_images_binary(struct cameras *c, const struct colmap_entries *all, struct cursor *in,
	const char *path, struct err *e)
{
	uint64_t count = 0;
	size_t capacity = 0;

	if (open_binary(in, path, 64 + 1 + 8, &count, e))
		return -1;
	for (uint64_t i = 0; i < count; i++) {
		const unsigned char *p = take(in, 64, "image entry", i, e), *end;
		double pose[7];
		if (!p)
			return -1;
		for (int k = 0; k < 7; k++)
			pose[k] = little_get_f64(p + 4 + 8 * k);
		uint32_t camera = (uint32_t)little_get(p + 60, 4);
		const char *name = (const char *)in->map.data + in->at;
		end = memchr(name, 0, in->map.len - in->at);
		if (!take(in, end ? (size_t)((const char *)end - name) + 1 : SIZE_MAX, "image entry", i, e) ||
			!(p = take(in, 8, "image entry", i, e)))
			return -1;
		uint64_t points = little_get(p, 8);
		/* Each point is x, y (f64) and the id of its 3D point (i64). */
		if (!take(in, points > SIZE_MAX / 24 ? SIZE_MAX : (size_t)points * 24, "image entry", i, e) ||
			colmap_add_view(c, &capacity, all, pose, camera, name, path, e))
			return -1;
	}
	return check_end(in, e);
}

/* A part of a model in one form, whatever the case of its letters: its path, or NULL where it is not there or
 * memory is out. */
static char *part_of(const char *dir, const char *name, const char *suffix, struct err *e)
{
	char file[16];

	snprintf(file, sizeof file, "%s%s", name, suffix);
	char *path = path_alike(dir, file, e);
	if (path && file_exists(path))
		return path;
	free(path);
	return NULL;
}

/* The paths of cameras and images: as a pair where there is one, first the binary one, else each in its own
 * form. -1 where the folder is no model. free() them. */
static int find_parts(const char *dir, char *parts[2], struct err *e)
{
	static const char *const forms[][2] = {
		{".bin", ".bin"}, {".txt", ".txt"}, {".bin", ".txt"}, {".txt", ".bin"}};

	for (size_t i = 0; i < sizeof forms / sizeof *forms; i++) {
		parts[0] = part_of(dir, "cameras", forms[i][0], e);
		parts[1] = part_of(dir, "images", forms[i][1], e);
		if (parts[0] && parts[1])
			return 0;
		mem_free_all(parts[0], parts[1]);
	}
	return -1;
}

int colmap_is_model(const char *dir)
{
	struct err ignored;
	char *parts[2];
	const int is_there = !find_parts(dir, parts, &ignored);

	if (is_there)
		mem_free_all(parts[0], parts[1]);
	return is_there;
}

int colmap_read(struct cameras *c, const char *dir, struct err *e)
{
	struct colmap_entries all = {0};
	struct cursor in[2] = {{0}};
	char *parts[2];

	*c = (struct cameras){0};
	if (find_parts(dir, parts, e))
		return err_file(e, dir, "no COLMAP model: no cameras and images, .bin or .txt");
	int bad = path_ends(parts[0], ".bin") ? read_cameras_binary(&all, &in[0], parts[0], e)
					      : colmap_read_cameras_text(&all, parts[0], e);
	bad = bad || sort_entries(&all, parts[0], e) ||
	      (path_ends(parts[1], ".bin") ? read_images_binary(c, &all, &in[1], parts[1], e)
					   : colmap_read_images_text(c, &all, parts[1], e)) ||
	      views_finish(c, parts[1], e);
	if (bad)
		cameras_free(c);
	file_unmap(&in[0].map);
	file_unmap(&in[1].map);
	mem_free_all(all.items, parts[0], parts[1]);
	return bad ? -1 : 0;
}

int colmap_add_point(struct colmap_points *p, size_t *room, const double place[3], const double color[3],
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

/* How many, and for each: id (u64), place (3 f64), colour (3 u8), error (f64), views (u64), 8 bytes each. */
enum { ENTRY = 8 + 24 + 3 + 8 + 8 };

static int read_points_binary(struct colmap_points *p, const char *path, struct err *e)
{
	struct cursor in = {0};
	size_t room = 0;
	uint64_t n = 0;
	int bad = open_binary(&in, path, ENTRY, &n, e);

	for (uint64_t i = 0; i < n && !bad; i++) {
		double place[3], color[3];
		const unsigned char *entry = take(&in, ENTRY, "point", i, e);
		const uint64_t views = entry ? little_get(entry + ENTRY - 8, 8) : 0;
		for (size_t k = 0; k < 3 && entry; k++) {
			place[k] = little_get_f64(entry + 8 + 8 * k);
			color[k] = entry[32 + k];
		}
		bad = !entry ||
		      !take(&in, views > SIZE_MAX / 8 ? SIZE_MAX : 8 * (size_t)views, "point", i, e) ||
		      colmap_add_point(p, &room, place, color, path, e);
	}
	file_unmap(&in.map);
	return bad;
}

int colmap_points_read(struct colmap_points *p, const char *dir, struct err *e)
{
	static const char *const suffixes[] = {".bin", ".txt"};
	int bad = 0;

	*p = (struct colmap_points){0};
	for (int i = 0; i < 2 && !bad && !p->n; i++) {
		SCOPED char *path = part_of(dir, "points3D", suffixes[i], e);
		if (path)
			bad = i ? colmap_read_points_text(p, path, e) : read_points_binary(p, path, e);
	}
	if (bad)
		colmap_points_free(p);
	return bad ? -1 : 0;
}

void colmap_points_free(struct colmap_points *p)
{
	mem_free_all(p->places, p->colors);
	*p = (struct colmap_points){0};
}
