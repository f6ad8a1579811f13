#include "propose/region_pick.h"

/* What part of the score of the region that has a pixel outside one without it needs to be taken in its
 * place. */
static const double worth = 0.5;

static int has(const struct region_tree *t, int32_t region, int32_t node)
{
	return node >= region && node < t->end[region];
}

/* Whether a region has a click of that kind. */
static int has_click(const struct region_tree *t, int32_t region, const struct region_click *clicks, size_t n,
	int is_outside)
{
	for (size_t k = 0; k < n; k++)
		if (clicks[k].is_outside == is_outside && has(t, region, clicks[k].node))
			return 1;
	return 0;
}

static int32_t better(const float *score, int32_t best, int32_t other)
{
	return best < 0 || score[other] > score[best] ? other : best;
}

/* The region of the first click: the best without a pixel outside, unless the best with one is much better.
 */
static int32_t choose_first(const struct region_tree *t, const float *score,
	const struct region_click *clicks, size_t n, int32_t from, int larger)
{
	int32_t clean = -1, any = -1;

	for (int32_t k = from; k >= 0; k = t->parent[k]) {
		any = better(score, any, k);
		if (!has_click(t, k, clicks, n, 1))
			clean = better(score, clean, k);
	}
	if (clean < 0)
		return -1;
	int32_t best = score[clean] >= worth * (double)score[any] ? clean : any;
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

/* What a later click adds or takes away: the best region that has no click of the other kind and is no larger
 * than the first one; -1: there is none. */
static int32_t choose_next(const struct region_tree *t, const float *score, const struct region_click *clicks,
	size_t n, struct region_click click, int32_t first)
{
	int32_t best = -1;

	for (int32_t k = click.node; k >= 0 && t->end[k] - k <= t->end[first] - first &&
				     !has_click(t, k, clicks, n, !click.is_outside);
		k = t->parent[k])
		best = better(score, best, k);
	return best;
}

int32_t region_pick(const struct region_tree *t, const float *score, const struct region_click *clicks,
	size_t n, int larger, uint8_t *is_in)
{
	int32_t first = -1, count = 0;

	for (int32_t i = 0; i < t->n; i++)
		is_in[i] = 0;
	for (int is_outside = 0; is_outside < 2; is_outside++)
		for (size_t k = 0; k < n; k++) {
			const struct region_click c = clicks[k];
			if (c.is_outside != is_outside || c.node < 0 || (is_outside && first < 0) ||
				(first >= 0 && is_in[c.node] != is_outside))
				continue;
			const int32_t region = first < 0 ? choose_first(t, score, clicks, n, c.node, larger)
							 : choose_next(t, score, clicks, n, c, first);
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
