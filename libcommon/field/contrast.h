/* The contrast loss (GTCL): the mean feature of the Gaussians that answer most against the sentences of the
 * scene (field/referring_model.h has the formula). In float64: it is small. */
#pragma once

#include "field/referring_model.h"

#include <stddef.h>
#include <stdint.h>

/* How many Gaussians of n the top set has at an iteration (counted from 0): max(1, floor(tau n)). */
size_t contrast_top_count(long iteration, size_t n);

/* Sets top[i] to the share of i among the k largest of m (n), each counted times[i] times (NULL: once) and
 * ties to the lower index: the weights of their mean. */
void contrast_top_set(const float *m, const uint32_t *times, size_t n, size_t k, float *top);

/* L_con of one sentence, whose mean feature is fg (128), over `count` embeddings e (count,128) with their
 * objects; the positives are those of `object`, and a sentence counts times[1] times in sums if it is one of
 * them, else times[0]. dfg (128) = scale dL/dfg; de (count,128) += scale dL/de. `score` holds 2 count
 * doubles.
 */
double contrast_loss(enum refer_contrast kind, double temperature, const double *fg, const float *e,
	const int *objects, size_t count, int object, const double times[2], double scale, double *dfg,
	float *de, double *score);
