/* How sure a figure is: intervals by resampling (Efron 1979), and a test by swapping signs (Fisher 1935).
 * What is resampled is a unit: things that belong together and are drawn together. */
#pragma once

#include "base/err.h"

#include <stdint.h>

enum { BOOTSTRAP_MAX = 1000000, BOOTSTRAP_MAX_RATIOS = 8 };

struct bootstrap {
	size_t resamples;  /* 1 to BOOTSTRAP_MAX */
	double confidence; /* within (0,1): 0.95 cuts off 2.5 % of the resamples at each end */
	uint64_t seed;
};

struct interval {
	double low, high;
};

/* Percentile intervals of k ratios, each of a sum over all units to another. sums (n,k,2) row-major holds
 * each unit's part of numerator and denominator; n > 0, no denominator is 0. A resample draws n units with
 * replacement, the same ones for every ratio. Quantiles lie between order statistics, linearly (type 7 of
 * Hyndman and Fan 1996). The same bytes for any number of threads. */
int bootstrap_ratios(struct interval *intervals, const double *sums, size_t n, size_t k,
	const struct bootstrap *how, struct err *e);

/* Two-sided p of n paired differences having a mean of 0: the share of sign patterns whose sum is at least as
 * far from 0 as the given one. Every pattern of the units that differ is tried where these are no more than
 * the resamples: p is then exact. Else as many random ones are, and the given one. */
int bootstrap_sign_test(
	double *p, const double *differences, size_t n, const struct bootstrap *how, struct err *e);
