/* Linear layers and the matrix product under them, in float32 without BLAS.
 *
 * Every element of a product is start + S_0 + S_1 + ..., added in that order, where S_b is the sum over the
 * b-th block of LINEAR_BLOCK terms, itself taken in order with one fused multiply-add a term (a
 * multiplication and an addition where the processor has no fma). Nothing in this depends on the number of
 * threads, on the vector width or on how the result is cut into tiles, so results are byte-identical on all
 * processors that have fma. */
#pragma once

#include <stddef.h>

enum { LINEAR_BLOCK = 256 }; /* terms summed before they are added to the result */

/* out (rows,out_width) = in (rows,in_width) weight^T + bias. weight (out_width,in_width) row-major, as
 * PyTorch's nn.Linear; bias (out_width) or NULL for none. `out` overlaps nothing. */
void linear_forward(float *out, const float *in, const float *weight, const float *bias, size_t rows,
	size_t in_width, size_t out_width);

/* Weights that are only read: floats, or half floats at any address, as in a file that is mapped. */
struct linear_weight {
	const float *floats; /* NULL: halves */
	const void *halves;
};

/* Copies n of them, from the `first` on. */
void linear_weight_take(float *to, const struct linear_weight *w, size_t first, size_t n);

/* The same layer with its weights where they lie; the same bytes as of the weights as floats, but for half
 * floats on processors with AMX (nn/linear_amx.h), which are about as near to the exact sums. */
struct linear_layer {
	float *out;	 /* (rows,out_width) */
	const float *in; /* (rows,in_width) */
	struct linear_weight weight;
	const float *bias; /* NULL: none */
	size_t rows, in_width, out_width;
};
void linear_layer_run(const struct linear_layer *l);

/* The gradients of linear_forward, given dout (rows,out_width):
 *   din (rows,in_width) = dout weight;          overwritten; NULL: not wanted
 *   dweight (out_width,in_width) += dout^T in;  NULL: not wanted
 *   dbias (out_width) += column sums of dout;   NULL: not wanted */
void linear_backward(float *din, float *dweight, float *dbias, const float *dout, const float *in,
	const float *weight, size_t rows, size_t in_width, size_t out_width);

/* One operand of a product: element (i,j) is data[i * row + j * column]. One of the strides is best 1. */
struct linear_matrix {
	const float *data;
	size_t row, column;
};

/* c (m,n), `stride` floats from row to row, = start + a b, with a (m,k) and b (k,n). `start` is (m,n) with
 * rows start_stride apart: c itself to add to it, a bias with start_stride 0, or NULL for zero. */
void linear_product(float *c, size_t stride, const float *start, size_t start_stride, struct linear_matrix a,
	struct linear_matrix b, size_t m, size_t n, size_t k);
