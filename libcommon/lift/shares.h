/* What a mask of a view has of each Gaussian: l_i = sum_p w_pi M(p), kept where it is above 0. A mask
 * shows few of a scene's Gaussians, so that many thousands of such rows fit into memory.
 *
 * From weights by tiles the sums are of whole numbers of 1/255, and exact. A tile that a mask has nothing of
 * costs nothing, and where it has all pixels of a Gaussian's, their sum is known. */
#pragma once

#include "base/err.h"
#include "splat/view_matrix.h"
#include "splat/view_tiles.h"

#include <stdint.h>

struct shares {
	size_t n;
	int32_t *index; /* (n) Gaussians, rising */
	float *share;	/* (n) */
};

/* The mean of some masks. */
struct shares_masks {
	const uint64_t *bits; /* (count,bits_tiles of the picture) mask/bits.h */
	size_t count;	      /* at least 1 */
};

/* weight (N) gets what all of the view has of each Gaussian, and rows (count) what each of its masks has. The
 * same to the bit for any number of threads. Returns 0 and shares_free each, or -1 with *e set for want of
 * memory and nothing to free. */
int shares_make(float *weight, struct shares *rows, const struct view_matrix *w,
	const struct shares_masks *masks, size_t count, struct err *e);
void shares_free(struct shares *row);
