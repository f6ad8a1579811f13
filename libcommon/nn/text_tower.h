/* A text encoder, forward only: token ids in, a vector for each token out. BERT's (Devlin et al. 2019)
 *
 *   x = LayerNorm(word[id] + position[k] + type[0]), through the layers of nn/transformer.h
 *
 * or, where the body has its norms first and is causal, CLIP's text tower (Radford et al. 2021):
 *
 *   x = word[id] + position[k], through the layers
 *   y = projection LayerNorm(x); LayerNorm(x) where there is no projection
 *
 * A sentence's vector of CLIP's is y of its end-of-text token, which alone has seen all of it. */
#pragma once

#include "base/err.h"
#include "nn/transformer.h"

#include <stdint.h>

struct text_tower {
	int words, positions; /* rows of the embeddings */
	int types;	      /* the same of BERT's third */
	int projected;	      /* columns of y; 0: there is no projection, and y has body.width */
	struct transformer body;
	struct linear_weight word; /* (words,width) */
	float *position, *type;	   /* (positions,width), (types,width) */
	struct transformer_norm norm;
	float *projection; /* (projected,width) */
	float *slab;	   /* all of the above lie in it, but halves */
	void *file;	   /* where halves lie, and what closes it; NULL: there are none */
	void (*close)(void *file);
};

/* Given the sizes (words to projected, and body's), allocates the layers, whose weights may then be set to
 * halves; then the slab, not initialised, and points the other arrays into it. */
int text_tower_alloc_layers(struct text_tower *t, struct err *e);
int text_tower_alloc(struct text_tower *t, struct err *e);
void text_tower_free(struct text_tower *t);

/* A hash of all weights, from `seed`. */
uint64_t text_tower_hash(const struct text_tower *t, uint64_t seed);

/* Columns of what comes out. */
int text_tower_width(const struct text_tower *t);

/* Floats of scratch that a forward pass over `rows` tokens in sequences of at most `longest` needs; -1 when
 * their number does not fit. */
int text_tower_scratch(const struct text_tower *t, size_t rows, size_t longest, size_t *floats);

/* n sequences side by side: sequence s has the tokens ids[starts[s]] to ids[starts[s+1]], at most `positions`
 * of them, those that begin and end a text included; ids are below `words`. out
 * (starts[n]-starts[0],text_tower_width): one row a token. middle (...,width): what x is after half of the
 * layers (transformer_middle); NULL: not wanted. Kernel: cannot fail. */
void text_tower_forward(const struct text_tower *t, const int32_t *ids, const size_t *starts, size_t n,
	float *out, float *middle, float *scratch);

/* What a token is before its sentence is read: out (n,body.width) = word[ids[k]], nothing added and not
 * normalised. Kernel: cannot fail. */
void text_tower_static(const struct text_tower *t, const int32_t *ids, size_t n, float *out);
