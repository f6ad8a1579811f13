#include "base/quantile.h"

#include <math.h>

double quantile_sorted(const double *sorted, size_t n, double share)
{
	double place = share * (double)(n - 1);
	size_t below = (size_t)place;

	if (below + 1 >= n || sorted[below] == sorted[below + 1])
		return sorted[below];
	return sorted[below] + (place - (double)below) * (sorted[below + 1] - sorted[below]);
}

static double middle_of(double a, double b, double c)
{
	return fmax(fmin(a, b), fmin(fmax(a, b), c));
}

/* What is on the wrong side of a pivot is left aside, until the pivot is what is looked for (Hoare 1961). */
double quantile_weighted(struct quantile_item *items, size_t n, double share)
{
	double left = 0;

	for (size_t i = 0; i < n; i++)
		left += share * items[i].weight;
	for (;;) {
		const double pivot = middle_of(items[0].at, items[n / 2].at, items[n - 1].at);
		double under = 0, here = 0;
		size_t below = 0, to = 0, above = n;
		while (to < above) {
			const struct quantile_item x = items[to];
			if (x.at < pivot) {
				under += x.weight;
				items[to++] = items[below];
				items[below++] = x;
			} else if (x.at > pivot) {
				items[to] = items[--above];
				items[above] = x;
			} else {
				here += x.weight;
				to++;
			}
		}
		if (left < under && below) {
			n = below;
		} else if (left < under + here || above == n) {
			return pivot;
		} else {
			left -= under + here;
			items += above;
			n -= above;
		}
	}
}
