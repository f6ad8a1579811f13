#include "places/track.h"

#include "base/compare.h"
#include "base/mem.h"
#include "base/quantile.h"
#include "geom/rotation.h"
#include "geom/vector.h"

#include <math.h>

enum { POINTS = 512, /* of an object, about so many */ SQUARINGS = 40 };
static const double most_weight = 4;
/* Of a cube of side 1: no turn moves a point by more. */
static const double diagonal = 1.8;

void tracks_free(struct tracks *to)
{
	for (size_t o = 0; to->of && o < to->n; o++) {
		struct track *k = &to->of[o];
		mem_free_all(k->at, k->turn, k->move, k->ids, k->weight, k->first);
	}
	free(to->of);
	*to = (struct tracks){0};
}

static int take_points(
	struct track *k, const struct extent *x, const struct splats *s, const char *is_moved, struct err *e)
{
	const size_t step = 1 + x->n / POINTS, n = (x->n + step - 1) / step;
	SCOPED double *sorted = mem_alloc(n, sizeof *sorted, "tracks", e);
	double sum = 0;

	k->ids = mem_alloc(n, sizeof *k->ids, "tracks", e);
	k->weight = mem_alloc(n, sizeof *k->weight, "tracks", e);
	k->first = mem_alloc(n, sizeof *k->first, "tracks", e);
	if (!sorted || !k->ids || !k->weight || !k->first)
		return -1;
	for (size_t i = 0; i < x->n; i += step, k->points++) {
		const size_t g = (size_t)x->ids[i];
		k->ids[k->points] = x->ids[i];
		k->weight[k->points] = sorted[k->points] = extent_part(s, g) * x->weight[i];
		k->is_moved |= !is_moved || is_moved[g];
	}
	qsort(sorted, n, sizeof *sorted, compare_double);
	for (size_t i = 0; i < n; i++)
		sum += k->weight[i] = fmin(k->weight[i], most_weight * sorted[n / 2]);
	for (size_t i = 0; i < n; i++)
		k->weight[i] = sum > 0 ? k->weight[i] / sum : 1 / (double)n;
	k->size = box_diagonal(&x->turned) / sqrt(3);
	return 0;
}

int tracks_begin(struct tracks *to, size_t objects, const struct extent *extents, const struct splats *s,
	const double *t, size_t times, const char *is_moved, const double up[3], struct err *e)
{
	*to = (struct tracks){.n = objects, .times = times, .t = t, .up = {up[0], up[1], up[2]}};
	to->of = mem_zalloc(to->n, sizeof *to->of, "tracks", e);
	int bad = !to->of;
	for (size_t o = 0; o < to->n && !bad; o++) {
		struct track *k = &to->of[o];
		k->at = mem_zalloc(times, sizeof *k->at, "tracks", e);
		k->turn = mem_zalloc(times, sizeof *k->turn, "tracks", e);
		bad = !k->at || !k->turn || (extents[o].n && take_points(k, &extents[o], s, is_moved, e));
	}
	return bad ? -1 : 0;
}

static double point_at(const struct splats *s, const struct track *k, size_t i, int axis)
{
	return (double)s->means[3 * (size_t)k->ids[i] + (size_t)axis];
}

static void turn_identity(double r[3][3])
{
	for (int a = 0; a < 9; a++)
		r[a / 3][a % 3] = a % 4 == 0;
}

/* The unit vector of the largest eigenvalue of a symmetric matrix of four, whose square is taken again and
 * again, from the side where eigenvalues are positive. */
static void largest_vector(double m[4][4], double q[4])
{
	double bound = 0, from[4][4];
	int best = 0;

	for (int a = 0; a < 4; a++)
		bound = fmax(bound, fabs(m[a][0]) + fabs(m[a][1]) + fabs(m[a][2]) + fabs(m[a][3]));
	for (int a = 0; a < 4; a++)
		m[a][a] += bound;
	for (int pass = 0; pass < SQUARINGS && bound > 0; pass++) {
		const double trace = m[0][0] + m[1][1] + m[2][2] + m[3][3];
		for (int a = 0; a < 16; a++)
			from[a / 4][a % 4] = m[a / 4][a % 4] / trace;
		for (int a = 0; a < 16; a++) {
			double sum = 0;
			for (int c = 0; c < 4; c++)
				sum += from[a / 4][c] * from[c][a % 4];
			m[a / 4][a % 4] = sum;
		}
	}
	for (int a = 1; a < 4; a++)
		best = m[a][a] > m[best][best] ? a : best;
	for (int a = 0; a < 4; a++)
		q[a] = bound > 0 ? m[a][best] : a == 0;
}

/* The rotation between the points of the first time and those of now, whose covariance is c. */
static void find_turn(const double c[3][3], double r[3][3])
{
	double q[4], m[4][4] = {{c[0][0] + c[1][1] + c[2][2], c[1][2] - c[2][1], c[2][0] - c[0][2],
					c[0][1] - c[1][0]},
			     {0, c[0][0] - c[1][1] - c[2][2], c[0][1] + c[1][0], c[2][0] + c[0][2]},
			     {0, 0, c[1][1] - c[0][0] - c[2][2], c[1][2] + c[2][1]},
			     {0, 0, 0, c[2][2] - c[0][0] - c[1][1]}};

	for (int a = 0; a < 4; a++)
		for (int b = 0; b < a; b++)
			m[a][b] = m[b][a];
	largest_vector(m, q);
	rotation_of_quat(q, r);
}

/* The middle of what the points are moved by along an axis since the first time. */
static double moved_by(const struct track *k, const struct splats *s, int axis, struct quantile_item *items)
{
	for (size_t i = 0; i < k->points; i++)
		items[i] = (struct quantile_item){point_at(s, k, i, axis) - k->first[i][axis], k->weight[i]};
	return quantile_weighted(items, k->points, 0.5);
}

/* The mean of what the points are moved by, but of those that no turn could have moved so far from the
 * middle. */
static void put_one(struct track *k, size_t time, const struct splats *s, struct quantile_item *items)
{
	double c[3][3] = {{0}}, middle[3], mean[3] = {0}, sum = 0;

	for (int d = 0; d < 3; d++)
		middle[d] = moved_by(k, s, d, items);
	for (size_t i = 0; i < k->points; i++) {
		double by[3], off[3];
		for (int d = 0; d < 3; d++) {
			by[d] = point_at(s, k, i, d) - k->first[i][d];
			off[d] = by[d] - middle[d];
		}
		if (vector_length(off) > diagonal * k->size)
			continue;
		sum += k->weight[i];
		for (int a = 0; a < 9; a++)
			c[a / 3][a % 3] += k->weight[i] * (k->first[i][a / 3] - k->at[0][a / 3]) *
					   (point_at(s, k, i, a % 3) - k->at[0][a % 3] - middle[a % 3]);
		for (int d = 0; d < 3; d++)
			mean[d] += k->weight[i] * by[d];
	}
	for (int d = 0; d < 3; d++)
		k->at[time][d] = k->at[0][d] + (sum > 0 ? mean[d] / sum : middle[d]);
	find_turn(c, k->turn[time]);
}

/* The points at the first time, and their middle. */
static void put_first(struct track *k, const struct splats *s)
{
	for (size_t i = 0; i < k->points; i++)
		for (int d = 0; d < 3; d++) {
			k->first[i][d] = point_at(s, k, i, d);
			k->at[0][d] += k->weight[i] * k->first[i][d];
		}
	turn_identity(k->turn[0]);
}

int tracks_put(struct tracks *to, size_t time, const struct splats *s, struct err *e)
{
	int bad = 0;

#pragma omp parallel for schedule(dynamic) reduction(| : bad)
	for (size_t o = 0; o < to->n; o++) {
		struct track *k = &to->of[o];
		struct err ignored;
		SCOPED struct quantile_item *items = mem_alloc(k->points, sizeof *items, "tracks", &ignored);
		bad |= !items;
		if (!time) {
			put_first(k, s);
		} else if (items && k->is_moved) {
			put_one(k, time, s, items);
		} else {
			memcpy(k->at[time], k->at[0], sizeof *k->at);
			turn_identity(k->turn[time]);
		}
	}
	return bad ? err_set(e, ERR_SYSTEM, "tracks: out of memory") : 0;
}
