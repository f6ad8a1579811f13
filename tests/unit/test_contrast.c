/* The top set of the contrast: how many Gaussians, and which. */
#include "unit.h"

#include "base/rng.h"
#include "field/contrast.h"

static const float *sorted_values;

static int by_rank(const void *a, const void *b)
{
	const size_t i = *(const size_t *)a, k = *(const size_t *)b;
	const float x = sorted_values[i], y = sorted_values[k];

	return x != y ? (x < y) - (x > y) : (i > k) - (i < k);
}

static void test_top(void)
{
	enum { N = 300 };
	struct rng rng;

	CHECK(contrast_top_count(0, 1000) == 100, "%zu at the start", contrast_top_count(0, 1000));
	CHECK(contrast_top_count(1000, 1000) == 60, "%zu after 1000", contrast_top_count(1000, 1000));
	CHECK(contrast_top_count(500, 1000) == 77, "%zu after 500", contrast_top_count(500, 1000));
	CHECK(contrast_top_count(45000, 1000) == 5, "%zu in the end", contrast_top_count(45000, 1000));
	CHECK(contrast_top_count(0, 9) == 1 && contrast_top_count(0, 1) == 1, "never none");
	rng_seed(&rng, 5, 1);
	for (int trial = 0; trial < 60; trial++) {
		float m[N], top[N];
		uint32_t times[N];
		size_t rank[N], left;
		const size_t n = trial ? 1 + rng_below(&rng, N) : N, k = 1 + rng_below(&rng, (uint32_t)n);
		int wrong = 0;

		/* Many ties, but no -0, which ranks below 0. */
		for (size_t i = 0; i < n; i++) {
			m[i] = trial % 3 ? (float)rng_normal(&rng) : (float)((int)rng_below(&rng, 7) - 3);
			m[i] = m[i] == 0 ? 0 : m[i];
			rank[i] = i;
		}
		sorted_values = m;
		qsort(rank, n, sizeof *rank, by_rank);
		contrast_top_set(m, NULL, n, k, top);
		for (size_t i = 0; i < n; i++)
			wrong += top[rank[i]] != (i < k ? 1 / (float)k : 0);
		/* Of rows that Gaussians share the last may be in with a part. */
		for (size_t i = 0; i < n; i++)
			times[i] = 1 + rng_below(&rng, 4);
		contrast_top_set(m, times, n, k, top);
		left = k;
		for (size_t i = 0; i < n; i++) {
			const size_t in = times[rank[i]] < left ? times[rank[i]] : left;
			wrong += top[rank[i]] != (float)in / (float)k;
			left -= in;
		}
		CHECK(!wrong, "trial %d: %d of %zu wrong, k %zu", trial, wrong, n, k);
	}
}

int main(void)
{
	test_top();
	return unit_end();
}
