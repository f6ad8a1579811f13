/* What a view has of each Gaussian, kept for those that it sees: a view shows a small part of a large scene.
 */
#ifndef LIFT_SEEN_H
#define LIFT_SEEN_H

#include "base/err.h"
#include "splat/view_weights.h"

#include <stddef.h>
#include <stdint.h>

struct seen {
	uint64_t *marks;  /* a bit for each Gaussian; NULL: none is seen */
	uint32_t *before; /* 1, and how many are seen before each word's */
	float *weight;	  /* 0, and of those that are seen, by rising number */
};

/* Of the view with these weights. Returns 0, or -1 with *e set for want of memory; seen_free after either. */
int seen_make(struct seen *s, const struct view_weights *w, struct err *e);
void seen_free(struct seen *s);

/* sum (gaussians) += all of it. */
void seen_add(const struct seen *s, size_t gaussians, double *sum);

/* How many bits are set: without the instruction for it, which not every processor has, the compiler's own is
 * a call. */
static inline uint32_t seen_ones(uint64_t x)
{
	x -= x >> 1 & 0x5555555555555555;
	x = (x & 0x3333333333333333) + (x >> 2 & 0x3333333333333333);
	x = (x + (x >> 4)) & 0x0f0f0f0f0f0f0f0f;
	return (uint32_t)(x * 0x0101010101010101 >> 56);
}

/* A Gaussian's weight, where s->marks is not NULL; without a branch, as no order tells which are seen. */
static inline float seen_weight(const struct seen *s, size_t i)
{
	const uint64_t word = s->marks[i / 64], bit = (uint64_t)1 << i % 64;
	const uint32_t is_seen = word >> i % 64 & 1, place = s->before[i / 64] + seen_ones(word & (bit - 1));

	return s->weight[place & -is_seen];
}

#endif
