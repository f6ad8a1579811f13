#include "ask/relate.h"

#include "ask/constants.h"
#include "base/largest.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { RANKS = 32 }; /* "the 32nd from the left" and all after it are one */

static double step(double x)
{
	return 1 / (1 + exp(-fmin(fmax(x, -40), 40)));
}

static const struct arranged *at(const struct arrangement *a, size_t i)
{
	return i < a->n ? &a->objects[i] : &a->viewer;
}

/* How much of the smaller foot lies within the other. */
static double feet_overlap(const struct arranged *p, const struct arranged *q)
{
	double common = 1, own = 1, other = 1;

	for (int k = 0; k < 2; k++) {
		common *= fmax(0, fmin(p->high[k], q->high[k]) - fmax(p->low[k], q->low[k]));
		own *= p->high[k] - p->low[k];
		other *= q->high[k] - q->low[k];
	}
	own = fmin(own, other);
	return own > 0 ? common / own : 0;
}

double relate_stands_on(const struct arrangement *a, const struct arranged *p, const struct arranged *q)
{
	return step((feet_overlap(p, q) - 0.4) / 0.1) *
	       step((p->centre[2] - q->centre[2]) / (0.02 * a->spacing)) *
	       exp(-fmax(0, (p->low[2] - q->high[2]) / a->spacing - TOUCHING) / 0.1);
}

double relate_gap(const struct arranged *p, const struct arranged *q)
{
	double sum = 0;

	for (int k = 0; k < 3; k++) {
		double d = fmax(0, fmax(p->low[k] - q->high[k], q->low[k] - p->high[k]));
		sum += d * d;
	}
	return sqrt(sum);
}

static double level_distance(const struct arranged *p, const struct arranged *q)
{
	return hypot(p->centre[0] - q->centre[0], p->centre[1] - q->centre[1]);
}

/* p is on the way `main` of q, and not too far aside. */
static double on_side(const struct arrangement *a, const struct arranged *p, const struct arranged *q,
	double main, double aside, enum relate_width width)
{
	const double there = step((main / a->spacing - APART_LEAST) / APART_SOFT);
	const double along = main / (hypot(main, aside) + 1e-9 * a->spacing),
		     up = p->centre[2] - q->centre[2];
	const double distance = hypot(level_distance(p, q), up);

	if (width == RELATE_HALF_PLANE)
		return there;
	const double straight = step((along - SIDEWAYS_LEAST) / SIDEWAYS_SOFT);
	const double aslant = width == RELATE_WIDE ? SIDEWAYS_WIDE : SIDEWAYS_ELSE;
	return there * (aslant + (1 - aslant) * straight) * exp(-NEARBY * distance / a->spacing) *
	       (1 - relate_stands_on(a, p, q)) * (1 - relate_stands_on(a, q, p));
}

static double near(const struct arrangement *a, const struct arranged *p, const struct arranged *q)
{
	const double x = relate_gap(p, q) / (NEXT_TO * a->spacing);

	return 1 / (1 + x * x);
}

/* p is in q: on top of it in plan, and not above its rim. */
static double inside(const struct arrangement *a, const struct arranged *p, const struct arranged *q)
{
	return step((feet_overlap(p, q) - 0.6) / 0.1) * step((q->high[2] - p->low[2]) / (0.03 * a->spacing)) *
	       step((arranged_bulk(a, q) - arranged_bulk(a, p)) / 0.1);
}

static double pair(const struct arrangement *a, enum parse_relation relation, enum relate_width width,
	const struct arranged *p, const struct arranged *q)
{
	const double s = a->spacing, right = p->side - q->side;
	const double away = p->centre[1] - q->centre[1] + LOW_IS_NEAR * (p->low[2] - q->low[2]);
	double loose;

	switch (relation) {
	case PARSE_LEFT:
		return on_side(a, p, q, -right, away, width);
	case PARSE_RIGHT:
		return on_side(a, p, q, right, away, width);
	case PARSE_FRONT:
		return on_side(a, p, q, -away, right, width);
	case PARSE_BEHIND:
		return on_side(a, p, q, away, right, width);
	case PARSE_NEAR:
	case PARSE_WITH:
		return near(a, p, q);
	case PARSE_FAR:
		return step((level_distance(p, q) / s - FAR_FROM) / 0.2);
	case PARSE_ON:
		return fmax(relate_stands_on(a, p, q), inside(a, p, q));
	case PARSE_INSIDE:
		return fmax(inside(a, p, q), 0.7 * relate_stands_on(a, p, q));
	case PARSE_SUPPORTS:
		return fmax(relate_stands_on(a, q, p), inside(a, q, p));
	case PARSE_BELOW:
		loose = 0.5 * step((q->centre[2] - p->centre[2]) / (0.03 * s) - 2) *
			exp(-level_distance(p, q) / (0.5 * s));
		return fmax(relate_stands_on(a, q, p), loose);
	case PARSE_ABOVE:
		loose = step((p->low[2] - q->high[2] + 0.1 * s) / (0.03 * s)) *
			exp(-level_distance(p, q) / (0.7 * s));
		return fmax(relate_stands_on(a, p, q), loose);
	case PARSE_ACROSS:
		return step((level_distance(p, q) / s - FAR_FROM) / 0.2);
	case PARSE_MIDDLE:
	case PARSE_CORNER:
	case PARSE_WALL:
		return near(a, p, q);
	default:
		return 0.5;
	}
}

/* How far a thing is from who looks: some mean the way to it, others how far back it is. */
static double away_from_viewer(const struct arrangement *a, const struct arranged *o)
{
	const double right = o->centre[0] - a->viewer.centre[0], away = o->centre[1] - a->viewer.centre[1];

	return (hypot(right, away) + away) / 2;
}

/* The end that a relation counts from has the smallest key. */
static double key_of(const struct arrangement *a, enum parse_relation relation, const struct arranged *o)
{
	const double wide = o->high[0] - o->low[0], deep = o->high[1] - o->low[1];
	const double eye = away_from_viewer(a, o);

	switch (relation) {
	case PARSE_LEFT:
		return o->side / a->spacing;
	case PARSE_RIGHT:
		return -o->side / a->spacing;
	case PARSE_FRONT:
	case PARSE_NEAR:
		return eye / a->spacing;
	case PARSE_BEHIND:
	case PARSE_FAR:
	case PARSE_WALL:
		return -eye / a->spacing;
	case PARSE_ABOVE:
		return -o->centre[2] / a->spacing;
	case PARSE_BELOW:
	case PARSE_FLOOR:
		return o->centre[2] / a->spacing;
	case PARSE_LARGER:
		return -arranged_bulk(a, o);
	case PARSE_SMALLER:
		return arranged_bulk(a, o);
	case PARSE_TALLER:
		return -arranged_length(a, o->high[2] - o->low[2]);
	case PARSE_SHORTER:
		return arranged_length(a, o->high[2] - o->low[2]);
	case PARSE_LONGER:
	case PARSE_WIDER:
		return -arranged_length(a, fmax(wide, deep));
	default:
		return 0;
	}
}

static int is_size(enum parse_relation r)
{
	return r >= PARSE_LARGER && r <= PARSE_WIDER;
}

static double soft_of(enum parse_relation r)
{
	return is_size(r) ? BEST_SOFT_SIZE : BEST_SOFT;
}

/* out[o]: that exactly k - 1 of the others that fit have a smaller key. `but` counts for none. */
static void rank(const struct arrangement *a, const double *key, const double *fit, int k, double soft,
	size_t but, double *out)
{
	const double most = fmax(largest(fit, a->n), 1e-12);
	double few[RANKS];

	k = k < 1 ? 1 : k > RANKS ? RANKS : k;
	for (size_t o = 0; o < a->n; o++) {
		memset(few, 0, sizeof few);
		few[0] = 1; /* few[j]: that j are before it */
		for (size_t i = 0; i < a->n; i++) {
			if (i == o || i == but || !a->objects[i].is_there)
				continue;
			const double before = fit[i] / most * step((key[o] - key[i]) / soft);
			for (int j = k - 1; j > 0; j--)
				few[j] = few[j] * (1 - before) + few[j - 1] * before;
			few[0] *= 1 - before;
		}
		out[o] = o == but ? 0 : few[k - 1];
	}
}

void relate_rank(const struct arrangement *a, enum parse_relation from, int k, const double *fit, double *key,
	double *out)
{
	const double sign = k < 0 ? -1 : 1;

	for (size_t o = 0; o < a->n; o++)
		key[o] = sign * key_of(a, from, &a->objects[o]);
	rank(a, key, fit, abs(k), soft_of(from), a->n, out);
}

void relate_rank_by(const struct arrangement *a, const double *key, int k, const double *fit, double *out)
{
	rank(a, key, fit, k, 1, a->n, out);
}

/* -1 to 1: where an object is in the objects' extent. */
static double place(const struct arrangement *a, const struct arranged *o, int axis)
{
	double low = INFINITY, high = -INFINITY;

	for (size_t k = 0; k < a->n; k++)
		if (a->objects[k].is_there) {
			const double x = axis ? a->objects[k].centre[axis] : a->objects[k].side;
			low = fmin(low, x);
			high = fmax(high, x);
		}
	return high > low ? (2 * (axis ? o->centre[axis] : o->side) - low - high) / (high - low) : 0;
}

/* Others that fit lie on both sides of it, along one of the level axes. */
static double is_middle(const struct arrangement *a, const double *fit, size_t o)
{
	const double most = fmax(largest(fit, a->n), 1e-12);
	double best = 0;

	for (int axis = 0; axis < 2; axis++) {
		double none_before = 1, none_after = 1;
		for (size_t k = 0; k < a->n; k++) {
			if (k == o || !a->objects[k].is_there)
				continue;
			const double d = (axis ? a->objects[o].centre[1] - a->objects[k].centre[1]
					       : a->objects[o].side - a->objects[k].side) /
					 (APART_SOFT * a->spacing);
			none_before *= 1 - fit[k] / most * step(d);
			none_after *= 1 - fit[k] / most * step(-d);
		}
		best = fmax(best, (1 - none_before) * (1 - none_after));
	}
	return best;
}

static double on_half(double place)
{
	return step((place - SIDE_LEAST) / SIDE_SOFT);
}

/* Of the scene as a whole, or of the objects' sizes. */
static double alone(const struct arrangement *a, enum parse_relation relation, const double *fit, size_t o)
{
	const struct arranged *p = &a->objects[o];
	double aside;

	switch (relation) {
	case PARSE_LEFT:
		return on_half(-place(a, p, 0));
	case PARSE_RIGHT:
		return on_half(place(a, p, 0));
	case PARSE_FRONT:
	case PARSE_NEAR:
		return on_half(-place(a, p, 1));
	case PARSE_BEHIND:
	case PARSE_FAR:
	case PARSE_WALL:
		return on_half(place(a, p, 1));
	case PARSE_ABOVE:
		return on_half(place(a, p, 2));
	case PARSE_BELOW:
	case PARSE_FLOOR:
		return on_half(-place(a, p, 2));
	case PARSE_CORNER:
		return on_half(fmin(fabs(place(a, p, 0)), fabs(place(a, p, 1))));
	case PARSE_MIDDLE:
		aside = fmax(fabs(place(a, p, 0)), fabs(place(a, p, 1))) / 0.5;
		return fmax(exp(-aside * aside), is_middle(a, fit, o));
	case PARSE_BETWEEN:
		return is_middle(a, fit, o);
	default:
		return is_size(relation) ? 0.5 : 1;
	}
}

/* "large" of a thing that is large for what it may be or for this scene. */
static void sized(const struct arrangement *a, enum parse_relation relation, const double *fit, double *key,
	double *out)
{
	double sum = 0, square = 0, weight = 0;

	for (size_t o = 0; o < a->n; o++) {
		key[o] = key_of(a, relation, &a->objects[o]);
		if (!a->objects[o].is_there)
			continue;
		sum += key[o];
		square += key[o] * key[o];
		weight++;
	}
	const double mean = sum / fmax(weight, 1);
	const double deviation = sqrt(fmax(square / fmax(weight, 1) - mean * mean, 1e-4));
	(void)fit;
	for (size_t o = 0; o < a->n; o++)
		out[o] = step(-(key[o] - mean) / (0.5 * deviation) + 0.5);
}

/* Where nothing is named: "the left one", "on the left" is the leftmost of those that fit or on the left
 * side. */
/* How far anything else fits as well as object o, or the best. */
static double rivalry(const struct arrangement *a, const double *fit, size_t o)
{
	double most = 0;

	for (size_t k = 0; k < a->n; k++)
		most = k != o && a->objects[k].is_there ? fmax(most, fit[k]) : most;
	return fmin(1, most / fmax(fit[o], 1e-12));
}

static void by_itself(
	const struct arrangement *a, const struct relation *r, const double *fit, double *key, double *out)
{
	if (is_size(r->kind)) {
		sized(a, r->kind, fit, key, out);
		return;
	}
	if (r->kind == PARSE_ON && r->count) { /* on the table itself, rather than on a thing that is on it */
		for (size_t o = 0; o < a->n; o++) {
			out[o] = 1 - ON_THE_REST * a->objects[o].raised;
			for (size_t i = 0; i < a->n; i++)
				if (i != o && a->objects[i].is_there)
					out[o] = fmin(
						out[o], 1 - ON_THE_REST * relate_stands_on(a, &a->objects[o],
										  &a->objects[i]));
		}
		return;
	}
	relate_rank(a, r->kind, 1, fit, key, out);
	const int is_ordered = r->kind <= PARSE_BELOW || r->kind == PARSE_NEAR || r->kind == PARSE_FAR;
	for (size_t o = 0; o < a->n; o++) {
		const double side = alone(a, r->kind, fit, o);
		/* of what nothing else is like, the side alone tells */
		const double rank =
			is_ordered && r->width != RELATE_HALF_PLANE ? 0.4 * rivalry(a, fit, o) : 0;
		out[o] = rank * out[o] + (1 - rank) * side;
	}
}

/* How much anchor k may be thing i; the likeliest has 1. */
static double weight_of(const struct arrangement *a, const struct relate_anchor *anchor, size_t i)
{
	const double x = anchor->p[i] / fmax(largest(anchor->p, a->n + 1), 1e-12);

	return at(a, i)->is_there ? x * x * x : 0;
}

static double between(const struct arrangement *a, const struct arranged *o, const struct arranged *p,
	const struct arranged *q)
{
	const double x = q->centre[0] - p->centre[0], y = q->centre[1] - p->centre[1];
	const double length = hypot(x, y) + 1e-9 * a->spacing;
	const double u = o->centre[0] - p->centre[0], v = o->centre[1] - p->centre[1];
	const double along = (u * x + v * y) / (length * length), aside = fabs(u * y - v * x) / length;

	return step((along - 0.1) / 0.05) * step((0.9 - along) / 0.05) *
	       exp(-0.5 * pow(aside / (0.25 * length + 0.1 * a->spacing), 2));
}

static void between_pairs(const struct arrangement *a, const struct relate_anchor *first,
	const struct relate_anchor *second, double *out)
{
	for (size_t i = 0; i <= a->n; i++)
		for (size_t k = 0; k <= a->n; k++) {
			if (i == k)
				continue;
			const double p = weight_of(a, first, i) * weight_of(a, second, k);
			for (size_t o = 0; p > 1e-3 && o < a->n; o++)
				if (o != i && o != k)
					out[o] = fmax(
						out[o], p * between(a, &a->objects[o], at(a, i), at(a, k)));
		}
}

/* "the nearest to", "taller than": out[o] for the anchor being thing i. */
static void compare(const struct arrangement *a, const struct relation *r, size_t i, const double *fit,
	double *key, double *out)
{
	const struct arranged *q = at(a, i);
	const int is_distance = r->kind == PARSE_NEAR || r->kind == PARSE_FAR || r->kind == PARSE_WITH;

	if (is_distance || i == a->n) {
		for (size_t o = 0; o < a->n; o++)
			key[o] = (r->kind == PARSE_FAR || r->kind == PARSE_BEHIND ? -1 : 1) *
				 (i == a->n ? away_from_viewer(a, &a->objects[o])
					    : level_distance(&a->objects[o], q)) /
				 a->spacing;
		rank(a, key, fit, r->place, BEST_SOFT, i, out);
		return;
	}
	for (size_t o = 0; o < a->n; o++)
		key[o] = key_of(a, r->kind, &a->objects[o]);
	if (r->degree == PARSE_MOST && !is_size(r->kind))
		rank(a, key, fit, r->place, soft_of(r->kind), i, out);
	for (size_t o = 0; o < a->n; o++) {
		const double more = step((key_of(a, r->kind, q) - key[o]) / soft_of(r->kind) - 1);
		const double side = r->kind <= PARSE_BELOW
					    ? pair(a, r->kind, RELATE_HALF_PLANE, &a->objects[o], q)
					    : more;
		out[o] = r->degree == PARSE_MOST && !is_size(r->kind) ? out[o] * side : side;
	}
}

/* "as tall as": how alike two things are in a size. */
static double is_as(const struct arrangement *a, enum parse_relation size, const struct arranged *o,
	const struct arranged *q)
{
	return exp(-fabs(key_of(a, size, o) - key_of(a, size, q)) / AS_LARGE_SOFT);
}

/* "left of", "as tall as": of an anchor that is q. */
static double plainly(const struct arrangement *a, const struct relation *r, const struct arranged *o,
	const struct arranged *q)
{
	return is_size(r->kind) ? is_as(a, r->kind, o, q) : pair(a, r->kind, r->width, o, q);
}

/* Of one anchor: the best of what it may be, or all of what it is. */
static void to_anchor(const struct arrangement *a, const struct relation *r,
	const struct relate_anchor *anchor, const double *fit, double *key, double *one, double *out)
{
	for (size_t o = 0; o < a->n; o++)
		out[o] = anchor->is_every;
	for (size_t i = 0; i <= a->n; i++) {
		const double w = weight_of(a, anchor, i);
		if (w < 0.02)
			continue;
		if (r->degree != PARSE_PLAIN)
			compare(a, r, i, fit, key, one);
		for (size_t o = 0; o < a->n; o++) {
			if (o == i) { /* no thing is left of itself */
				out[o] *= anchor->is_every && !anchor->is_other ? 1 - w : 1;
				continue;
			}
			const double x =
				r->degree != PARSE_PLAIN ? one[o] : plainly(a, r, &a->objects[o], at(a, i));
			out[o] = anchor->is_every ? out[o] * (1 - w + w * x) : fmax(out[o], w * x);
		}
	}
}

static void to_anchors(const struct arrangement *a, const struct relation *r, const double *fit, double *key,
	double *scratch, double *out)
{
	double *one = scratch, *part = scratch + a->n;
	int count = 0;

	for (size_t o = 0; o < a->n; o++)
		out[o] = 1;
	for (int k = 0; k < r->count; k++) {
		if (r->anchors[k].is_scene)
			continue;
		to_anchor(a, r, &r->anchors[k], fit, key, one, part);
		for (size_t o = 0; o < a->n; o++)
			out[o] *= part[o];
		count++;
	}
	for (size_t o = 0; o < a->n && count > 1; o++)
		out[o] = pow(out[o], 1.0 / count);
}

void relate(
	const struct arrangement *a, const struct relation *r, const double *fit, double *key, double *out)
{
	const struct relate_anchor *named[2] = {NULL, NULL};
	int count = 0;

	for (int k = 0; k < r->count; k++)
		if (!r->anchors[k].is_scene) {
			named[count ? 1 : 0] = &r->anchors[k];
			count++;
		}
	if (!count) {
		if (r->degree == PARSE_PLAIN || r->kind == PARSE_MIDDLE || r->kind == PARSE_BETWEEN ||
			r->kind == PARSE_CORNER)
			by_itself(a, r, fit, key, out);
		else
			relate_rank(a, r->kind, r->place ? r->place : 1, fit, key, out);
	} else if (r->kind == PARSE_BETWEEN ||
		   (r->kind == PARSE_MIDDLE && (count > 1 || named[0]->is_every))) {
		memset(out, 0, a->n * sizeof *out);
		between_pairs(a, named[0], named[count > 1], out);
	} else {
		to_anchors(a, r, fit, key, key + a->n, out);
	}
	for (size_t o = 0; o < a->n; o++)
		if (!a->objects[o].is_there)
			out[o] = 0;
}
