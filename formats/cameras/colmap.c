#include "formats/cameras/colmap.h"

#include "base/file.h"
#include "base/mem.h"
#include "base/textfile.h"
#include "geom/lens.h"
#include "geom/rotation.h"
#include "geom/views.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct entry {
	uint32_t id;
	struct camera camera; /* size, intrinsics and lens only */
};

struct entries {
	size_t n, capacity;
	struct entry *items;
};

/* A place in a binary file. */
struct cursor {
	const char *path;
	struct file_map map;
	size_t at;
};

/* A place in a text file that was read whole. */
struct lines {
	char *text, *next;
	long number;
	unsigned long images; /* that a comment says the file has */
	long images_line;     /* 0: none does */
};

/* Where the model distorts, the pinhole is of its focal lengths and principal point until lens_pinhole finds
 * it. */
static int set_camera(struct entry *c, const struct lens_model *m, double width, double height,
	const double *params, const char *path, struct err *e)
{
	const int n = lens_model_parameters(m), focals = lens_model_focals(m);
	struct lens lens = {.model = m};

	for (int i = 0; i < n; i++)
		if (!isfinite(lens.parameters[i] = params[i]))
			return err_set(e, ERR_FORMAT, "%s: camera %lu: parameter %d is not finite", path,
				(unsigned long)c->id, i);
	if (view_set_size(&c->camera, width, height))
		return err_set(e, ERR_FORMAT, "%s: camera %lu: size %gx%g is not whole numbers in 1 to 65536",
			path, (unsigned long)c->id, width, height);
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

static int add_entry(struct entries *all, const struct entry *c, const char *path, struct err *e)
{
	void *block = all->items;

	if (mem_grow(&block, &all->capacity, all->n + 1, sizeof *c, path, e))
		return -1;
	all->items = block;
	all->items[all->n++] = *c;
	return 0;
}

static int by_id(const void *a, const void *b)
{
	const struct entry *x = a, *y = b;

	return (x->id > y->id) - (x->id < y->id);
}

static int sort_entries(struct entries *all, const char *path, struct err *e)
{
	if (all->n)
		qsort(all->items, all->n, sizeof *all->items, by_id);
	for (size_t i = 0; i + 1 < all->n; i++)
		if (all->items[i].id == all->items[i + 1].id)
			return err_set(e, ERR_FORMAT, "%s: camera %lu appears twice", path,
				(unsigned long)all->items[i].id);
	return 0;
}

/* Adds a view: pose is qw qx qy qz tx ty tz, world to camera. */
static int add_view(struct cameras *c, size_t *capacity, const struct entries *all, const double pose[7],
	uint32_t camera, const char *image, const char *path, struct err *e)
{
	void *block = c->views;
	struct camera v;
	double length = sqrt(pose[0] * pose[0] + pose[1] * pose[1] + pose[2] * pose[2] + pose[3] * pose[3]);
	struct entry key = {.id = camera};
	const struct entry *l = all->n ? bsearch(&key, all->items, all->n, sizeof key, by_id) : NULL;

	if (!l)
		return err_set(e, ERR_FORMAT, "%s: image '%.200s': no camera %lu in the model", path, image,
			(unsigned long)camera);
	if (!isfinite(length) || length < 1e-12)
		return err_set(
			e, ERR_FORMAT, "%s: image '%.200s': its rotation is zero or not finite", path, image);
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
	if (mem_grow(&block, capacity, c->n + 1, sizeof v, path, e)) {
		free(v.image);
		return -1;
	}
	c->views = block;
	c->views[c->n++] = v;
	return 0;
}

/* The next `bytes` bytes, or NULL with *e. */
static const unsigned char *take(
	struct cursor *in, size_t bytes, const char *what, uint64_t index, struct err *e)
{
	if (bytes > in->map.len - in->at) {
		err_set(e, ERR_FORMAT, "%s: the file ends at offset %zu, within %s %llu", in->path,
			in->map.len, what, (unsigned long long)index);
		return NULL;
	}
	in->at += bytes;
	return in->map.data + in->at - bytes;
}

static uint64_t get_bits(const unsigned char *p, int bytes)
{
	uint64_t bits = 0;

	for (int i = bytes; i-- > 0;)
		bits = bits << 8 | p[i];
	return bits;
}

static double get_double(const unsigned char *p)
{
	uint64_t bits = get_bits(p, 8);
	double value;

	memcpy(&value, &bits, 8);
	return value;
}

/* Opens a binary file and reads its number of entries, each of at least `entry` bytes. */
static int open_binary(struct cursor *in, const char *path, size_t entry, uint64_t *count, struct err *e)
{
	*in = (struct cursor){.path = path};
	if (file_map(path, &in->map, e))
		return -1;
	if (in->map.len < 8)
		return err_set(
			e, ERR_FORMAT, "%s: %zu bytes, too short for a COLMAP file", path, in->map.len);
	*count = get_bits(in->map.data, 8);
	in->at = 8;
	if (*count > (in->map.len - 8) / entry)
		return err_set(e, ERR_FORMAT, "%s: %llu entries at offset 0 do not fit a file of %zu bytes",
			path, (unsigned long long)*count, in->map.len);
	return 0;
}

static int check_end(const struct cursor *in, struct err *e)
{
	if (in->at == in->map.len)
		return 0;
	return err_set(e, ERR_FORMAT, "%s: %zu bytes after the last entry, from offset %zu", in->path,
		in->map.len - in->at, in->at);
}

static int read_cameras_binary(struct entries *all, struct cursor *in, const char *path, struct err *e)
{
	uint64_t count = 0;

	if (open_binary(in, path, 24 + 3 * 8, &count, e))
		return -1;
	for (uint64_t i = 0; i < count; i++) {
		const unsigned char *p = take(in, 24, "camera entry", i, e);
		double params[LENS_PARAMETERS] = {0};
		if (!p)
			return -1;
		struct entry l = {.id = (uint32_t)get_bits(p, 4)};
		const uint32_t id = (uint32_t)get_bits(p + 4, 4);
		const struct lens_model *model = lens_model_numbered(id);
		double width = (double)get_bits(p + 8, 8), height = (double)get_bits(p + 16, 8);
		if (!model)
			return err_set(e, ERR_FORMAT, "%s: camera %lu: model id %ld at offset %zu is unknown",
				path, (unsigned long)l.id, (long)(int32_t)id, in->at - 20);
		p = take(in, 8 * (size_t)lens_model_parameters(model), "camera entry", i, e);
		if (!p)
			return -1;
		for (int k = 0; k < lens_model_parameters(model); k++)
			params[k] = get_double(p + 8 * k);
		if (set_camera(&l, model, width, height, params, path, e) || add_entry(all, &l, path, e))
			return -1;
	}
	return check_end(in, e);
}

static int read_images_binary(
	struct cameras *c, const struct entries *all, struct cursor *in, const char *path, struct err *e)
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
			pose[k] = get_double(p + 4 + 8 * k);
		uint32_t camera = (uint32_t)get_bits(p + 60, 4);
		const char *name = (const char *)in->map.data + in->at;
		end = memchr(name, 0, in->map.len - in->at);
		if (!take(in, end ? (size_t)((const char *)end - name) + 1 : SIZE_MAX, "image entry", i, e) ||
			!(p = take(in, 8, "image entry", i, e)))
			return -1;
		uint64_t points = get_bits(p, 8);
		/* Each point is x, y (f64) and the id of its 3D point (i64). */
		if (!take(in, points > SIZE_MAX / 24 ? SIZE_MAX : (size_t)points * 24, "image entry", i, e) ||
			add_view(c, &capacity, all, pose, camera, name, path, e))
			return -1;
	}
	return check_end(in, e);
}

/* The next line, without its end, or NULL. Text lines are cut in place. */
static char *next_line(struct lines *in)
{
	char *line = in->next, *end;

	if (!*line)
		return NULL;
	in->number++;
	end = line + strcspn(line, "\r\n");
	in->next = end + (*end == '\r' && end[1] == '\n') + (*end != 0);
	*end = 0;
	return line;
}

/* The next line that is neither empty nor a comment. */
static char *next_entry(struct lines *in)
{
	char *line;

	while ((line = next_line(in)))
		if (line[strspn(line, " \t")] && line[strspn(line, " \t")] != '#')
			return line;
	return NULL;
}

static int next_number(char **line, double *value)
{
	char *end;

	*value = strtod(*line, &end);
	if (end == *line || (*end && *end != ' ' && *end != '\t'))
		return -1;
	*line = end;
	return 0;
}

/* As next_number; an id. */
static int next_id(char **line, uint32_t *id)
{
	double value;

	if (next_number(line, &value) || !(value >= 0 && value <= UINT32_MAX) || value != floor(value))
		return -1;
	*id = (uint32_t)value;
	return 0;
}

static int open_text(struct lines *in, const char *path, struct err *e)
{
	size_t len;

	*in = (struct lines){0};
	if (textfile_read(path, &in->text, &len, e))
		return -1;
	in->next = in->text;
	if (strlen(in->text) != len)
		return err_set(e, ERR_FORMAT, "%s: a NUL byte at offset %zu", path, strlen(in->text));
	return 0;
}

static int read_camera_text(
	struct entries *all, struct lines *in, char *line, const char *path, struct err *e)
{
	double size[2], params[LENS_PARAMETERS] = {0};
	struct entry l = {0};

	if (next_id(&line, &l.id))
		return err_set(e, ERR_FORMAT, "%s:%ld: does not begin with a camera id", path, in->number);
	line += strspn(line, " \t");
	size_t len = strcspn(line, " \t");
	const struct lens_model *model = lens_model_named(line, len);
	if (!model)
		return err_set(e, ERR_FORMAT, "%s:%ld: camera model '%.*s' is unknown", path, in->number,
			len < 60 ? (int)len : 60, line);
	const int n = lens_model_parameters(model);
	line += len;
	if (next_number(&line, &size[0]) || next_number(&line, &size[1]))
		return err_set(e, ERR_FORMAT, "%s:%ld: no width and height", path, in->number);
	for (int i = 0; i < n; i++)
		if (next_number(&line, &params[i]))
			return err_set(e, ERR_FORMAT, "%s:%ld: model %s needs %d parameters, has %d", path,
				in->number, lens_model_name(model), n, i);
	if (line[strspn(line, " \t")])
		return err_set(e, ERR_FORMAT, "%s:%ld: more than %d parameters", path, in->number, n);
	return set_camera(&l, model, size[0], size[1], params, path, e) || add_entry(all, &l, path, e) ? -1
												       : 0;
}

static int read_cameras_text(struct entries *all, struct lines *in, const char *path, struct err *e)
{
	char *line;

	if (open_text(in, path, e))
		return -1;
	while ((line = next_entry(in)))
		if (read_camera_text(all, in, line, path, e))
			return -1;
	return 0;
}

/* What a line of images.txt is. */
struct image_line {
	uint32_t camera;
	double pose[7];
	char *name;
};

/* ID QW QX QY QZ TX TY TZ CAMERA_ID NAME: the name is cut in place. -1 where the line is none. */
static int parse_image(char *line, struct image_line *to)
{
	uint32_t id;
	int bad = next_id(&line, &id);

	for (int k = 0; !bad && k < 7; k++)
		bad = next_number(&line, &to->pose[k]);
	if (bad || next_id(&line, &to->camera))
		return -1;
	to->name = line + strspn(line, " \t");
	size_t len = strlen(to->name);
	while (len && (to->name[len - 1] == ' ' || to->name[len - 1] == '\t'))
		to->name[--len] = 0;
	return 0;
}

/* Whether a line is an image's points, X Y POINT3D_ID of each: nothing but numbers, and each third one whole,
 * which an image's line without its name is only by chance. */
static int is_points(char *line)
{
	double value = 0;
	size_t n = 0;

	for (; line[strspn(line, " \t")]; n++)
		if (next_number(&line, &value) || (n % 3 == 2 && value != floor(value)))
			return 0;
	return n % 3 == 0;
}

/* COLMAP's comment of how many images there are, where the line is that. */
static void note_count(const char *comment, struct lines *in)
{
	const char *at = strstr(comment, "Number of images:");

	if (!at)
		return;
	in->images = strtoul(strchr(at, ':') + 1, NULL, 10);
	in->images_line = in->number;
}

/* An image's line is followed by one of its points, which may be empty; files of other programs leave it out.
 */
static int read_images_text(
	struct cameras *c, const struct entries *all, struct lines *in, const char *path, struct err *e)
{
	size_t capacity = 0;
	int may_be_points = 0;
	struct image_line image;
	char *line;

	if (open_text(in, path, e))
		return -1;
	while ((line = next_line(in))) {
		const char first = line[strspn(line, " \t")];
		if (first == '#') {
			note_count(line, in);
			continue;
		}
		if (!first || (may_be_points && is_points(line))) {
			may_be_points = 0;
			continue;
		}
		if (parse_image(line, &image))
			return err_set(e, ERR_FORMAT,
				"%s:%ld: not 'ID QW QX QY QZ TX TY TZ CAMERA_ID NAME'%s", path, in->number,
				may_be_points
					? ", and not the points of the image before, 'X Y POINT3D_ID ...'"
					: "");
		if (!*image.name)
			return err_set(e, ERR_FORMAT, "%s:%ld: image without a name", path, in->number);
		if (add_view(c, &capacity, all, image.pose, image.camera, image.name, path, e))
			return -1;
		may_be_points = 1;
	}
	if (in->images_line && in->images != c->n)
		return err_set(e, ERR_FORMAT,
			"%s: has %zu images, but line %ld says %lu: is the file whole? If so, take that line out",
			path, c->n, in->images_line, in->images);
	return 0;
}

static int is_pair(const char *dir, const char *suffix)
{
	struct err ignored;
	char *a = file_join(dir, "cameras", suffix, &ignored),
	     *b = file_join(dir, "images", suffix, &ignored);
	int both = a && b && file_exists(a) && file_exists(b);

	free(a);
	free(b);
	return both;
}

int colmap_is_model(const char *dir)
{
	return is_pair(dir, ".bin") || is_pair(dir, ".txt");
}

static int read_binary(
	struct cameras *c, struct entries *all, const char *cameras, const char *images, struct err *e)
{
	struct cursor first = {0}, second = {0};
	int bad = read_cameras_binary(all, &first, cameras, e) || sort_entries(all, cameras, e) ||
		  read_images_binary(c, all, &second, images, e);

	file_unmap(&first.map);
	file_unmap(&second.map);
	return bad;
}

static int read_text(
	struct cameras *c, struct entries *all, const char *cameras, const char *images, struct err *e)
{
	struct lines first = {0}, second = {0};
	int bad = read_cameras_text(all, &first, cameras, e) || sort_entries(all, cameras, e) ||
		  read_images_text(c, all, &second, images, e);

	free(first.text);
	free(second.text);
	return bad;
}

int colmap_read(struct cameras *c, const char *dir, struct err *e)
{
	const char *suffix = is_pair(dir, ".bin") ? ".bin" : ".txt";
	char *cameras = file_join(dir, "cameras", suffix, e), *images = file_join(dir, "images", suffix, e);
	struct entries all = {0};
	int bad = -1;

	*c = (struct cameras){0};
	if (cameras && images)
		bad = !strcmp(suffix, ".bin") ? read_binary(c, &all, cameras, images, e)
					      : read_text(c, &all, cameras, images, e);
	if (!bad)
		bad = views_finish(c, images, e);
	if (bad)
		cameras_free(c);
	free(all.items);
	free(cameras);
	free(images);
	return bad ? -1 : 0;
}

/* The first view with the intrinsics of view i: its number, from 1, is the camera's id. */
static size_t camera_of(const struct cameras *c, size_t i)
{
	const struct camera *v = &c->views[i];
	size_t k = 0;

	for (; k < i; k++) {
		const struct camera *o = &c->views[k];
		if (o->width == v->width && o->height == v->height && o->fx == v->fx && o->fy == v->fy &&
			o->cx == v->cx && o->cy == v->cy)
			break;
	}
	return k + 1;
}

static void put_cameras(FILE *out, const struct cameras *c)
{
	fputs("# Cameras: CAMERA_ID MODEL WIDTH HEIGHT FX FY CX CY\n", out);
	for (size_t i = 0; i < c->n; i++) {
		const struct camera *v = &c->views[i];
		if (camera_of(c, i) == i + 1)
			fprintf(out, "%zu PINHOLE %d %d %.17g %.17g %.17g %.17g\n", i + 1, v->width,
				v->height, v->fx, v->fy, v->cx, v->cy);
	}
}

static void put_images(FILE *out, const struct cameras *c)
{
	fputs("# Images: IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME, then a line for its points, of which there are none\n",
		out);
	for (size_t i = 0; i < c->n; i++) {
		const struct camera *v = &c->views[i];
		double rotation[3][3], q[4];
		for (int k = 0; k < 3; k++)
			memcpy(rotation[k], v->world_to_camera[k], sizeof rotation[k]);
		rotation_to_quat(rotation, q);
		fprintf(out, "%zu", i + 1);
		for (int k = 0; k < 4; k++)
			fprintf(out, " %.17g", q[k]);
		for (int k = 0; k < 3; k++)
			fprintf(out, " %.17g", v->world_to_camera[k][3]);
		fprintf(out, " %zu %s\n\n", camera_of(c, i), v->image ? view_base(v->image) : v->name);
	}
}

static void put_points(FILE *out, const struct cameras *c)
{
	(void)c;
	fputs("# Points: POINT3D_ID X Y Z R G B ERROR TRACK[]; there are none\n", out);
}

static int write_part(const struct cameras *c, const char *dir, const char *name,
	void (*put)(FILE *out, const struct cameras *c), struct err *e)
{
	char *path = file_join(dir, name, ".txt", e);
	struct file_out out;
	int bad = -1;

	if (path && !file_out_open(&out, path, e)) {
		put(out.stream, c);
		bad = file_out_commit(&out, e);
	}
	free(path);
	return bad;
}

int colmap_write_text(const struct cameras *c, const char *dir, struct err *e)
{
	if (file_make_dir(dir, e))
		return -1;
	return write_part(c, dir, "cameras", put_cameras, e) || write_part(c, dir, "images", put_images, e) ||
			       write_part(c, dir, "points3D", put_points, e)
		       ? -1
		       : 0;
}
