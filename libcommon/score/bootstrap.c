#include "score/bootstrap.h"

#include "base/compare.h"
#include "base/mem.h"
#include "base/quantile.h"
#include "base/rng.h"

#include <math.h>

/* Additions from which on threads pay. */
enum { WORTH_THREADS = 1 << 20 };

/* The finaliser of splitmix64 (Steele, Lea and Flood 2014). */
static uint64_t mixed(uint64_t x)
{
	x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9u;
	x = (x ^ x >> 27) * 0x94d049bb133111ebu;
	return x ^ x >> 31;
}

/* A generator of each resample's own, so that it does not matter which thread draws it. Neighbouring streams
 * of one state resemble each other, hence the mixing. */
static struct rng resample_rng(const struct bootstrap *how, size_t resample)
{
	struct rng r;

	rng_seed(&r, mixed(how->seed + 0x9e3779b97f4a7c15u * (resample + 1)), resample);
	return r;
}

static void draw(double *ratios, size_t stride, const double *sums, size_t n, size_t k, struct rng *r)
{
	double total[2 * BOOTSTRAP_MAX_RATIOS] = {0};

	for (size_t i = 0; i < n; i++) {
		const double *unit = sums + (size_t)rng_below(r, (uint32_t)n) * 2 * k;
		for (size_t j = 0; j < 2 * k; j++)
			total[j] += unit[j];
	}
	for (size_t j = 0; j < k; j++)
		ratios[j * stride] = total[2 * j] / total[2 * j + 1];
}

int bootstrap_ratios(struct interval *intervals, const double *sums, size_t n, size_t k,
	const struct bootstrap *how, struct err *e)
{
	const ptrdiff_t resamples = (ptrdiff_t)how->resamples;

	if (n > UINT32_MAX)
		return err_set(e, ERR_SYSTEM, "resamples: %zu units are more than can be drawn from", n);
	/* (k,resamples) */
	SCOPED double *ratios = mem_alloc(how->resamples, k * sizeof *ratios, "resamples", e);
	if (!ratios)
		return -1;
#pragma omp parallel for schedule(static) if ((double)n * (double)k * (double)resamples > WORTH_THREADS)
	for (ptrdiff_t b = 0; b < resamples; b++) {
		struct rng r = resample_rng(how, (size_t)b);
		draw(ratios + b, how->resamples, sums, n, k, &r);
	}
	for (size_t j = 0; j < k; j++) {
		double *one = ratios + j * how->resamples;
		qsort(one, how->resamples, sizeof *one, compare_double);
		intervals[j].low = quantile_sorted(one, how->resamples, (1 - how->confidence) / 2);
		intervals[j].high = quantile_sorted(one, how->resamples, (1 + how->confidence) / 2);
	}
	return 0;
}

/* |sum| with the signs that 32 bits at a time give. */
static double random_sum(const double *values, size_t n, struct rng *r)
{
	uint32_t bits = 0;
	double sum = 0;

	for (size_t i = 0; i < n; i++) {
		if (!(i & 31))
			bits = rng_u32(r);
		sum += bits >> (i & 31) & 1 ? values[i] : -values[i];
	}
	return fabs(sum);
}

static double pattern_sum(const double *values, size_t n, size_t pattern)
{
	double sum = 0;

	for (size_t i = 0; i < n; i++)
		sum += pattern >> i & 1 ? values[i] : -values[i];
	return fabs(sum);
}

int bootstrap_sign_test(
	double *p, const double *differences, size_t n, const struct bootstrap *how, struct err *e)
{
	SCOPED double *values = mem_alloc(n, sizeof *values, "differences", e);
	SCOPED unsigned char *is_far = mem_alloc(how->resamples, 1, "resamples", e);
	double sum = 0, size = 0;
	size_t kept = 0, count = 0;

	if (!values || !is_far)
		return -1;
	for (size_t i = 0; i < n; i++) {
		if (differences[i] != 0)
			values[kept++] = differences[i];
		sum += differences[i];
		size += fabs(differences[i]);
	}
	/* sums that are equal but for rounding are as far */
	const double far = fabs(sum) - 1e-12 * size;
	const int is_exact = kept < 20 && (size_t)1 << kept <= how->resamples;
	const ptrdiff_t patterns = is_exact ? (ptrdiff_t)1 << kept : (ptrdiff_t)how->resamples;
#pragma omp parallel for schedule(static) if ((double)kept * (double)patterns > WORTH_THREADS)
	for (ptrdiff_t b = 0; b < patterns; b++) {
		struct rng r = resample_rng(how, (size_t)b);
		is_far[b] = (is_exact ? pattern_sum(values, kept, (size_t)b)
				      : random_sum(values, kept, &r)) >= far;
	}
	for (ptrdiff_t b = 0; b < patterns; b++)
		count += is_far[b];
	*p = is_exact ? (double)count / (double)patterns : (double)(count + 1) / (double)(patterns + 1);
	return 0;
}
