/* libcommon/propose: each part against a plain twin in float64, or against all that is possible tried. */
#include "base/rng.h"
#include "propose/affinity.h"
#include "propose/linkage.h"
#include "propose/region_pick.h"
#include "propose/region_scores.h"
#include "propose/region_tree.h"
#include "mask/bits.h"
#include "unit.h"

enum { MOST = 64 };

/* A path through all leaves, so that they are connected, and other edges, a few of them twice. */
static size_t make_graph(struct linkage_edge *edges, int32_t leaves, struct rng *r)
{
	size_t count = 0;

	for (int32_t i = 1; i < leaves; i++)
		edges[count++] = (struct linkage_edge){i - 1, i, rng_below(r, 1000000)};
	for (int k = 0; k < 2 * leaves; k++) {
		const int32_t a = (int32_t)rng_below(r, (uint32_t)leaves),
			      b = (int32_t)rng_below(r, (uint32_t)leaves);
		if (a != b)
			edges[count++] = (struct linkage_edge){a, b, rng_below(r, 1000000)};
	}
	return count;
}

/* Which leaves each node has, a bit a leaf. */
static void leaf_sets(const struct linkage *l, uint64_t *set)
{
	for (int32_t i = 0; i < l->nodes; i++)
		set[i] = i < l->leaves
				 ? (uint64_t)1 << i
				 : set[l->children[i - l->leaves][0]] | set[l->children[i - l->leaves][1]];
}

/* All pairs of clusters looked at before each merge. */
static void twin_linkage(int32_t leaves, const double *size, const struct linkage_edge *edges, size_t count,
	double power, uint64_t *merged)
{
	uint64_t cluster[MOST];
	int32_t left = leaves;

	for (int32_t i = 0; i < leaves; i++)
		cluster[i] = (uint64_t)1 << i;
	for (int32_t made = 0; left > 1; made++, left--) {
		int32_t best[2] = {0, 1};
		double least = INFINITY;
		for (int32_t a = 0; a < left; a++)
			for (int32_t b = a + 1; b < left; b++) {
				double sum = 0, n = 0, sizes[2] = {0, 0};
				for (size_t k = 0; k < count; k++) {
					const uint64_t x = (uint64_t)1 << edges[k].a,
						       y = (uint64_t)1 << edges[k].b;
					const int is_between = (cluster[a] & x && cluster[b] & y) ||
							       (cluster[a] & y && cluster[b] & x);
					sum += is_between ? (double)edges[k].length : 0;
					n += is_between;
				}
				for (int32_t i = 0; i < leaves; i++) {
					sizes[0] += cluster[a] >> i & 1 ? size[i] : 0;
					sizes[1] += cluster[b] >> i & 1 ? size[i] : 0;
				}
				const double key = sum / n * pow(fmin(sizes[0], sizes[1]), power);
				if (n > 0 && key < least) {
					least = key;
					best[0] = a;
					best[1] = b;
				}
			}
		merged[made] = cluster[best[0]] |= cluster[best[1]];
		cluster[best[1]] = cluster[left - 1];
	}
}

static void test_linkage(int32_t leaves, double power, uint64_t seed)
{
	struct linkage_edge edges[4 * MOST];
	double size[MOST];
	uint64_t set[2 * MOST], right[MOST];
	struct linkage l;
	struct rng r;
	struct err e;
	int wrong = 0;

	rng_seed(&r, seed, 1);
	const size_t count = make_graph(edges, leaves, &r);
	for (int32_t i = 0; i < leaves; i++)
		size[i] = 1 + rng_below(&r, 4);
	twin_linkage(leaves, size, edges, count, power, right);
	if (!CHECK(!linkage_make(&l, leaves, size, edges, count, power, &e), "%s", e.message))
		return;
	leaf_sets(&l, set);
	for (int32_t k = leaves; k < l.nodes; k++)
		wrong += set[k] != right[k - leaves];
	CHECK(l.nodes == 2 * leaves - 1 && !wrong, "%d leaves, power %g: %d merges are others", leaves, power,
		wrong);

	int32_t place[2 * MOST], fine[MOST], coarse[MOST], at[MOST] = {0};
	CHECK(!linkage_order(&l, place, &e), "%s", e.message);
	for (int32_t i = 0; i < leaves; i++)
		at[place[i]]++;
	for (int32_t i = 0; i < leaves; i++)
		CHECK(at[i] == 1, "place %d is of %d leaves", i, at[i]);
	for (int32_t want = 1; want <= leaves; want++) {
		CHECK(linkage_cut(&l, place, want, coarse, &e) == want, "cut into %d", want);
		CHECK(linkage_cut(&l, place, want < leaves ? want + 1 : leaves, fine, &e) > 0, "cut");
		for (int32_t i = 0; i < leaves; i++)
			for (int32_t j = 0; j < leaves; j++)
				wrong += (fine[i] == fine[j] && coarse[i] != coarse[j]) ||
					 (fine[i] < fine[j] && coarse[i] > coarse[j]);
	}
	CHECK(!wrong, "%d pairs of leaves are in no order", wrong);
	linkage_free(&l);
}

/* Leaves and edges in another order give the same clusters. */
static void test_order(void)
{
	struct linkage_edge edges[4 * MOST], mixed[4 * MOST];
	double size[MOST], of_mixed[MOST];
	uint32_t name[MOST], place[4 * MOST];
	uint64_t set[2 * MOST], other[2 * MOST];
	struct linkage a, b;
	struct rng r;
	struct err e;
	int wrong = 0;

	rng_seed(&r, 5, 2);
	const size_t count = make_graph(edges, MOST, &r);
	for (uint32_t i = 0; i < MOST; i++) {
		name[i] = i;
		size[i] = 1 + rng_below(&r, 4);
	}
	for (uint32_t k = 0; k < count; k++)
		place[k] = k;
	rng_shuffle(&r, name, MOST);
	rng_shuffle(&r, place, (uint32_t)count);
	for (size_t i = 0; i < MOST; i++)
		of_mixed[name[i]] = size[i];
	for (size_t k = 0; k < count; k++)
		mixed[place[k]] = (struct linkage_edge){
			(int32_t)name[edges[k].b], (int32_t)name[edges[k].a], edges[k].length};
	CHECK(!linkage_make(&a, MOST, size, edges, count, 0.15, &e), "%s", e.message);
	CHECK(!linkage_make(&b, MOST, of_mixed, mixed, count, 0.15, &e), "%s", e.message);
	leaf_sets(&a, set);
	leaf_sets(&b, other);
	for (int32_t k = MOST; k < a.nodes; k++) {
		uint64_t renamed = 0;
		for (int i = 0; i < MOST; i++)
			renamed |= (set[k] >> i & 1) << name[i];
		wrong += renamed != other[k];
	}
	CHECK(a.nodes == b.nodes && !wrong, "%d clusters are others in another order", wrong);
	linkage_free(&a);
	linkage_free(&b);
}

/* A tree of n nodes, each below one of the last `depth`; node[i] of Gaussian i is any of them, or none. */
static void make_tree(struct region_tree *t, int32_t n, int32_t depth, size_t gaussians, struct rng *r)
{
	*t = (struct region_tree){.gaussians = gaussians, .n = n};
	t->parent = malloc((size_t)n * sizeof *t->parent);
	t->end = malloc((size_t)n * sizeof *t->end);
	t->node = malloc(gaussians * sizeof *t->node);
	for (int32_t i = 0; i < n; i++) {
		int32_t above = i - 1; /* an ancestor of the last node, so that subtrees stand together */
		for (uint32_t k = rng_below(r, (uint32_t)depth); k && above >= 0; k--)
			above = t->parent[above];
		t->parent[i] = above;
	}
	for (size_t i = 0; i < gaussians; i++)
		t->node[i] = (int32_t)rng_below(r, (uint32_t)n + 1) - 1;
	region_tree_span(t);
}

static int is_in(const struct region_tree *t, int32_t node, int32_t top)
{
	while (node >= 0 && node != top)
		node = t->parent[node];
	return node == top;
}

/* Each node's share of each pixel summed up; the lowest of those above a half. And boxes and areas. */
static void test_pixels(uint64_t seed)
{
	enum { WIDTH = 9, HEIGHT = 7, PIXELS = WIDTH * HEIGHT, EACH = 12, GAUSSIANS = 50, NODES = 30 };
	int64_t indptr[PIXELS + 1] = {0};
	int32_t index[PIXELS * EACH], at[PIXELS];
	float weight[PIXELS * EACH];
	uint8_t mask[PIXELS];
	struct region_shown shown[NODES];
	struct region_tree t;
	struct rng r;
	struct err e;
	int wrong = 0;

	rng_seed(&r, seed, 3);
	make_tree(&t, NODES, 3, GAUSSIANS, &r);
	for (size_t p = 0; p < PIXELS; p++) {
		indptr[p + 1] = indptr[p] + rng_below(&r, EACH + 1);
		for (int64_t k = indptr[p]; k < indptr[p + 1]; k++) {
			index[k] = (int32_t)rng_below(&r, GAUSSIANS);
			weight[k] = (float)rng_uniform(&r);
			weight[k] *= weight[k] * weight[k];
		}
	}
	const struct view_weights w = {PIXELS, GAUSSIANS, indptr, index, weight};
	CHECK(!region_tree_pixels(&t, &w, at, &e), "%s", e.message);
	for (size_t p = 0; p < PIXELS; p++) {
		int32_t lowest = -1;
		for (int32_t node = 0; node < t.n; node++) {
			double all = 0, sum = 0;
			for (int64_t k = indptr[p]; k < indptr[p + 1]; k++) {
				all += weight[k];
				sum += is_in(&t, t.node[index[k]], node) ? weight[k] : 0;
			}
			if (sum > all / 2)
				lowest = node; /* children come after parents */
		}
		wrong += at[p] != lowest;
	}
	CHECK(!wrong, "%d of %d pixels have another node", wrong, PIXELS);
	CHECK(!region_tree_measure(&t, at, HEIGHT, WIDTH, shown, &e), "%s", e.message);
	for (int32_t node = 0; node < t.n; node++) {
		int32_t area = 0, left = WIDTH, right = 0;
		for (int p = 0; p < PIXELS; p++)
			if (is_in(&t, at[p], node)) {
				area++;
				left = p % WIDTH < left ? p % WIDTH : left;
				right = p % WIDTH >= right ? p % WIDTH + 1 : right;
			}
		CHECK(shown[node].area == area, "node %d: area %d, not %d", node, shown[node].area, area);
		CHECK(!area || area > 49 || (shown[node].left == left && shown[node].right == right),
			"node %d: %d to %d, not %d to %d", node, shown[node].left, shown[node].right, left,
			right);
		CHECK(region_tree_mask(&t, at, PIXELS, node, mask) == (size_t)area, "node %d: mask", node);
	}
	region_tree_free(&t);
}

/* Every set of at most so many regions, none in another. */
static double try_all(const struct region_tree *t, const double *score, int32_t from, int32_t most,
	int32_t *chosen, int32_t count)
{
	double best = 0;

	for (int32_t i = from; i < t->n && count < most; i++) {
		int is_apart = 1;
		for (int32_t k = 0; k < count; k++)
			is_apart &= !is_in(t, i, chosen[k]);
		if (!is_apart)
			continue;
		chosen[count] = i;
		best = fmax(best, score[i] + try_all(t, score, i + 1, most, chosen, count + 1));
	}
	return best;
}

static void test_choice(uint64_t seed)
{
	enum { NODES = 14 };
	double score[NODES], area[NODES] = {0};
	int32_t chosen[NODES], scratch[NODES];
	struct region_tree t;
	struct rng r;
	struct err e;

	rng_seed(&r, seed, 4);
	make_tree(&t, NODES, 3, 1, &r);
	for (int32_t i = 0; i < NODES; i++)
		score[i] = rng_below(&r, 3) ? rng_uniform(&r) : 0;
	for (int32_t most = 1; most <= 6; most++) {
		const int32_t count = region_tree_disjoint(&t, score, most, chosen, &e);
		const double right = try_all(&t, score, 0, most, scratch, 0);
		double sum = 0;
		for (int32_t k = 0; k < count; k++) {
			sum += score[chosen[k]];
			for (int32_t j = 0; j < count; j++)
				CHECK(j == k || !is_in(&t, chosen[j], chosen[k]), "one is in another");
		}
		CHECK(count >= 0 && count <= most, "%d of at most %d", count, most);
		CHECK(fabs(sum - right) < 1e-12, "at most %d: %g, not %g", most, sum, right);
	}
	for (int32_t i = NODES - 1; i >= 0; i--) {
		area[i] += 1 + rng_below(&r, 3);
		if (t.parent[i] >= 0)
			area[t.parent[i]] += area[i];
	}
	const int32_t count = region_tree_nested(&t, score, area, 0.6, NODES, chosen, &e);
	for (int32_t i = 0; i < NODES; i++) {
		int is_there = 0, is_near = 0;
		for (int32_t k = 0; k < count; k++) {
			const int32_t c = chosen[k];
			is_there |= c == i;
			is_near |= c != i && (is_in(&t, c, i) || is_in(&t, i, c)) &&
				   fmin(area[c], area[i]) > 0.6 * fmax(area[c], area[i]);
		}
		CHECK(!(is_there && is_near) && (is_there || is_near || !(score[i] > 0)), "region %d", i);
	}
	region_tree_free(&t);
}

/* Segments, boxes and weights of one view by hand: both affinities of each edge in float64. */
static void test_affinity(uint64_t seed)
{
	enum { SIDE = 16, PIXELS = SIDE * SIDE, EACH = 3, GAUSSIANS = 20, BOXES = 4 };
	static int64_t indptr[PIXELS + 1];
	static int32_t index[PIXELS * EACH];
	static float weight[PIXELS * EACH], points[3 * GAUSSIANS];
	static uint8_t rgb[3 * PIXELS];
	struct affinity_box boxes[BOXES];
	struct pieces p;
	struct affinity a;
	struct rng r;
	struct err e;

	rng_seed(&r, seed, 5);
	for (size_t k = 0; k < sizeof rgb; k++)
		rgb[k] = (uint8_t)rng_below(&r, 256);
	for (size_t k = 0; k < PIXELS * EACH; k++) {
		indptr[k / EACH + 1] = (int64_t)(k / EACH + 1) * EACH;
		index[k] = (int32_t)(k % EACH * 7 + (k / EACH / 64 * 2 + rng_below(&r, 3)) % 7) % GAUSSIANS;
		weight[k] = (float)rng_range(&r, 0.01, 0.3);
	}
	for (size_t k = 0; k < 3 * GAUSSIANS; k++)
		points[k] = (float)rng_uniform(&r);
	for (size_t b = 0; b < BOXES; b++) {
		const double x = rng_range(&r, 0, 10), y = rng_range(&r, 0, 10);
		boxes[b] = (struct affinity_box){x, y, x + 6, y + 5, rng_range(&r, 0.1, 1), -1};
	}
	const struct view_matrix w = {
		SIDE, SIDE, GAUSSIANS, {PIXELS, GAUSSIANS, indptr, index, weight}, NULL};
	CHECK(!pieces_make(&p, rgb, SIDE, SIDE, &e), "%s", e.message);
	CHECK(!affinity_init(&a, points, NULL, GAUSSIANS, 4, &e), "%s", e.message);
	CHECK(a.count >= 2 * GAUSSIANS && a.count <= 4 * GAUSSIANS, "%zu edges", a.count);
	CHECK(!affinity_view(&a, &w, &p, boxes, BOXES, &e), "%s", e.message);
	for (size_t k = 0; k < a.count; k++) {
		double all[2] = {0, 0}, image = 0, box[2] = {0, 0};
		for (size_t m = 0; m < PIXELS * EACH; m++)
			for (int s = 0; s < 2; s++)
				all[s] += index[m] == a.ends[k][s] ? (double)weight[m] : 0;
		if (!(all[0] > 0 && all[1] > 0))
			continue;
		for (int level = 0; level < PIECES_LEVELS; level++)
			for (int32_t segment = 0; segment < p.count; segment++) {
				double mine[2] = {0, 0};
				for (size_t m = 0; m < PIXELS * EACH; m++)
					for (int s = 0; s < 2; s++)
						if (index[m] == a.ends[k][s] &&
							p.segment[level * p.count + p.piece[m / EACH]] ==
								segment)
							mine[s] += weight[m] / all[s];
				image += fmin(mine[0], mine[1]) / PIECES_LEVELS;
			}
		for (size_t b = 0; b < BOXES; b++) {
			double mine[2] = {0, 0};
			for (size_t m = 0; m < PIXELS * EACH; m++) {
				const double x = (double)(m / EACH % SIDE) + 0.5,
					     y = (double)(m / EACH / SIDE) + 0.5;
				for (int s = 0; s < 2; s++)
					if (index[m] == a.ends[k][s] && x > boxes[b].left &&
						x < boxes[b].right && y > boxes[b].top && y < boxes[b].bottom)
						mine[s] += weight[m] / all[s];
			}
			box[0] += boxes[b].score * fmin(mine[0], mine[1]);
			box[1] += boxes[b].score * fmax(mine[0], mine[1]);
		}
		CHECK(fabs(a.image[k][0] / a.image[k][1] - image) < 1e-5, "edge %zu: %g, not %g", k,
			a.image[k][0] / a.image[k][1], image);
		CHECK(fabs(a.box[k][0] - box[0]) < 1e-5 && fabs(a.box[k][1] - box[1]) < 1e-5,
			"edge %zu: %g, not %g", k, a.box[k][0], box[0]);
	}
	affinity_free(&a);
	pieces_free(&p);
}

/* Four quarters of a colour each, with a little noise: no segment of the coarsest level is of two. */
static void test_pieces(void)
{
	enum { SIDE = 40, HALF = SIDE / 2 };
	static const uint8_t colour[4][3] = {{200, 40, 40}, {40, 180, 60}, {40, 60, 200}, {220, 220, 210}};
	static uint8_t rgb[SIDE * SIDE * 3];
	struct pieces p;
	struct rng r;
	struct err e;

	rng_seed(&r, 8, 6);
	for (int k = 0; k < SIDE * SIDE * 3; k++) {
		const int x = k / 3 % SIDE / HALF, y = k / 3 / SIDE / HALF;
		rgb[k] = (uint8_t)(colour[2 * y + x][k % 3] + (int)rng_below(&r, 5));
	}
	CHECK(!pieces_make(&p, rgb, SIDE, SIDE, &e), "%s", e.message);
	int of[SIDE * SIDE], wrong = 0;
	memset(of, 0, sizeof of);
	for (int k = 0; k < SIDE * SIDE; k++) {
		const int x = k % SIDE, y = k / SIDE;
		/* the border itself is smoothed */
		if (abs(x - HALF) > 2 && abs(y - HALF) > 2)
			of[p.segment[p.piece[k]]] |= 1 << (2 * (y / HALF) + x / HALF);
	}
	for (int k = 0; k < SIDE * SIDE; k++)
		wrong += of[k] & (of[k] - 1);
	CHECK(!wrong, "segments are of two colours");
	pieces_free(&p);
}

/* A region that is exactly a segment, and one with half of it. */
static void test_scores(void)
{
	enum { SIDE = 20, PIXELS = SIDE * SIDE };
	int32_t parent[3] = {-1, 0, 1}, end[3] = {0}, at[PIXELS], piece[PIXELS], segment[2 * PIECES_LEVELS];
	struct region_tree t = {.n = 3, .parent = parent, .end = end};
	const struct pieces p = {SIDE, SIDE, 2, piece, segment};
	const struct affinity_box box = {0, 0, SIDE / 2, SIDE, 0.25, 1};
	struct region_scores s;
	double score[3];
	struct err e;

	region_tree_span(&t);
	for (int k = 0; k < PIXELS; k++) {
		const int x = k % SIDE;
		piece[k] = x >= SIDE / 2;
		at[k] = x >= SIDE / 2 ? 0 : x >= SIDE / 4 ? 1 : 2;
	}
	for (int k = 0; k < 2 * PIECES_LEVELS; k++)
		segment[k] = k % 2;
	CHECK(!region_scores_init(&s, 3, 2, &e), "%s", e.message);
	CHECK(!region_scores_view(&s, &t, at, &p, &box, 1, &e), "%s", e.message);
	region_scores_end(&s, 0, score);
	CHECK(fabs(score[0] - 0.25) < 1e-12 && fabs(score[1] - 1) < 1e-12 && fabs(score[2] - 0.25) < 1e-12,
		"by the photograph %g %g %g", score[0], score[1], score[2]);
	region_scores_end(&s, 1, score);
	CHECK(fabs(score[0] - 0.125) < 1e-12 && fabs(score[1] - 0.5) < 1e-12 &&
			fabs(score[2] - 0.125) < 1e-12,
		"by the box %g %g %g", score[0], score[1], score[2]);
	region_scores_free(&s);
}

/* 0 has 1 and 4, 1 has 2 and 3: clicks on leaves. */
static void test_pick(void)
{
	int32_t parent[5] = {-1, 0, 1, 1, 0}, end[5];
	const float score[5] = {0.1f, 0.6f, 0.3f, 0.7f, 0.2f};
	const struct region_shown shown[5] = {
		{20, 0, 0, 10, 10}, {9, 0, 0, 5, 5}, {4, 0, 0, 2, 2}, {4, 3, 3, 5, 5}, {9, 6, 6, 10, 10}};
	const double box[4] = {0, 0, 4.5, 5}, nowhere[4] = {20, 20, 30, 30};
	struct region_tree t = {.n = 5, .parent = parent, .end = end};
	static const struct {
		struct region_click clicks[2];
		int larger;
		uint8_t is_in[5];
	} cases[] = {{{{2, 0}, {-1, 0}}, 0, {0, 1, 1, 1, 0}}, {{{3, 0}, {-1, 0}}, 0, {0, 0, 0, 1, 0}},
		{{{3, 0}, {-1, 0}}, 1, {0, 1, 1, 1, 0}}, {{{2, 0}, {-1, 0}}, -1, {0, 0, 1, 0, 0}},
		{{{2, 0}, {-1, 0}}, 9, {1, 1, 1, 1, 1}}, {{{2, 0}, {3, 1}}, 0, {0, 1, 1, 0, 0}},
		{{{2, 0}, {4, 1}}, 9, {1, 1, 1, 1, 0}}, {{{3, 0}, {4, 0}}, 0, {0, 0, 0, 1, 0}},
		{{{2, 0}, {3, 0}}, -1, {0, 0, 1, 1, 0}}, {{{2, 0}, {2, 1}}, 0, {0, 1, 1, 1, 0}},
		{{{-1, 0}, {4, 1}}, 0, {0, 0, 0, 0, 0}}};
	static const int own[5] = {34, 2, 50, 8, 6};
	int32_t at[100];
	uint8_t is_in[5];
	float area[5];

	region_tree_span(&t);
	for (int k = 0, p = 0; k < 5; k++)
		for (int i = 0; i < own[k]; i++)
			at[p++] = k;
	region_tree_areas(&t, at, 100, area);
	CHECK(area[0] == 100 && area[1] == 60 && area[4] == 6, "areas %g %g %g", (double)area[0],
		(double)area[1], (double)area[4]);
	for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
		const int32_t count =
			region_pick(&t, score, area, cases[k].clicks, 2, cases[k].larger, is_in);
		CHECK(!memcmp(is_in, cases[k].is_in, 5), "case %zu", k);
		CHECK((count > 0) == (memchr(is_in, 1, 5) != NULL), "case %zu: %d regions", k, count);
	}
	CHECK(region_pick_box(&t, shown, box) == 1, "the box is of %d", region_pick_box(&t, shown, box));
	CHECK(region_pick_box(&t, shown, nowhere) == -1, "a box of nothing");
}

int main(void)
{
	for (uint64_t seed = 1; seed <= 6; seed++) {
		test_linkage(2 + (int32_t)seed * 7, seed % 2 ? 0.15 : 0, seed);
		test_pixels(seed);
		test_affinity(seed);
	}
	for (uint64_t seed = 1; seed <= 60; seed++)
		test_choice(seed);
	test_order();
	test_pick();
	test_pieces();
	test_scores();
	return unit_end();
}
