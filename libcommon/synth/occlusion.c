#include "synth/occlusion.h"

#include "base/mem.h"

#include <math.h>

enum { CELLS = SYNTH_OCCLUSION_COLUMNS * SYNTH_OCCLUSION_COLUMNS };

static void set_points(float *points, const struct synth_object *o)
{
	struct synth_surface surface;
	struct synth_spot spot;

	synth_object_surface(&surface, o->shape);
	for (int i = 0; i < SYNTH_OCCLUSION_POINTS; i++, points += 3) {
		/* Evenly spread in two dimensions: multiples of the golden ratio. */
		synth_surface_spot(&surface, (i + 0.5) / SYNTH_OCCLUSION_POINTS,
			fmod(0.6180339887498949 * i, 1), 0, &spot);
		synth_object_place(o, spot.point, spot.point);
		for (int k = 0; k < 3; k++)
			points[k] = (float)spot.point[k];
	}
}

int synth_occlusion_make(struct synth_occlusion *s, const struct synth_object *objects, int n, struct err *e)
{
	*s = (struct synth_occlusion){.n = n};
	s->points = mem_alloc((size_t)n, 3 * SYNTH_OCCLUSION_POINTS * sizeof *s->points, "points", e);
	s->depth = mem_alloc(CELLS, sizeof *s->depth, "depth buffer", e);
	s->seen = mem_alloc(CELLS, sizeof *s->seen, "depth buffer", e);
	s->last = mem_alloc(CELLS, sizeof *s->last, "depth buffer", e);
	if (!s->points || !s->depth || !s->seen || !s->last)
		return -1;
	for (int i = 0; i < n; i++)
		set_points(s->points + (size_t)i * 3 * SYNTH_OCCLUSION_POINTS, &objects[i]);
	return 0;
}

void synth_occlusion_free(struct synth_occlusion *s)
{
	mem_free_all(s->points, s->depth, s->seen, s->last);
	*s = (struct synth_occlusion){0};
}

void synth_occlusion_look(struct synth_occlusion *s, const struct camera *c, int *visible, int *whole)
{
	int longer = c->width > c->height ? c->width : c->height;
	double scale = (double)SYNTH_OCCLUSION_COLUMNS / longer;
	const float near = 0.2f, columns = (float)(scale * c->width), rows = (float)(scale * c->height);
	float m[3][4]; /* from the world to cells, times z */

	for (int k = 0; k < 4; k++) {
		double z = c->world_to_camera[2][k];
		m[0][k] = (float)(scale * (c->fx * c->world_to_camera[0][k] + c->cx * z));
		m[1][k] = (float)(scale * (c->fy * c->world_to_camera[1][k] + c->cy * z));
		m[2][k] = (float)z;
	}
	for (int i = 0; i < CELLS; i++) {
		s->depth[i] = INFINITY;
		s->seen[i] = s->last[i] = -1;
	}
	memset(visible, 0, (size_t)s->n * sizeof *visible);
	memset(whole, 0, (size_t)s->n * sizeof *whole);
	for (int o = 0; o < s->n; o++) {
		const float *point = s->points + (size_t)o * 3 * SYNTH_OCCLUSION_POINTS;
		for (int i = 0; i < SYNTH_OCCLUSION_POINTS; i++, point += 3) {
			float p[3];
			for (int k = 0; k < 3; k++)
				p[k] = m[k][0] * point[0] + m[k][1] * point[1] + m[k][2] * point[2] + m[k][3];
			if (!(p[2] > near))
				continue;
			float x = p[0] / p[2], y = p[1] / p[2];
			if (!(x >= 0 && x < columns && y >= 0 && y < rows))
				continue;
			int cell = (int)y * SYNTH_OCCLUSION_COLUMNS + (int)x;
			whole[o] += s->last[cell] != o;
			s->last[cell] = o;
			if (p[2] < s->depth[cell]) {
				s->depth[cell] = p[2];
				s->seen[cell] = o;
			}
		}
	}
	for (int i = 0; i < CELLS; i++)
		if (s->seen[i] >= 0)
			visible[s->seen[i]]++;
}
