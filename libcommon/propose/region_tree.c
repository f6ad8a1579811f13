#include "propose/region_tree.h"

#include "base/compare.h"
#include "base/mem.h"

#include <math.h>

#define GROWN 1.1 /* times the size of the last node below, from which a cluster is a node of its own */

void region_tree_free(struct region_tree *t)
{
	mem_free_all(t->parent, t->end, t->node);
	*t = (struct region_tree){0};
}

/* kept (nodes) gets 1 where a cluster is a node. last (nodes): the size of the last one below or at it. */
static void find_kept(const struct linkage *l, double least, char *kept, double *last)
{
	for (int32_t i = 0; i < l->nodes; i++) {
		const int32_t *c = i < l->leaves ? NULL : l->children[i - l->leaves];
		const double a = c ? last[c[0]] : 0, b = c ? last[c[1]] : 0;
		kept[i] = l->size[i] >= least && ((a > 0) == (b > 0) || l->size[i] >= GROWN * fmax(a, b));
		last[i] = kept[i] ? l->size[i] : fmax(a, b);
	}
}

/* number (nodes): the node of each cluster, or of the next above that is one. count (nodes): those at or
 * below. */
static void number_nodes(
	struct region_tree *t, const struct linkage *l, const char *kept, int32_t *number, int32_t *count)
{
	for (int32_t i = 0; i < l->nodes; i++) {
		const int32_t *c = i < l->leaves ? NULL : l->children[i - l->leaves];
		count[i] = kept[i] + (c ? count[c[0]] + count[c[1]] : 0);
	}
	/* while on its way down, number is where the subtree begins */
	for (int32_t i = l->nodes - 1; i >= 0; i--) {
		if (l->parent[i] < 0) {
			number[i] = t->n;
			t->n += count[i];
		}
		if (i < l->leaves)
			continue;
		const int32_t *c = l->children[i - l->leaves];
		number[c[0]] = number[i] + kept[i];
		number[c[1]] = number[c[0]] + count[c[0]];
	}
	for (int32_t i = l->nodes - 1; i >= 0; i--) {
		const int32_t above = l->parent[i] < 0 ? -1 : number[l->parent[i]];
		if (kept[i])
			t->parent[number[i]] = above;
		else
			number[i] = above;
	}
}

int region_tree_make(struct region_tree *t, const struct linkage *l, double least, struct err *e)
{
	const size_t n = (size_t)l->nodes;
	SCOPED char *kept = mem_alloc(n, 1, "regions", e);
	SCOPED double *last = mem_alloc(n, sizeof *last, "regions", e);
	SCOPED int32_t *number = mem_alloc(n, sizeof *number, "regions", e);
	SCOPED int32_t *count = mem_alloc(n, sizeof *count, "regions", e);

	*t = (struct region_tree){.gaussians = (size_t)l->leaves};
	t->parent = mem_alloc(n, sizeof *t->parent, "regions", e);
	t->end = mem_alloc(n, sizeof *t->end, "regions", e);
	t->node = mem_alloc(t->gaussians, sizeof *t->node, "regions", e);
	if (!kept || !last || !number || !count || !t->parent || !t->end || !t->node)
		return -1;
	find_kept(l, least, kept, last);
	number_nodes(t, l, kept, number, count);
	for (size_t i = 0; i < t->gaussians; i++)
		t->node[i] = number[i];
	region_tree_span(t);
	return 0;
}

void region_tree_span(struct region_tree *t)
{
	for (int32_t i = 0; i < t->n; i++)
		t->end[i] = i + 1;
	for (int32_t i = t->n - 1; i >= 0; i--)
		if (t->parent[i] >= 0 && t->end[i] > t->end[t->parent[i]])
			t->end[t->parent[i]] = t->end[i];
}

struct weighted {
	int32_t node;
	float weight;
};

/* n weights, the nodes rising. Any node with more than half of the weight has the Gaussian at which half is
 * passed; its place is widened upwards until it has enough. */
static int32_t lowest(const struct region_tree *t, const struct weighted *of, size_t n, double half)
{
	size_t from = 0;
	double sum = 0;

	if (!n)
		return -1;
	for (sum = of[0].weight; sum <= half && from + 1 < n;)
		sum += of[++from].weight;
	size_t to = from + 1;
	sum = of[from].weight;
	for (int32_t node = of[from].node; node >= 0; node = t->parent[node]) {
		while (from > 0 && of[from - 1].node >= node)
			sum += of[--from].weight;
		while (to < n && of[to].node < t->end[node])
			sum += of[to++].weight;
		if (sum > half)
			return node;
	}
	return -1;
}

/* Gathers a pixel's Gaussians that have a node, in the order of these. */
static size_t gather(const struct region_tree *t, const struct view_weights *w, size_t p, struct weighted *to)
{
	size_t n = 0;

	for (int64_t k = w->indptr[p]; k < w->indptr[p + 1]; k++) {
		const struct weighted now = {t->node[w->index[k]], w->weight[k]};
		size_t at = n;
		if (now.node < 0)
			continue;
		for (; at && to[at - 1].node > now.node; at--)
			to[at] = to[at - 1];
		to[at] = now;
		n++;
	}
	return n;
}

int region_tree_pixels(const struct region_tree *t, const struct view_weights *w, int32_t *at, struct err *e)
{
	int64_t most = 1;
	int failed = 0;

	for (size_t p = 0; p < w->pixels; p++)
		if (w->indptr[p + 1] - w->indptr[p] > most)
			most = w->indptr[p + 1] - w->indptr[p];
#pragma omp parallel reduction(| : failed)
	{
		struct err mine;
		struct weighted *of = mem_alloc((size_t)most, sizeof *of, "regions", &mine);
		failed = !of;
#pragma omp for schedule(dynamic, 1024)
		for (size_t p = 0; p < w->pixels; p++) {
			double all = 0;
			for (int64_t k = w->indptr[p]; k < w->indptr[p + 1]; k++)
				all += w->weight[k];
			at[p] = of ? lowest(t, of, gather(t, w, p, of), all / 2) : -1;
		}
		if (failed) {
#pragma omp critical
			*e = mine;
		}
		free(of);
	}
	return failed ? -1 : 0;
}

size_t region_tree_mask(
	const struct region_tree *t, const int32_t *at, size_t pixels, int32_t node, uint8_t *mask)
{
	size_t count = 0;

	for (size_t p = 0; p < pixels; p++) {
		mask[p] = (uint8_t)region_tree_has(t, node, at[p]);
		count += mask[p];
	}
	return count;
}

void region_tree_areas(const struct region_tree *t, const int32_t *at, size_t pixels, float *area)
{
	memset(area, 0, (size_t)t->n * sizeof *area);
	for (size_t p = 0; p < pixels; p++)
		if (at[p] >= 0)
			area[at[p]]++;
	for (int32_t k = t->n - 1; k >= 0; k--)
		if (t->parent[k] >= 0)
			area[t->parent[k]] += area[k];
}

/* Of counts (n): where more than `cut` have passed, from the one end and from the other. */
static void trim(const int32_t *count, int n, int32_t cut, int32_t *from, int32_t *to)
{
	int32_t sum = 0;
	int i = 0;

	while ((sum += count[i]) <= cut)
		i++;
	*from = i;
	for (sum = 0, i = n - 1; (sum += count[i]) <= cut; i--)
		;
	*to = i + 1;
}

/* counts (n,width+height): how many pixels of each node, and then of each region, are in each column and row.
 */
int region_tree_measure(const struct region_tree *t, const int32_t *at, int height, int width,
	struct region_shown *shown, struct err *e)
{
	const size_t w = (size_t)width, each = w + (size_t)height;
	SCOPED int32_t *counts = mem_zalloc((size_t)t->n, each * sizeof *counts, "regions", e);

	if (!counts)
		return -1;
	memset(shown, 0, (size_t)t->n * sizeof *shown);
	for (size_t p = 0; p < w * (size_t)height; p++)
		if (at[p] >= 0) {
			int32_t *count = counts + (size_t)at[p] * each;
			count[p % w]++;
			count[w + p / w]++;
			shown[at[p]].area++;
		}
	for (int32_t i = t->n - 1; i >= 0; i--) {
		const int32_t *count = counts + (size_t)i * each, parent = t->parent[i];
		struct region_shown *s = &shown[i];
		if (!s->area)
			continue;
		const int32_t cut = (int32_t)(REGION_TREE_TRIM * s->area);
		trim(count, width, cut, &s->left, &s->right);
		trim(count + w, height, cut, &s->top, &s->bottom);
		if (parent < 0)
			continue;
		shown[parent].area += s->area;
		for (size_t k = 0; k < each; k++)
			counts[(size_t)parent * each + k] += count[k];
	}
	return 0;
}

double region_shown_agrees(const struct region_shown *s, const double box[4])
{
	const double across = fmin(s->right, box[2]) - fmax(s->left, box[0]),
		     down = fmin(s->bottom, box[3]) - fmax(s->top, box[1]);
	const double both = fmax(across, 0) * fmax(down, 0);
	const double all = (double)(s->right - s->left) * (s->bottom - s->top) +
			   (box[2] - box[0]) * (box[3] - box[1]) - both;

	return all > 0 ? both / all : 0;
}

int32_t region_tree_nested(const struct region_tree *t, const double *score, const double *area, double agree,
	int32_t most, int32_t *chosen, struct err *e)
{
	SCOPED struct ranked *by = mem_alloc((size_t)t->n, sizeof *by, "regions", e);
	int32_t count = 0;

	if (!by)
		return -1;
	for (int32_t i = 0; i < t->n; i++)
		by[i] = (struct ranked){score[i], (size_t)i};
	if (t->n)
		qsort(by, (size_t)t->n, sizeof *by, ranked_falling);
	for (int32_t i = 0; i < t->n && count < most && by[i].by > 0; i++) {
		const int32_t node = (int32_t)by[i].at;
		int is_same = 0;
		for (int32_t k = 0; k < count && !is_same; k++) {
			const int32_t other = chosen[k];
			const int is_in = region_tree_has(t, node, other) || region_tree_has(t, other, node);
			is_same = is_in &&
				  fmin(area[node], area[other]) > agree * fmax(area[node], area[other]);
		}
		if (!is_same)
			chosen[count++] = node;
	}
	return count;
}

/* best (n,most+1): the largest sum of scores of at most k disjoint regions in the subtree; below (n,most+1):
 * of those of its children that are numbered from this one to the end of the parent, this one among them.
 * Filled from the last node to the first. */
struct sums {
	double *best, *after;
	size_t width;
};

static double combine(const double *a, const double *b, int32_t k, int32_t *split)
{
	double most = -1;

	for (int32_t m = 0; m <= k; m++) {
		const double sum = a[m] + b[k - m];
		if (sum > most) {
			most = sum;
			*split = m;
		}
	}
	return most;
}

static const double *sums_after(const struct region_tree *t, const struct sums *s, int32_t node)
{
	const int32_t next = t->end[node];
	const int32_t limit = t->parent[node] < 0 ? t->n : t->end[t->parent[node]];

	return next < limit ? s->after + (size_t)next * s->width : s->after + (size_t)t->n * s->width;
}

static const double *sums_below(const struct region_tree *t, const struct sums *s, int32_t node)
{
	return s->after + (size_t)(t->end[node] > node + 1 ? node + 1 : t->n) * s->width;
}

static void fill(const struct region_tree *t, const struct sums *s, const double *score)
{
	const int32_t most = (int32_t)s->width - 1;
	int32_t split;

	for (int32_t node = t->n - 1; node >= 0; node--) {
		double *best = s->best + (size_t)node * s->width, *after = s->after + (size_t)node * s->width;
		const double *below = sums_below(t, s, node), *rest = sums_after(t, s, node);
		for (int32_t k = 0; k <= most; k++)
			best[k] = k ? fmax(below[k], score[node]) : 0;
		for (int32_t k = 0; k <= most; k++)
			after[k] = combine(best, rest, k, &split);
	}
}

/* Goes the way by which the sums came about: of the nodes from `node` on that are its siblings, k regions. */
static int32_t trace(const struct region_tree *t, const struct sums *s, const double *score, int32_t most,
	int32_t *left, int32_t *chosen)
{
	int32_t count = 0;

	/* left (n): how many regions the siblings from a node on may have */
	for (int32_t node = 0; node < t->n; node++) {
		const int32_t k = node ? left[node] : most;
		const double *best = s->best + (size_t)node * s->width;
		int32_t own = 0;
		combine(best, sums_after(t, s, node), k, &own);
		const int32_t limit = t->parent[node] < 0 ? t->n : t->end[t->parent[node]];
		const int is_chosen = own && score[node] > 0 && score[node] >= sums_below(t, s, node)[own];
		if (is_chosen)
			chosen[count++] = node;
		if (t->end[node] < limit)
			left[t->end[node]] = k - own;
		if (t->end[node] > node + 1)
			left[node + 1] = is_chosen ? 0 : own;
	}
	return count;
}

int32_t region_tree_disjoint(
	const struct region_tree *t, const double *score, int32_t most, int32_t *chosen, struct err *e)
{
	const size_t n = (size_t)t->n;
	struct sums s = {.width = (size_t)most + 1};
	SCOPED double *best = s.best = mem_alloc(n, s.width * sizeof *best, "regions", e);
	SCOPED double *after = s.after = mem_zalloc(n + 1, s.width * sizeof *after, "regions", e);
	SCOPED int32_t *left = mem_zalloc(n, sizeof *left, "regions", e);

	if (!best || !after || !left)
		return -1;
	fill(t, &s, score);
	return trace(t, &s, score, most, left, chosen);
}
