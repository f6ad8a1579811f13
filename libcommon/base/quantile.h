/* Quantiles: the value below which a share of the numbers, or of their weight, lies. */
#pragma once

#include <stddef.h>

/* Of n > 0 numbers in rising order, linearly between two of them (type 7 of Hyndman and Fan 1996). */
double quantile_sorted(const double *sorted, size_t n, double share);

struct quantile_item {
	double at, weight;
};

/* Puts items in rising order, those that are equal as they were; none is NaN. other (n) is scratch. */
void quantile_order(struct quantile_item *items, struct quantile_item *other, size_t n);

/* Of n > 0 items in any order: where `share` of their weight is passed. They change places. */
double quantile_weighted(struct quantile_item *items, size_t n, double share);
/* The same, where so much weight is passed. */
double quantile_passed(struct quantile_item *items, size_t n, double left);
