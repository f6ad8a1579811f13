#include "refer/arrangement.h"

#include "base/mem.h"
#include "geom/up.h"
#include "lang/colours.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double trimmed = 0.1, longer = 0.1;
static const double alike_colour = 8, alike_size = 0.15;
static const double degree0 = 0.28209479177387814; /* the spherical harmonic of degree 0 */

void arrangement_free(struct arrangement *a)
{
	for (size_t o = 0; a->objects && o < a->n; o++) {
		free(a->objects[o].palette);
		free(a->objects[o].part);
	}
	free(a->objects);
	*a = (struct arrangement){0};
}

static double dot(const double a[3], const double b[3])
{
	return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double out[3])
{
	out[0] = a[1] * b[2] - a[2] * b[1];
	out[1] = a[2] * b[0] - a[0] * b[2];
	out[2] = a[0] * b[1] - a[1] * b[0];
}

static int is_looked_from(const struct cameras *c, size_t i)
{
	int any = 0;

	for (size_t k = 0; k < c->n; k++)
		any |= c->views[k].split == SPLIT_TRAIN;
	return !any || c->views[i].split == SPLIT_TRAIN;
}

/* Axes of the reference viewpoint in the world (rows: right, away, up) and its centre. */
static void look(const struct cameras *c, double axes[3][3], double eye[3])
{
	double away[3] = {0}, count = 0, up[3];

	memset(eye, 0, 3 * sizeof *eye);
	cameras_up(c, up);
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
	double rise = dot(away, up);
	for (int k = 0; k < 3; k++) {
		eye[k] /= count > 0 ? count : 1;
		away[k] -= rise * up[k];
	}
	double length = sqrt(dot(away, away));
	if (!(length > 1e-9)) { /* straight down, or no camera: any level direction */
		const double other[3] = {fabs(up[0]) < 0.9, fabs(up[0]) >= 0.9, 0};
		cross(up, other, away);
		length = sqrt(dot(away, away));
	}
	for (int k = 0; k < 3; k++)
		away[k] /= length;
	cross(away, up, axes[0]);
	memcpy(axes[1], away, sizeof away);
	memcpy(axes[2], up, sizeof up);
}

struct weighted {
	double at, weight;
};

static int by_place(const void *a, const void *b)
{
	const struct weighted *x = a, *y = b;

	return (x->at > y->at) - (x->at < y->at);
}

static double quantile(const struct weighted *w, size_t n, double weight)
{
	double sum = 0;

	for (size_t i = 0; i < n; i++) {
		sum += w[i].weight;
		if (sum >= weight)
			return w[i].at;
	}
	return w[n - 1].at;
}

/* How much of the object a Gaussian makes up: what it covers, seen from anywhere. */
static double size_of(const struct splats *s, size_t g)
{
	const float *r = s->scales + 3 * g;
	double area = (double)r[0] * r[1] + (double)r[1] * r[2] + (double)r[2] * r[0];

	return isfinite(area) ? area * s->opacities[g] : 0;
}

static int measure(struct arranged *o, const struct lifted *l, size_t object, const struct splats *s,
	double axes[3][3], struct err *e)
{
	const size_t begin = (size_t)l->indptr[object], end = (size_t)l->indptr[object + 1];
	struct weighted *along = mem_alloc(3 * (end - begin), sizeof *along, "objects", e);
	size_t n = 0, room = end - begin;
	double total = 0;

	o->palette = mem_alloc(3 * room, sizeof *o->palette, "objects", e);
	o->part = mem_alloc(room, sizeof *o->part, "objects", e);
	if (!along || !o->palette || !o->part) {
		free(along);
		return -1;
	}
	for (size_t i = begin; i < end; i++) {
		const size_t g = (size_t)l->index[i];
		const double weight = l->share[i] > 0.5F ? l->share[i] * size_of(s, g) : 0;
		if (!(weight > 0))
			continue;
		double mean[3], lab[3], rgb[3];
		for (int k = 0; k < 3; k++) {
			mean[k] = s->means[3 * g + (size_t)k];
			rgb[k] = 0.5 + degree0 * s->sh[g * (size_t)s->sh_coefficients * 3 + (size_t)k];
		}
		for (int k = 0; k < 3; k++)
			along[(size_t)k * room + n] = (struct weighted){dot(axes[k], mean), weight};
		colour_lab(rgb, lab);
		for (int k = 0; k < 3; k++) {
			o->palette[3 * n + (size_t)k] = (float)lab[k];
			o->lab[k] += weight * lab[k];
		}
		o->part[n++] = (float)weight;
		total += weight;
	}
	o->colours = n;
	o->is_there = n > 0;
	for (int k = 0; k < 3 && n; k++) {
		struct weighted *w = along + (size_t)k * room;
		qsort(w, n, sizeof *w, by_place);
		double low = quantile(w, n, trimmed * total), high = quantile(w, n, (1 - trimmed) * total);
		o->low[k] = low - longer * (high - low);
		o->high[k] = high + longer * (high - low);
		o->centre[k] = (low + high) / 2;
		o->lab[k] /= total;
	}
	for (size_t i = 0; i < n; i++)
		o->part[i] = (float)(o->part[i] / total);
	free(along);
	return 0;
}

/* Moves the origin to the middle of the objects. */
static void centre_all(struct arrangement *a)
{
	double middle[3] = {0}, n = 0;

	for (size_t o = 0; o < a->n; o++)
		for (int k = 0; k < 3 && a->objects[o].is_there; k++) {
			middle[k] += a->objects[o].centre[k];
			n += k == 0;
		}
	for (int k = 0; k < 3; k++) {
		middle[k] /= n > 0 ? n : 1;
		a->eye[k] -= middle[k];
		for (size_t o = 0; o < a->n; o++) {
			a->objects[o].low[k] -= middle[k];
			a->objects[o].high[k] -= middle[k];
			a->objects[o].centre[k] -= middle[k];
		}
	}
}

static int find_spacing(struct arrangement *a, struct err *e)
{
	struct weighted *between = mem_alloc(a->n * a->n, sizeof *between, "objects", e);
	size_t n = 0;

	if (!between)
		return -1;
	for (size_t i = 0; i < a->n; i++)
		for (size_t k = 0; k < i; k++) {
			const struct arranged *p = &a->objects[i], *q = &a->objects[k];
			if (p->is_there && q->is_there)
				between[n++] = (struct weighted){
					hypot(p->centre[0] - q->centre[0], p->centre[1] - q->centre[1]), 1};
		}
	if (n)
		qsort(between, n, sizeof *between, by_place);
	a->spacing = n && between[n / 2].at > 0 ? between[n / 2].at : 1;
	free(between);
	return 0;
}

int arrangement_make(struct arrangement *a, const struct lifted *l, const struct splats *splats,
	const struct cameras *cameras, struct err *e)
{
	double axes[3][3], eye[3];
	int bad = 0;

	*a = (struct arrangement){.n = l->objects};
	a->objects = mem_zalloc(a->n, sizeof *a->objects, "objects", e);
	if (!a->objects)
		return -1;
	look(cameras, axes, eye);
	for (int k = 0; k < 3; k++)
		a->eye[k] = dot(axes[k], eye);
	for (size_t o = 0; o < a->n && !bad; o++)
		bad = measure(&a->objects[o], l, o, splats, axes, e);
	if (!bad) {
		centre_all(a);
		bad = find_spacing(a, e);
	}
	if (bad)
		arrangement_free(a);
	return bad ? -1 : 0;
}

/* Lengths of the box: the shorter and the longer one on the ground, and the height. */
static void lengths(const struct arranged *o, double out[3])
{
	double a = o->high[0] - o->low[0], b = o->high[1] - o->low[1];

	out[0] = log(fmax(fmin(a, b), 1e-6));
	out[1] = log(fmax(fmax(a, b), 1e-6));
	out[2] = log(fmax(o->high[2] - o->low[2], 1e-6));
}

double arrangement_alike(const struct arrangement *a, size_t i, size_t k)
{
	const struct arranged *p = &a->objects[i], *q = &a->objects[k];
	double x[3], y[3], sum = 0;

	if (i == k)
		return 0;
	if (!p->is_there || !q->is_there)
		return -INFINITY;
	lengths(p, x);
	lengths(q, y);
	for (int d = 0; d < 3; d++) {
		double colour = (p->lab[d] - q->lab[d]) / alike_colour, size = (x[d] - y[d]) / alike_size;
		sum += colour * colour + size * size;
	}
	return -0.5 * sum;
}
