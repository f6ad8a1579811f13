/* Principal components of features: the mean, and the directions in which rows differ most, so that a row is
 * told by a few numbers. */
#pragma once

#include "base/err.h"

/* The largest width, for which the covariance takes 128 MiB. */
enum { COMPONENTS_MAX_CHANNELS = 4096 };

struct components {
	size_t channels, count;
	float *mean;  /* (C); owned */
	float *basis; /* (K,C) row-major: orthonormal, or 0 where rows differ in fewer directions; owned */
};

/* The first `count` components of rows (n,C): eigenvectors of their covariance, by subspace iteration in
 * float64. Each has its entry of largest size above 0. count <= C. The same bytes for any number of threads.
 * Returns 0, or -1 with *e set and nothing to free. */
int components_find(
	struct components *c, const float *rows, size_t n, size_t channels, size_t count, struct err *e);
void components_free(struct components *c);

/* y (n,K): b_k . (x - mean) of each of the rows x (n,C), which become x - mean. */
void components_of(const struct components *c, float *x, size_t n, float *y);
