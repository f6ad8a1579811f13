/* The innermost part of a matrix product, once for each instruction set. For linear.c and its test. */
#pragma once

#include "nn/linear.h"

#include <stddef.h>

enum { LINEAR_TILE_ROWS = 24, LINEAR_TILE_COLUMNS = 32 }; /* the largest of all tiles */

struct linear_tile {
	const char *name;
	size_t rows, columns; /* of the tile of c that one call makes */

	/* c (rows,columns) = start + a b over k terms. a's element (i,j) is a[i * row + j * column]; b is
	 * packed, (k,columns), 64-byte aligned; c and start have rows `stride` and `start_stride` apart; they
	 * may be the same. */
	void (*run)(float *c, size_t stride, const float *start, size_t start_stride, const float *a,
		size_t row, size_t column, const float *b, size_t k);
};

/* The tiles that this processor can run, best first; NULL past the last. There is always tile 0. */
const struct linear_tile *linear_tile_get(int i);

/* The one to use for a result of so many rows and columns. */
const struct linear_tile *linear_tile_best(size_t rows, size_t columns);

/* linear_product and linear_layer_run with a tile of one's choice. */
void linear_layer_with(const struct linear_tile *tile, const struct linear_layer *l);
void linear_product_with(const struct linear_tile *tile, float *c, size_t stride, const float *start,
	size_t start_stride, struct linear_matrix a, struct linear_matrix b, size_t m, size_t n, size_t k);
