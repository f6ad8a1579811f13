#include "refer/relate.h"

#include <math.h>
#include <string.h>

/* All lengths are shares of the arrangement's spacing. Found on synthetic scenes (seeds 1 to 9). */
static const double sideways_least = 0.65, sideways_soft = 0.1; /* cosine of the angle to the direction */
static const double apart_least = 0.04, apart_soft = 0.03;	/* how far that way at least */
static const double nearby = 0.3;      /* e-folds by which what is near is preferred */
static const double low_is_near = 0.7; /* a thing's foot this much higher looks as if it were 1 farther */
static const double next_to = 0.2;
static const double best_soft = 0.04, best_soft_size = 0.06;
static const double side_least = 0.15, side_soft = 0.1; /* of half the objects' extent */

static double step(double x)
{
	return 1 / (1 + exp(-fmin(fmax(x, -40), 40)));
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
	return common / fmax(fmin(own, other), 1e-9);
}

/* p stands on q. */
static double stands_on(const struct arrangement *a, const struct arranged *p, const struct arranged *q)
{
	return step((feet_overlap(p, q) - 0.4) / 0.1) *
	       step((p->centre[2] - q->centre[2]) / (0.02 * a->spacing)) *
	       exp(-fmax(0, p->low[2] - q->high[2]) / (0.1 * a->spacing));
}

static double gap(const struct arranged *p, const struct arranged *q)
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
	double main, double aside)
{
	double along = main / (hypot(main, aside) + 1e-9), up = p->centre[2] - q->centre[2];
	double distance = sqrt(level_distance(p, q) * level_distance(p, q) + up * up);

	return step((along - sideways_least) / sideways_soft) *
	       step((main / a->spacing - apart_least) / apart_soft) * exp(-nearby * distance / a->spacing) *
	       (1 - stands_on(a, p, q)) * (1 - stands_on(a, q, p));
}

static double judge(const struct arrangement *a, enum lang_relation relation, const struct arranged *p,
	const struct arranged *q)
{
	const double s = a->spacing, right = p->centre[0] - q->centre[0];
	const double away = p->centre[1] - q->centre[1] + low_is_near * (p->low[2] - q->low[2]);
	double loose;

	switch (relation) {
	case LANG_LEFT:
		return on_side(a, p, q, -right, away);
	case LANG_RIGHT:
		return on_side(a, p, q, right, away);
	case LANG_FRONT:
		return on_side(a, p, q, -away, right);
	case LANG_BEHIND:
		return on_side(a, p, q, away, right);
	case LANG_NEAR:
		return exp(-gap(p, q) / (next_to * s));
	case LANG_ON:
		return stands_on(a, p, q);
	case LANG_UNDER:
		loose = 0.5 * step((q->centre[2] - p->centre[2]) / (0.03 * s) - 2) *
			exp(-level_distance(p, q) / (0.5 * s));
		return fmax(stands_on(a, q, p), loose);
	case LANG_ABOVE:
		loose = step((p->low[2] - q->high[2] + 0.1 * s) / (0.03 * s)) *
			exp(-level_distance(p, q) / (0.7 * s));
		return fmax(stands_on(a, p, q), loose);
	default:
		return 0;
	}
}

static void each_anchor(const struct arrangement *a, enum lang_relation relation, const double *anchors,
	int count, double *out)
{
	for (size_t o = 0; o < a->n; o++) {
		double product = 1;
		for (int k = 0; k < count; k++) {
			double sum = 0;
			for (size_t i = 0; i < a->n; i++)
				if (i != o && a->objects[i].is_there)
					sum += anchors[(size_t)k * a->n + i] *
					       judge(a, relation, &a->objects[o], &a->objects[i]);
			product *= sum;
		}
		out[o] = pow(product, 1.0 / count);
	}
}

/* o is on the way from p to q, on the ground. */
static double is_between(const struct arranged *o, const struct arranged *p, const struct arranged *q)
{
	const double x = q->centre[0] - p->centre[0], y = q->centre[1] - p->centre[1];
	const double u = o->centre[0] - p->centre[0], v = o->centre[1] - p->centre[1];
	const double square = x * x + y * y + 1e-12;
	const double along = (u * x + v * y) / square, aside = (x * v - y * u) / square;

	return step((along - 0.1) / 0.05) * step((0.9 - along) / 0.05) * exp(-aside * aside / (0.3 * 0.3));
}

static void between(const struct arrangement *a, const double *anchors, int count, double *out)
{
	const double *first = anchors, *second = count > 1 ? anchors + a->n : anchors;
	double total = 0;

	memset(out, 0, a->n * sizeof *out);
	for (size_t i = 0; i < a->n; i++)
		for (size_t k = 0; k < a->n; k++) {
			const double both = i == k ? 0 : first[i] * second[k];
			total += both;
			if (both < 1e-4 || !a->objects[i].is_there || !a->objects[k].is_there)
				continue;
			for (size_t o = 0; o < a->n; o++)
				if (o != i && o != k)
					out[o] += both *
						  is_between(&a->objects[o], &a->objects[i], &a->objects[k]);
		}
	for (size_t o = 0; o < a->n; o++)
		out[o] /= fmax(total, 1e-9);
}

/* That o has the least key of those that fit, but for `without`. */
static double is_best(const struct arrangement *a, const double *key, const double *fit, size_t o,
	size_t without, double soft)
{
	double p = 1;

	for (size_t k = 0; k < a->n; k++)
		if (k != o && k != without && a->objects[k].is_there)
			p *= 1 - fit[k] * step((key[o] - key[k]) / soft);
	return p;
}

/* Nearest to an anchor, or farthest from it (sign -1). key (n) is scratch. */
static void extreme_to(const struct arrangement *a, double sign, const double *anchors, int count,
	const double *fit, double *key, double *out)
{
	memset(out, 0, a->n * sizeof *out);
	for (int c = 0; c < count; c++)
		for (size_t i = 0; i < a->n; i++) {
			const double p = anchors[(size_t)c * a->n + i];
			if (p < 0.02 || !a->objects[i].is_there)
				continue;
			for (size_t o = 0; o < a->n; o++)
				key[o] = sign * level_distance(&a->objects[o], &a->objects[i]) / a->spacing;
			for (size_t o = 0; o < a->n; o++)
				if (o != i)
					out[o] += p * is_best(a, key, fit, o, i, best_soft) / count;
		}
}

static double key_of(const struct arrangement *a, enum lang_relation relation, const struct arranged *o)
{
	double bulk = 1;

	for (int k = 0; k < 3; k++)
		bulk *= fmax(o->high[k] - o->low[k], 1e-3 * a->spacing);
	switch (relation) {
	case LANG_LEFTMOST:
		return o->centre[0] / a->spacing;
	case LANG_RIGHTMOST:
		return -o->centre[0] / a->spacing;
	case LANG_NEAREST_US:
		return hypot(o->centre[0] - a->eye[0], o->centre[1] - a->eye[1]) / a->spacing;
	case LANG_FARTHEST_US:
		return -hypot(o->centre[0] - a->eye[0], o->centre[1] - a->eye[1]) / a->spacing;
	case LANG_LARGEST:
		return -log(bulk) / 3;
	case LANG_SMALLEST:
		return log(bulk) / 3;
	case LANG_TALLEST:
		return -log(fmax(o->high[2] - o->low[2], 1e-9));
	case LANG_HIGHEST:
		return -o->centre[2] / a->spacing;
	default:
		return o->centre[2] / a->spacing;
	}
}

/* Others that fit lie on both sides of it, along one of the level axes. */
static double is_middle(const struct arrangement *a, const double *fit, size_t o)
{
	double best = 0;

	for (int axis = 0; axis < 2; axis++) {
		double none_before = 1, none_after = 1;
		for (size_t k = 0; k < a->n; k++) {
			if (k == o || !a->objects[k].is_there)
				continue;
			double d = (a->objects[o].centre[axis] - a->objects[k].centre[axis]) /
				   (apart_soft * a->spacing);
			none_before *= 1 - fit[k] * step(d);
			none_after *= 1 - fit[k] * step(-d);
		}
		best = fmax(best, (1 - none_before) * (1 - none_after));
	}
	return best;
}

/* -1 to 1: where an object is in the objects' extent. */
static double place(const struct arrangement *a, const struct arranged *o, int axis)
{
	double low = INFINITY, high = -INFINITY;

	for (size_t k = 0; k < a->n; k++)
		if (a->objects[k].is_there) {
			low = fmin(low, a->objects[k].centre[axis]);
			high = fmax(high, a->objects[k].centre[axis]);
		}
	return high > low ? (2 * o->centre[axis] - low - high) / (high - low) : 0;
}

static double alone(
	const struct arrangement *a, enum lang_relation relation, const double *fit, double *key, size_t o)
{
	const struct arranged *p = &a->objects[o];
	double aside;

	switch (relation) {
	case LANG_LEFT_SIDE:
		return step((-place(a, p, 0) - side_least) / side_soft);
	case LANG_RIGHT_SIDE:
		return step((place(a, p, 0) - side_least) / side_soft);
	case LANG_FRONT_SIDE:
		return step((-place(a, p, 1) - side_least) / side_soft);
	case LANG_BACK_SIDE:
		return step((place(a, p, 1) - side_least) / side_soft);
	case LANG_MIDDLE_SIDE:
		aside = fmax(fabs(place(a, p, 0)), fabs(place(a, p, 1))) / 0.5;
		return exp(-aside * aside);
	case LANG_MIDDLE_ONE:
		return is_middle(a, fit, o);
	default:
		return is_best(a, key, fit, o, o,
			relation == LANG_LARGEST || relation == LANG_SMALLEST || relation == LANG_TALLEST
				? best_soft_size
				: best_soft);
	}
}

void relate(const struct arrangement *a, enum lang_relation relation, const double *anchors, int count,
	const double *fit, double *key, double *out)
{
	if (relation == LANG_BETWEEN) {
		between(a, anchors, count, out);
	} else if (relation == LANG_NEAREST || relation == LANG_FARTHEST) {
		extreme_to(a, relation == LANG_NEAREST ? 1 : -1, anchors, count, fit, key, out);
	} else if (relation < LANG_BETWEEN) {
		each_anchor(a, relation, anchors, count, out);
	} else {
		for (size_t o = 0; o < a->n; o++)
			key[o] = key_of(a, relation, &a->objects[o]);
		for (size_t o = 0; o < a->n; o++)
			out[o] = alone(a, relation, fit, key, o);
	}
	for (size_t o = 0; o < a->n; o++)
		if (!a->objects[o].is_there)
			out[o] = 0;
}
