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
	uint32_t *before; /* how many are seen before each word's */
	float *weight;	  /* of those that are, by rising number */
};

/* Of the view with these weights. Returns 0, or -1 with *e set for want of memory; seen_free after either. */
int seen_make(struct seen *s, const struct view_weights *w, struct err *e);
void seen_free(struct seen *s);

/* sum (gaussians) += all of it. */
void seen_add(const struct seen *s, size_t gaussians, double *sum);

/* A Gaussian's weight, where s->marks is not NULL. */
static inline float seen_weight(const struct seen *s, size_t i)
{
	const uint64_t word = s->marks[i / 64], bit = (uint64_t)1 << i % 64;

	return word & bit ? s->weight[s->before[i / 64] + (uint32_t)__builtin_popcountll(word & (bit - 1))]
			  : 0;
}

#endif
