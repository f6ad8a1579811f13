/* Layers whose weights are half floats, on processors with AMX: several times as fast as by vectors. For
 * linear.c and its test. */
#pragma once

#include "nn/linear.h"

/* Whether this processor has it, and the layer's widths are multiples of 32. */
int linear_amx_fits(const struct linear_layer *l);

/* The layer, of which linear_amx_fits holds, in so many parts at least where it has them. An output is the
 * bias and then, over 32 terms after 32, the products of the parts of bfloat16: neither other rows nor
 * threads change it. */
void linear_amx_run(const struct linear_layer *l, size_t parts);
