#include "places/motions_private.h"

#include <math.h>

/* Of a way, the cosine to where it is said to go. */
static const double straight = 0.6, upwards = 0.45, straight_soft = 0.07;
/* Ends of a motion that are this part of it are rest. */
static const double trim = 0.02;
/* Of a way down, the share of the time that the second half takes: 0.29 in free fall, 0.5 of what is put
 * down. */
static const double hasty = 0.42, hasty_soft = 0.03;
/* How much as far as it goes its surface turns, of what rolls; radians of what turns, and of what tips over.
 */
static const double rolling = 0.4, rolling_soft = 0.05, turning = 0.35, tipping = 0.8, turn_soft = 0.07;
/* What fits the rest this well beside the best is compared. */
static const double rival = 0.3;
/* A rest is longer than this part of the move beside it: the ends of one are slow. */
static const double rest = 0.15;
/* Speeds and lengths, and parts of the whole time, that are told apart. */
static const double told_apart = 0.05, told_time = 0.02;

static double value_at(const struct signal *s, const struct track *k, size_t i)
{
	if (s->axis)
		return s->sign * vector_dot(s->axis, k->at[i]);
	return -s->sign * distance(k->at[i], s->other->at[i]);
}

void motions_look(struct motions *m, const struct tracks *t, const struct cameras *cameras,
	const struct viewpoint *from)
{
	double middle[3] = {0}, n = 0;

	m->tracks = t;
	for (size_t o = 0; o < t->n; o++)
		for (int d = 0; d < 3 && t->of[o].points; d++) {
			middle[d] += t->of[o].at[0][d];
			n += d == 0;
		}
	for (int d = 0; d < 3; d++)
		middle[d] /= fmax(n, 1);
	viewpoint_axes(from, cameras, middle, told_apart * t->scene, m->axes, m->eye);
}

/* The part of a move that is within a span. */
struct motions_span motions_within(const struct track_move *m, const struct motions_span *in)
{
	const struct motions_span s = {
		m->first > in->a ? m->first : in->a, m->last < in->b ? m->last : in->b};

	return s.a < s.b ? s : (struct motions_span){in->a, in->a};
}

/* What goes somewhere, far and straight enough: the longest rise of a signal, but for falls within reach. */
double motions_way(const struct signal *s, const struct track *k, double cosine, struct motions_span *in)
{
	const double slack = fmax(k->reach, trim * k->size);
	size_t low = in->a, top = in->a, a = in->a, b = in->a;
	double rise = 0;

	for (size_t i = in->a; i <= in->b; i++) {
		const double x = value_at(s, k, i);
		if (x < value_at(s, k, low) || x < value_at(s, k, top) - slack)
			low = top = i;
		if (x > value_at(s, k, top))
			top = i;
		if (value_at(s, k, top) - value_at(s, k, low) > rise) {
			rise = value_at(s, k, top) - value_at(s, k, low);
			a = low;
			b = top;
		}
	}
	const double from = value_at(s, k, a), to = value_at(s, k, b);
	while (a + 1 < b && value_at(s, k, a + 1) < from + trim * rise)
		a++;
	while (b > a + 1 && value_at(s, k, b - 1) > to - trim * rise)
		b--;
	*in = (struct motions_span){a, b};
	const double way = s->axis ? distance(k->at[a], k->at[b]) : track_path(k, a, b);
	return way > 0 ? soft(rise / k->size, motions_least, motions_soft) *
				 soft(rise / way, cosine, straight_soft)
		       : 0;
}

/* How far a way down is a fall: what is put down slows down at its end. */
static double is_fall(
	const struct tracks *t, const struct signal *s, const struct track *k, struct motions_span in)
{
	const double half = (value_at(s, k, in.a) + value_at(s, k, in.b)) / 2;
	size_t i = in.a;

	while (i + 1 < in.b && value_at(s, k, i + 1) < half)
		i++;
	if (in.b < in.a + 3) /* too few to tell */
		return 0.75;
	const double low = value_at(s, k, i), high = value_at(s, k, i + 1);
	const double at =
		t->t[i] + (high > low ? (half - low) / (high - low) : 0.5) * (t->t[i + 1] - t->t[i]);
	return soft(-(t->t[in.b] - at) / (t->t[in.b] - t->t[in.a]), -hasty, hasty_soft);
}

/* Its moves within a span, together: all, or those after or before a rest. */
double motions_moves(
	const struct tracks *t, const struct track *k, enum motion_kind kind, struct motions_span *in)
{
	struct motions_span found = {in->b, in->a};
	double far = 0;

	for (size_t i = 0; i < k->moves; i++) {
		const struct track_move *m = &k->move[i];
		const struct motions_span s = motions_within(m, in);
		const double least_rest = rest * (t->t[m->last] - t->t[m->first]);
		if (s.a == s.b || (kind == MOTION_STARTS && t->t[m->first] - t->t[0] <= least_rest) ||
			(kind == MOTION_STOPS && t->t[t->times - 1] - t->t[m->last] <= least_rest))
			continue;
		found.a = s.a < found.a ? s.a : found.a;
		found.b = s.b > found.b ? s.b : found.b;
		for (size_t j = s.a; j <= s.b; j++)
			far = fmax(far, track_between(k, s.a, j));
	}
	*in = found.a < found.b ? found : (struct motions_span){in->a, in->a};
	return far > 0 ? soft(far / k->size, motions_least / 3, motions_soft / 3) : 0;
}

/* How far it is tilted in a move. */
static double tilt(const struct tracks *t, const struct track *k, const struct track_move *m)
{
	double cosine = 0;

	for (int c = 0; c < 3; c++) {
		double now = 0, was = 0;
		for (int d = 0; d < 3; d++) {
			now += t->up[d] * k->turn[m->last][d][c];
			was += t->up[d] * k->turn[m->first][d][c];
		}
		cosine += now * was;
	}
	return acos(fmax(fmin(cosine, 1), -1));
}

static double judge_turn(
	const struct tracks *t, const struct track *k, enum motion_kind kind, const struct track_move *m)
{
	double low = INFINITY, high = -INFINITY;

	if (kind == MOTION_TIPS)
		return soft(tilt(t, k, m), tipping, turn_soft) * soft(-m->path / k->size, -2, motions_least);
	if (kind == MOTION_TURNS) {
		const double turned = fabs(m->turned);
		return soft(turned, turning, turn_soft) * soft(turned / (turned + m->rolled), 0.5, turn_soft);
	}
	if (!(m->path > 0))
		return 0;
	for (size_t i = m->first; i <= m->last; i++) {
		low = fmin(low, vector_dot(t->up, k->at[i]));
		high = fmax(high, vector_dot(t->up, k->at[i]));
	}
	const double level = soft((low - high) / k->size, -motions_least, motions_soft);
	const double roll = soft(m->rolled * k->size / 2 / m->path, rolling, rolling_soft);
	return soft(m->path / k->size, motions_least, motions_soft) * level *
	       (kind == MOTION_ROLLS ? roll : 1 - roll);
}

/* The moves within a span that fit, together, or the one that fits best. */
static double best_moves(
	const struct tracks *t, const struct track *k, enum motion_kind kind, struct motions_span *in)
{
	struct motions_span found = {in->a, in->a};
	double best = 0;

	for (size_t i = 0; i < k->moves; i++) {
		const struct motions_span s = motions_within(&k->move[i], in);
		const double fits = s.a == s.b ? 0 : judge_turn(t, k, kind, &k->move[i]);
		if (fits >= 0.5 && best >= 0.5)
			found.b = s.b;
		else if (fits > best)
			found = s;
		best = fmax(fits, best);
	}
	*in = found;
	return best;
}

/* It rests between two moves. */
static double judge_pause(const struct track *k, struct motions_span *in)
{
	double far[2] = {0};
	struct motions_span found = {in->a, in->a};

	for (size_t i = 0; i < k->moves; i++) {
		const struct motions_span s = motions_within(&k->move[i], in);
		const double own = track_between(k, s.a, s.b);
		found.a = far[0] > 0 ? found.a : s.a;
		found.b = s.b > found.b ? s.b : found.b;
		far[1] = fmax(far[1], fmin(own, far[0]));
		far[0] = fmax(far[0], own);
	}
	*in = found;
	return far[1] > 0 ? soft(far[1] / k->size, motions_least / 3, motions_soft / 3) : 0;
}

double motions_judge(
	const struct motions *m, enum motion_kind kind, size_t o, long about, struct motions_span *in)
{
	const struct tracks *t = m->tracks;
	const struct track *k = &t->of[o];
	const int is_side = kind == MOTION_LEFT || kind == MOTION_RIGHT;
	const int is_back =
		kind == MOTION_LEFT || kind == MOTION_DOWN || kind == MOTION_FALLS || kind == MOTION_LOWERED;
	const struct signal s = {is_side ? m->axes[0] : t->up, is_back ? -1 : 1, NULL};
	struct motions_span own = *in;

	if (!k->points || !(k->size > 0) || in->a >= in->b)
		return kind == MOTION_STILL && k->points;
	switch (kind) {
	case MOTION_MOVES:
	case MOTION_STARTS:
	case MOTION_STOPS:
		return motions_moves(t, k, kind, in);
	case MOTION_STILL:
		return 1 - motions_moves(t, k, MOTION_MOVES, &own);
	case MOTION_FALLS:
	case MOTION_LOWERED: {
		const double down = motions_way(&s, k, straight, in), falls = is_fall(t, &s, k, *in);
		return down * (kind == MOTION_FALLS ? falls : 1 - falls);
	}
	case MOTION_RAISED:
	case MOTION_LEFT:
	case MOTION_RIGHT:
	case MOTION_UP:
	case MOTION_DOWN:
		return motions_way(&s, k, kind == MOTION_RAISED ? upwards : straight, in);
	case MOTION_ROLLS:
	case MOTION_SLIDES:
	case MOTION_TURNS:
	case MOTION_TIPS:
		return best_moves(t, k, kind, in);
	case MOTION_PAUSES:
		return judge_pause(k, in);
	default:
		return motions_about(m, kind, o, about, in);
	}
}

/* What is compared, in units of what is told apart: the smallest is meant. INFINITY: it does not move. */
static double rank_key(
	const struct tracks *t, enum motion_kind kind, const struct track *k, struct motions_span in)
{
	double speed = 0;

	for (size_t i = 0; i < k->moves; i++)
		if (k->move[i].first < in.b && k->move[i].last > in.a)
			speed = fmax(speed, k->move[i].speed);
	const double path = track_path(k, in.a, in.b), whole = t->t[t->times - 1] - t->t[0];
	if (!(speed > 0) || !(path > 0))
		return INFINITY;
	switch (kind) {
	case MOTION_FASTEST:
		return -log(speed) / told_apart;
	case MOTION_SLOWEST:
		return log(speed) / told_apart;
	case MOTION_FARTHEST:
		return -log(path) / told_apart;
	case MOTION_LEAST:
		return log(path) / told_apart;
	default:
		return (kind == MOTION_LAST ? -1 : 1) * t->t[in.a] / (told_time * whole);
	}
}

void motions_rank(const struct motions *m, enum motion_kind kind, const double *as,
	const struct motions_span *in, double *fits)
{
	const struct tracks *t = m->tracks;
	double low = INFINITY;

	for (size_t o = 0; o < t->n; o++) {
		fits[o] = t->of[o].points && in[o].a < in[o].b && as[o] >= rival
				  ? rank_key(t, kind, &t->of[o], in[o])
				  : INFINITY;
		low = fmin(low, fits[o]);
	}
	for (size_t o = 0; o < t->n; o++)
		fits[o] = fits[o] < INFINITY ? exp(fmax(low - fits[o], -50)) : 0;
}
