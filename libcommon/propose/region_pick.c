#include "propose/region_pick.h"

#include <math.h>
#include <string.h>

/* Found on the desk's labelled training views and made scenes of seed 5. */
static const double area_power = 0.25; /* a thing may be meant however large it is, but for one place in it */
static const double most_next = 0.2;   /* of the first region's area that a further click adds or takes */

struct picked {
	const struct region_tree *tree;
	const float *score, *area;
	const struct region_click *clicks;
	size_t n;
};

/* Whether a region has a click of that kind. */
static int has_click(const struct picked *p, int32_t region, int is_outside)
{
	for (size_t k = 0; k < p->n; k++)
		if (p->clicks[k].is_outside == is_outside &&
			region_tree_has(p->tree, region, p->clicks[k].node))
			return 1;
	return 0;
}

static double value(const struct picked *p, int32_t k)
{
	return p->score[k] / pow(fmax(p->area[k], 1), area_power);
}

/* The likeliest region of those around a click, and the steps from it. */
static int32_t choose_first(const struct picked *p, int32_t from, int larger)
{
	const struct region_tree *t = p->tree;
	int32_t best = from;

	for (int32_t k = from; k >= 0; k = t->parent[k])
		best = value(p, k) > value(p, best) ? k : best;
	for (; larger > 0 && t->parent[best] >= 0; larger--)
		best = t->parent[best];
	for (; larger < 0 && best != from; larger++) {
		int32_t below = from;
		while (t->parent[below] != best)
			below = t->parent[below];
		best = below;
	}
	return best;
}

/* What a later click adds or takes away: the largest region there that is small beside the first one, and has
 * neither that nor a click of the other kind; -1: there is none. */
static int32_t choose_next(const struct picked *p, struct region_click click, int32_t first)
{
	const struct region_tree *t = p->tree;
	int32_t best = -1;

	for (int32_t k = click.node;
		k >= 0 && !region_tree_has(t, k, first) && !has_click(p, k, !click.is_outside) &&
		p->area[k] <= most_next * p->area[first];
		k = t->parent[k])
		best = k;
	return best;
}

int32_t region_pick(const struct region_tree *t, const float *score, const float *area,
	const struct region_click *clicks, size_t n, int larger, uint8_t *is_in)
{
	const struct picked p = {t, score, area, clicks, n};
	int32_t first = -1, count = 0;

	memset(is_in, 0, (size_t)t->n);
	for (int is_outside = 0; is_outside < 2; is_outside++)
		for (size_t k = 0; k < n; k++) {
			const struct region_click c = clicks[k];
			if (c.is_outside != is_outside || c.node < 0 || (is_outside && first < 0) ||
				(first >= 0 && is_in[c.node] != is_outside))
				continue;
			const int32_t region =
				first < 0 ? choose_first(&p, c.node, larger) : choose_next(&p, c, first);
			for (int32_t i = region; region >= 0 && i < t->end[region]; i++)
				is_in[i] = !is_outside;
			first = first < 0 ? region : first;
			count += region >= 0 && !is_outside;
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
