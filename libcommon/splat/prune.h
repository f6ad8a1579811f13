/* Leaving the smallest weights out of a view's matrix. */
#ifndef SPLAT_PRUNE_H
#define SPLAT_PRUNE_H

#include "base/err.h"
#include "splat/render.h"

#include <stddef.h>

/* In each of `pixels` rows takes out the smallest weights (of equal ones the farther) while what is out is at
 * most `tolerance` of the row's sum; the rest keep their order. dropped (pixels) gets the sum of what is out,
 * which bounds the error of a response: |dM| <= dropped max|m|. Returns 0, or -1 with *e set and *w as it
 * was. */
int prune_weights(struct render_weights *w, size_t pixels, double tolerance, float *dropped, struct err *e);

/* Takes every weight below `least` out, and adds it to the pixel's `dropped`, which stays at most 1. */
void prune_below(struct render_weights *w, size_t pixels, double least, float *dropped);

#endif
