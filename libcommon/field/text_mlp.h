/* MLP_t over the words of the sentences of a step, with the mean of a sentence taken before the last, linear
 * layer (exact: e = mean_j (W h_j + b) = W mean_j h_j + b). */
#pragma once

#include "base/err.h"
#include "field/referring_model.h"

#include <stdint.h>

/* Arrays are over the chosen sentences, k of them with n words together. */
struct text_mlp {
	const struct refer_layout *layout;
	size_t sentences;	/* R */
	const int64_t *offsets; /* (R+1), from 0 */
	const float *input;	/* (offsets[R], D_text) */
	size_t count;		/* k */
	int64_t *at;		/* (k+1) where a chosen sentence's words begin */
	const float *chosen;	/* (n,D_text) their words: copied, or input */
	float *copied;		/* (offsets[R],D_text), for learning */
	float *h1, *h2;		/* (n,512), (n,256) hidden layers */
	float *dh1, *dh2;	/* their gradients */
	float *mean, *dmean;	/* (k,256) mean of h2 */
	float *e, *de;		/* (k,128) embeddings */
};

/* What it is for decides its size: answering has buffers for one sentence at a time, and none for gradients.
 */
enum text_mlp_purpose { TEXT_MLP_ANSWERING, TEXT_MLP_LEARNING };

/* Refers to offsets and input, which must outlive it. A sentence without words has the embedding of h2 = 0.
 */
int text_mlp_init(struct text_mlp *w, const struct refer_layout *l, size_t sentences, const int64_t *offsets,
	const float *input, enum text_mlp_purpose purpose, struct err *e);
void text_mlp_free(struct text_mlp *w);

/* Which sentences go together: `list` (count) of different ones; for answering count is 1. What follows goes
 * by their place in it. */
void text_mlp_choose(struct text_mlp *w, const size_t *list, size_t count);

/* Hidden layers. */
void text_mlp_hidden(struct text_mlp *w, const float *parameters);

/* w_j of one sentence after text_mlp_hidden: (its words,128). */
void text_mlp_vectors(const struct text_mlp *w, const float *parameters, size_t place, float *out);

/* Embeddings after text_mlp_hidden: in w->e. */
void text_mlp_embed(struct text_mlp *w, const float *parameters);

/* Starts the backward pass: hidden gradients zero, or through w->de where has_embeddings. */
void text_mlp_back_begin(struct text_mlp *w, const float *parameters, float *gradient, int has_embeddings);

/* Adds a sentence's dw (its words,128). */
void text_mlp_back_vectors(
	struct text_mlp *w, const float *parameters, float *gradient, size_t place, const float *dw);

/* Finishes: gradients of the first two layers are added. */
void text_mlp_back_end(struct text_mlp *w, const float *parameters, float *gradient);
