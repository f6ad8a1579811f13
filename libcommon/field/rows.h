/* Rows: which referring feature serves each Gaussian of a scene. A row is of one Gaussian, or of all those in
 * a leaf of an octree that learn. */
#pragma once

#include "base/err.h"
#include "field/octree.h"
#include "splat/view_weights.h"

#include <stdint.h>

struct rows {
	size_t gaussians; /* N of the scene */
	size_t n;	  /* M rows */
	int32_t *of;	  /* (N) a Gaussian's row, or -1: none */
};

/* A row for each of the Gaussians ids (n), rising. */
int rows_of_ids(struct rows *r, const int32_t *ids, size_t n, size_t gaussians, struct err *e);

/* A row for each leaf, of those of the Gaussians ids (n) that lie in it; means (gaussians,3). ids
 * NULL: of all that do. */
int rows_of_leaves(struct rows *r, const struct octree *t, const float *means, size_t gaussians,
	const int32_t *ids, size_t n, struct err *e);
void rows_free(struct rows *r);

/* position (n,3): the mean of each row's means (gaussians,3) scaled from the bounds to [-1,1], and cut there;
 * 0 for a row without Gaussians. */
int rows_positions(const struct rows *r, const float *means, const double low[3], const double high[3],
	float *position, struct err *e);

/* to (gaussians) = from (n) of each Gaussian's row; 0 for those without. */
void rows_spread(const struct rows *r, const float *from, float *to);

/* A view's weights over rows instead of Gaussians; those of a row at a pixel are added up, in the order in
 * which the row first appears. Free with rows_view_free. */
int rows_view(const struct rows *r, const struct view_weights *from, struct view_weights *to, struct err *e);
void rows_view_free(struct view_weights *w);
