/* One training step of the referring model, folded and in float32 (design section 4): responses of the step's
 * sentences, images of a view, both losses and every gradient. Results do not depend on the number of
 * threads. */
#pragma once

#include "base/err.h"
#include "field/block.h"
#include "field/contrast.h"
#include "field/panels.h"
#include "field/referring_model.h"
#include "splat/view_weights.h"

#include <stdint.h>

/* What stays the same from step to step. Arrays are referred to, not copied. */
struct step_setup {
	const struct refer_layout *layout;
	enum refer_similarity similarity;
	enum refer_contrast contrast;
	double temperature, lambda;
	size_t gaussians;	/* N, the rows of features; a view's weights are over them */
	const float *position;	/* (N,3) means scaled to [-1,1] */
	const uint32_t *counts; /* (N) how many Gaussians share a row; NULL: it is one */
	size_t sentences;	/* R */
	const int64_t *offsets; /* (R+1) into words */
	const float *words;	/* (offsets[R], D_text) */
	const int *objects;	/* (R) which object a sentence means; may be NULL without contrast */
	size_t pixels;		/* the largest view's */
	int batch;		/* most sentences in a step */
	const struct block_kernels *kernels; /* NULL: block_select(NULL) */
};

struct step;

/* NULL with *e set (memory; a sentence without words). */
struct step *step_new(const struct step_setup *setup, struct err *e);
void step_free(struct step *s);

/* What step_run's time goes to. */
enum step_phase {
	STEP_WORDS, /* MLP_t and its gradients */
	STEP_FOLD,  /* folding, the contrast, sums of the chunks */
	STEP_HIDDEN,
	STEP_RESPOND,
	STEP_IMAGES, /* images, their loss and dm */
	STEP_TOP,    /* choosing the top sets */
	STEP_GATHER,
	STEP_SCORES_BACK,
	STEP_HIDDEN_BACK,
	STEP_PHASES
};

/* Has `ended` called at the end of every phase, for measurements: the time since the last call is that
 * phase's. */
void step_watch(struct step *s, void (*ended)(void *data, enum step_phase phase), void *data);

struct step_target {
	size_t sentence;     /* index below R */
	const uint8_t *mask; /* of P pixels, as bits (mask/bits.h) */
};

struct step_losses {
	double bce, contrast; /* means over the step's sentences */
	double total;	      /* bce + lambda contrast */
};

/* Sentences that a step's contrast takes besides the targets. They stand for all: those of an object count as
 * often as makes up for the rest of its sentences, those of the others for the rest of theirs. */
struct step_others {
	const size_t *list;
	size_t count;
};

/* One step over `count` sentences of one view. x (panels of d_r channels, field/panels.h) are the features.
 * gradient (layout count) and dx (panels) are overwritten with
 * the gradients of the total loss. top_count is contrast_top_count's of step_gaussians. others NULL: the
 * contrast is with all sentences. */
struct step_losses step_run(struct step *s, const float *parameters, const float *x,
	const struct view_weights *view, const struct step_target *targets, int count, size_t top_count,
	const struct step_others *others, float *gradient, float *dx);

/* How many Gaussians its rows are of. */
size_t step_gaussians(const struct step *s);

/* Responses m (gaussians) of one sentence. */
void step_respond(struct step *s, const float *parameters, const float *x, size_t sentence, float *m);
