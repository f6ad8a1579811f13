/* When a track moves: by its speed over a reach to either side, beside the fastest that it gets. */
#include "base/mem.h"
#include "base/quantile.h"
#include "geom/rotation.h"
#include "geom/vector.h"
#include "places/track.h"

#include <math.h>
#include <string.h>

enum { EMBEDDED = 12, NOISE_TIMES = 5 };
/* Rest is less than these parts of the object's size and of the scene's, and so many times the noise. */
static const double reach_size = 0.01, reach_scene = 5e-4, reach_noise = 4;
/* A whole move is more than this part of the size; and so many times the reach: noise alone gets that far. */
static const double least_move = 0.05, least_reaches = 1.5;
/* What is slower than this part of the fastest rests ... */
static const double slow = 0.1;
/* ... unless it is moved by this part of its size all the same. */
static const double drift = 0.3;
/* A turn as a length: what the points of a cube move by. */
static const double turn_worth = 0.25;
/* The middle half of the lengths of noise in three dimensions is from 1.1 of its deviation on. */
static const double noise_quarter = 1.1;

static void embed(const struct track *k, size_t time, double x[EMBEDDED])
{
	for (int d = 0; d < 3; d++)
		x[d] = k->at[time][d] - k->at[0][d];
	for (int a = 0; a < 9; a++)
		x[3 + a] = turn_worth * k->size * k->turn[time][a / 3][a % 3];
}

static double apart(const double a[EMBEDDED], const double b[EMBEDDED])
{
	double sum = 0;

	for (int i = 0; i < EMBEDDED; i++)
		sum += (a[i] - b[i]) * (a[i] - b[i]);
	return sqrt(sum);
}

double track_between(const struct track *k, size_t a, size_t b)
{
	double x[EMBEDDED], y[EMBEDDED];

	embed(k, a, x);
	embed(k, b, y);
	return apart(x, y);
}

/* Noise is what is left of a time when a straight line is drawn between its neighbours, where that is least.
 */
static double find_noise(const struct tracks *to, double (*x)[EMBEDDED], struct quantile_item *items)
{
	if (to->times < NOISE_TIMES)
		return 0;
	for (size_t i = 1; i + 1 < to->times; i++) {
		const double b = (to->t[i] - to->t[i - 1]) / (to->t[i + 1] - to->t[i - 1]), a = 1 - b;
		double line[EMBEDDED];
		for (int d = 0; d < EMBEDDED; d++)
			line[d] = a * x[i - 1][d] + b * x[i + 1][d];
		items[i - 1] = (struct quantile_item){apart(line, x[i]) / sqrt(1 + a * a + b * b), 1};
	}
	return quantile_weighted(items, to->times - 2, 0.25) / noise_quarter;
}

/* How long it takes from a time between i and i + 1, where it is at m, until it is out of reach: forwards, or
 * with step -1 backwards. INFINITY: it never is. */
static double leaves(const struct tracks *to, double (*x)[EMBEDDED], const double m[EMBEDDED], double reach,
	size_t i, int step)
{
	const double now = (to->t[i] + to->t[i + 1]) / 2;
	double from[EMBEDDED], since = now;

	memcpy(from, m, sizeof from);
	for (size_t j = step > 0 ? i + 1 : i; j < to->times; j += (size_t)step) {
		if (apart(x[j], m) > reach) {
			double a = 0, b = 0, c = -reach * reach;
			for (int d = 0; d < EMBEDDED; d++) {
				a += (x[j][d] - from[d]) * (x[j][d] - from[d]);
				b += (x[j][d] - from[d]) * (from[d] - m[d]);
				c += (from[d] - m[d]) * (from[d] - m[d]);
			}
			const double u = (sqrt(fmax(b * b - a * c, 0)) - b) / a;
			return fabs(since + u * (to->t[j] - since) - now);
		}
		memcpy(from, x[j], sizeof from);
		since = to->t[j];
		if (!j && step < 0)
			break;
	}
	return INFINITY;
}

/* The speed between two stored times, over a reach to either side. What is not seen to begin or to end is
 * taken to go on as it is seen, if that is longer. */
static double speed_at(const struct tracks *to, double (*x)[EMBEDDED], double reach, size_t i)
{
	const double now = (to->t[i] + to->t[i + 1]) / 2, seen = now - to->t[0],
		     left = to->t[to->times - 1] - now;
	double m[EMBEDDED];

	for (int d = 0; d < EMBEDDED; d++)
		m[d] = (x[i][d] + x[i + 1][d]) / 2;
	double on = leaves(to, x, m, reach, i, 1), back = leaves(to, x, m, reach, i, -1);
	if (on == INFINITY && back == INFINITY)
		return 0;
	back = back == INFINITY ? fmax(seen, on) : back;
	on = on == INFINITY ? fmax(left, back) : on;
	return 2 * reach / (on + back);
}

/* Whether it gets anywhere between two stored times. */
static int is_far(const struct track *k, double (*x)[EMBEDDED], size_t begin, size_t end)
{
	double far = 0;

	for (size_t i = begin; i < end; i++)
		far = fmax(far, apart(x[begin], x[i + 1]));
	return far >= fmax(least_move * k->size, least_reaches * k->reach);
}

/* moving (T-1) gets 1 between stored times from `begin` to `end` that are no rest. */
static void mark(const struct track *k, double (*x)[EMBEDDED], const double *speed, char *moving,
	size_t begin, size_t end)
{
	double most = 0;

	for (size_t i = begin; i < end; i++)
		most = fmax(most, speed[i]);
	if (most <= 0 || !is_far(k, x, begin, end))
		return;
	for (size_t i = begin; i < end; i++)
		moving[i] = speed[i] >= slow * most;
	for (size_t i = begin, from; i < end; i++) {
		if (moving[i])
			continue;
		for (from = i; i < end && !moving[i]; i++)
			;
		if (i - from < end - begin && apart(x[from], x[i]) > drift * k->size)
			mark(k, x, speed, moving, from, i);
	}
}

double track_path(const struct track *k, size_t a, size_t b)
{
	double sum = 0;

	for (size_t i = a + 1, from = a; i <= b; i++) {
		const double by[3] = {k->at[i][0] - k->at[from][0], k->at[i][1] - k->at[from][1],
			k->at[i][2] - k->at[from][2]};
		if (vector_length(by) <= k->reach && i < b)
			continue;
		sum += vector_length(by);
		from = i;
	}
	return sum;
}

/* The rotation from one stored time to another as a vector, as long as its angle. */
static void turn_vector(const struct track *k, size_t a, size_t b, double v[3])
{
	double r[3][3], q[4];

	for (int i = 0; i < 9; i++) {
		r[i / 3][i % 3] = 0;
		for (int c = 0; c < 3; c++)
			r[i / 3][i % 3] += k->turn[b][i / 3][c] * k->turn[a][i % 3][c];
	}
	rotation_to_quat(r, q);
	const double sine = hypot(hypot(q[1], q[2]), q[3]), angle = 2 * atan2(sine, q[0]);
	for (int d = 0; d < 3; d++)
		v[d] = sine > 0 ? angle * q[1 + d] / sine : 0;
}

static void measure_move(
	const struct tracks *to, const struct track *k, const double *speed, struct track_move *m)
{
	m->path = track_path(k, m->first, m->last);
	for (size_t i = m->first; i < m->last; i++) {
		double v[3];
		m->speed = fmax(m->speed, speed[i]);
		turn_vector(k, i, i + 1, v);
		const double about = vector_dot(v, to->up);
		m->turned += about;
		m->rolled += sqrt(fmax(vector_dot(v, v) - about * about, 0));
	}
}

static int find_moves(const struct tracks *to, struct track *k, struct err *e)
{
	const size_t n = to->times;
	SCOPED double(*x)[EMBEDDED] = mem_alloc(n, sizeof *x, "tracks", e);
	SCOPED struct quantile_item *items = mem_alloc(n, sizeof *items, "tracks", e);
	SCOPED double *speed = mem_alloc(n, sizeof *speed, "tracks", e);
	SCOPED char *moving = mem_zalloc(n, 1, "tracks", e);

	k->move = mem_alloc(n, sizeof *k->move, "tracks", e);
	if (!x || !items || !speed || !moving || !k->move)
		return -1;
	if (n < 2 || !k->is_moved || !(k->size > 0))
		return 0;
	for (size_t i = 0; i < n; i++)
		embed(k, i, x[i]);
	k->noise = find_noise(to, x, items);
	k->reach = fmax(fmax(reach_size * k->size, reach_scene * to->scene), reach_noise * k->noise);
	for (size_t i = 0; i + 1 < n; i++)
		speed[i] = speed_at(to, x, k->reach, i);
	mark(k, x, speed, moving, 0, n - 1);
	for (size_t i = 0; i + 1 < n; i++) {
		if (!moving[i])
			continue;
		struct track_move m = {.first = i};
		while (i + 1 < n && moving[i])
			i++;
		m.last = i;
		if (!is_far(k, x, m.first, m.last))
			continue;
		measure_move(to, k, speed, &m);
		k->move[k->moves++] = m;
	}
	return 0;
}

int tracks_end(struct tracks *to, struct err *e)
{
	double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY}, by[3];
	int bad = 0;

	for (size_t o = 0; o < to->n; o++)
		for (size_t i = 0; i < to->times && to->of[o].points; i++)
			for (int d = 0; d < 3; d++) {
				low[d] = fmin(low[d], to->of[o].at[i][d] - to->of[o].size / 2);
				high[d] = fmax(high[d], to->of[o].at[i][d] + to->of[o].size / 2);
			}
	for (int d = 0; d < 3; d++)
		by[d] = fmax(high[d] - low[d], 0);
	to->scene = vector_length(by);
	for (size_t o = 0; o < to->n && !bad; o++)
		bad = find_moves(to, &to->of[o], e);
	return bad ? -1 : 0;
}
