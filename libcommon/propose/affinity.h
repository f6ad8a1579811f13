/* How far neighbouring Gaussians are of one thing, by the photographs and by a detector's boxes.
 *
 * By a photograph, two Gaussians belong together as far as their blend weight falls into the same segments:
 * of the shares m_i(s) of a Gaussian's weight in each segment, sum_s min(m_i(s), m_j(s)), the mean over
 * levels, and over views by the weight of the one that is seen less. By boxes, as far as what has one of them
 * inside has the other: sum_b c_b min(m_i(b), m_j(b)) / sum_b c_b max(m_i(b), m_j(b)), c_b the confidence,
 * over the boxes of all views that see both. */
#pragma once

#include "base/err.h"
#include "propose/linkage.h"
#include "propose/pieces.h"
#include "splat/view_matrix.h"

#include <stdint.h>

/* A detection in a view, in pixels of its weights; what is detected does not matter here. */
struct affinity_box {
	double left, top, right, bottom, score;
	int32_t class; /* -1: not said */
};

struct affinity {
	size_t count;	    /* edges */
	int32_t (*ends)[2]; /* (count) Gaussians; owned */
	/* (count) sums over views, numerator and denominator */
	double (*image)[2], (*box)[2];
};

/* Each of n points (n,3) with its `neighbours` nearest others: Gaussians kept[i], or i where it is NULL. */
int affinity_init(struct affinity *a, const float *points, const int32_t *kept, size_t n, int neighbours,
	struct err *e);
void affinity_free(struct affinity *a);

/* Adds a view. Returns 0, or -1 with *e set for want of memory. */
int affinity_view(struct affinity *a, const struct view_matrix *w, const struct pieces *p,
	const struct affinity_box *boxes, size_t box_count, struct err *e);

/* edges (count): how far apart, in 2^-20, of the Gaussians of `ends`. */
void affinity_edges(const struct affinity *a, struct linkage_edge *edges);
