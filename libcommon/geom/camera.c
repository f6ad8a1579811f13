#include "geom/camera.h"

#include "base/mem.h"
#include "base/names.h"

#include <math.h>
#include <string.h>

void cameras_free(struct cameras *c)
{
	for (size_t i = 0; i < c->n; i++)
		mem_free_all(c->views[i].name, c->views[i].image, c->views[i].source);
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

int cameras_mark(const struct cameras *c, const char *list, const char *option, char *chosen, struct err *e)
{
	return names_mark(c->views, sizeof *c->views, offsetof(struct camera, name), c->n, list, option,
		"view", chosen, e);
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

struct camera camera_scaled(const struct camera *c, double s)
{
	int width, height;

	camera_scaled_size(c, s, &width, &height);
	return camera_resize(c, width, height);
}

struct camera camera_within(const struct camera *c, int side)
{
	return camera_scaled(c, fmin(1, (double)side / (c->width > c->height ? c->width : c->height)));
}

size_t cameras_spread(const struct cameras *c, size_t most, int side, struct camera *chosen)
{
	size_t all = 0, at = 0, n = 0;

	for (size_t i = 0; i < c->n; i++)
		all += c->views[i].split == SPLIT_TRAIN;
	const int is_any = !all;
	if (is_any)
		all = c->n;
	const size_t take = all < most ? all : most;
	for (size_t i = 0; i < c->n && n < take; i++) {
		if (!is_any && c->views[i].split != SPLIT_TRAIN)
			continue;
		if (at++ == n * all / take)
			chosen[n++] = camera_within(&c->views[i], side);
	}
	return n;
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

int camera_is_rigid(const struct camera *c)
{
	const double(*m)[4] = c->world_to_camera;
	double determinant = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) +
			     m[0][1] * (m[1][2] * m[2][0] - m[1][0] * m[2][2]) +
			     m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);

	for (int a = 0; a < 3; a++) {
		const double *x = m[a];
		if (!isfinite(x[3]))
			return 0;
		for (int b = 0; b < 3; b++) {
			double dot = x[0] * m[b][0] + x[1] * m[b][1] + x[2] * m[b][2];
			if (!(fabs(dot - (a == b)) <= 1e-4))
				return 0;
		}
	}
	return determinant > 0 && m[3][0] == 0 && m[3][1] == 0 && m[3][2] == 0 && m[3][3] == 1;
}

void camera_set_centre(struct camera *c, double rotation[3][3], const double centre[3])
{
	memset(c->world_to_camera, 0, sizeof c->world_to_camera);
	for (int r = 0; r < 3; r++)
		for (int k = 0; k < 3; k++) {
			c->world_to_camera[r][k] = rotation[r][k];
			c->world_to_camera[r][3] -= rotation[r][k] * centre[k];
		}
	c->world_to_camera[3][3] = 1;
}

void cameras_shift(struct cameras *c, const double offset[3])
{
	for (size_t i = 0; i < c->n; i++) {
		double moved[3];
		camera_transform(&c->views[i], offset, moved);
		for (int r = 0; r < 3; r++)
			c->views[i].world_to_camera[r][3] = moved[r];
	}
}
