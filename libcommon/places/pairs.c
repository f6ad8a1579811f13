#include "places/pairs.h"

#include "base/logistic.h"

#include <math.h>

/* Lengths are shares of the arrangement's spacing. Found on synthetic scenes, seeds 1 to 9. */
/* Cosine of the angle to the direction that people mean, and what is left to a thing that is that way at all;
 * the same where two directions are said of it. */
static const double sideways_least = 0.65, sideways_soft = 0.1, sideways_else = 0.35, sideways_wide = 0.8;
/* How far that way at least, and the e-folds by which what is near is preferred. */
static const double apart_least = 0.04, apart_soft = 0.03, nearby = 0.3;
/* A thing's foot this much higher looks as if it were 1 farther. */
static const double low_is_near = 0.7;
/* How well what lies on a thing is "above" it, which is rather said of what is apart. */
static const double on_is_above = 0.6;
/* How high above the others' undersides what rests on nothing is half on the table. */
static const double above_all = 0.6, above_soft = 0.1;
/* How true it is to say of what a thing stands on that it is in that. */
static const double upside_down = 0.2;
/* How wrong it is to say of a thing on another that it is on the table. */
static const double on_the_rest = 0.55;
/* The gap between the heights of two things at which that is half so. */
static const double same_height = 0.25;
/* A gap that is none, as the undersides of things are seen badly; the gap at which "next to", and the
 * distance at which "far from" is half true. */
static const double touching = 0.05, next_to = 0.3, far_from = 0.8;

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

double pair_stands_on(const struct arrangement *a, const struct arranged *p, const struct arranged *q)
{
	return logistic((feet_overlap(p, q) - 0.4) / 0.1) *
	       logistic((p->centre[2] - q->centre[2]) / (0.02 * a->spacing)) *
	       exp(-fmax(0, (p->low[2] - q->high[2]) / a->spacing - touching) / 0.1);
}

double pair_gap(const struct arranged *p, const struct arranged *q)
{
	double sum = 0;

	for (int k = 0; k < 3; k++) {
		double d = fmax(0, fmax(p->low[k] - q->high[k], q->low[k] - p->high[k]));
		sum += d * d;
	}
	return sqrt(sum);
}

double pair_distance(const struct arranged *p, const struct arranged *q)
{
	return hypot(p->centre[0] - q->centre[0], p->centre[1] - q->centre[1]);
}

/* Whether two things are at one height: what hangs over a desk is not "behind" what stands on it. */
static double level(const struct arrangement *a, const struct arranged *p, const struct arranged *q)
{
	const double gap =
		fmax(0, fmax(p->low[2] - q->high[2], q->low[2] - p->high[2])) / (same_height * a->spacing);

	return 1 / (1 + gap * gap);
}

/* p is on the way `main` of q, and not too far aside. */
static double on_side(const struct arrangement *a, const struct arranged *p, const struct arranged *q,
	double main, double aside, enum relate_width width)
{
	const double there = logistic((main / a->spacing - apart_least) / apart_soft);
	const double along = main / (hypot(main, aside) + 1e-9 * a->spacing),
		     up = p->centre[2] - q->centre[2];
	const double distance = hypot(pair_distance(p, q), up);

	if (width == RELATE_HALF_PLANE)
		return there;
	const double straight = logistic((along - sideways_least) / sideways_soft);
	if (width == RELATE_CONE)
		return there * straight;
	const double aslant = width == RELATE_WIDE ? sideways_wide : sideways_else;
	return there * (aslant + (1 - aslant) * straight) * exp(-nearby * distance / a->spacing) *
	       level(a, p, q) * (1 - pair_stands_on(a, p, q)) * (1 - pair_stands_on(a, q, p));
}

static double near(const struct arrangement *a, const struct arranged *p, const struct arranged *q)
{
	const double x = pair_gap(p, q) / (next_to * a->spacing);

	return 1 / (1 + x * x);
}

/* p is in q: on top of it in plan, not above its rim, and not what q stands on. */
static double inside(const struct arrangement *a, const struct arranged *p, const struct arranged *q)
{
	return logistic((feet_overlap(p, q) - 0.6) / 0.1) *
	       logistic((q->high[2] - p->low[2]) / (0.03 * a->spacing)) *
	       (upside_down + (1 - upside_down) *
				      logistic((p->centre[2] - q->centre[2]) / (0.02 * a->spacing) + 2)) *
	       logistic((arranged_bulk(a, q) - arranged_bulk(a, p)) / 0.1);
}

double pair_fits(const struct arrangement *a, enum parse_relation relation, enum relate_width width,
	const struct arranged *p, const struct arranged *q)
{
	const double s = a->spacing, right = p->side - q->side;
	const double away = p->centre[1] - q->centre[1] + low_is_near * (p->low[2] - q->low[2]);
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
	case PARSE_BETWEEN: /* of it and what is nothing here */
	case PARSE_MIDDLE:
	case PARSE_CORNER:
	case PARSE_WALL:
		return near(a, p, q);
	case PARSE_FAR:
	case PARSE_ACROSS:
		return logistic((pair_distance(p, q) / s - far_from) / 0.2);
	case PARSE_ON:
		return fmax(pair_stands_on(a, p, q), inside(a, p, q));
	case PARSE_INSIDE:
		return fmax(inside(a, p, q), 0.7 * pair_stands_on(a, p, q));
	case PARSE_SUPPORTS:
		return fmax(pair_stands_on(a, q, p), inside(a, q, p));
	case PARSE_BELOW:
		loose = 0.5 * logistic((q->centre[2] - p->centre[2]) / (0.03 * s) - 2) *
			exp(-pair_distance(p, q) / (0.5 * s));
		return fmax(pair_stands_on(a, q, p), loose);
	case PARSE_ABOVE:
		loose = logistic((p->low[2] - q->high[2] + 0.1 * s) / (0.03 * s)) *
			exp(-pair_distance(p, q) / ((width == RELATE_HALF_PLANE ? 1.4 : 0.7) * s));
		return fmax(on_is_above * pair_stands_on(a, p, q), loose);
	default:
		return 0.5;
	}
}

double pair_between(const struct arrangement *a, const struct arranged *o, const struct arranged *p,
	const struct arranged *q)
{
	const double x = q->centre[0] - p->centre[0], y = q->centre[1] - p->centre[1];
	const double length = hypot(x, y) + 1e-9 * a->spacing;
	const double u = o->centre[0] - p->centre[0], v = o->centre[1] - p->centre[1];
	const double along = (u * x + v * y) / (length * length), aside = fabs(u * y - v * x) / length;

	return logistic((along - 0.1) / 0.05) * logistic((0.9 - along) / 0.05) *
	       fmax(level(a, o, p), level(a, o, q)) *
	       exp(-0.5 * pow(aside / (0.25 * length + 0.1 * a->spacing), 2));
}

/* The middle one of the heights of the objects' undersides. */
static double find_ground(const struct arrangement *a)
{
	double ground = INFINITY;

	for (size_t o = 0; o < a->n; o++) {
		size_t below = 0, there = 0;
		for (size_t i = 0; i < a->n; i++) {
			there += a->objects[i].is_there != 0;
			below += a->objects[i].is_there && a->objects[i].low[2] <= a->objects[o].low[2];
		}
		if (a->objects[o].is_there && 2 * below >= there)
			ground = fmin(ground, a->objects[o].low[2]);
	}
	return ground;
}

void pairs_on_scene(const struct arrangement *a, double *out)
{
	const double ground = find_ground(a);

	for (size_t o = 0; o < a->n; o++) {
		const double high = (a->objects[o].low[2] - ground) / a->spacing;
		double rests = 0;
		for (size_t i = 0; i < a->n; i++)
			if (i != o && a->objects[i].is_there)
				rests = fmax(rests, pair_stands_on(a, &a->objects[o], &a->objects[i]));
		out[o] =
			fmin(1 - on_the_rest * rests, fmax(rests, logistic((above_all - high) / above_soft)));
	}
}
