/* Learning a parser's weights from sentences with analyses. */
#pragma once

#include "base/rng.h"
#include "lang/parser_net.h"

/* Uniform in +-sqrt(6 / inputs) for the matrices. */
void parser_weights_begin(struct parser_weights *w, struct rng *r);

/* A batch that parser_backward can use as its scratch. Freed as any batch. */
int parser_scratch_make(
	struct parser_batch *b, int capacity, int sentences, const struct parser_weights *w, struct err *e);

/* Adds to dw the gradient of the loss, and returns the loss: the sum over words of the cross-entropies of
 * role, and where it has them head, relation and negation, divided by the number of words. b holds
 * parser_forward's results. right: what each sentence's words should be, an array a sentence; a word whose
 * role is ROLES is not learnt from. scratch is of the shape of b, its contents are lost, and so is what b
 * holds of the lstms. */
double parser_backward(const struct parser_weights *w, struct parser_weights *dw,
	const struct parser_batch *b, const struct analysis_word *const *right, struct parser_batch *scratch);

/* A sentence to learn from. */
struct parser_sample {
	int n;				  /* words; one without is not learnt from */
	struct parser_features *features; /* (n) */
	struct analysis_word *right;	  /* (n) */
	float *vectors;			  /* (n, width) */
};

int parser_sample_make(struct parser_sample *s, const struct tokens *t, const struct analysis *right,
	const float *pieces, int piece_count, int width, struct err *e);
void parser_sample_free(struct parser_sample *s);

struct parser_learning {
	const struct parser_sample *samples; /* (sample_count) */
	size_t sample_count;
	int epochs;
	unsigned long long seed;
	/* said of each epoch, of several members at once, one at a time; may be NULL */
	void (*progress)(void *context, int member, int epoch, double loss);
	void *context;
};

/* All members of w learn, each by itself from its own start, on several threads at once: Adam, the rate
 * falling to zero. The same bytes for any number of threads. */
int parser_learn(const struct parser_learning *l, struct parser_weights *w, struct err *e);
