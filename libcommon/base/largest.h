/* The largest of a row of numbers, and where it is; the lesser of two. */
#pragma once

#include <math.h>
#include <stddef.h>

/* -INFINITY of none. NaN does not count. */
static inline double largest(const double *x, size_t n)
{
	double most = -INFINITY;

	for (size_t i = 0; i < n; i++)
		most = fmax(most, x[i]);
	return most;
}

/* The first of the largest; 0 of none. */
static inline size_t best_of(const double *x, size_t n)
{
	size_t best = 0;

	for (size_t i = 1; i < n; i++)
		best = x[i] > x[best] ? i : best;
	return best;
}

static inline int least_of(int a, int b)
{
	return a < b ? a : b;
}
