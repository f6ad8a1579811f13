/* A k-d tree in an array of the points' numbers: the middle of a range splits it along one axis, and each
 * half is a tree again (Bentley 1975). */
#include "geom/neighbours.h"

#include "base/mem.h"

#include <math.h>

struct tree {
	const float *points;
	size_t *order;
};

struct search {
	const float *from;
	size_t self; /* of the points, or none */
	int k;
	double nearest[NEIGHBOURS_MOST]; /* squared, rising */
	size_t which[NEIGHBOURS_MOST];
};

static float at(const struct tree *t, size_t place, int axis)
{
	return t->points[3 * t->order[place] + (size_t)axis];
}

static void exchange(struct tree *t, size_t a, size_t b)
{
	const size_t kept = t->order[a];

	t->order[a] = t->order[b];
	t->order[b] = kept;
}

/* Puts the middle of [low, high) where it belongs, smaller before, larger after (Hoare's selection). */
static void select_middle(struct tree *t, size_t low, size_t high, int axis)
{
	const size_t middle = low + (high - low) / 2;

	high--;
	while (low < high) {
		const float pivot = at(t, middle, axis);
		size_t i = low, k = high;
		while (i <= k) {
			while (at(t, i, axis) < pivot)
				i++;
			while (at(t, k, axis) > pivot)
				k--;
			if (i > k)
				break;
			exchange(t, i++, k);
			if (!k--)
				break;
		}
		if (k + 1 <= middle) /* k may be one before 0 */
			low = i;
		if (i > middle)
			high = k;
	}
}

static void build(struct tree *t, size_t low, size_t high, int axis)
{
	while (high - low > 1) {
		const size_t middle = low + (high - low) / 2;
		select_middle(t, low, high, axis);
		axis = (axis + 1) % 3;
		build(t, low, middle, axis);
		low = middle + 1;
	}
}

static void offer(struct search *s, double squared, size_t point)
{
	int i = s->k - 1;

	if (squared >= s->nearest[i])
		return;
	for (; i > 0 && s->nearest[i - 1] > squared; i--) {
		s->nearest[i] = s->nearest[i - 1];
		s->which[i] = s->which[i - 1];
	}
	s->nearest[i] = squared;
	s->which[i] = point;
}

static void look(const struct tree *t, size_t low, size_t high, int axis, struct search *s)
{
	const float *from = s->from;

	while (high > low) {
		const size_t middle = low + (high - low) / 2, here = t->order[middle];
		const float *p = t->points + 3 * here;
		const double x = (double)p[0] - from[0], y = (double)p[1] - from[1],
			     z = (double)p[2] - from[2];
		const double side = (double)from[axis] - p[axis];
		if (here != s->self)
			offer(s, x * x + y * y + z * z, here);
		axis = (axis + 1) % 3;
		if (side < 0) {
			look(t, low, middle, axis, s);
			low = middle + 1;
		} else {
			look(t, middle + 1, high, axis, s);
			high = middle;
		}
		if (side * side >= s->nearest[s->k - 1])
			return;
	}
}

/* from (m,3) are the points where `is_same`, else others. distance (m) or near (m,k), or NULL. */
static int find(const float *points, size_t n, const float *from, size_t m, int is_same, int k,
	float *distance, int32_t *near, struct err *e)
{
	struct tree t = {points, mem_alloc(n, sizeof *t.order, "neighbours", e)};

	if (!t.order)
		return -1;
	for (size_t i = 0; i < n; i++)
		t.order[i] = i;
	build(&t, 0, n, 0);
#pragma omp parallel for schedule(dynamic, 1024)
	for (size_t i = 0; i < m; i++) {
		struct search s = {.from = from + 3 * i, .self = is_same ? i : n, .k = k};
		for (int j = 0; j < k; j++)
			s.nearest[j] = INFINITY;
		look(&t, 0, n, 0, &s);
		if (distance)
			distance[i] = (float)sqrt(s.nearest[k - 1]);
		for (int j = 0; j < k && near; j++)
			near[i * (size_t)k + (size_t)j] = s.nearest[j] < INFINITY ? (int32_t)s.which[j] : -1;
	}
	free(t.order);
	return 0;
}

int neighbours_find(const float *points, size_t n, int k, float *distance, struct err *e)
{
	return find(points, n, points, n, 1, k, distance, NULL, e);
}

int neighbours_of(
	const float *points, size_t n, const float *from, size_t m, int k, float *distance, struct err *e)
{
	return find(points, n, from, m, 0, k, distance, NULL, e);
}

int neighbours_list(const float *points, size_t n, int k, int32_t *near, struct err *e)
{
	return find(points, n, points, n, 1, k, NULL, near, e);
}
