/* How far two boxes are apart. Boxes that no plane parts touch (separating axes: the faces' normals, and the
 * cross products of edges). Of two that are apart, the nearest points are a corner and a face, or on two
 * edges, so that the least of these distances is the gap. */
#include "base/dot.h"
#include "geom/box.h"
#include "geom/vector.h"

#include <math.h>

/* Axes that are nearly parallel have a cross product that says nothing. */
#define PARALLEL 1e-12

struct edge {
	double middle[3];
	const double *along; /* unit vector */
	double half;
};

static double reach(const struct box *b, const double axis[3])
{
	double sum = 0;

	for (int k = 0; k < 3; k++)
		sum += fabs(dot(b->axes[k], axis, 3)) * b->half[k];
	return sum;
}

static int is_parted_by(const struct box *a, const struct box *b, const double axis[3])
{
	const double apart = dot(axis, b->centre, 3) - dot(axis, a->centre, 3);

	return fabs(apart) > reach(a, axis) + reach(b, axis);
}

static int is_parted(const struct box *a, const struct box *b)
{
	int parted = 0;

	for (int i = 0; i < 3; i++) {
		parted |= is_parted_by(a, b, a->axes[i]) || is_parted_by(a, b, b->axes[i]);
		for (int j = 0; j < 3; j++) {
			double axis[3];
			vector_cross(a->axes[i], b->axes[j], axis);
			parted |= dot(axis, axis, 3) > PARALLEL && is_parted_by(a, b, axis);
		}
	}
	return parted;
}

static double clamp(double x, double most)
{
	return fmax(-most, fmin(most, x));
}

/* From a corner of b, one of 8, to a. */
static double corner_gap(const struct box *a, const struct box *b, int corner)
{
	double square = 0, from[3];

	for (int d = 0; d < 3; d++) {
		from[d] = b->centre[d] - a->centre[d];
		for (int k = 0; k < 3; k++)
			from[d] += (corner >> k & 1 ? 1 : -1) * b->half[k] * b->axes[k][d];
	}
	for (int k = 0; k < 3; k++) {
		const double at = dot(from, a->axes[k], 3), over = at - clamp(at, a->half[k]);
		square += over * over;
	}
	return sqrt(square);
}

/* One of the 12 edges. */
static struct edge edge_of(const struct box *b, int number)
{
	const int k = number / 4, u = (k + 1) % 3, v = (k + 2) % 3;
	struct edge e = {.along = b->axes[k], .half = b->half[k]};

	for (int d = 0; d < 3; d++)
		e.middle[d] = b->centre[d] + (number & 1 ? 1 : -1) * b->half[u] * b->axes[u][d] +
			      (number & 2 ? 1 : -1) * b->half[v] * b->axes[v][d];
	return e;
}

static double edge_gap(const struct edge *a, const struct edge *b)
{
	const double between[3] = {
		a->middle[0] - b->middle[0], a->middle[1] - b->middle[1], a->middle[2] - b->middle[2]};
	const double both = dot(a->along, b->along, 3), on_a = dot(a->along, between, 3),
		     on_b = dot(b->along, between, 3), angle = 1 - both * both;
	double s = angle > PARALLEL ? clamp((both * on_b - on_a) / angle, a->half) : 0, square = 0;
	const double t = clamp(both * s + on_b, b->half);

	s = clamp(both * t - on_a, a->half);
	for (int d = 0; d < 3; d++) {
		const double x = between[d] + s * a->along[d] - t * b->along[d];
		square += x * x;
	}
	return sqrt(square);
}

double box_gap(const struct box *a, const struct box *b)
{
	double least = INFINITY;

	if (!is_parted(a, b))
		return 0;
	for (int corner = 0; corner < 8; corner++)
		least = fmin(least, fmin(corner_gap(a, b, corner), corner_gap(b, a, corner)));
	for (int i = 0; i < 12; i++)
		for (int j = 0; j < 12; j++) {
			const struct edge on_a = edge_of(a, i), on_b = edge_of(b, j);
			least = fmin(least, edge_gap(&on_a, &on_b));
		}
	return least;
}
