/* Training: what is learned from, the order in which it is seen, and the state that a checkpoint holds. */
#pragma once

#include "base/err.h"
#include "splat/view_weights.h"
#include "train/step.h"

#include <stdint.h>

/* A training view: its weights, and the sentences that have a mask in it. */
struct train_view {
	struct view_weights weights;
	int count;
	int *sentences;	       /* (count) indices of sentences */
	const uint8_t **masks; /* (count) of weights.pixels each, as bits (mask/bits.h) */
};

/* Gaussians that can learn: those that carry all but `tolerance` of the weight (scene_gaussians) that they
 * have over all views; at 0, those with any. ids (scene_gaussians) gets *n rising indices. */
int train_active_set(const double *weight, size_t scene_gaussians, double tolerance, int32_t *ids, size_t *n,
	struct err *e);

/* Robust bounds of the means (N,3) of the Gaussians ids (n): the 1st and 99th percentile of each axis,
 * widened where they meet. */
int train_bounds(
	const float *means, const int32_t *ids, size_t n, double low[3], double high[3], struct err *e);

/* What a contrast is with: `negatives` of the sentences, 0 for all. */
struct train_contrast {
	size_t sentences, negatives;
	const int *objects;
};

/* Sentences of a target's own object that a sampled contrast takes besides. */
enum { TRAIN_POSITIVES = 4 };

/* The order of training: epochs, each a shuffle of every view's sentences into groups of at most `batch` and
 * of those groups. It depends on seed, epoch and view alone, so that any iteration can be found again. */
struct train_order {
	const struct train_view *views;
	size_t view_count;
	int batch;
	uint64_t seed;
	struct train_contrast contrast;
	size_t *others;		/* (batch * TRAIN_POSITIVES + R) */
	uint32_t groups;	/* in an epoch */
	long begin;		/* the training's iteration where this order begins */
	long epoch;		/* that `order` holds, or -1 */
	uint32_t *order;	/* (groups) */
	uint32_t *view, *first; /* (groups) the view, and the first of its shuffled sentences */
	uint32_t *shuffled;	/* every view's sentences, one after another */
	uint32_t *start;	/* (view_count+1) into shuffled */
};

int train_order_init(struct train_order *o, const struct train_view *views, size_t view_count, int batch,
	const struct train_contrast *contrast, uint64_t seed, struct err *e);
void train_order_free(struct train_order *o);

/* The view of an iteration (counted from 0), and which of its sentences: picks (batch) gets *count positions
 * in the view's list. */
size_t train_order_at(struct train_order *o, long iteration, uint32_t *picks, int *count);

/* The view of a training's iteration, and then of the one after it: SIZE_MAX where that is of another epoch.
 */
size_t train_order_view(struct train_order *o, long iteration);
size_t train_order_next(struct train_order *o, long iteration);

/* The sentences that an iteration's contrast is with: `negatives` of all, and some of each target's object,
 * all drawn evenly; some may be there twice. list NULL: all. */
struct step_others train_order_others(
	struct train_order *o, long iteration, const struct step_target *targets, int count);

/* Parameters and referring features in one slab with gradient and both Adam moments alike; a checkpoint is
 * the slab, the iteration and the sum. */
struct train_state {
	size_t parameters, count;	  /* floats of the parameters (padded) and of the slab */
	float *values, *gradient, *m, *v; /* (count): parameters, then x in panels */
	long iteration;			  /* steps done */
	struct step_losses sum;		  /* of the steps since the caller last set it to zero */
};

int train_state_init(
	struct train_state *t, const struct refer_layout *l, size_t gaussians, uint64_t seed, struct err *e);
void train_state_free(struct train_state *t);
float *train_state_x(const struct train_state *t);

struct train_rates {
	double features, mlps; /* Adam's */
};

/* Adam on all parameters with the gradient that is there; iteration + 1. */
void train_adam(struct train_state *t, const struct train_rates *rates);

/* One step, with the weights over rows of train_order_view: gradient, Adam, iteration + 1, losses added to
 * sum. Where the loss is not finite the values stay as they are, so that they show why (train/divergence.h).
 */
struct step_losses train_step(struct train_state *t, struct step *s, struct train_order *o,
	const struct train_rates *rates, const struct view_weights *weights);
