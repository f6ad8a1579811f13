#include "propose/region_pick.h"

#include <math.h>

static int has_outside(const struct region_tree *t, int32_t node, const struct region_click *clicks, size_t n)
{
	for (size_t k = 0; k < n; k++)
		if (clicks[k].is_outside && clicks[k].node >= node && clicks[k].node < t->end[node])
			return 1;
	return 0;
}

/* The region of a click, -1 where all that have it have a pixel outside too. */
static int32_t choose(const struct region_tree *t, const float *score, const struct region_click *clicks,
	size_t n, int32_t from, int larger)
{
	int32_t best = -1;

	for (int32_t k = from; k >= 0 && !has_outside(t, k, clicks, n); k = t->parent[k])
		best = best < 0 || score[k] > score[best] ? k : best;
	for (; best >= 0 && larger > 0 && t->parent[best] >= 0 && !has_outside(t, t->parent[best], clicks, n);
		larger--)
		best = t->parent[best];
	for (; best >= 0 && larger < 0 && best != from; larger++) {
		int32_t below = from;
		while (t->parent[below] != best)
			below = t->parent[below];
		best = below;
	}
	return best;
}

int32_t region_pick(const struct region_tree *t, const float *score, const struct region_click *clicks,
	size_t n, int larger, uint8_t *is_in)
{
	int32_t count = 0;

	for (int32_t i = 0; i < t->n; i++)
		is_in[i] = 0;
	for (size_t k = 0; k < n; k++) {
		const int32_t node = clicks[k].is_outside || clicks[k].node < 0
					     ? -1
					     : choose(t, score, clicks, n, clicks[k].node, larger);
		for (int32_t i = node; node >= 0 && i < t->end[node]; i++)
			is_in[i] = 1;
		count += node >= 0;
	}
	return count;
}

int32_t region_pick_box(const struct region_tree *t, const struct region_shown *shown, const double box[4])
{
	double most = 0;
	int32_t best = -1;

	for (int32_t i = 0; i < t->n; i++) {
		const double agree = shown[i].area ? region_shown_agrees(&shown[i], box) : 0;
		if (agree > most) {
			most = agree;
			best = i;
		}
	}
	return best;
}
