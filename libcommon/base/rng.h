/* PCG32 (O'Neill 2014, XSH-RR 64/32): small, portable, with published known answers. */
#pragma once

#include <stdint.h>

struct rng {
	uint64_t state, increment;
};

/* Streams with different `stream` are independent. seed 42, stream 54 is the reference's demonstration. */
void rng_seed(struct rng *r, uint64_t seed, uint64_t stream);
uint32_t rng_u32(struct rng *r);
uint32_t rng_below(struct rng *r, uint32_t n);		  /* uniform in [0,n), without bias; n > 0 */
int rng_draw(struct rng *r, const int *weights, int n);	  /* an index, as often as its weight says */
double rng_uniform(struct rng *r);			  /* [0,1), 53 bits */
double rng_range(struct rng *r, double low, double high); /* [low,high) */
double rng_normal(struct rng *r); /* mean 0, variance 1; Box-Muller, two draws a call */
void rng_shuffle(struct rng *r, uint32_t *items, uint32_t n); /* Fisher-Yates */
