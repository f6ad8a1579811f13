/* CLIP's text tower (Radford et al. 2021), forward only: token ids in, a vector for each token out.
 *
 *   x = word[id] + position[k], through the layers of nn/transformer.h, norms first and causal
 *   y = projection LayerNorm(x); LayerNorm(x) where there is no projection
 *
 * The sentence's vector is y of its end-of-text token, which alone has seen all of it. */
#ifndef NN_CLIP_H
#define NN_CLIP_H

#include "base/err.h"
#include "nn/transformer.h"

#include <stddef.h>
#include <stdint.h>

struct clip {
	int words, positions; /* rows of the two embeddings */
	int projected;	      /* columns of y; 0: there is no projection, and y has body.width */
	struct transformer body;
	float *word, *position; /* (words,width), (positions,width) */
	struct transformer_norm norm;
	float *projection; /* (projected,width) */
	float *slab;	   /* all of the above lie in it */
};

/* Given the sizes (words to projected, and body's), allocates the slab, not initialised, and points the
 * arrays into it. */
int clip_alloc(struct clip *c, struct err *e);
void clip_free(struct clip *c);

/* A hash of all weights, from `seed`. */
uint64_t clip_hash(const struct clip *c, uint64_t seed);

/* Columns of y. */
int clip_width(const struct clip *c);

/* Floats of scratch that a forward pass over `rows` tokens in sequences of at most `longest` needs; -1 when
 * their number does not fit. */
int clip_scratch(const struct clip *c, size_t rows, size_t longest, size_t *floats);

/* n sequences side by side: sequence s has the tokens ids[starts[s]] to ids[starts[s+1]], at most `positions`
 * of them, start and end of text included; ids are below `words`. out (starts[n]-starts[0],clip_width): y,
 * one row a token. Kernel: cannot fail. */
void clip_forward(
	const struct clip *c, const int32_t *ids, const size_t *starts, size_t n, float *out, float *scratch);

/* What a token is before its sentence is read: out (n,body.width) = word[ids[k]]. Kernel: cannot fail. */
void clip_static(const struct clip *c, const int32_t *ids, size_t n, float *out);

#endif
