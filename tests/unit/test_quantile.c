/* Quantiles against sorting. */
#include "base/quantile.h"
#include "base/rng.h"
#include "unit.h"

#include <string.h>

static int by_place(const void *a, const void *b)
{
	const struct quantile_item *p = a, *q = b;

	return (p->at > q->at) - (p->at < q->at);
}

static double naive(const struct quantile_item *sorted, size_t n, double share)
{
	double all = 0, sum = 0;

	for (size_t i = 0; i < n; i++)
		all += sorted[i].weight;
	for (size_t i = 0; i < n; i++) {
		sum += sorted[i].weight;
		if (sum > share * all)
			return sorted[i].at;
	}
	return sorted[n - 1].at;
}

/* Whole numbers as weights and shares in sixteenths and the like, so that sums are exact; many places are
 * shared. */
static void weighted(void)
{
	enum { MOST = 200 };
	struct quantile_item items[MOST], sorted[MOST], ordered[MOST], other[MOST];
	static const double shares[] = {0, 0.0625, 0.25, 0.5, 0.75, 0.96875, 1};
	struct rng r;

	rng_seed(&r, 3, 1);
	for (int round = 0; round < 500; round++) {
		const size_t n = 1 + rng_below(&r, MOST);
		for (size_t i = 0; i < n; i++)
			ordered[i] = sorted[i] = items[i] = (struct quantile_item){
				rng_below(&r, 50) - 20.5, 1 + rng_below(&r, round % 2 ? 1 : 9)};
		qsort(sorted, n, sizeof *sorted, by_place);
		quantile_order(ordered, other, n);
		CHECK(!memcmp(ordered, sorted, n * sizeof *sorted), "round %d: another order", round);
		for (size_t k = 0; k < sizeof shares / sizeof *shares; k++) {
			const double got = quantile_weighted(items, n, shares[k]);
			CHECK(got == naive(sorted, n, shares[k]), "round %d, %g: %g", round, shares[k], got);
		}
	}
}

static void linear(void)
{
	const double x[5] = {1, 2, 4, 8, 16};

	CHECK(quantile_sorted(x, 5, 0) == 1 && quantile_sorted(x, 5, 1) == 16, "the ends");
	CHECK(quantile_sorted(x, 5, 0.5) == 4 && quantile_sorted(x, 5, 0.375) == 3, "%g",
		quantile_sorted(x, 5, 0.375));
	CHECK(quantile_sorted(x, 1, 0.7) == 1, "of one");
}

int main(void)
{
	weighted();
	linear();
	return unit_end();
}
