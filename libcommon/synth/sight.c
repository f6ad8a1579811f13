#include "synth/sight.h"

#include "base/mem.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { CELLS = SYNTH_SIGHT_COLUMNS * SYNTH_SIGHT_COLUMNS };

static void set_points(float *points, const struct synth_object *o)
{
	struct synth_surface surface;
	double p[3], normal[3];

	synth_object_surface(&surface, o->shape);
	for (int i = 0; i < SYNTH_SIGHT_POINTS; i++, points += 3) {
		/* Evenly spread in two dimensions: multiples of the golden ratio. */
		synth_surface_at(
			&surface, (i + 0.5) / SYNTH_SIGHT_POINTS, fmod(0.6180339887498949 * i, 1), p, normal);
		synth_object_place(o, p, p);
		for (int k = 0; k < 3; k++)
			points[k] = (float)p[k];
	}
}

int synth_sight_make(struct synth_sight *s, const struct synth_object *objects, int n, struct err *e)
{
	*s = (struct synth_sight){.n = n};
	s->points = mem_alloc((size_t)n, 3 * SYNTH_SIGHT_POINTS * sizeof *s->points, "points", e);
	s->depth = mem_alloc(CELLS, sizeof *s->depth, "depth buffer", e);
	s->seen = mem_alloc(CELLS, sizeof *s->seen, "depth buffer", e);
	s->last = mem_alloc(CELLS, sizeof *s->last, "depth buffer", e);
	if (!s->points || !s->depth || !s->seen || !s->last) {
		synth_sight_free(s);
		return -1;
	}
	for (int i = 0; i < n; i++)
		set_points(s->points + (size_t)i * 3 * SYNTH_SIGHT_POINTS, &objects[i]);
	return 0;
}

void synth_sight_free(struct synth_sight *s)
{
	free(s->points);
	free(s->depth);
	free(s->seen);
	free(s->last);
	*s = (struct synth_sight){0};
}

void synth_sight_look(struct synth_sight *s, const struct camera *c, int *visible, int *whole)
{
	int longer = c->width > c->height ? c->width : c->height;
	double scale = (double)SYNTH_SIGHT_COLUMNS / longer;

	for (int i = 0; i < CELLS; i++) {
		s->depth[i] = INFINITY;
		s->seen[i] = s->last[i] = -1;
	}
	memset(visible, 0, (size_t)s->n * sizeof *visible);
	memset(whole, 0, (size_t)s->n * sizeof *whole);
	for (int o = 0; o < s->n; o++) {
		const float *point = s->points + (size_t)o * 3 * SYNTH_SIGHT_POINTS;
		for (int i = 0; i < SYNTH_SIGHT_POINTS; i++, point += 3) {
			double p[3], world[3] = {point[0], point[1], point[2]};
			camera_transform(c, world, p);
			if (p[2] <= 0.2)
				continue;
			double x = c->fx * p[0] / p[2] + c->cx, y = c->fy * p[1] / p[2] + c->cy;
			if (!(x >= 0 && x < c->width && y >= 0 && y < c->height))
				continue;
			int cell = (int)(y * scale) * SYNTH_SIGHT_COLUMNS + (int)(x * scale);
			whole[o] += s->last[cell] != o;
			s->last[cell] = o;
			if (p[2] < (double)s->depth[cell]) {
				s->depth[cell] = (float)p[2];
				s->seen[cell] = o;
			}
		}
	}
	for (int i = 0; i < CELLS; i++)
		if (s->seen[i] >= 0)
			visible[s->seen[i]]++;
}
