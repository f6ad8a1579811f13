#include "ask/arrangement.h"

#include "base/mem.h"
#include "geom/up.h"
#include "lang/colours.h"
#include "refer/extent.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { COLOURS_SEEN = 1024 }; /* Gaussians of an object */
static const double trimmed = 0.1, longer = 0.1, most_weight = 4;
static const double alike_colour = 8, alike_size = 0.15;
static const double degree0 = 0.28209479177387814; /* the spherical harmonic of degree 0 */

void arrangement_free(struct arrangement *a)
{
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

/* Level axes in the world (rows: right, away, up) with `away` along a direction. */
static void level_axes(const double up[3], const double direction[3], double axes[3][3])
{
	double away[3], rise = dot(direction, up), length;

	for (int k = 0; k < 3; k++)
		away[k] = direction[k] - rise * up[k];
	length = sqrt(dot(away, away));
	if (!(length > 1e-9)) { /* straight down, or no camera: any level direction */
		const double other[3] = {fabs(up[0]) < 0.9, fabs(up[0]) >= 0.9, 0};
		cross(up, other, away);
		length = sqrt(dot(away, away));
	}
	for (int k = 0; k < 3; k++)
		away[k] /= length;
	cross(away, up, axes[0]);
	memcpy(axes[1], away, sizeof away);
	memcpy(axes[2], up, 3 * sizeof *up);
}

/* Where the objects are, roughly: the mean of a few of their Gaussians. */
static void find_middle(const struct lifted *l, const struct splats *s, double middle[3])
{
	const size_t shares = (size_t)l->indptr[l->objects], step = 1 + shares / 1024;
	double count = 0;

	memset(middle, 0, 3 * sizeof *middle);
	for (size_t i = 0; i < shares; i += step, count++)
		for (size_t k = 0; k < 3; k++)
			middle[k] += s->means[3 * (size_t)l->index[i] + k];
	for (int k = 0; k < 3; k++)
		middle[k] /= count > 0 ? count : 1;
}

/* Axes and centre of the viewpoint. */
static void look(const struct cameras *c, const struct viewpoint *from, const double middle[3],
	double axes[3][3], double eye[3])
{
	double away[3] = {0}, count = 0, up[3];

	memset(eye, 0, 3 * sizeof *eye);
	cameras_up(c, up);
	for (size_t i = 0; i < c->n && from->kind == VIEWPOINT_USUAL; i++) {
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
	if (from->kind == VIEWPOINT_CAMERA) {
		camera_centre(from->camera, eye);
		memcpy(away, from->camera->world_to_camera[2], sizeof away);
	} else if (from->kind == VIEWPOINT_POINT) {
		memcpy(eye, from->point, 3 * sizeof *eye);
		for (int k = 0; k < 3; k++)
			away[k] = middle[k] - eye[k];
	}
	level_axes(up, away, axes);
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

static int by_weight(const void *a, const void *b)
{
	const double x = *(const double *)a, y = *(const double *)b;

	return (x > y) - (x < y);
}

/* No Gaussian counts more than most_weight times the middle one: a stray that is large has much weight. */
static void level_weights(double *weight, double *sorted, size_t n)
{
	memcpy(sorted, weight, n * sizeof *weight);
	qsort(sorted, n, sizeof *sorted, by_weight);
	for (size_t i = 0; i < n; i++)
		weight[i] = fmin(weight[i], most_weight * sorted[n / 2]);
}

/* The Gaussians that are mostly the object's and hang together: ids (n) of *x. */
static int find_own(struct extent *x, const struct lifted *l, size_t object, const struct splats *s,
	const double up[3], struct err *e)
{
	const size_t begin = (size_t)l->indptr[object], room = (size_t)l->indptr[object + 1] - begin;
	int32_t *ids = mem_alloc(room, sizeof *ids, "objects", e);
	float *shares = mem_alloc(room, sizeof *shares, "objects", e);
	size_t n = 0;
	int bad = !ids || !shares;

	for (size_t i = begin; i < begin + room && !bad; i++)
		if (l->share[i] > 0.5F && size_of(s, (size_t)l->index[i]) > 0) {
			ids[n] = l->index[i];
			shares[n++] = l->share[i];
		}
	bad = bad || extent_find(x, s, ids, shares, n, up, e);
	free(ids);
	free(shares);
	return bad ? -1 : 0;
}

/* What is made of one object's Gaussians. */
struct measured {
	double *weight, *sorted;  /* (n) */
	struct weighted *along;	  /* (n) */
};

/* Mean colour, and what it is called, of a sample of its Gaussians. */
static void take_colours(struct arranged *o, const struct splats *s, const int32_t *ids, const double *weight, size_t n)
{
	const size_t step = 1 + n / COLOURS_SEEN;
	double total = 0;

	for (size_t i = 0; i < n; i += step)
		total += weight[i];
	for (size_t i = 0; i < n; i += step) {
		const float *sh = s->sh + (size_t)ids[i] * (size_t)s->sh_coefficients * 3;
		double lab[3], rgb[3];
		for (int k = 0; k < 3; k++)
			rgb[k] = 0.5 + degree0 * sh[k];
		colour_lab(rgb, lab);
		for (size_t k = 0; k < 3; k++)
			o->lab[k] += weight[i] / total * lab[k];
		colour_call(lab, weight[i] / total, o->colours);
	}
}

static void take_box(struct arranged *o, const struct splats *s, const int32_t *ids, double axes[3][3],
	const struct measured *m, size_t n)
{
	double total = 0;

	for (size_t i = 0; i < n; i++)
		total += m->weight[i];
	for (int k = 0; k < 3; k++) {
		for (size_t i = 0; i < n; i++) {
			const float *mean = s->means + 3 * (size_t)ids[i];
			m->along[i] = (struct weighted){
				axes[k][0] * mean[0] + axes[k][1] * mean[1] + axes[k][2] * mean[2], m->weight[i]};
		}
		qsort(m->along, n, sizeof *m->along, by_place);
		const double low = quantile(m->along, n, trimmed * total);
		const double high = quantile(m->along, n, (1 - trimmed) * total);
		o->low[k] = low - longer * (high - low);
		o->high[k] = high + longer * (high - low);
		o->centre[k] = (low + high) / 2;
	}
}

static int measure(struct arranged *o, const struct lifted *l, size_t object, const struct splats *s,
	double axes[3][3], struct err *e)
{
	struct extent own;

	if (find_own(&own, l, object, s, axes[2], e))
		return -1;
	struct measured m = {mem_alloc(own.n, sizeof *m.weight, "objects", e),
		mem_alloc(own.n, sizeof *m.sorted, "objects", e), mem_alloc(own.n, sizeof *m.along, "objects", e)};
	const int bad = !m.weight || !m.sorted || !m.along;
	if (!bad && own.n) {
		o->is_there = o->in_sight = 1;
		for (size_t i = 0; i < own.n; i++)
			m.weight[i] = size_of(s, (size_t)own.ids[i]);
		level_weights(m.weight, m.sorted, own.n);
		take_colours(o, s, own.ids, m.weight, own.n);
		take_box(o, s, own.ids, axes, &m, own.n);
	}
	free(m.weight);
	free(m.sorted);
	free(m.along);
	extent_free(&own);
	return bad ? -1 : 0;
}

/* Where objects are in a picture: whether their middle is in it, and how far right it is there, as a length at
 * the objects' mean distance. */
static void see(struct arrangement *a, const struct camera *c, double axes[3][3])
{
	double mean = 0, count = 0, depth;

	for (int pass = 0; pass < 2; pass++)
		for (size_t o = 0; o < a->n; o++) {
			struct arranged *p = &a->objects[o];
			double world[3], at[3];
			if (!p->is_there)
				continue;
			for (int d = 0; d < 3; d++)
				world[d] = p->centre[0] * axes[0][d] + p->centre[1] * axes[1][d] +
					   p->centre[2] * axes[2][d];
			camera_transform(c, world, at);
			depth = fmax(at[2], 1e-6);
			if (!pass) {
				mean += at[2];
				count++;
				continue;
			}
			const double x = c->fx * at[0] / depth + c->cx, y = c->fy * at[1] / depth + c->cy;
			p->in_sight = at[2] > 0 && x >= 0 && x <= c->width && y >= 0 && y <= c->height;
			p->side = at[0] / depth * fmax(mean / count, 1e-6);
		}
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
		a->viewer.centre[k] -= middle[k];
		a->viewer.low[k] = a->viewer.high[k] = a->viewer.centre[k];
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
	const struct cameras *cameras, const struct viewpoint *from, struct err *e)
{
	double axes[3][3], eye[3], middle[3];
	int bad = 0;

	*a = (struct arrangement){.n = l->objects};
	a->objects = mem_zalloc(a->n, sizeof *a->objects, "objects", e);
	if (!a->objects)
		return -1;
	find_middle(l, splats, middle);
	look(cameras, from, middle, axes, eye);
	a->viewer.is_there = 1;
	for (int k = 0; k < 3; k++)
		a->viewer.centre[k] = dot(axes[k], eye);
	for (size_t o = 0; o < a->n && !bad; o++)
		bad = measure(&a->objects[o], l, o, splats, axes, e);
	if (!bad) {
		for (size_t o = 0; o < a->n; o++)
			a->objects[o].side = a->objects[o].centre[0];
		if (from->kind == VIEWPOINT_CAMERA)
			see(a, from->camera, axes);
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

double arranged_bulk(const struct arranged *o)
{
	double sum = 0;

	for (int k = 0; k < 3; k++)
		sum += log(fmax(o->high[k] - o->low[k], 1e-6)) / 3;
	return sum;
}
