#include "propose/region_scores.h"

#include "base/compare.h"
#include "base/mem.h"

#include <math.h>

/* Found on Ref-Synth and the desk's training views. */
#define LEAST_SHOWN 1e-4 /* of a picture that a region covers in a view that counts */

void region_scores_free(struct region_scores *s)
{
	mem_free_all(s->image, s->box, s->views, s->area, s->votes);
	*s = (struct region_scores){0};
}

int region_scores_init(struct region_scores *s, int32_t n, int32_t classes, struct err *e)
{
	double **all[] = {&s->image, &s->box, &s->views, &s->area};

	*s = (struct region_scores){.n = n, .classes = classes};
	s->votes = mem_zalloc((size_t)n, (size_t)classes * sizeof *s->votes, "regions", e);
	if (!s->votes)
		return -1;
	for (size_t k = 0; k < sizeof all / sizeof *all; k++)
		if (!(*all[k] = mem_zalloc((size_t)n, sizeof **all[k], "regions", e)))
			return -1;
	return 0;
}

/* Pixels of a segment and of a node that is the lowest of theirs. */
struct overlap {
	int32_t segment, node, pixels;
};

static int order_overlaps(const void *a, const void *b)
{
	const struct overlap *p = a, *q = b;

	return p->segment != q->segment ? COMPARE(p->segment, q->segment) : COMPARE(p->node, q->node);
}

/* Sorts overlaps and adds up those of one segment and node. Returns how many are left. */
static size_t join_overlaps(struct overlap *o, size_t n)
{
	size_t count = 0;

	if (n)
		qsort(o, n, sizeof *o, order_overlaps);
	for (size_t k = 0; k < n; k++)
		if (count && o[count - 1].segment == o[k].segment && o[count - 1].node == o[k].node)
			o[count - 1].pixels += o[k].pixels;
		else
			o[count++] = o[k];
	return count;
}

/* best (n): the largest IoU of a region and one of these segments. inside (n) is 0 before and after. */
static void agree(const struct region_tree *t, const struct region_shown *shown, const struct overlap *o,
	size_t n, int32_t *inside, double *best)
{
	for (size_t from = 0, to; from < n; from = to) {
		int32_t area = 0;
		for (to = from; to < n && o[to].segment == o[from].segment; to++) {
			area += o[to].pixels;
			for (int32_t k = o[to].node; k >= 0; k = t->parent[k])
				inside[k] += o[to].pixels;
		}
		for (size_t i = from; i < to; i++)
			for (int32_t k = o[i].node; k >= 0 && inside[k]; k = t->parent[k]) {
				const double iou = (double)inside[k] / (shown[k].area + area - inside[k]);
				best[k] = fmax(best[k], iou);
				inside[k] = 0;
			}
	}
}

/* The overlaps of the finest pieces become those of the segments of each level. */
static int agree_all(const struct region_tree *t, const struct region_shown *shown, const int32_t *nodes,
	const struct pieces *p, double *best, struct err *e)
{
	const size_t pixels = (size_t)p->height * (size_t)p->width;
	SCOPED struct overlap *o = mem_alloc(pixels, sizeof *o, "regions", e);
	SCOPED int32_t *inside = mem_zalloc((size_t)t->n, sizeof *inside, "regions", e);
	size_t n = 0;

	if (!o || !inside)
		return -1;
	for (size_t k = 0; k < pixels; k++)
		if (nodes[k] >= 0)
			o[n++] = (struct overlap){p->piece[k], nodes[k], 1};
	n = join_overlaps(o, n);
	/* from the finest level on, each is made of the one before */
	SCOPED int32_t *up = mem_alloc((size_t)p->count, sizeof *up, "regions", e);
	if (!up)
		return -1;
	for (int level = PIECES_LEVELS - 1; level >= 0; level--) {
		const int32_t *segment = p->segment + level * p->count, *last = segment + p->count;
		for (int32_t k = 0; k < p->count; k++)
			up[level + 1 < PIECES_LEVELS ? last[k] : k] = segment[k];
		for (size_t k = 0; k < n; k++)
			o[k].segment = up[o[k].segment];
		n = join_overlaps(o, n);
		agree(t, shown, o, n, inside, best);
	}
	return 0;
}

/* The largest IoU^2 sqrt(score) of a box that a view shows around a region and a detected one; votes
 * (classes) gets the largest IoU^2 score of each class added. best (classes) is scratch. */
static double agree_boxes(const struct region_shown *shown, const struct affinity_box *boxes,
	size_t box_count, int32_t classes, double *best, double *votes)
{
	double most = 0;

	memset(best, 0, (size_t)classes * sizeof *best);
	for (size_t b = 0; b < box_count; b++) {
		const struct affinity_box *a = &boxes[b];
		const double box[4] = {a->left, a->top, a->right, a->bottom};
		const double iou = region_shown_agrees(shown, box), square = iou * iou;
		most = fmax(most, square * sqrt(a->score));
		if (a->class >= 0)
			best[a->class] = fmax(best[a->class], square * a->score);
	}
	for (int32_t c = 0; c < classes; c++)
		votes[c] += best[c];
	return most;
}

int region_scores_view(struct region_scores *s, const struct region_tree *t, const int32_t *nodes,
	const struct pieces *p, const struct affinity_box *boxes, size_t box_count, struct err *e)
{
	const double pixels = (double)p->height * p->width;
	const size_t classes = (size_t)s->classes;
	SCOPED struct region_shown *shown = mem_alloc((size_t)t->n, sizeof *shown, "regions", e);
	SCOPED double *best = mem_zalloc((size_t)t->n + classes, sizeof *best, "regions", e);

	if (!shown || !best)
		return -1;
	if (region_tree_measure(t, nodes, p->height, p->width, shown, e) ||
		agree_all(t, shown, nodes, p, best, e))
		return -1;
	for (int32_t k = 0; k < t->n; k++) {
		s->area[k] += shown[k].area / pixels;
		if (shown[k].area < LEAST_SHOWN * pixels)
			continue;
		s->image[k] += best[k] * best[k];
		s->box[k] += agree_boxes(
			&shown[k], boxes, box_count, s->classes, best + t->n, s->votes + (size_t)k * classes);
		s->views[k]++;
	}
	return 0;
}

void region_scores_end(struct region_scores *s, int has_boxes, double *score)
{
	const size_t classes = (size_t)s->classes;

	for (int32_t k = 0; k < s->n; k++) {
		const double views = fmax(s->views[k], 1);
		score[k] = (has_boxes ? s->box[k] : s->image[k]) / views;
		for (size_t c = 0; c < classes; c++)
			s->votes[(size_t)k * classes + c] /= views;
	}
}

void region_scores_value(const struct region_scores *s, const double *score, double *value)
{
	for (int32_t k = 0; k < s->n; k++)
		value[k] = s->views[k] > 0 ? score[k] * score[k] * sqrt(s->area[k] / s->views[k]) : 0;
}
