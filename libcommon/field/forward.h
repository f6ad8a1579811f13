/* The forward pass, folded and in float32 (field/block.h): responses of all Gaussians to a few sentences. It
 * is all that an answer needs (answer/respond.h), and the first half of a training step (train/step.h).
 * Results do not depend on the number of threads: sums over Gaussians go in chunks of blocks, which are added
 * in order. */
#pragma once

#include "base/err.h"
#include "field/block.h"
#include "field/fold.h"
#include "field/referring_model.h"

enum { FORWARD_CHUNKS = 32 };

/* What stays the same from pass to pass. Arrays are referred to, not copied. */
struct forward_setup {
	const struct refer_layout *layout;
	enum refer_similarity similarity;
	size_t gaussians;		     /* N, the rows of features */
	const float *position;		     /* (N,3) means scaled to [-1,1] */
	int longest;			     /* most words of a sentence, at least 1 */
	int batch;			     /* most sentences of a pass */
	const struct block_kernels *kernels; /* NULL: block_select(NULL) */
};

struct forward {
	struct forward_setup setup;
	size_t padded, blocks; /* N padded to whole blocks */
	int threads;
	int *first;	/* (batch+1) the words of the pass's sentence i are first[i] to first[i+1], */
	float *vectors; /* (batch longest,128) and these w_j: both are the caller's to fill */
	struct fold *fold;
	struct block_model model; /* of the last pass */
	struct block_arrays
		arrays;		/* x to sigma, responses in m; those of the backward pass are the caller's */
	float *slab, *position; /* what arrays point to */
	struct block_sums sums[FORWARD_CHUNKS]; /* the softmax over Gaussians, in `chunks` */
	float *chunks;
	double *total;
	float *scratch; /* (threads,scratch_size) */
	size_t scratch_size;
};

/* Returns 0, or -1 with *e set and *f as it can be freed. */
int forward_init(struct forward *f, const struct forward_setup *setup, struct err *e);
void forward_free(struct forward *f);

/* A pass over `count` sentences, in these four parts: the words and parameters are folded; x (panels of d_r
 * channels) through the MLPs; scores are folded; responses, in arrays.m (panels of `count` channels). */
void forward_fold(struct forward *f, const float *parameters, int count);
void forward_hidden(struct forward *f, const float *x);
void forward_scores(struct forward *f);
void forward_respond(struct forward *f);

/* Runs something on every block, each chunk's in order. scratch is the thread's own. */
void forward_each_block(
	struct forward *f, void (*run)(void *data, size_t block, int chunk, float *scratch), void *data);
