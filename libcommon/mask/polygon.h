/* Polygons as masks. */
#pragma once

#include <stddef.h>
#include <stdint.h>

/* Sets to 1 the pixels of mask (height,width) whose centres lie in a polygon of n points x,y: by the even-odd
 * rule, so that a part that is circled twice is outside. The centre of the first pixel is at 0.5,0.5. flips
 * (height,width) is scratch, all 0 before and after. */
void polygon_fill(uint8_t *mask, uint8_t *flips, int height, int width, const double *points, size_t n);
