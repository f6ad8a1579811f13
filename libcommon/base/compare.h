/* What qsort and bsearch order by: numbers that rise, and strings by their bytes. */
#pragma once

#include <stddef.h>
#include <stdint.h>
#include <string.h>

#define COMPARE(x, y) (((x) > (y)) - ((x) < (y)))

static inline int compare_float(const void *a, const void *b)
{
	const float x = *(const float *)a, y = *(const float *)b;

	return COMPARE(x, y);
}

static inline int compare_double(const void *a, const void *b)
{
	const double x = *(const double *)a, y = *(const double *)b;

	return COMPARE(x, y);
}

static inline int compare_u32(const void *a, const void *b)
{
	const uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;

	return COMPARE(x, y);
}

static inline int compare_u64(const void *a, const void *b)
{
	const uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;

	return COMPARE(x, y);
}

static inline int compare_string(const void *a, const void *b)
{
	return strcmp(*(const char *const *)a, *(const char *const *)b);
}

/* What is put in order by a number; of equal ones the earlier is first. */
struct ranked {
	double by;
	size_t at;
};

static inline int ranked_rising(const void *a, const void *b)
{
	const struct ranked *x = a, *y = b;

	return x->by != y->by ? COMPARE(x->by, y->by) : COMPARE(x->at, y->at);
}

static inline int ranked_falling(const void *a, const void *b)
{
	const struct ranked *x = a, *y = b;

	return x->by != y->by ? COMPARE(y->by, x->by) : COMPARE(x->at, y->at);
}
