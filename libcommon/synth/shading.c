#include "synth/shading.h"

#include "geom/vector.h"
#include "splat/sh.h"

#include <math.h>
#include <string.h>

/* Towards the light, and how much of a colour comes from everywhere. */
static const double light[3] = {-0.45, -0.40, 0.80};
static const double ambient = 0.58;

static const double colours[SYNTH_COLOURS][3] = {{0.80, 0.08, 0.08}, {0.10, 0.55, 0.15}, {0.10, 0.22, 0.80},
	{0.95, 0.85, 0.10}, {0.95, 0.95, 0.93}, {0.07, 0.07, 0.08}, {0.98, 0.50, 0.05}, {0.48, 0.14, 0.62},
	{0.36, 0.18, 0.08}, {0.98, 0.55, 0.70}, {0.48, 0.49, 0.50}, {0.05, 0.58, 0.58}};

static void mix(double rgb[3], const double with[3], double share)
{
	for (int k = 0; k < 3; k++)
		rgb[k] += share * (with[k] - rgb[k]);
}

/* The colour of an object at a point of its surface. */
static void object_colour(const struct synth_object *o, enum synth_tint tint, const double point[3],
	const struct synth_noise *texture, double rgb[3])
{
	static const double pages[3] = {0.90, 0.87, 0.76}, cap[3] = {0.20, 0.20, 0.22},
			    pale[3] = {0.96, 0.96, 0.94}, dark[3] = {0.25, 0.25, 0.27}, night[3] = {0};
	int is_pale = o->colour == SYNTH_WHITE || o->colour == SYNTH_YELLOW || o->colour == SYNTH_PINK;
	const double *second = is_pale ? dark : pale;

	memcpy(rgb, colours[o->colour], 3 * sizeof(double));
	if (tint == SYNTH_PAGES)
		memcpy(rgb, pages, sizeof pages);
	else if (tint == SYNTH_CAP)
		memcpy(rgb, cap, sizeof cap);
	else if (tint == SYNTH_INNER)
		mix(rgb, night, 0.35);
	if (tint != SYNTH_OWN)
		return;
	if (o->finish == SYNTH_STRIPED) {
		/* Up an upright thing, across a flat one. */
		double at = o->shape == SYNTH_BOOK || o->shape == SYNTH_PLATE ? point[0] : point[2];
		double phase = at / 0.24 - floor(at / 0.24);
		if (phase > 0.6)
			mix(rgb, second, 0.75);
	} else if (o->finish == SYNTH_SPECKLED) {
		double at =
			synth_noise_at(texture, 13 * point[0] + 9 * point[2], 13 * point[1] - 9 * point[2]);
		if (at > 0.33)
			mix(rgb, second, 0.7);
	}
}

/* How much light the objects leave on a point of the table or of `owner`'s top. */
static double shadow(const struct synth_scene *s, int owner, const double point[3])
{
	double left = 1;

	for (int i = 0; i < s->object_count && !s->is_moving; i++) {
		const struct synth_object *o = &s->objects[i];
		double reach = o->z + 0.5 * o->height - point[2];
		if (i == owner || reach <= 0)
			continue;
		double dx = point[0] - o->x + light[0] * reach, dy = point[1] - o->y + light[1] * reach;
		double at = hypot(dx, dy) / (0.8 * o->radius + 0.4 * reach);
		left *= 1 - 0.45 * fmax(0, 1 - at * at);
	}
	return left;
}

void synth_albedo(const struct synth_scene *s, const struct synth_noise *texture, int owner, int is_table,
	const struct synth_spot *spot, const double p[3], double rgb[3])
{
	const struct synth_preset *preset = s->preset;
	const double *ground = spot->normal[2] > 0.5 ? preset->carpet : preset->wall;
	double tone = 1;

	if (owner >= 0) {
		object_colour(&s->objects[owner], spot->tint, spot->point, texture, rgb);
		tone = spot->normal[2] > 0.5 ? shadow(s, owner, p) : 1;
	} else if (is_table) { /* boards along x */
		double board = floor((p[1] + s->table.half_depth) / preset->boards);
		double grain = synth_noise_at(texture, 0.6 * p[0] + 17 * board, 9 * p[1]);
		tone = 1 + 0.13 * grain + 0.05 * synth_noise_at(texture, 7.3 * board, 0.5);
		tone *= spot->tint == SYNTH_OWN ? shadow(s, owner, p) : 0.8;
		memcpy(rgb, preset->wood, 3 * sizeof *rgb);
	} else {
		tone = 1 + 0.10 * synth_noise_at(texture, 0.7 * p[0] + 0.9 * p[2], 0.7 * p[1]);
		memcpy(rgb, ground, 3 * sizeof *rgb);
	}
	for (int k = 0; k < 3; k++)
		rgb[k] *= tone;
}

double synth_shade(const double normal[3])
{
	return ambient + (1 - ambient) * fmax(0, vector_dot(normal, light));
}

void synth_harmonics(float *sh, const double rgb[3], const double normal[3], double gloss)
{
	double along = 2 * vector_dot(light, normal), mirrored[3];

	for (int k = 0; k < 3; k++)
		mirrored[k] = along * normal[k] - light[k];
	for (int k = 0; k < 3; k++) {
		sh[k] = (float)((rgb[k] - 0.5) / SH_C0);
		/* The direction in the harmonics is from the camera to the Gaussian. */
		sh[3 + k] = (float)(gloss * mirrored[1] / SH_C1);
		sh[6 + k] = (float)(-gloss * mirrored[2] / SH_C1);
		sh[9 + k] = (float)(gloss * mirrored[0] / SH_C1);
	}
}
