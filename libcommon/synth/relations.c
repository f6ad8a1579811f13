#include "synth/relations.h"

#include <math.h>

void synth_layout_make(struct synth_layout *l, const struct synth_object *objects, int n,
	const struct synth_table *table, const double right[2], const double away[2])
{
	*l = (struct synth_layout){.n = n, .objects = objects};
	for (int i = 0; i < n; i++) {
		l->u[i] = right[0] * objects[i].x + right[1] * objects[i].y;
		l->v[i] = away[0] * objects[i].x + away[1] * objects[i].y;
	}
	l->half_u = fabs(right[0]) * table->half_width + fabs(right[1]) * table->half_depth;
	l->half_v = fabs(away[0]) * table->half_width + fabs(away[1]) * table->half_depth;
}

static int judge(int is_true, int is_false)
{
	return is_true ? 1 : is_false ? -1 : 0;
}

/* `ahead` is how far i lies in the direction that the word names, `aside` how far across it. */
static int towards(double ahead, double aside)
{
	aside = fabs(aside);
	return judge(ahead > 0.3 && ahead > 1.1 * aside, ahead < 0.1 || aside > 2.5 * ahead);
}

static double distance(const struct synth_layout *l, int i, int j)
{
	return hypot(l->u[i] - l->u[j], l->v[i] - l->v[j]);
}

int synth_layout_stands_on(const struct synth_layout *l, int i, int a)
{
	for (i = l->objects[i].on; i >= 0; i = l->objects[i].on)
		if (i == a)
			return 1;
	return 0;
}

static int are_stacked(const struct synth_layout *l, int i, int j)
{
	return synth_layout_stands_on(l, i, j) || synth_layout_stands_on(l, j, i);
}

/* What stands on a thing is hardly "beside" it, but who is to say. */
static int unless_stacked(const struct synth_layout *l, int i, int j, int verdict)
{
	return verdict > 0 && are_stacked(l, i, j) ? 0 : verdict;
}

static int between(const struct synth_layout *l, int i, int a, int b)
{
	double du = l->u[b] - l->u[a], dv = l->v[b] - l->v[a], length = hypot(du, dv);
	double pu = l->u[i] - l->u[a], pv = l->v[i] - l->v[a];

	if (length < 0.3)
		return 0;
	double along = (pu * du + pv * dv) / (length * length),
	       off = fabs(pu * dv - pv * du) / (length * length);
	int verdict =
		judge(along > 0.25 && along < 0.75 && off < 0.2, along < 0.05 || along > 0.95 || off > 0.45);
	return unless_stacked(l, i, a, unless_stacked(l, i, b, verdict));
}

/* The quantity of which the superlative's object has the least. */
static double amount(const struct synth_layout *l, const struct synth_clause *c, int i)
{
	switch (c->relation) {
	case SYNTH_NEAREST_TO:
		return distance(l, i, c->a);
	case SYNTH_FARTHEST_FROM:
		return -distance(l, i, c->a);
	case SYNTH_LEFTMOST:
	case SYNTH_LEFT_ONE:
		return l->u[i];
	case SYNTH_RIGHTMOST:
	case SYNTH_RIGHT_ONE:
		return -l->u[i];
	case SYNTH_NEAREST_US:
	case SYNTH_NEAR_ONE:
		return l->v[i];
	default:
		return -l->v[i];
	}
}

/* Against those that fit `among`; where there are none, against every other object, or of "ones" against
 * nothing. */
static int superlative(
	const struct synth_layout *l, const struct synth_clause *c, int i, const struct synth_meaning *among)
{
	double own = amount(l, c, i), best = INFINITY, best_fitting = INFINITY;

	for (int j = 0; j < l->n; j++) {
		if (j == i || j == c->a)
			continue;
		double other = amount(l, c, j);
		best = fmin(best, other);
		if (synth_meaning_fits(among, &l->objects[j]))
			best_fitting = fmin(best_fitting, other);
	}
	if (isinf(best_fitting) && c->relation >= SYNTH_LEFT_ONE)
		return 0;
	best = isinf(best_fitting) ? best : best_fitting;
	return judge(own<best - 0.25, own> best + 0.25);
}

/* What stands on A has no distance from it that a person would compare. */
static int nearest(
	const struct synth_layout *l, const struct synth_clause *c, int i, const struct synth_meaning *among)
{
	for (int j = 0; j < l->n; j++)
		if (are_stacked(l, j, c->a) && (j == i || synth_meaning_fits(among, &l->objects[j])))
			return 0;
	return superlative(l, c, i, among);
}

static int middle_one(const struct synth_layout *l, int i, const struct synth_meaning *among)
{
	int others[2], n = 0;

	for (int j = 0; j < l->n; j++) {
		if (j == i || !synth_meaning_fits(among, &l->objects[j]))
			continue;
		if (n == 2)
			return 0;
		others[n++] = j;
	}
	return n == 2 ? between(l, i, others[0], others[1]) : 0;
}

/* 1 where a is plainly larger than b, -1 where it is plainly smaller: things of different shapes both in bulk
 * and in their longest extent. */
static int compare_sizes(const struct synth_object *a, const struct synth_object *b, enum synth_relation by)
{
	static const double margin = 1.12;
	double tall = a->height / b->height;

	if (by == SYNTH_TALLEST)
		return judge(tall > margin, tall < 1 / margin);
	double bulk = cbrt(a->radius * a->radius * a->height / (b->radius * b->radius * b->height));
	double extent = fmax(2 * a->radius, a->height) / fmax(2 * b->radius, b->height);
	return judge(bulk > margin && extent > margin, bulk < 1 / margin && extent < 1 / margin);
}

static int largest(
	const struct synth_layout *l, enum synth_relation by, int i, const struct synth_meaning *among)
{
	int verdict = 1, rivals = 0;

	for (int j = 0; j < l->n; j++) {
		if (j == i || !synth_meaning_fits(among, &l->objects[j]))
			continue;
		int larger = compare_sizes(&l->objects[i], &l->objects[j], by);
		larger = by == SYNTH_SMALLEST ? -larger : larger;
		verdict = larger < verdict ? larger : verdict;
		rivals++;
	}
	return rivals ? verdict : 0;
}

/* "The red mug at the far left" should not stand on the right, were it the only one or not. */
static int outermost(
	const struct synth_layout *l, const struct synth_clause *c, int i, const struct synth_meaning *among)
{
	double side = c->relation == SYNTH_LEFTMOST ? -l->u[i] : l->u[i];
	int verdict = superlative(l, c, i, among);

	return verdict == 1 && side < 0.1 * l->half_u ? 0 : verdict;
}

int synth_clause_judge(
	const struct synth_layout *l, const struct synth_clause *c, int i, const struct synth_meaning *among)
{
	int a = c->a;
	double u = l->u[i] / l->half_u, v = l->v[i] / l->half_v;

	if (i == a || i == c->b)
		return -1;
	switch (c->relation) {
	case SYNTH_LEFT_OF:
		return unless_stacked(l, i, a, towards(l->u[a] - l->u[i], l->v[a] - l->v[i]));
	case SYNTH_RIGHT_OF:
		return unless_stacked(l, i, a, towards(l->u[i] - l->u[a], l->v[a] - l->v[i]));
	case SYNTH_IN_FRONT_OF:
		return unless_stacked(l, i, a, towards(l->v[a] - l->v[i], l->u[a] - l->u[i]));
	case SYNTH_BEHIND:
		return unless_stacked(l, i, a, towards(l->v[i] - l->v[a], l->u[a] - l->u[i]));
	case SYNTH_NEXT_TO: {
		double gap = distance(l, i, a) - l->objects[i].radius - l->objects[a].radius;
		return unless_stacked(l, i, a, judge(gap<0.4, gap> 0.8));
	}
	case SYNTH_BETWEEN:
		return between(l, i, a, c->b);
	case SYNTH_ON:
		return judge(l->objects[i].on == a, !synth_layout_stands_on(l, i, a));
	case SYNTH_UNDER:
		return judge(l->objects[a].on == i, !synth_layout_stands_on(l, a, i));
	case SYNTH_LEFT_SIDE:
		return judge(u<-0.3, u> - 0.1);
	case SYNTH_RIGHT_SIDE:
		return judge(u > 0.3, u < 0.1);
	case SYNTH_FRONT_SIDE:
		return judge(v<-0.3, v> - 0.1);
	case SYNTH_BACK_SIDE:
		return judge(v > 0.3, v < 0.1);
	case SYNTH_MIDDLE:
		return judge(hypot(u, v) < 0.35, hypot(u, v) > 0.55);
	case SYNTH_ON_TABLE:
		return judge(l->objects[i].on < 0, l->objects[i].on >= 0);
	case SYNTH_LEFTMOST:
	case SYNTH_RIGHTMOST:
		return outermost(l, c, i, among);
	case SYNTH_NEAREST_TO:
		return nearest(l, c, i, among);
	case SYNTH_FARTHEST_FROM:
	case SYNTH_NEAREST_US:
	case SYNTH_FARTHEST_US:
	case SYNTH_LEFT_ONE:
	case SYNTH_RIGHT_ONE:
	case SYNTH_NEAR_ONE:
	case SYNTH_FAR_ONE:
		return superlative(l, c, i, among);
	case SYNTH_MIDDLE_ONE:
		return middle_one(l, i, among);
	case SYNTH_LARGEST:
	case SYNTH_SMALLEST:
	case SYNTH_TALLEST:
		return largest(l, c->relation, i, among);
	case SYNTH_RELATIONS:
		break;
	}
	return -1;
}
