#include "geom/box.h"

#include "base/dot.h"
#include "geom/vector.h"

#include <math.h>
#include <string.h>

enum { CORNERS = 16 }; /* of a face that six planes cut: four, and one more for each */

struct polygon {
	int n;
	double points[CORNERS][3];
};

struct box box_between(const double low[3], const double high[3])
{
	struct box b = {.axes = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

	for (int k = 0; k < 3; k++) {
		b.centre[k] = low[k] + (high[k] - low[k]) / 2;
		b.half[k] = (high[k] - low[k]) / 2;
	}
	return b;
}

void box_bounds(const struct box *b, double low[3], double high[3])
{
	for (int k = 0; k < 3; k++) {
		double reach = 0;
		for (int a = 0; a < 3; a++)
			reach += fabs(b->axes[a][k]) * b->half[a];
		low[k] = b->centre[k] - reach;
		high[k] = b->centre[k] + reach;
	}
}

double box_volume(const struct box *b)
{
	return 8 * b->half[0] * b->half[1] * b->half[2];
}

double box_diagonal(const struct box *b)
{
	return 2 * sqrt(dot(b->half, b->half, 3));
}

/* The face of b across axis k, on the side `sign`. */
static struct polygon face_of(const struct box *b, int k, double sign)
{
	static const double corners[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
	const int u = (k + 1) % 3, v = (k + 2) % 3;
	struct polygon p = {.n = 4};

	for (int i = 0; i < 4; i++)
		for (int d = 0; d < 3; d++)
			p.points[i][d] = b->centre[d] + sign * b->half[k] * b->axes[k][d] +
					 corners[i][0] * b->half[u] * b->axes[u][d] +
					 corners[i][1] * b->half[v] * b->axes[v][d];
	return p;
}

/* Keeps of p the part with normal . x <= limit (Sutherland and Hodgman 1974). */
static void cut(struct polygon *p, const double normal[3], double limit)
{
	struct polygon kept = {0};

	for (int i = 0; i < p->n; i++) {
		const double *a = p->points[i], *b = p->points[(i + 1) % p->n];
		double over_a = dot(normal, a, 3) - limit, over_b = dot(normal, b, 3) - limit;
		if (over_a <= 0 && kept.n < CORNERS)
			memcpy(kept.points[kept.n++], a, sizeof kept.points[0]);
		if ((over_a <= 0) != (over_b <= 0) && kept.n < CORNERS) {
			double t = over_a / (over_a - over_b);
			for (int d = 0; d < 3; d++)
				kept.points[kept.n][d] = a[d] + t * (b[d] - a[d]);
			kept.n++;
		}
	}
	*p = kept;
}

/* The area of a convex polygon in a plane with this unit normal. */
static double area_of(const struct polygon *p, const double normal[3])
{
	double area = 0;

	for (int i = 2; i < p->n; i++) {
		double u[3], v[3];
		for (int d = 0; d < 3; d++) {
			u[d] = p->points[i - 1][d] - p->points[0][d];
			v[d] = p->points[i][d] - p->points[0][d];
		}
		area += normal[0] * (u[1] * v[2] - u[2] * v[1]) + normal[1] * (u[2] * v[0] - u[0] * v[2]) +
			normal[2] * (u[0] * v[1] - u[1] * v[0]);
	}
	return fabs(area) / 2;
}

/* What the faces of b inside a add to the integral of x . normal about the origin. */
static double flux(const struct box *b, const struct box *a)
{
	double sum = 0;

	for (int k = 0; k < 3; k++)
		for (int side = -1; side <= 1; side += 2) {
			struct polygon p = face_of(b, k, side);
			for (int j = 0; j < 3; j++) {
				const double at = dot(a->axes[j], a->centre, 3);
				double other[3] = {-a->axes[j][0], -a->axes[j][1], -a->axes[j][2]};
				cut(&p, a->axes[j], at + a->half[j]);
				cut(&p, other, a->half[j] - at);
			}
			sum += area_of(&p, b->axes[k]) * (side * dot(b->axes[k], b->centre, 3) + b->half[k]);
		}
	return sum;
}

/* What bounds the common part is of one box's faces, inside the other box: three times its volume is their
 * flux. One box is a hair larger, so that faces of both are never in one plane, where they would count twice
 * or be left open. */
static double common_volume(const struct box *a, const struct box *b)
{
	const double hair = 1e-10 * fmin(box_diagonal(a), box_diagonal(b));
	struct box here = *a, there = *b;

	for (int d = 0; d < 3; d++) {
		here.centre[d] = 0;
		there.centre[d] -= a->centre[d];
		there.half[d] += hair;
	}
	double volume = (flux(&here, &there) + flux(&there, &here)) / 3;
	return fmin(fmax(volume, 0), fmin(box_volume(a), box_volume(b)));
}

double box_iou(const struct box *a, const struct box *b)
{
	double common = common_volume(a, b), all = box_volume(a) + box_volume(b) - common;

	return all > 0 ? common / all : 0;
}

/* How far two boxes are apart. Boxes that no plane parts touch (separating axes: the faces' normals, and the
 * cross products of edges). Of two that are apart, the nearest points are a corner and a face, or on two
 * edges, so that the least of these distances is the gap. */

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
