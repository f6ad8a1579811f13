/* MLP_t over the words of the sentences of a step, with the mean of a sentence taken before the last, linear
 * layer (exact: e = mean_j (W h_j + b) = W mean_j h_j + b). */
#ifndef REFER_WORDS_H
#define REFER_WORDS_H

#include "base/err.h"
#include "refer/model.h"

#include <stddef.h>
#include <stdint.h>

/* Arrays are over the chosen sentences, k of them with n words together. */
struct words {
	const struct refer_layout *layout;
	size_t sentences;	/* R */
	const int64_t *offsets; /* (R+1), from 0 */
	const float *input;	/* (offsets[R], D_text) */
	size_t count;		/* k */
	int64_t *at;		/* (k+1) where a chosen sentence's words begin */
	const float *chosen;	/* (n,D_text) their words: copied, or input */
	float *copied;		/* (offsets[R],D_text) */
	float *h1, *h2;		/* (n,512), (n,256) hidden layers */
	float *dh1, *dh2;	/* their gradients */
	float *mean, *dmean;	/* (k,256) mean of h2 */
	float *e, *de;		/* (k,128) embeddings */
};

/* Refers to offsets and input, which must outlive it. A sentence without words has the embedding of h2 = 0.
 */
int words_init(struct words *w, const struct refer_layout *l, size_t sentences, const int64_t *offsets,
	const float *input, struct err *e);
void words_free(struct words *w);

/* Which sentences the step has: `list` (count) of different ones. What follows goes by their place in it. */
void words_choose(struct words *w, const size_t *list, size_t count);

/* Hidden layers. */
void words_hidden(struct words *w, const float *parameters);

/* w_j of one sentence after words_hidden: (its words,128). */
void words_vectors(const struct words *w, const float *parameters, size_t place, float *out);

/* Embeddings after words_hidden: in w->e. */
void words_embed(struct words *w, const float *parameters);

/* Starts the backward pass: hidden gradients zero, or through w->de where has_embeddings. */
void words_back_begin(struct words *w, const float *parameters, float *gradient, int has_embeddings);

/* Adds a sentence's dw (its words,128). */
void words_back_vectors(
	struct words *w, const float *parameters, float *gradient, size_t place, const float *dw);

/* Finishes: gradients of the first two layers are added. */
void words_back_end(struct words *w, const float *parameters, float *gradient);

#endif
