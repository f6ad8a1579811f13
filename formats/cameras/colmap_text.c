/* COLMAP's text form: reading, which cuts lines in place, and writing. */
#include "formats/cameras/colmap_private.h"

#include "base/file.h"
#include "base/mem.h"
#include "base/textfile.h"
#include "formats/cameras/colmap.h"
#include "geom/rotation.h"
#include "geom/views.h"

#include <math.h>
#include <stdio.h>

/* A place in a text file that was read whole. */
struct lines {
	char *text, *next;
	long number;
	unsigned long images; /* that a comment says the file has */
	long images_line;     /* 0: none does */
};

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
		return err_file(e, path, "a NUL byte at offset %zu", strlen(in->text));
	return 0;
}

static int read_camera_text(
	struct colmap_entries *all, struct lines *in, char *line, const char *path, struct err *e)
{
	double size[2], params[LENS_PARAMETERS] = {0};
	struct colmap_entry l = {0};

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
	return -(colmap_set_camera(&l, model, size[0], size[1], params, path, e) ||
		 colmap_add_entry(all, &l, path, e));
}

int colmap_read_cameras_text(struct colmap_entries *all, const char *path, struct err *e)
{
	struct lines in;
	char *line;
	int bad = open_text(&in, path, e);

	while (!bad && (line = next_entry(&in)))
		bad = read_camera_text(all, &in, line, path, e);
	free(in.text);
	return bad;
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

/* An image's line is followed by one of its points, which may be empty; other programs leave it out. */
static int read_image_lines(struct cameras *c, const struct colmap_entries *all, struct lines *in,
	const char *path, struct err *e)
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
		if (colmap_add_view(c, &capacity, all, image.pose, image.camera, image.name, path, e))
			return -1;
		may_be_points = 1;
	}
	if (in->images_line && in->images != c->n)
		return err_file(e, path,
			"has %zu images, but line %ld says %lu: is the file whole? If so, take that line out",
			c->n, in->images_line, in->images);
	return 0;
}

int colmap_read_images_text(
	struct cameras *c, const struct colmap_entries *all, const char *path, struct err *e)
{
	struct lines in;
	const int bad = read_image_lines(c, all, &in, path, e);

	free(in.text);
	return bad;
}

int colmap_read_points_text(struct colmap_points *p, const char *path, struct err *e)
{
	struct lines in;
	size_t room = 0;
	char *line;
	int bad = open_text(&in, path, e);

	while (!bad && (line = next_entry(&in))) {
		double v[7];
		int n = 0;
		while (n < 7 && !next_number(&line, &v[n]))
			n++;
		bad = n < 7 ? err_set(e, ERR_FORMAT, "%s:%ld: not 'ID X Y Z R G B ERROR'", path, in.number)
			    : colmap_add_point(p, &room, v + 1, v + 4, path, e);
	}
	free(in.text);
	return bad;
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
	SCOPED char *path = file_join(dir, name, ".txt", e);
	struct file_out out;
	int bad = -1;

	if (path && !file_out_open(&out, path, e)) {
		put(out.stream, c);
		bad = file_out_commit(&out, e);
	}
	return bad;
}

int colmap_write_text(const struct cameras *c, const char *dir, struct err *e)
{
	if (file_make_dir(dir, e))
		return -1;
	return -(write_part(c, dir, "cameras", put_cameras, e) ||
		 write_part(c, dir, "images", put_images, e) ||
		 write_part(c, dir, "points3D", put_points, e));
}
