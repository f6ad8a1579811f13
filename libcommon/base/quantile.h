/* Quantiles: the value below which a share of the numbers, or of their weight, lies. */
#pragma once

#include <stddef.h>

/* Of n > 0 numbers in rising order, linearly between two of them (type 7 of Hyndman and Fan 1996, R's
 * default). */
double quantile_sorted(const double *sorted, size_t n, double share);

struct quantile_item {
	double at, weight;
};

/* Of n > 0 items in any order: where `share` of their weight is passed. They change places. */
double quantile_weighted(struct quantile_item *items, size_t n, double share);
