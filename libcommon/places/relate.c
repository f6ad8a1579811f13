#include "places/relate.h"

#include "base/largest.h"
#include "base/logistic.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { RANKS = 32 }; /* "the 32nd from the left" and all after it are one */

/* Of half the objects' extent: where the left side begins. */
static const double side_least = 0.15, side_soft = 0.1;
/* Differences that are told apart: of lengths, as shares of the spacing, and of natural logarithms of sizes;
 * of what is "as tall as" another; of what lies on both sides of the middle. */
static const double best_soft = 0.04, best_soft_size = 0.06, as_large_soft = 0.25, middle_soft = 0.03;

static const struct arranged *at(const struct arrangement *a, size_t i)
{
	return i < a->n ? &a->objects[i] : &a->viewer;
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
	return is_size(r) ? best_soft_size : best_soft;
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
			const double before = fit[i] / most * logistic((key[o] - key[i]) / soft);
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
					 (middle_soft * a->spacing);
			none_before *= 1 - fit[k] / most * logistic(d);
			none_after *= 1 - fit[k] / most * logistic(-d);
		}
		best = fmax(best, (1 - none_before) * (1 - none_after));
	}
	return best;
}

static double on_half(double place)
{
	return logistic((place - side_least) / side_soft);
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
		return on_half(place(a, p, 1));
	case PARSE_WALL: /* most often behind all, but a room has four */
		return 0.25 + 0.5 * on_half(place(a, p, 1));
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
static void sized(const struct arrangement *a, enum parse_relation relation, double *key, double *out)
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
	for (size_t o = 0; o < a->n; o++)
		out[o] = logistic(-(key[o] - mean) / (0.5 * deviation) + 0.5);
}

/* How far anything else fits as well as object o, or the best. */
static double rivalry(const struct arrangement *a, const double *fit, size_t o)
{
	double most = 0;

	for (size_t k = 0; k < a->n; k++)
		most = k != o && a->objects[k].is_there ? fmax(most, fit[k]) : most;
	return fmin(1, most / fmax(fit[o], 1e-12));
}

/* Where nothing is named: "the left one", "on the left" is leftmost of those that fit or on the left side. */
static void by_itself(
	const struct arrangement *a, const struct relation *r, const double *fit, double *key, double *out)
{
	if (is_size(r->kind)) {
		sized(a, r->kind, key, out);
		return;
	}
	if (r->kind == PARSE_ON && r->count) {
		pairs_on_scene(a, out);
		return;
	}
	relate_rank(a, r->kind, 1, fit, key, out);
	const int is_ordered = r->kind <= PARSE_BELOW || r->kind == PARSE_NEAR || r->kind == PARSE_FAR;
	for (size_t o = 0; o < a->n; o++) {
		const double side = alone(a, r->kind, fit, o);
		/* of what nothing else is like, the side alone tells */
		const double rank = is_ordered && r->width < RELATE_CONE ? 0.4 * rivalry(a, fit, o) : 0;
		out[o] = rank * out[o] + (1 - rank) * side;
	}
}

/* How much anchor k may be thing i; the likeliest has 1. */
static double weight_of(const struct arrangement *a, const struct relate_anchor *anchor, size_t i)
{
	const double x = anchor->p[i] / fmax(largest(anchor->p, a->n + 1), 1e-12);

	return at(a, i)->is_there ? x * x * x : 0;
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
					out[o] = fmax(out[o],
						p * pair_between(a, &a->objects[o], at(a, i), at(a, k)));
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
					    : pair_distance(&a->objects[o], q)) /
				 a->spacing;
		rank(a, key, fit, r->place, best_soft, i, out);
		return;
	}
	for (size_t o = 0; o < a->n; o++)
		key[o] = key_of(a, r->kind, &a->objects[o]);
	if (r->degree == PARSE_MOST && !is_size(r->kind))
		rank(a, key, fit, r->place, soft_of(r->kind), i, out);
	for (size_t o = 0; o < a->n; o++) {
		const double more = logistic((key_of(a, r->kind, q) - key[o]) / soft_of(r->kind) - 1);
		const double side = r->kind <= PARSE_BELOW
					    ? pair_fits(a, r->kind, RELATE_HALF_PLANE, &a->objects[o], q)
					    : more;
		out[o] = r->degree == PARSE_MOST && !is_size(r->kind) ? out[o] * side : side;
	}
}

/* "as tall as": how alike two things are in a size. */
static double is_as(const struct arrangement *a, enum parse_relation size, const struct arranged *o,
	const struct arranged *q)
{
	return exp(-fabs(key_of(a, size, o) - key_of(a, size, q)) / as_large_soft);
}

/* "left of", "as tall as": of an anchor that is q. */
static double plainly(const struct arrangement *a, const struct relation *r, const struct arranged *o,
	const struct arranged *q)
{
	return is_size(r->kind) ? is_as(a, r->kind, o, q) : pair_fits(a, r->kind, r->width, o, q);
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
			named[count > 0] = &r->anchors[k];
			count++;
		}
	if (!count) {
		if (r->degree == PARSE_PLAIN || r->kind == PARSE_MIDDLE || r->kind == PARSE_BETWEEN ||
			r->kind == PARSE_CORNER)
			by_itself(a, r, fit, key, out);
		else
			relate_rank(a, r->kind, r->place ? r->place : 1, fit, key, out);
	} else if ((r->kind == PARSE_BETWEEN || r->kind == PARSE_MIDDLE) &&
		   (count > 1 || named[0]->is_every)) {
		memset(out, 0, a->n * sizeof *out);
		between_pairs(a, named[0], named[count > 1], out);
	} else {
		to_anchors(a, r, fit, key, key + a->n, out);
	}
	for (size_t o = 0; o < a->n; o++)
		if (!a->objects[o].is_there)
			out[o] = 0;
}
