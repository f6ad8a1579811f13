/* Shared features: the octree's leaves, which Gaussians they hold, views over rows, and what tells Gaussians
 * apart. */
#include "unit.h"

#include "base/mem.h"
#include "base/rng.h"
#include "field/octree.h"
#include "field/rows.h"
#include "splat/backproject.h"
#include "train/octree_input.h"

enum { N = 3000, K = OCTREE_SIGNATURE };

struct cloud {
	float means[N * 3], finest[N], signature[N * K];
	double weight[N];
	int32_t ids[N];
};

/* Points in a cube of edge 2; those with x above 0.3 differ from the others in the first channel. */
static struct cloud *make_cloud(double noise)
{
	struct err e;
	struct cloud *c = mem_zalloc(1, sizeof *c, "test", &e);
	struct rng r;

	rng_seed(&r, 4, 1);
	for (int i = 0; i < N; i++) {
		c->ids[i] = i;
		for (int k = 0; k < 3; k++)
			c->means[3 * i + k] = (float)rng_range(&r, -1, 1);
		c->finest[i] = 0.01f;
		c->weight[i] = rng_range(&r, 0.5, 3);
		c->signature[i * K] = (float)((c->means[3 * i] > 0.3f) + noise * rng_normal(&r));
	}
	return c;
}

static struct octree build(const struct cloud *c, double price)
{
	const struct octree_points points = {N, c->means, c->ids, c->finest, c->weight, c->signature};
	struct octree t;
	struct err e;

	CHECK(!octree_build(&t, &points, price, &e), "%s", e.message);
	return t;
}

/* Weighted squares about the mean of each leaf, in the plainest way. */
static double error_of(const struct cloud *c, const int32_t *leaf, size_t leaves)
{
	struct err e;
	double(*sum)[2 + K] = mem_zalloc(leaves, sizeof *sum, "test", &e), error = 0;

	for (int i = 0; i < N; i++) {
		double *to = sum[leaf[i]];
		to[0] += c->weight[i];
		for (int k = 0; k < K; k++)
			to[2 + k] += c->weight[i] * (double)c->signature[i * K + k];
	}
	for (int i = 0; i < N; i++)
		for (int k = 0; k < K; k++) {
			double d = (double)c->signature[i * K + k] - sum[leaf[i]][2 + k] / sum[leaf[i]][0];
			error += c->weight[i] * d * d;
		}
	free(sum);
	return error;
}

/* More detail costs leaves and saves error, and the cost of what is chosen is the least of all trees tried.
 */
static void leaves_cost_least(void)
{
	static const double prices[] = {0, 0.01, 0.1, 1, 10, 1e9};
	enum { PRICES = sizeof prices / sizeof *prices };
	struct cloud *c = make_cloud(0.1);
	double errors[PRICES];
	size_t counts[PRICES], bad;
	struct err e;

	for (int p = 0; p < PRICES; p++) {
		struct octree t = build(c, prices[p]);
		int32_t leaf[N];
		CHECK(!octree_check(&t, &bad), "leaf %zu is out of place", bad);
		CHECK(!octree_find(&t, c->means, N, leaf, &e), "%s", e.message);
		for (int i = 0; i < N; i++)
			CHECK(leaf[i] >= 0 && (size_t)leaf[i] < t.n, "point %d is in no leaf", i);
		errors[p] = error_of(c, leaf, t.n);
		counts[p] = t.n;
		octree_free(&t);
	}
	for (int p = 0; p < PRICES; p++)
		for (int q = 0; q < PRICES; q++)
			CHECK(errors[p] + prices[p] * (double)counts[p] <=
					errors[q] + prices[p] * (double)counts[q] + 1e-6 * errors[q] + 1e-6,
				"at price %g the leaves for %g cost less", prices[p], prices[q]);
	CHECK(counts[0] > N / 2 && counts[PRICES - 1] == 1, "%zu and %zu leaves", counts[0],
		counts[PRICES - 1]);
	CHECK(counts[3] > 8 && counts[3] < N / 4, "%zu leaves at price 1", counts[3]);
	free(c);
}

/* No leaf holds points of both kinds where a feature costs little beside what it saves. */
static void kinds_stay_apart(void)
{
	struct cloud *c = make_cloud(0);
	struct octree t = build(c, 1e-4);
	int32_t leaf[N];
	struct err e;

	CHECK(!octree_find(&t, c->means, N, leaf, &e), "%s", e.message);
	CHECK(error_of(c, leaf, t.n) < 0.05, "error %g", error_of(c, leaf, t.n));
	CHECK(t.n < N / 2, "%zu leaves", t.n);
	/* A point outside the root belongs to the cube at its side: here to those of two corners. */
	float far[12] = {-50, -50, -50, 60, 70, 80};
	int32_t at[4];
	for (int k = 0; k < 3; k++) {
		far[6 + k] = (float)t.low[k];
		far[9 + k] = (float)(t.low[k] + t.edge);
	}
	CHECK(!octree_find(&t, far, 4, at, &e), "%s", e.message);
	CHECK(at[0] == at[2] && at[1] == at[3] && (at[0] != at[1] || at[0] < 0), "leaves %d %d %d %d", at[0],
		at[1], at[2], at[3]);
	CHECK(at[0] == 0, "the lowest corner is in leaf %d", at[0]);
	/* Leaves out of order, inside one another, or with a number of bits that no level has. */
	size_t bad = 0;
	int64_t kept = t.codes[1];
	t.codes[1] = t.codes[0];
	CHECK(octree_check(&t, &bad) && bad == 1, "the same leaf twice: %zu", bad);
	t.codes[1] = t.codes[0] << 3;
	CHECK(octree_check(&t, &bad) && bad == 1, "a leaf in a leaf: %zu", bad);
	t.codes[1] = kept;
	t.codes[0] = 2;
	CHECK(octree_check(&t, &bad) && bad == 0, "two bits: %zu", bad);
	t.codes[0] = 0;
	CHECK(octree_check(&t, &bad) && bad == 0, "no bits: %zu", bad);
	octree_free(&t);
	free(c);
}

/* Needles in the haystack of a tree: one point, two at one place, a scene without extent. */
static void hard_places(void)
{
	float means[6] = {1e6f, -1e6f, 3, 1e6f, -1e6f, 3}, finest[2] = {0, 0};
	double weight[2] = {1, 1};
	float signature[2 * K] = {0};
	int32_t ids[2] = {0, 1}, leaf[2];
	struct octree t;
	struct err e;

	signature[K] = 1;
	for (size_t n = 0; n <= 2; n++) {
		const struct octree_points points = {n, means, ids, finest, weight, signature};
		CHECK(!octree_build(&t, &points, 0, &e) && t.n == (n > 0), "%zu points in %zu leaves", n,
			t.n);
		CHECK(!octree_find(&t, means, 2, leaf, &e) && leaf[0] == (n ? 0 : -1) && leaf[1] == leaf[0],
			"in leaf %d and %d", leaf[0], leaf[1]);
		octree_free(&t);
	}
}

/* The image of a view over rows is that over Gaussians whose responses are their rows'. */
static void views_agree(void)
{
	enum { G = 200, ROWS = 30, P = 40, ENTRIES = 25 };
	int64_t indptr[P + 1];
	int32_t index[P * ENTRIES], of[G];
	float weight[P * ENTRIES], m[ROWS], spread[G], image[P];
	struct rows rows = {G, ROWS, of};
	struct view_weights view = {P, G, indptr, index, weight}, packed;
	struct rng r;
	struct err e;

	rng_seed(&r, 9, 1);
	for (int i = 0; i < G; i++)
		of[i] = (int32_t)rng_below(&r, ROWS + 3) - 3 < 0 ? -1 : (int32_t)rng_below(&r, ROWS);
	for (int i = 0; i < ROWS; i++)
		m[i] = (float)rng_normal(&r);
	indptr[0] = 0;
	for (int p = 0; p < P; p++) {
		indptr[p + 1] = indptr[p] + (p % 7 ? rng_below(&r, ENTRIES) : 0);
		for (int64_t k = indptr[p]; k < indptr[p + 1]; k++) {
			index[k] = (int32_t)rng_below(&r, G);
			weight[k] = (float)rng_uniform(&r);
		}
	}
	CHECK(!rows_view(&rows, &view, &packed, &e), "%s", e.message);
	rows_spread(&rows, m, spread);
	view_blend(&packed, m, 0, P, image);
	for (int p = 0; p < P; p++) {
		double sum = 0;
		for (int64_t k = indptr[p]; k < indptr[p + 1]; k++)
			sum += (double)weight[k] * (double)spread[index[k]];
		CHECK(fabs((double)image[p] - sum) < 1e-5, "pixel %d is %g, not %g", p, (double)image[p],
			sum);
		for (int64_t k = packed.indptr[p]; k < packed.indptr[p + 1]; k++)
			for (int64_t l = packed.indptr[p]; l < k; l++)
				CHECK(packed.index[k] != packed.index[l], "row %d twice in pixel %d",
					(int)packed.index[k], p);
	}
	rows_view_free(&packed);
}

/* A pixel's size where the nearest view sees a point; masks of one object in two views, of another in one. */
static void details(void)
{
	enum { G = 3, P = 2 };
	const struct camera cameras[2] = {
		{.width = 100,
			.height = 80,
			.fx = 50,
			.fy = 40,
			.cx = 50,
			.cy = 40,
			.world_to_camera = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}},
		{.width = 100,
			.height = 80,
			.fx = 200,
			.fy = 200,
			.cx = 50,
			.cy = 40,
			.world_to_camera = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 5}, {0, 0, 0, 1}}}};
	const float means[9] = {0, 0, 10, 0.9f, 0, 1, 0, 0, -9};
	float footprint[3], signature[G * K];
	double weight[G];
	int64_t indptr[P + 1] = {0, 2, 3};
	int32_t index[3] = {0, 1, 1};
	float w[3] = {0.5f, 0.25f, 0.75f};
	const uint8_t first[1] = {1}, second[1] = {3}; /* bits: pixel 0, and both */
	const uint8_t *masks[3] = {first, first, second};
	int sentences[3] = {0, 2, 1};
	const int objects[3] = {0, 7, 0};
	struct train_view view = {{P, G, indptr, index, w}, 3, sentences, masks};
	struct err e;

	octree_input_footprints(means, 3, cameras, 2, footprint);
	CHECK(fabs((double)footprint[0] - 15.0 / 200) < 1e-6, "%g", (double)footprint[0]);
	CHECK(fabs((double)footprint[1] - 1.0 / 50) < 1e-6, "%g", (double)footprint[1]);
	CHECK(isinf(footprint[2]), "%g", (double)footprint[2]);
	const struct view_source views = {.views = &view, .n = 1};
	memset(weight, 0, sizeof weight);
	backproject_weight(&view.weights, weight);
	CHECK(weight[0] == 0.5 && weight[1] == 1 && weight[2] == 0, "%g %g %g", weight[0], weight[1],
		weight[2]);
	CHECK(!octree_input_signatures(&views, objects, G, weight, signature, &e), "%s", e.message);
	/* Gaussian 0 is in the masks of both; 1 wholly in the second's and a quarter in the first's. */
	for (int k = 0; k < K; k++) {
		double a =
			4 * ((double)signature[k] - (double)signature[K + k]) / 3; /* the first's direction */
		double b = (double)signature[k] - a;
		CHECK(fabs(fabs(a) - 0.25) < 1e-6 && fabs(fabs(b) - 0.25) < 1e-6 && signature[2 * K + k] == 0,
			"channel %d: %g %g", k, a, b);
	}
}

/* The leaves are of the points alone: neither the order of the Gaussians nor one that is no point, put first,
 * changes them. */
static void any_order(void)
{
	enum { MORE = N / 3 };
	struct cloud *c = make_cloud(0.1);
	struct err e;
	struct octree t, all = build(c, 0.1);
	float *means = mem_zalloc(N + MORE, 3 * sizeof *means, "test", &e);
	float *finest = mem_zalloc(N + MORE, sizeof *finest, "test", &e);
	float *signature = mem_zalloc(N + MORE, K * sizeof *signature, "test", &e);
	double *weight = mem_zalloc(N + MORE, sizeof *weight, "test", &e);
	int32_t ids[N];
	const struct octree_points points = {N, means, ids, finest, weight, signature};

	/* Gaussian MORE + i is point (7 i) mod N; those before are no points. */
	for (size_t i = 0; i < N; i++) {
		const size_t from = 7 * i % N, to = MORE + i;
		ids[i] = (int32_t)to;
		memcpy(means + 3 * to, c->means + 3 * from, 3 * sizeof *means);
		memcpy(signature + K * to, c->signature + K * from, K * sizeof *signature);
		finest[to] = c->finest[from];
		weight[to] = c->weight[from];
	}
	CHECK(!octree_build(&t, &points, 0.1, &e), "%s", e.message);
	CHECK(t.n == all.n && !memcmp(t.codes, all.codes, t.n * sizeof *t.codes),
		"%zu leaves, and %zu in another order", all.n, t.n);
	octree_free(&t);
	octree_free(&all);
	free(means);
	free(finest);
	free(signature);
	free(weight);
	free(c);
}

/* A leaf has the Gaussians that learn, and no other that lies in it. */
static void left_out_stay_out(void)
{
	struct cloud *c = make_cloud(0);
	struct octree t = build(c, 3);
	struct rows all, some;
	struct err e;
	int32_t every_third[N / 3];
	int wrong = 0;

	for (int i = 0; i < N / 3; i++)
		every_third[i] = 3 * i;
	CHECK(!rows_of_leaves(&all, &t, c->means, N, NULL, 0, &e) &&
			!rows_of_leaves(&some, &t, c->means, N, every_third, N / 3, &e),
		"%s", e.message);
	for (int i = 0; i < N; i++)
		wrong += all.of[i] < 0 || some.of[i] != (i % 3 ? -1 : all.of[i]);
	CHECK(!wrong && some.n == all.n, "%d Gaussians have another row", wrong);
	rows_free(&all);
	rows_free(&some);
	octree_free(&t);
	free(c);
}

int main(void)
{
	leaves_cost_least();
	kinds_stay_apart();
	hard_places();
	any_order();
	views_agree();
	details();
	left_out_stay_out();
	return unit_end();
}
