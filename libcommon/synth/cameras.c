#include "synth/cameras.h"

#include "base/mem.h"
#include "base/rng.h"
#include "geom/vector.h"

#include <math.h>
#include <stdio.h>

#define PI 3.14159265358979323846

static void normalise(double a[3])
{
	double length = vector_length(a);

	for (int k = 0; k < 3; k++)
		a[k] /= length;
}

void synth_cameras_aim(struct camera *c, const double centre[3], const double target[3], double roll)
{
	double forward[3], right[3], down[3], up[3] = {0, 0, 1}, cosine = cos(roll), sine = sin(roll);

	for (int k = 0; k < 3; k++)
		forward[k] = target[k] - centre[k];
	normalise(forward);
	vector_cross(forward, up, right);
	normalise(right);
	vector_cross(forward, right, down);
	for (int k = 0; k < 3; k++) {
		c->world_to_camera[0][k] = cosine * right[k] + sine * down[k];
		c->world_to_camera[1][k] = cosine * down[k] - sine * right[k];
		c->world_to_camera[2][k] = forward[k];
		c->world_to_camera[3][k] = 0;
	}
	for (int r = 0; r < 3; r++)
		c->world_to_camera[r][3] = -vector_dot(c->world_to_camera[r], centre);
	c->world_to_camera[3][3] = 1;
}

double synth_cameras_distance(const struct synth_table *table, const struct synth_preset *preset)
{
	return preset->distance * fmax(table->half_width, 1.3 * table->half_depth);
}

int synth_cameras_make(
	struct cameras *c, const struct synth_options *o, const struct synth_table *table, struct err *e)
{
	double far = synth_cameras_distance(table, o->preset), reach = far / o->preset->distance;
	int n = o->views, share = n * o->preset->test_views / o->preset->views, tests = share ? share : 1;
	struct rng r;

	*c = (struct cameras){0};
	c->views = mem_zalloc((size_t)n, sizeof *c->views, "cameras", e);
	if (!c->views)
		return -1;
	rng_seed(&r, o->seed, SYNTH_STREAM_CAMERAS);
	for (int i = 0; i < n; i++) {
		struct camera *v = &c->views[c->n++];
		char name[32];
		snprintf(name, sizeof name, "view_%03d", i);
		v->name = mem_strdup(name, e);
		if (!v->name) {
			cameras_free(c);
			return -1;
		}
		v->width = o->width;
		v->height = o->height;
		v->fx = v->fy = 0.95 * fmax(o->width, o->height * 4 / 3.0);
		v->cx = o->width / 2.0;
		v->cy = o->height / 2.0;
		v->split = (i + 1) * tests / n > i * tests / n ? SPLIT_TEST : SPLIT_TRAIN;
		/* Out along the arc and back again. */
		double walked = 2 * (i + 0.5) / n, side = walked < 1 ? walked : 2 - walked;
		double azimuth = (-70 + 140 * side + rng_range(&r, -6, 6)) * PI / 180;
		double elevation = (o->preset->elevations[walked >= 1] + rng_range(&r, -6, 6)) * PI / 180;
		double distance = far * rng_range(&r, 0.9, 1.1);
		double centre[3] = {distance * cos(elevation) * sin(azimuth),
			-distance * cos(elevation) * cos(azimuth), distance * sin(elevation)};
		double target[3] = {0.12 * reach * rng_normal(&r), 0.12 * reach * rng_normal(&r), 0.1};
		synth_cameras_aim(v, centre, target, 0.03 * rng_normal(&r));
	}
	return 0;
}

void synth_cameras_reference(const struct cameras *c, double centre[3], double right[2], double away[2])
{
	double one[3];
	int n = 0;

	centre[0] = centre[1] = centre[2] = 0;
	for (size_t i = 0; i < c->n; i++) {
		if (c->views[i].split != SPLIT_TRAIN)
			continue;
		camera_centre(&c->views[i], one);
		for (int k = 0; k < 3; k++)
			centre[k] += one[k];
		n++;
	}
	double length = hypot(centre[0], centre[1]);
	away[0] = -centre[0] / length;
	away[1] = -centre[1] / length;
	right[0] = away[1];
	right[1] = -away[0];
	for (int k = 0; k < 3; k++)
		centre[k] /= n;
}
