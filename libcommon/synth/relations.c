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

static int between(const struct synth_layout *l, int i, int a, int b)
{
	double du = l->u[b] - l->u[a], dv = l->v[b] - l->v[a], length = hypot(du, dv);
	double pu = l->u[i] - l->u[a], pv = l->v[i] - l->v[a];
	double along = (pu * du + pv * dv) / (length * length),
	       off = fabs(pu * dv - pv * du) / (length * length);

	return judge(along > 0.25 && along < 0.75 && off < 0.2, along < 0.05 || along > 0.95 || off > 0.45);
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
		return l->u[i];
	default:
		return -l->u[i];
	}
}

/* Against those that fit `among`; where there are none, against every other object. */
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
	best = isinf(best_fitting) ? best : best_fitting;
	return judge(own<best - 0.25, own> best + 0.25);
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
		return towards(l->u[a] - l->u[i], l->v[a] - l->v[i]);
	case SYNTH_RIGHT_OF:
		return towards(l->u[i] - l->u[a], l->v[a] - l->v[i]);
	case SYNTH_IN_FRONT_OF:
		return towards(l->v[a] - l->v[i], l->u[a] - l->u[i]);
	case SYNTH_BEHIND:
		return towards(l->v[i] - l->v[a], l->u[a] - l->u[i]);
	case SYNTH_NEXT_TO: {
		double gap = distance(l, i, a) - l->objects[i].radius - l->objects[a].radius;
		return judge(gap<0.4, gap> 0.8);
	}
	case SYNTH_BETWEEN:
		return between(l, i, a, c->b);
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
	case SYNTH_LEFTMOST:
	case SYNTH_RIGHTMOST: {
		/* "The red mug at the far left" should not stand on the right, were it the only one or not.
		 */
		double side = c->relation == SYNTH_LEFTMOST ? -u : u;
		int verdict = superlative(l, c, i, among);
		return verdict == 1 && side < 0.1 ? 0 : verdict;
	}
	case SYNTH_NEAREST_TO:
	case SYNTH_FARTHEST_FROM:
		return superlative(l, c, i, among);
	case SYNTH_RELATIONS:
		break;
	}
	return -1;
}
