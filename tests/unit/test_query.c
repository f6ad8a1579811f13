/* Rules of queries against plain float64 by their definitions; hyperplanes against the definition of their
 * minimum. */
#include "unit.h"

#include "base/rng.h"
#include "lift/hyperplane.h"
#include "lift/query_rules.h"

enum { QUERIES = 5, ALL = 8, GAUSSIANS = 400, EXAMPLES = 300, POSITIVE = 40, CHANNELS = 6, LABELS = 7 };

static void test_unit(void)
{
	float x[6] = {3, 4, 0, 0, -2, 0};

	query_unit(x, 3, 2);
	CHECK(fabs((double)x[0] - 0.6) < 1e-7 && fabs((double)x[1] - 0.8) < 1e-7, "%g %g", (double)x[0],
		(double)x[1]);
	CHECK(x[2] <= 0 && x[2] >= 0 && fabs((double)x[4] + 1) < 1e-7, "zero stays, and signs");
}

static void test_cosine(uint64_t seed)
{
	struct rng r;
	int chosen = 0;

	rng_seed(&r, seed, 1);
	for (int t = 0; t < 1000; t++) {
		float cosines[ALL];
		size_t group[ALL];
		char selected[QUERIES];
		for (size_t k = 0; k < ALL; k++) {
			/* of few values, so that some are equal */
			cosines[k] = (float)rng_below(&r, 6) / 4;
			group[k] = k < QUERIES ? rng_below(&r, 3) : k;
		}
		query_cosine(cosines, group, ALL, QUERIES, selected);
		for (size_t q = 0; q < QUERIES; q++) {
			int expected = 1;
			for (size_t k = 0; k < ALL; k++)
				expected &= group[k] == group[q] || cosines[q] > cosines[k];
			CHECK(selected[q] == expected, "trial %d, query %zu", t, q);
			chosen += expected;
		}
	}
	CHECK(chosen > 100 && chosen < 4000, "%d chosen", chosen);
}

static void test_relevancy(void)
{
	struct rng r;

	rng_seed(&r, 3, 1);
	for (int t = 0; t < 200; t++) {
		float canonical[4], cosine = (float)rng_range(&r, -1, 1);
		double least = 1;
		for (int k = 0; k < 4; k++) {
			canonical[k] = (float)rng_range(&r, -1, 1);
			const double own = exp(10 * (double)cosine), other = exp(10 * (double)canonical[k]);
			least = fmin(least, own / (own + other));
		}
		CHECK(fabs(query_relevancy(cosine, canonical, 4) - least) < 1e-12, "%g", least);
	}
	/* a range of 0.2 to 0.8 becomes -1 to 1: 0.4 is at 0.62 */
	CHECK(fabs(query_relative_threshold(0.4, 0.2, 0.8) - 0.62) < 1e-12, "relative");
}

static void test_identity(uint64_t seed)
{
	static int32_t labels[GAUSSIANS];
	static float weight[GAUSSIANS];
	static char inside[GAUSSIANS], selected[GAUSSIANS];
	double sums[2 * LABELS], all[LABELS] = {0}, in[LABELS] = {0};
	struct rng r;
	int count = 0;

	rng_seed(&r, seed, 1);
	for (int i = 0; i < GAUSSIANS; i++) {
		labels[i] = (int32_t)rng_below(&r, LABELS + 1) - 1;
		weight[i] = (float)rng_uniform(&r);
		inside[i] = labels[i] >= 0 && rng_below(&r, LABELS) < (uint32_t)labels[i];
		if (labels[i] >= 0) {
			all[labels[i]] += (double)weight[i];
			in[labels[i]] += inside[i] ? (double)weight[i] : 0;
		}
	}
	query_identity(labels, weight, inside, GAUSSIANS, 0.5, sums, LABELS, selected);
	for (int i = 0; i < GAUSSIANS; i++) {
		const int expected = labels[i] > 0 && in[labels[i]] / all[labels[i]] > 0.5;
		CHECK(selected[i] == expected, "Gaussian %d of label %d", i, labels[i]);
		count += expected;
	}
	CHECK(count > GAUSSIANS / 5 && count < GAUSSIANS * 4 / 5, "%d selected", count);
}

/* The slope of the objective in direction c, by the definition. */
static double slope(const float *examples, const double *plane, size_t c)
{
	double sum = c < CHANNELS ? HYPERPLANE_DECAY * plane[c] : 0;

	for (size_t i = 0; i < EXAMPLES; i++) {
		const float *f = examples + i * CHANNELS;
		double z = plane[CHANNELS];
		for (size_t k = 0; k < CHANNELS; k++)
			z += plane[k] * (double)f[k];
		const double sign = i < POSITIVE ? 1 : -1, n = i < POSITIVE ? POSITIVE : EXAMPLES - POSITIVE;
		sum -= 0.5 / n * sign / (1 + exp(sign * z)) * (c < CHANNELS ? (double)f[c] : 1);
	}
	return sum;
}

static void test_hyperplane(void)
{
	static float examples[EXAMPLES * CHANNELS];
	double plane[CHANNELS + 1];
	struct rng r;
	struct err e = {0};
	int right = 0;

	rng_seed(&r, 5, 1);
	for (int i = 0; i < EXAMPLES * CHANNELS; i++)
		examples[i] = (float)rng_normal(&r);
	/* positives are farther along the first axis */
	for (int i = 0; i < EXAMPLES; i++)
		examples[(size_t)i * CHANNELS] += i < POSITIVE ? 3 : -1;
	query_unit(examples, EXAMPLES, CHANNELS);
	if (!CHECK(!hyperplane_fit(examples, EXAMPLES, POSITIVE, CHANNELS, plane, &e), "%s", e.message))
		return;
	for (size_t c = 0; c <= CHANNELS; c++)
		CHECK(fabs(slope(examples, plane, c)) < 1e-4, "channel %zu: slope %g at the minimum", c,
			slope(examples, plane, c));
	for (size_t i = 0; i < EXAMPLES; i++)
		right += (hyperplane_side(plane, examples + i * CHANNELS, CHANNELS) > 0) == (i < POSITIVE);
	CHECK(right > EXAMPLES * 9 / 10, "%d of %d on their side", right, EXAMPLES);
	/* what is on a side does not depend on how many examples there are of it: the plane is not that of
	 * none */
	CHECK(fabs(plane[0]) > 1, "w is %g along the first axis", plane[0]);
}

int main(void)
{
	test_unit();
	test_relevancy();
	for (uint64_t seed = 1; seed <= 3; seed++) {
		test_cosine(seed);
		test_identity(seed);
	}
	test_hyperplane();
	return unit_end();
}
