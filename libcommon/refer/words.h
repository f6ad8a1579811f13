/* MLP_t over the words of every sentence of a scene, with the mean of a sentence taken before the last,
 * linear layer (exact: e = mean_j (W h_j + b) = W mean_j h_j + b). */
#ifndef REFER_WORDS_H
#define REFER_WORDS_H

#include "base/err.h"
#include "refer/model.h"

#include <stddef.h>
#include <stdint.h>

struct words {
	const struct refer_layout *layout;
	size_t sentences;	/* R */
	const int64_t *offsets; /* (R+1), from 0 */
	const float *input;	/* (offsets[R], D_text) */
	float *h1, *h2;		/* (rows,512), (rows,256) hidden layers */
	float *dh1, *dh2;	/* their gradients */
	float *mean, *dmean;	/* (R,256) mean of h2 */
	float *e, *de;		/* (R,128) embeddings */
};

/* Refers to offsets and input, which must outlive it. A sentence without words has the embedding of h2 = 0.
 */
int words_init(struct words *w, const struct refer_layout *l, size_t sentences, const int64_t *offsets,
	const float *input, struct err *e);
void words_free(struct words *w);

/* Hidden layers of sentences [from,to). */
void words_hidden(struct words *w, const float *parameters, size_t from, size_t to);

/* w_j of one sentence after words_hidden: (n,128). */
void words_vectors(const struct words *w, const float *parameters, size_t sentence, float *out);

/* Embeddings e (R,128) of all sentences after words_hidden of all: in w->e. */
void words_embed(struct words *w, const float *parameters);

/* Starts the backward pass over sentences [from,to): hidden gradients zero, or through w->de where
 * has_embeddings. */
void words_back_begin(struct words *w, const float *parameters, float *gradient, size_t from, size_t to,
	int has_embeddings);

/* Adds a sentence's dw (n,128). */
void words_back_vectors(
	struct words *w, const float *parameters, float *gradient, size_t sentence, const float *dw);

/* Finishes: gradients of the first two layers are added. */
void words_back_end(struct words *w, const float *parameters, float *gradient, size_t from, size_t to);

#endif
