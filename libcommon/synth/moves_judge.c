#include "synth/moves_judge.h"

#include <math.h>

enum { APART = 2, LATE = 3 /* stored times */ };

static const double far_enough = 0.5, factor = 1.3;

static int verdict(int is_true, int is_false)
{
	return is_true ? 1 : is_false ? -1 : 0;
}

/* From its first movement to its last; runs: times without rest between. */
static struct finding hull(const struct teller *t, int i, int *runs)
{
	const struct synth_way *w = &t->m->ways[i];
	struct finding f = {w->n ? 1 : -1, w->n ? w->moves[0].first : 0, w->n ? w->moves[w->n - 1].last : 0};

	*runs = w->n > 0;
	for (int k = 1; k < w->n; k++)
		*runs += w->moves[k].first > w->moves[k - 1].last;
	return f;
}

static struct finding when_it(const struct teller *t, int i, enum synth_move_kind kind)
{
	const struct synth_way *w = &t->m->ways[i];
	struct finding f = {-1, 0, 0};

	for (int k = 0; k < w->n; k++)
		if (w->moves[k].kind == kind) {
			f.first = f.is > 0 ? f.first : w->moves[k].first;
			f.last = w->moves[k].last;
			f.is = 1;
		}
	return f;
}

/* Its move along the table, or over it; NULL: none, or two. */
static const struct synth_move *level(const struct teller *t, int i)
{
	const struct synth_way *w = &t->m->ways[i];
	const struct synth_move *found = NULL;

	for (int k = 0; k < w->n; k++) {
		const enum synth_move_kind kind = w->moves[k].kind;
		if (kind != SYNTH_SLIDES && kind != SYNTH_ROLLS && kind != SYNTH_CARRIED)
			continue;
		if (found)
			return NULL;
		found = &w->moves[k];
	}
	return found;
}

/* Of starts, stops and pauses. Who moves at the edge of what is stored does neither there. */
static struct finding judge_rest(const struct teller *t, enum synth_list kind, int i)
{
	int runs;
	struct finding f = hull(t, i, &runs);
	const int is_pushed = runs == 2 && t->m->ways[i].moves[1].kind == SYNTH_SLIDES;

	if (f.is < 0)
		return f;
	if (kind == SYNTH_PAUSES)
		f.is = verdict(is_pushed, runs == 1);
	else if (kind == SYNTH_STARTS)
		f.is = verdict(runs == 1 && f.first >= LATE, 0);
	else
		f.is = verdict(
			runs == 1 && f.last < t->m->times - LATE, runs == 1 && f.last == t->m->times - 1);
	return f;
}

static struct finding judge_direction(const struct teller *t, enum synth_list kind, int i)
{
	const struct synth_move *v = level(t, i);
	const double *along = kind == SYNTH_LEFTWARDS || kind == SYNTH_RIGHTWARDS ? t->right : t->away;
	const double *across = along == t->right ? t->away : t->right;
	const int sign = kind == SYNTH_RIGHTWARDS || kind == SYNTH_FARTHER ? 1 : -1;

	if (!v)
		return (struct finding){
			t->m->ways[i].n > 1 && t->m->ways[i].moves[0].kind == SYNTH_SLIDES ? 0 : -1, 0, 0};
	const double ahead = sign * (along[0] * v->by[0] + along[1] * v->by[1]);
	const double aside = fabs(across[0] * v->by[0] + across[1] * v->by[1]);
	return (struct finding){
		verdict(ahead > far_enough && ahead > 1.5 * aside && !(v->aside > 0), ahead < 0.05), v->first,
		v->last};
}

/* Where object i is before (or after) its moves. */
static void place(const struct teller *t, int i, int is_end, double xy[2])
{
	const struct synth_object *o = &t->m->scene->objects[i];
	double by[3], rolled;

	synth_moves_at(t->m, i, is_end ? t->m->times - 1 : 0, by, &rolled);
	xy[0] = o->x + by[0];
	xy[1] = o->y + by[1];
}

/* Of "towards" and "away from" another, which stays. */
static struct finding judge_approach(const struct teller *t, enum synth_list kind, int i, int a)
{
	const struct synth_move *v = level(t, i);
	double from[2], to[2], at[2];

	if (t->m->ways[a].n || i == a)
		return (struct finding){i == a ? -1 : 0, 0, 0};
	if (!v)
		return judge_direction(t, SYNTH_LEFTWARDS, i);
	place(t, i, 0, from);
	place(t, i, 1, to);
	place(t, a, 0, at);
	const int sign = kind == SYNTH_TOWARDS ? 1 : -1;
	const double before = hypot(at[0] - from[0], at[1] - from[1]),
		     after = hypot(at[0] - to[0], at[1] - to[1]);
	const double straight = sign * ((at[0] - from[0]) * v->by[0] + (at[1] - from[1]) * v->by[1]) /
				(before * hypot(v->by[0], v->by[1]));
	return (struct finding){
		verdict(sign * (before - after) > far_enough && straight > 0.9 && !(v->aside > 0),
			straight < 0 && sign * (before - after) < 0),
		v->first, v->last};
}

/* As who looks sees it: the bearing of another, which stays, is passed on its far side, or its near one. */
static struct finding judge_pass(const struct teller *t, enum synth_list kind, int i, int a)
{
	const struct synth_move *v = level(t, i);
	double at[3][2], bearing[3], range[3];

	if (t->m->ways[a].n || i == a)
		return (struct finding){i == a ? -1 : 0, 0, 0};
	if (!v)
		return judge_direction(t, SYNTH_LEFTWARDS, i);
	place(t, i, 0, at[0]);
	place(t, i, 1, at[1]);
	place(t, a, 0, at[2]);
	for (int k = 0; k < 3; k++) {
		const double x = at[k][0] - t->centre[0], y = at[k][1] - t->centre[1];
		const double u = t->right[0] * x + t->right[1] * y, w = t->away[0] * x + t->away[1] * y;
		bearing[k] = atan2(u, w);
		range[k] = hypot(u, w);
	}
	const double share = (bearing[2] - bearing[0]) / (bearing[1] - bearing[0]);
	const double apart = range[0] + share * (range[1] - range[0]) - range[2];
	const double sign = kind == SYNTH_PASSES_BEHIND ? apart : -apart;
	const int is_crossed = share > 0.15 && share < 0.85 && fabs(bearing[1] - bearing[0]) > 0.1;
	return (struct finding){verdict(is_crossed && sign > 0.3 && sign < 2 && !(v->aside > 0),
					share < -0.1 || share > 1.1 || (is_crossed && sign < -0.3)),
		v->first, v->last};
}

static void measure(const struct teller *t, int i, enum synth_list kind, double *a, double *b)
{
	int runs;
	const struct finding f = hull(t, i, &runs);
	double last[3], by[3], rolled, path = 0, peak = 0;

	synth_moves_at(t->m, i, 0, last, &rolled);
	for (int k = 1; k < 4 * t->m->times; k++) {
		synth_moves_at(t->m, i, k / 4.0, by, &rolled);
		const double step =
			sqrt(pow(by[0] - last[0], 2) + pow(by[1] - last[1], 2) + pow(by[2] - last[2], 2));
		path += step;
		peak = fmax(peak, step);
		for (int d = 0; d < 3; d++)
			last[d] = by[d];
	}
	*a = kind == SYNTH_FASTEST || kind == SYNTH_SLOWEST ? peak
	     : kind == SYNTH_MOVES_MOST			    ? path
							    : f.first;
	*b = kind == SYNTH_MOVES_MOST	 ? path
	     : kind == SYNTH_MOVES_FIRST ? f.first
	     : kind == SYNTH_MOVES_LAST	 ? f.last
					 : path / (f.last - f.first);
}

/* Against all others that move and that the words may mean. */
static struct finding judge_rank(const struct teller *t, const struct draft *d, int i)
{
	const int sign = d->kind == SYNTH_SLOWEST || d->kind == SYNTH_MOVES_FIRST ? -1 : 1,
		  is_time = d->kind >= SYNTH_MOVES_FIRST;
	int runs, rivals = 0;
	struct finding f = hull(t, i, &runs);
	double a, b, x, y;

	if (f.is < 0)
		return f;
	measure(t, i, d->kind, &a, &b);
	for (int j = 0; j < t->n; j++) {
		if (j == i || d->fits[j] < 0 || !t->m->ways[j].n)
			continue;
		measure(t, j, d->kind, &x, &y);
		const double least = is_time ? sign * (a - x) - APART : sign * log(a / x) - log(factor);
		const double other = is_time ? sign * (b - y) - (d->kind == SYNTH_MOVES_LAST ? 0 : APART)
					     : sign * log(b / y) - log(factor);
		const double worst = is_time ? sign * (x - a) - APART : sign * log(x / a) - log(factor);
		const int one = verdict(least >= 0 && other >= 0, worst >= 0);
		f.is = one < f.is ? one : f.is;
		rivals++;
	}
	f.is = rivals ? f.is : 0;
	return f;
}

/* What moves while, before or after something happens to another. */
static struct finding judge_event(const struct teller *t, const struct draft *d, int i)
{
	int runs;
	struct finding f = hull(t, i, &runs);
	const struct finding y = moves_judge(t, d, d->event, d->other);

	if (i == d->other || f.is < 0)
		return (struct finding){-1, 0, 0};
	if (y.is <= 0 || runs > 1)
		return (struct finding){0};
	const int both = (f.last < y.last ? f.last : y.last) - (f.first > y.first ? f.first : y.first);
	const int is_before = f.last <= y.first, is_after = f.first >= y.last;
	f.is = d->kind == SYNTH_WHILE	 ? verdict(both >= APART, both <= 0)
	       : d->kind == SYNTH_BEFORE ? verdict(is_before, f.first >= y.first)
					 : verdict(is_after, f.last <= y.last);
	if (d->kind == SYNTH_WHILE) {
		f.first = f.first > y.first ? f.first : y.first;
		f.last = f.last < y.last ? f.last : y.last;
	}
	return f;
}

struct finding moves_judge(const struct teller *t, const struct draft *d, enum synth_list kind, int i)
{
	const struct synth_way *w = &t->m->ways[i];
	int runs;
	struct finding f = hull(t, i, &runs);

	switch (kind) {
	case SYNTH_MOVES_NOT:
		return (struct finding){-f.is, 0, t->m->times - 1};
	case SYNTH_PLAIN_THING:
		return (struct finding){1, 0, t->m->times - 1};
	case SYNTH_STARTS:
	case SYNTH_STOPS:
	case SYNTH_PAUSES:
		return judge_rest(t, kind, i);
	case SYNTH_RAISED:
		return when_it(t, i, SYNTH_RISES);
	case SYNTH_PUT_DOWN:
		f = when_it(t, i, SYNTH_FALLS);
		return f.is > 0 ? (struct finding){0} : when_it(t, i, SYNTH_LOWERED);
	case SYNTH_FALLS_DOWN:
		return when_it(t, i, SYNTH_FALLS);
	case SYNTH_ROLLS_OFF:
		return when_it(t, i, SYNTH_ROLLS);
	case SYNTH_SLIDES_OFF:
		return when_it(t, i, SYNTH_SLIDES);
	case SYNTH_CHANGES_PLACES:
		f.is = w->partner >= 0 && w->partner == d->other ? 1 : -1;
		return f;
	case SYNTH_TOWARDS:
	case SYNTH_AWAY:
		return judge_approach(t, kind, i, d->other);
	case SYNTH_PASSES_BEHIND:
	case SYNTH_PASSES_FRONT:
		return judge_pass(t, kind, i, d->other);
	case SYNTH_WHILE:
	case SYNTH_BEFORE:
	case SYNTH_AFTER:
		return judge_event(t, d, i);
	default:
		return kind >= SYNTH_FASTEST	 ? judge_rank(t, d, i)
		       : kind >= SYNTH_LEFTWARDS ? judge_direction(t, kind, i)
						 : f;
	}
}
