/* What a view has of each Gaussian, kept for those that it sees, a small part. */
#pragma once

#include "base/err.h"
#include "base/ones.h"

#include <stdint.h>

struct seen {
	uint64_t *marks;  /* a bit for each Gaussian; NULL: none is seen */
	uint32_t *before; /* 1, and how many are seen before each word's */
	float *weight;	  /* 0, and of those that are seen, by rising number */
};

/* weight (gaussians): shares_make. 0, or -1 with *e; seen_free after either. */
int seen_make(struct seen *s, const float *weight, size_t gaussians, struct err *e);
void seen_free(struct seen *s);

/* sum (gaussians) += all of it. */
void seen_add(const struct seen *s, size_t gaussians, double *sum);

/* A Gaussian's weight, where s->marks is not NULL; without a branch, as no order tells which are seen. */
static inline float seen_weight(const struct seen *s, size_t i)
{
	const uint64_t word = s->marks[i / 64], bit = (uint64_t)1 << i % 64;
	const uint32_t is_seen = word >> i % 64 & 1, place = s->before[i / 64] + ones(word & (bit - 1));

	return s->weight[place & -is_seen];
}
