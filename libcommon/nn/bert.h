/* BERT's encoder (Devlin et al. 2019), forward only: token ids in, a vector for each token out.
 *
 *   x = LayerNorm(word[id] + position[k] + type[0]), through the layers of nn/transformer.h
 */
#ifndef NN_BERT_H
#define NN_BERT_H

#include "base/err.h"
#include "nn/transformer.h"

#include <stddef.h>
#include <stdint.h>

struct bert {
	int words, positions, types; /* rows of the three embeddings */
	struct transformer body;
	float *word, *position, *type; /* (words,width), (positions,width), (types,width) */
	struct transformer_norm norm;
	float *slab; /* all of the above lie in it */
};

/* Given the sizes (words to types, and body's), allocates the slab, not initialised, and points the arrays
 * into it.
 */
int bert_alloc(struct bert *b, struct err *e);
void bert_free(struct bert *b);

/* A hash of all weights, from `seed`. */
uint64_t bert_hash(const struct bert *b, uint64_t seed);

/* Floats of scratch that a forward pass over `rows` tokens in sequences of at most `longest` needs; -1 when
 * their number does not fit. */
int bert_scratch(const struct bert *b, size_t rows, size_t longest, size_t *floats);

/* n sequences side by side: sequence s has the tokens ids[starts[s]] to ids[starts[s+1]], at most `positions`
 * of them, [CLS] and [SEP] included; ids are below `words`. out (starts[n]-starts[0],width): one row a token.
 * middle, of the shape of out: the same after half of the layers (transformer_middle); NULL: not wanted.
 * Kernel: cannot fail. */
void bert_forward(const struct bert *b, const int32_t *ids, const size_t *starts, size_t n, float *out,
	float *middle, float *scratch);

/* What a token is before its sentence is read: out (n,width) = word[ids[k]], nothing added and not
 * normalised. Kernel: cannot fail. */
void bert_static(const struct bert *b, const int32_t *ids, size_t n, float *out);

#endif
