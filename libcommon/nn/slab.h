/* One block of floats that many arrays share: an optimiser, a file or a hash then goes through it once. */
#pragma once

#include "base/err.h"
#include "nn/linear.h"

#include <stdint.h>

/* Hands out consecutive arrays, and hashes those that are there. With `at` NULL it only counts; -1 in `bad`
 * when the count does not fit. */
struct slab {
	float *at;
	size_t used;
	int bad;
	uint64_t *hash; /* NULL: do not read them */
};

/* rows x columns floats, beginning on a 64-byte boundary. */
float *slab_take(struct slab *s, size_t rows, size_t columns);

/* The same of weights, unless they are halves, which lie elsewhere. Their hash is that of floats. */
void slab_take_weight(struct slab *s, struct linear_weight *w, size_t rows, size_t columns);

/* Allocates what `lay_out` takes for `of`, not initialised, and has it point `of`'s arrays into it: the block
 * to free(), or NULL with *e set, which names `what`. */
float *slab_alloc(void (*lay_out)(void *of, struct slab *s), void *of, const char *what, struct err *e);
