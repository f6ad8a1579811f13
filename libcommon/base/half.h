/* IEEE half floats to and from float, rounding to nearest even. */
#pragma once

#include <stddef.h>
#include <stdint.h>

float half_to_float(uint16_t h);
/* Of n, at any address, in the machine's order of bytes. */
void half_to_floats(const void *halves, size_t n, float *out);
uint16_t half_of_float(float f);
/* How many of n, at any address, stand before the first infinity or NaN. */
size_t half_count_finite(const void *halves, size_t n);
