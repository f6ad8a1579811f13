/* A point's neighbours, and how far they are. */
#pragma once

#include "base/err.h"

#include <stdint.h>

enum { NEIGHBOURS_MOST = 16 };

/* distance[i] is that from point i to its k-th nearest other one, INFINITY where there are fewer. points
 * (n,3), k from 1 to NEIGHBOURS_MOST. Returns 0, or -1 with *e set. */
int neighbours_find(const float *points, size_t n, int k, float *distance, struct err *e);

/* The same of each of `from` (m,3), which are none of the points. */
int neighbours_of(
	const float *points, size_t n, const float *from, size_t m, int k, float *distance, struct err *e);

/* near (n,k): the numbers of the k nearest other points of each, nearest first; -1 where there are fewer. */
int neighbours_list(const float *points, size_t n, int k, int32_t *near, struct err *e);
