/* Writing of COLMAP's text form. */
#include "formats/cameras/colmap.h"

#include "base/file.h"
#include "geom/rotation.h"
#include "geom/views.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

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
	return -(write_part(c, dir, "cameras", put_cameras, e) ||
		 write_part(c, dir, "images", put_images, e) ||
		 write_part(c, dir, "points3D", put_points, e));
}
