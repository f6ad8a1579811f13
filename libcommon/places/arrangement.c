#include "places/arrangement.h"

#include "places/object_span.h"
#include "base/compare.h"
#include "base/mem.h"
#include "geom/up.h"
#include "geom/vector.h"
#include "lift/extent.h"

#include <math.h>

enum { POINTS = 2048 }; /* of an object, at most about so many */
static const double most_weight = 4;
static const double no_direction = 0.1, nothing = 1e-6; /* of the spacing */
static const double degree0 = 0.28209479177387814;	/* the spherical harmonic of degree 0 */

void arrangement_free(struct arrangement *a)
{
	free(a->objects);
	free(a->points);
	free(a->along);
	*a = (struct arrangement){0};
}

/* Where the objects are, roughly: the mean of their points. */
static void find_middle(const struct arrangement *a, double middle[3])
{
	const size_t n = a->point_count;

	memset(middle, 0, 3 * sizeof *middle);
	for (size_t i = 0; i < n; i++)
		for (int k = 0; k < 3; k++)
			middle[k] += a->points[i].at[k] / (double)n;
}

int arrangement_where(const struct arrangement *a, size_t object, double at[3])
{
	double weight = 0;

	memset(at, 0, 3 * sizeof *at);
	const struct arranged_point *p = a->points + a->objects[object].begin;
	for (size_t i = 0; i < a->objects[object].count; i++) {
		weight += p[i].weight;
		for (int k = 0; k < 3; k++)
			at[k] += p[i].weight * p[i].at[k];
	}
	for (int k = 0; k < 3 && weight > 0; k++)
		at[k] /= weight;
	return weight > 0;
}

/* No Gaussian counts more than most_weight times the middle one: a stray that is large has much weight. */
static void level_weights(double *weight, double *sorted, size_t n)
{
	memcpy(sorted, weight, n * sizeof *weight);
	qsort(sorted, n, sizeof *sorted, compare_double);
	for (size_t i = 0; i < n; i++)
		weight[i] = fmin(weight[i], most_weight * sorted[n / 2]);
}

/* How far a colour depends on where it is seen from: the sum of the squares of the first degree. */
static double view_dependence(const struct splats *s, const float *sh)
{
	double sum = 0;

	for (int k = 3; k < 12 && s->sh_coefficients >= 4; k++)
		sum += (double)sh[k] * sh[k];
	return isfinite(sum) ? sum : 0;
}

/* Mean colour, what it is called, and the surface, of every `step`th Gaussian. points (own->n / step + 1) is
 * scratch. */
static int take_looks(struct arranged *o, const struct splats *s, const struct extent *own, size_t step,
	const double *weight, const double up[3], struct surface_point *points, struct err *e)
{
	struct colour_labs words;
	double total = 0;
	size_t n = 0;

	colour_labs_make(&words);
	for (size_t i = 0; i < own->n; i += step)
		total += weight[i];
	for (size_t i = 0; i < own->n; i += step) {
		const float *sh = s->sh + (size_t)own->ids[i] * (size_t)s->sh_coefficients * 3;
		double lab[3], rgb[3];
		for (int k = 0; k < 3; k++)
			rgb[k] = 0.5 + degree0 * sh[k];
		colour_lab(rgb, lab);
		for (size_t k = 0; k < 3; k++) {
			o->lab[k] += weight[i] / total * lab[k];
		}
		colour_call(&words, lab, weight[i] / total, o->colours);
		const float *mean = s->means + 3 * (size_t)own->ids[i];
		points[n++] = (struct surface_point){
			{mean[0], mean[1], mean[2]}, {lab[0], lab[1], lab[2]}, weight[i]};
		o->surface.view_dependence += weight[i] / total * view_dependence(s, sh) / 9;
	}
	o->surface.view_dependence = sqrt(o->surface.view_dependence);
	return surface_find(&o->surface, points, n, up, e);
}

/* The points of object o, after those before it. */
static int take_points(struct arrangement *a, size_t o, const struct extent *own, const struct splats *s,
	const double up[3], struct err *e)
{
	const size_t step = 1 + own->n / POINTS;
	SCOPED double *weight = mem_alloc(own->n, sizeof *weight, "objects", e);
	SCOPED double *sorted = mem_alloc(own->n, sizeof *sorted, "objects", e);
	SCOPED struct surface_point *points = mem_alloc(POINTS + 1, sizeof *points, "objects", e);
	int bad = !weight || !sorted || !points;
	a->objects[o].begin = a->point_count;
	a->objects[o].is_there = own->n > 0;
	if (!bad && own->n) {
		for (size_t i = 0; i < own->n; i++)
			weight[i] = extent_part(s, (size_t)own->ids[i]);
		level_weights(weight, sorted, own->n);
		bad = take_looks(&a->objects[o], s, own, step, weight, up, points, e);
		for (size_t i = 0; i < own->n; i += step) {
			const float *mean = s->means + 3 * (size_t)own->ids[i];
			a->points[a->point_count++] = (struct arranged_point){
				{mean[0], mean[1], mean[2]}, weight[i] * own->weight[i]};
		}
	}
	a->objects[o].count = a->point_count - a->objects[o].begin;
	return bad ? -1 : 0;
}

void arrangement_swap(struct arrangement *a, size_t i, size_t k)
{
	const struct arranged was = a->objects[i];

	a->objects[i] = a->objects[k];
	a->objects[k] = was;
}

/* How objects shine beside one another. */
static void compare_gloss(struct arrangement *a)
{
	double low = INFINITY, high = 0;

	for (size_t o = 0; o < a->n; o++) {
		const double x = a->objects[o].surface.view_dependence;
		low = x > 0 ? fmin(low, x) : low;
		high = fmax(high, x);
	}
	for (size_t o = 0; o < a->n; o++)
		surface_set_gloss(&a->objects[o].surface, low, high);
}

static void take_box(struct arrangement *a, size_t o, double axes[3][3])
{
	struct arranged *to = &a->objects[o];
	const size_t n = to->count;

	for (int k = 0; k < 3 && n; k++) {
		for (size_t i = 0; i < n; i++) {
			const struct arranged_point *p = &a->points[to->begin + i];
			a->along[i] = (struct quantile_item){vector_dot(axes[k], p->at), p->weight};
		}
		const struct object_span span = object_span(a->along, n, k == 2);
		to->low[k] = span.low;
		to->high[k] = span.high;
		to->centre[k] = span.middle;
	}
	to->side = to->centre[0];
	to->in_sight = to->is_there;
}

/* Where objects are in a picture: whether their middle is in it, and, unless whoever speaks has turned to
 * something, how far right it is there, as a length at the objects' mean distance. */
static void see(struct arrangement *a, const struct camera *c, double axes[3][3], int is_facing)
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
			depth = fmax(at[2], nothing * a->spacing);
			if (!pass) {
				mean += at[2];
				count++;
				continue;
			}
			const double x = c->fx * at[0] / depth + c->cx, y = c->fy * at[1] / depth + c->cy;
			p->in_sight = at[2] > 0 && x >= 0 && x <= c->width && y >= 0 && y <= c->height;
			if (!is_facing)
				p->side = at[0] / depth * fmax(mean / count, nothing * a->spacing);
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

static void find_spacing(struct arrangement *a)
{
	size_t n = 0;

	for (size_t i = 0; i < a->n; i++)
		for (size_t k = 0; k < i; k++) {
			const struct arranged *p = &a->objects[i], *q = &a->objects[k];
			if (p->is_there && q->is_there)
				a->along[n++] = (struct quantile_item){
					hypot(p->centre[0] - q->centre[0], p->centre[1] - q->centre[1]), 1};
		}
	const double median = n ? quantile_weighted(a->along, n, 0.5) : 0;
	a->spacing = median > 0 ? median : 1;
}

void arrangement_look(struct arrangement *a, const struct viewpoint *from)
{
	double axes[3][3], eye[3], middle[3];

	find_middle(a, middle);
	viewpoint_axes(from, a->cameras, middle, no_direction * a->spacing, axes, eye);
	a->viewer.is_there = 1;
	for (int k = 0; k < 3; k++)
		a->viewer.centre[k] = vector_dot(axes[k], eye);
	for (size_t o = 0; o < a->n; o++)
		take_box(a, o, axes);
	if (from->kind == VIEWPOINT_CAMERA)
		see(a, from->camera, axes, from->is_facing);
	centre_all(a);
	find_spacing(a);
}

int arrangement_make(struct arrangement *a, const struct lifted *l, const struct splats *splats,
	const struct cameras *cameras, struct err *e)
{
	static const struct viewpoint usual = {.kind = VIEWPOINT_USUAL};
	size_t along = l->objects * l->objects;
	struct extent *found = NULL;
	double up[3];

	*a = (struct arrangement){.n = l->objects, .cameras = cameras};
	a->objects = mem_zalloc(a->n, sizeof *a->objects, "objects", e);
	a->points = mem_alloc(a->n, (POINTS + 1) * sizeof *a->points, "objects", e);
	a->along = mem_alloc(along > POINTS ? along : POINTS + 1, sizeof *a->along, "objects", e);
	int bad = !a->objects || !a->points || !a->along;
	cameras_up(cameras, up);
	bad = bad || (!l->extents && lifted_extents(&found, l, splats, up, e));
	for (size_t o = 0; o < a->n && !bad; o++)
		bad = take_points(a, o, &(found ? found : l->extents)[o], splats, up, e);
	lifted_extents_free(found, a->n);
	if (!bad)
		compare_gloss(a);
	if (bad)
		arrangement_free(a);
	else
		arrangement_look(a, &usual);
	return bad ? -1 : 0;
}

double arranged_length(const struct arrangement *a, double length)
{
	return log(fmax(length, nothing * a->spacing));
}

double arranged_bulk(const struct arrangement *a, const struct arranged *o)
{
	double sum = 0;

	for (int k = 0; k < 3; k++)
		sum += arranged_length(a, o->high[k] - o->low[k]) / 3;
	return sum;
}
