/* Masks as plain pixels, for the tests that compare run lengths with them. */
#ifndef MASK_HELP_H
#define MASK_HELP_H

#include "base/rng.h"
#include "mask/rle.h"

/* (height,width) row-major of 0 and 1; free() it. `kind`: 0 noise of density p, 1 blobs, 2 empty, 3 full, 4
 * stripes. */
uint8_t *mask_random(struct rng *r, int height, int width, int kind);

/* As rle_encode; the test ends where memory does. */
struct rle mask_rle(const uint8_t *pixels, int height, int width);

#endif
