#include "places/viewpoint.h"

#include "geom/up.h"
#include "geom/vector.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static int is_same_point(const double a[3], const double b[3])
{
	return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

int viewpoint_is_same(const struct viewpoint *a, const struct viewpoint *b)
{
	return a->kind == b->kind && (a->kind != VIEWPOINT_CAMERA || a->camera == b->camera) &&
	       (a->kind != VIEWPOINT_POINT || is_same_point(a->point, b->point)) &&
	       a->is_facing == b->is_facing && (!a->is_facing || is_same_point(a->faced, b->faced));
}

int viewpoint_read(
	struct viewpoint *v, const char *text, const struct cameras *cameras, const double offset[3])
{
	const struct camera *camera = cameras_find(cameras, text);
	char *end;

	*v = (struct viewpoint){.kind = VIEWPOINT_POINT};
	if (camera) {
		*v = (struct viewpoint){.kind = VIEWPOINT_CAMERA, .camera = camera};
		return 0;
	}
	for (int k = 0; k < 3; k++) {
		v->point[k] = strtod(text, &end) - offset[k];
		if (end == text || !isfinite(v->point[k]) || *end != (k < 2 ? ',' : 0))
			return -1;
		text = end + 1;
	}
	return 0;
}

static int is_looked_from(const struct cameras *c, size_t i)
{
	int any = 0;

	for (size_t k = 0; k < c->n; k++)
		any |= c->views[k].split == SPLIT_TRAIN;
	return !any || c->views[i].split == SPLIT_TRAIN;
}

/* Level axes in the world (rows: right, away, up) with `away` along a direction. */
static void level_axes(const double up[3], const double direction[3], double axes[3][3])
{
	double away[3], rise = vector_dot(direction, up), length;

	for (int k = 0; k < 3; k++)
		away[k] = direction[k] - rise * up[k];
	length = sqrt(vector_dot(away, away));
	if (!(length > 1e-9)) { /* straight down, or no camera: any level direction */
		const double other[3] = {fabs(up[0]) < 0.9, fabs(up[0]) >= 0.9, 0};
		vector_cross(up, other, away);
		length = sqrt(vector_dot(away, away));
	}
	for (int k = 0; k < 3; k++)
		away[k] /= length;
	vector_cross(away, up, axes[0]);
	memcpy(axes[1], away, sizeof away);
	memcpy(axes[2], up, 3 * sizeof *up);
}

/* The mean of the cameras that the scene is usually looked at from. */
static void look_usual(const struct cameras *c, double eye[3], double away[3])
{
	double count = 0;

	memset(eye, 0, 3 * sizeof *eye);
	memset(away, 0, 3 * sizeof *away);
	for (size_t i = 0; i < c->n; i++) {
		double centre[3];
		if (!is_looked_from(c, i))
			continue;
		camera_centre(&c->views[i], centre);
		for (int k = 0; k < 3; k++) {
			away[k] += c->views[i].world_to_camera[2][k];
			eye[k] += centre[k];
		}
		count++;
	}
	for (int k = 0; k < 3; k++)
		eye[k] /= count > 0 ? count : 1;
}

/* Turns to a point, unless it is right above or below, nearer than `least`: that is no direction. */
static void turn_to(
	const double point[3], const double eye[3], const double up[3], double least, double away[3])
{
	double to[3];

	for (int k = 0; k < 3; k++)
		to[k] = point[k] - eye[k];
	const double rise = vector_dot(to, up);
	if (vector_dot(to, to) - rise * rise > least * least)
		memcpy(away, to, sizeof to);
}

void viewpoint_axes(const struct viewpoint *v, const struct cameras *cameras, const double middle[3],
	double least, double axes[3][3], double eye[3])
{
	double away[3], up[3];

	cameras_up(cameras, up);
	look_usual(cameras, eye, away);
	if (v->kind == VIEWPOINT_CAMERA) {
		camera_centre(v->camera, eye);
		memcpy(away, v->camera->world_to_camera[2], sizeof away);
	} else if (v->kind == VIEWPOINT_POINT) {
		memcpy(eye, v->point, 3 * sizeof *eye);
		turn_to(middle, eye, up, least, away);
	}
	if (v->is_facing)
		turn_to(v->faced, eye, up, least, away);
	level_axes(up, away, axes);
}
