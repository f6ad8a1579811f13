/* Leaving the smallest weights out of a view's matrix. */
#pragma once

#include "base/err.h"
#include "splat/render.h"

/* In each of `pixels` rows takes out the smallest weights (of equal ones the farther) while what is out is at
 * most `tolerance` of the row's sum, and then those below `least`; the rest keep their order. Weights are as
 * rendered ones: at least 2^-29, and at most 1 in sum. dropped (pixels) gets the sum of what is out, at most
 * 1, which bounds the error of a response: |dM| <= dropped max|m|. 0, or -1 with *e and *w as it was. */
int prune_weights(struct render_weights *w, size_t pixels, double tolerance, double least, float *dropped,
	struct err *e);
