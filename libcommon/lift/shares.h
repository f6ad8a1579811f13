/* What an image of a view has of each Gaussian: l_i = sum_p w_pi I(p), kept where it is above 0. An image
 * shows few of a scene's Gaussians, so that many thousands of such rows fit into memory. */
#ifndef LIFT_SHARES_H
#define LIFT_SHARES_H

#include "base/err.h"
#include "splat/view_weights.h"

#include <stddef.h>
#include <stdint.h>

struct shares {
	size_t n;
	int32_t *index; /* (n) Gaussians, rising */
	float *share;	/* (n) */
};

/* rows (count) of images (count,P), whose values are 0 or more; pixels of 0 cost nothing. The same to the bit
 * for any number of threads. Returns 0 and shares_free each, or -1 with *e set for want of memory and nothing
 * to free. */
int shares_make(
	struct shares *rows, const struct view_weights *w, const float *images, size_t count, struct err *e);
void shares_free(struct shares *row);

/* What all of a view has of each Gaussian: weight (N). Returns 0, or -1 with *e set for want of memory. */
int shares_of_view(float *weight, const struct view_weights *w, struct err *e);

#endif
