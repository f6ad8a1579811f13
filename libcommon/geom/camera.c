#include "geom/camera.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void cameras_free(struct cameras *c)
{
	for (size_t i = 0; i < c->n; i++) {
		free(c->views[i].name);
		free(c->views[i].image);
	}
	free(c->views);
	*c = (struct cameras){0};
}

const struct camera *cameras_find(const struct cameras *c, const char *name)
{
	for (size_t i = 0; i < c->n; i++)
		if (!strcmp(c->views[i].name, name))
			return &c->views[i];
	return NULL;
}

struct camera camera_resize(const struct camera *from, int width, int height)
{
	struct camera to = *from;
	double sx = (double)width / from->width, sy = (double)height / from->height;

	to.width = width;
	to.height = height;
	to.fx *= sx;
	to.cx *= sx;
	to.fy *= sy;
	to.cy *= sy;
	return to;
}

void camera_scaled_size(const struct camera *c, double s, int *width, int *height)
{
	*width = (int)fmax(1, round(c->width * s));
	*height = (int)fmax(1, round(c->height * s));
}

void camera_transform(const struct camera *c, const double world[3], double out[3])
{
	for (int r = 0; r < 3; r++) {
		const double *row = c->world_to_camera[r];
		out[r] = row[0] * world[0] + row[1] * world[1] + row[2] * world[2] + row[3];
	}
}

void camera_centre(const struct camera *c, double out[3])
{
	for (int k = 0; k < 3; k++) {
		out[k] = 0;
		for (int r = 0; r < 3; r++)
			out[k] -= c->world_to_camera[r][k] * c->world_to_camera[r][3];
	}
}
