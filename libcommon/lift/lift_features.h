/* Features of pictures lifted onto the Gaussians in closed form: a Gaussian's feature is the mean of the unit
 * vectors that it takes part in, by blend weight,
 *     x_i = sum_vs S_vis f_vs / |f_vs| / sum_vs S_vis,
 * with S of lift/source_weights.h; a feature of length 0 counts as 0. It minimises sum w_pi |f_p / |f_p| -
 * x_i|^2 (Occam's LGS, arXiv 2412.01807; LUDVIG, arXiv 2410.14462). The norm r_i = |x_i| in [0,1] is its
 * reliability: 1 where all views agree, small where they do not.
 *
 * Channels come in blocks, so that memory is bounded by the block's width: for each block all views, in the
 * same order. Weights are summed in the first. Numbers are the same to the bit for any threads and blocks. */
#pragma once

#include "base/err.h"
#include "lift/source_weights.h"

struct lift_features {
	size_t gaussians, channels; /* of the widest block */
	float *sum;		    /* (N,channels of the block) */
	double *weight;		    /* (N) sum of S */
	double *square;		    /* (N) of the means so far */
};

/* Returns 0, or -1 with *e set; lift_features_free in any case. */
int lift_features_init(struct lift_features *l, size_t gaussians, size_t channels, struct err *e);
void lift_features_free(struct lift_features *l);

/* Begins a block. */
void lift_features_begin(struct lift_features *l, size_t channels);

/* A view: its sources' features (sources,channels) in this block, and 1 over the length that each has with
 * all channels, or 0. is_first: of the first block. */
void lift_features_add(struct lift_features *l, size_t channels, const struct source_weights *s,
	const float *features, const double *factor, int is_first);

/* Ends a block: l->sum has the means, 0 for Gaussians without weight. */
void lift_features_end(struct lift_features *l, size_t channels);

/* After the last block: reliability (N), 0 for Gaussians without weight. */
void lift_features_reliability(const struct lift_features *l, float *reliability);
