/* A hyperplane in the space of features that parts the Gaussians of a thing from all others: GOI's idea
 * (arXiv 2405.17596), which begins with the text's vector and trains on the mask of a model of referring
 * segmentation. Here it is the logistic regression of examples, so that where it begins does not matter: w, b
 * = argmin 1/2 mean_positive log(1 + exp(-z)) + 1/2 mean_negative log(1 + exp(z)) + HYPERPLANE_DECAY/2 |w|^2
 * with z = w.f + b. Both kinds count alike, however many there are. */
#pragma once

#include "base/err.h"

#define HYPERPLANE_DECAY 1e-3
enum { HYPERPLANE_STEPS = 200 }; /* of Nesterov's accelerated gradient */

/* examples (n,channels) of length 1 at most, the first `positive` of them positive; both kinds must be there.
 * plane (channels + 1): w, then b. Returns 0, or -1 with *e set for want of memory. */
int hyperplane_fit(
	const float *examples, size_t n, size_t positive, size_t channels, double *plane, struct err *e);

/* z of a feature. */
double hyperplane_side(const double *plane, const float *feature, size_t channels);
