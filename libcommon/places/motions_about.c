/* Motion about another object: past it, behind it, to its place. */
#include "places/motions_private.h"

#include <math.h>

/* Nearness, in sizes of both; and what is left of a way where places are swapped or ways followed. */
static const double near_by = 1.5, near_soft = 0.12, same_way = 0.3, same_soft = 0.05;
static const double straight = 0.6;

/* It comes near another and leaves it behind. */
static double judge_near(const struct track *k, const struct track *other, struct motions_span s)
{
	double nearest = INFINITY;

	for (size_t j = s.a; j <= s.b; j++)
		nearest = fmin(nearest, distance(k->at[j], other->at[j]));
	const double before = distance(k->at[s.a], other->at[s.a]),
		     after = distance(k->at[s.b], other->at[s.b]);
	return soft((fmin(before, after) - nearest) / k->size, motions_least, motions_soft) *
	       soft(-nearest / (k->size + other->size), -near_by, near_soft);
}

/* How far to the right of another it is, as who looks sees it; *beyond: how much farther away. */
static double side_of(const struct motions *m, const double at[3], const double other[3], double *beyond)
{
	double x[2] = {0}, y[2] = {0};

	for (int d = 0; d < 3; d++)
		for (int a = 0; a < 2; a++) {
			x[a] += m->axes[a][d] * (at[d] - m->eye[d]);
			y[a] += m->axes[a][d] * (other[d] - m->eye[d]);
		}
	*beyond = hypot(x[0], x[1]) - hypot(y[0], y[1]);
	return hypot(x[0], x[1]) * sin(atan2(x[0], x[1]) - atan2(y[0], y[1]));
}

/* It gets from one side of another to the other side, beyond it or on this side. */
static double judge_side(const struct motions *m, const struct track *k, const struct track *other, int sign,
	struct motions_span s)
{
	double beyond, last = side_of(m, k->at[s.a], other->at[s.a], &beyond);
	const double before = last, after = side_of(m, k->at[s.b], other->at[s.b], &beyond);

	if (before * after >= 0)
		return 0;
	for (size_t j = s.a + 1; j <= s.b; j++) {
		const double from = beyond, side = side_of(m, k->at[j], other->at[j], &beyond);
		if (side * before <= 0)
			return soft(fmin(fabs(before), fabs(after)) / k->size, motions_least, motions_soft) *
			       soft(sign *
					       (j > s.a + 1 ? from + (beyond - from) * last / (last - side)
							    : beyond) /
					       k->size,
				       motions_least, motions_soft);
		last = side;
	}
	return 0;
}

/* The move within a span that passes another best. */
static double judge_pass(const struct motions *m, enum motion_kind kind, const struct track *k,
	const struct track *other, struct motions_span *in)
{
	struct motions_span found = {in->a, in->a};
	double best = 0;

	for (size_t i = 0; i < k->moves; i++) {
		const struct motions_span s = motions_within(&k->move[i], in);
		const double fits = s.a == s.b ? 0
				    : kind == MOTION_PASSES
					    ? judge_near(k, other, s)
					    : judge_side(m, k, other, kind == MOTION_BEHIND ? 1 : -1, s);
		if (fits <= best)
			continue;
		best = fits;
		found = s;
	}
	*in = found;
	return best;
}

/* It is where the other was: somewhat later of what follows, at the end of what swaps places. */
static double judge_ways(const struct tracks *t, const struct track *k, const struct track *other,
	enum motion_kind kind, struct motions_span *in)
{
	const struct motions_span all = *in;
	const double moves = motions_moves(t, k, MOTION_MOVES, in),
		     between = distance(k->at[all.a], other->at[all.a]);
	double off = INFINITY;

	if (!k->moves || !other->moves || moves < 0.5)
		return 0;
	if (kind == MOTION_SWAPS) {
		off = (distance(k->at[all.b], other->at[all.a]) + distance(other->at[all.b], k->at[all.a])) /
		      2;
		return between > 0 ? soft(-off / between, -same_way, same_soft) : 0;
	}
	const struct track_move *m = other->move;
	for (size_t lag = 1; m->first + lag < all.b; lag++) {
		double sum = 0, n = 0;
		for (size_t i = m->first; i <= m->last && i + lag <= all.b; i++, n++)
			sum += distance(k->at[i + lag], other->at[i]);
		if (n > (double)(m->last - m->first) / 2)
			off = fmin(off, sum / n);
	}
	return soft(-off / fmax(m->path, 1e-300), -same_way, same_soft);
}

static double judge_pair(const struct motions *m, enum motion_kind kind, const struct track *k,
	const struct track *other, struct motions_span *in)
{
	const struct signal to = {other ? NULL : m->axes[1], (kind == MOTION_AWAY) == !other ? 1 : -1, other};

	if (kind == MOTION_PASSES || kind == MOTION_BEHIND || kind == MOTION_FRONT)
		return judge_pass(m, kind, k, other, in);
	if (kind == MOTION_SWAPS || kind == MOTION_FOLLOWS)
		return judge_ways(m->tracks, k, other, kind, in);
	return motions_way(&to, k, straight, in);
}

double motions_about(
	const struct motions *m, enum motion_kind kind, size_t o, long about, struct motions_span *in)
{
	const struct tracks *t = m->tracks;
	struct motions_span best = {in->a, in->a};
	double most = 0;

	if (about < 0 && (kind == MOTION_TOWARDS || kind == MOTION_AWAY))
		return judge_pair(m, kind, &t->of[o], NULL, in);
	for (size_t other = 0; other < t->n; other++) {
		struct motions_span own = *in;
		if (other == o || !t->of[other].points || (about >= 0 && other != (size_t)about))
			continue;
		const double fits = judge_pair(m, kind, &t->of[o], &t->of[other], &own);
		if (fits <= most)
			continue;
		most = fits;
		best = own;
	}
	*in = best;
	return most;
}
