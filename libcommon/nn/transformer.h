/* The layers of a transformer encoder (Vaswani et al. 2017), forward only, as BERT and CLIP's text tower have
 * them. Each layer, with heads of d = width/heads columns:
 *
 *   attend(x): q,k,v = Linear(x), split into heads
 *              c     = softmax(q k^T / sqrt d) v, heads side by side; is_causal: k of no later token
 *              Linear(c)
 *   feed(x):   Linear(act(Linear(x)))
 *
 *   BERT:                x = LayerNorm(x + attend(x));  x = LayerNorm(x + feed(x))
 *   CLIP, is_norm_first: x = x + attend(LayerNorm(x));  x = x + feed(LayerNorm(x))
 */
#pragma once

#include "nn/slab.h"

#include <stddef.h>

enum transformer_activation {
	TRANSFORMER_GELU,      /* x Phi(x), by erf */
	TRANSFORMER_GELU_TANH, /* its approximation by tanh: "gelu_new", "gelu_pytorch_tanh" */
	TRANSFORMER_RELU,
	TRANSFORMER_QUICK_GELU, /* x sigmoid(1.702 x) */
};

struct transformer_linear {
	struct linear_weight weight; /* (out,in) row-major */
	float *bias;		     /* (out) */
};

struct transformer_norm {
	float *scale, *shift; /* (width) */
};

struct transformer_layer {
	struct transformer_linear query, key, value, attention_out, inner, outer;
	struct transformer_norm attention_norm, norm; /* of attend and of feed */
};

struct transformer {
	int width, heads, inner, layer_count;
	enum transformer_activation activation;
	double eps; /* of every LayerNorm */
	int is_causal, is_norm_first;
	struct transformer_layer *layers; /* (layer_count), the owner's; their arrays lie in a slab */
};

/* x (n) = x Phi(x), within 6e-8 (1 + |x|). Kernel: cannot fail. */
void transformer_gelu(float *x, size_t n);

/* The arrays of all layers, and of a norm. */
void transformer_take(struct transformer *t, struct slab *s);
void transformer_take_norm(const struct transformer *t, struct transformer_norm *norm, struct slab *s);

/* x (width) = LayerNorm(x). Kernel: cannot fail. */
void transformer_normalise(const struct transformer *t, float *x, const struct transformer_norm *norm);

/* Floats of scratch that a forward pass over `rows` tokens in sequences of at most `longest` needs; -1 when
 * their number does not fit. */
int transformer_scratch(const struct transformer *t, size_t rows, size_t longest, size_t *floats);

/* The layers after which a token's row is its middle one: half of them, 3 of 6. */
int transformer_middle(const struct transformer *t);

/* x (starts[n]-starts[0],width), one row a token, through all layers, in place. Sequence s has the rows from
 * starts[s]-starts[0] on, to that of the next. middle, of the shape of x, gets the rows after
 * transformer_middle layers; NULL: not wanted. Kernel: cannot fail. */
void transformer_forward(
	const struct transformer *t, const size_t *starts, size_t n, float *x, float *middle, float *scratch);
