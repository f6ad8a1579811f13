/* Products on panels of Gaussians (refer/block.h): W x, and the sums of outer products that give the
 * gradients of W. Included by block_kernel.h, for each instruction set. */
#include "refer/block.h"

#include "base/vecmath.h"

#include <math.h>
#include <string.h>

enum {
	L = BLOCK_LANES,
	TILE = VEC_LANES == 16 ? 4 : 2, /* vectors held in registers for each row of a product */
	MAX_ROWS = 4,
};

VEC_INLINE vecn vec_sqrt(vecn x)
{
	for (int i = 0; i < VEC_LANES; i++)
		x[i] = sqrtf(x[i]);
	return x;
}

/* x in the first `count` lanes, `fill` in the others. */
VEC_INLINE vecn vec_first(vecn x, int count, float fill)
{
	static const float lanes[16] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};

	return vec_choose(vec_lt(vec_load(lanes), vec_splat((float)count)), x, vec_splat(fill));
}

/* `rows` rows of out = [base +] W in, over TILE vectors. base: 0 nothing, 1 what out holds, 2 bias. */
VEC_INLINE void product_tile(const int rows, float *out, const float *w, int stride, int columns,
	const float *in, const float *bias, const int base, const int relu)
{
	vecn sum[MAX_ROWS][TILE];

	for (int r = 0; r < rows; r++)
		for (int v = 0; v < TILE; v++)
			sum[r][v] = base == 1 ? vec_load(out + r * L + VEC_LANES * v)
					      : vec_splat(base == 2 ? bias[r] : 0);
	for (int c = 0; c < columns; c++) {
		vecn x[TILE];
		for (int v = 0; v < TILE; v++)
			x[v] = vec_load(in + c * L + VEC_LANES * v);
		for (int r = 0; r < rows; r++) {
			vecn scale = vec_splat(w[r * stride + c]);
			for (int v = 0; v < TILE; v++)
				sum[r][v] = vec_fma(scale, x[v], sum[r][v]);
		}
	}
	for (int r = 0; r < rows; r++)
		for (int v = 0; v < TILE; v++) {
			if (relu)
				sum[r][v] = vec_max(sum[r][v], vec_splat(0));
			vec_store(out + r * L + VEC_LANES * v, sum[r][v]);
		}
}

/* out (rows,L) = [base +] w (rows,columns; rows `stride` apart) in (columns,L), for one panel. */
VEC_INLINE void product(float *out, const float *w, int rows, int columns, int stride, const float *in,
	const float *bias, const int base, const int relu)
{
	for (int v = 0; v < L; v += TILE * VEC_LANES) {
		int r = 0;
		for (; r + 4 <= rows; r += 4)
			product_tile(4, out + r * L + v, w + r * stride, stride, columns, in + v, bias + r,
				base, relu);
		if (rows - r == 3)
			product_tile(3, out + r * L + v, w + r * stride, stride, columns, in + v, bias + r,
				base, relu);
		else if (rows - r == 2)
			product_tile(2, out + r * L + v, w + r * stride, stride, columns, in + v, bias + r,
				base, relu);
		else if (rows - r == 1)
			product_tile(1, out + r * L + v, w + r * stride, stride, columns, in + v, bias + r,
				base, relu);
	}
}

static const float no_bias[BLOCK_WORDS];

static void product_set(float *out, const float *w, int rows, int columns, int stride, const float *in)
{
	product(out, w, rows, columns, stride, in, no_bias, 0, 0);
}

static void product_add(float *out, const float *w, int rows, int columns, int stride, const float *in)
{
	product(out, w, rows, columns, stride, in, no_bias, 1, 0);
}

static void product_relu(
	float *out, const float *w, int rows, int columns, const float *in, const float *bias)
{
	product(out, w, rows, columns, columns, in, bias, 2, 1);
}

VEC_INLINE float sum_lanes(vecn v)
{
	float s[VEC_LANES];

	vec_store(s, v);
	for (int half = VEC_LANES / 2; half; half /= 2)
		for (int i = 0; i < half; i++)
			s[i] += s[i + half];
	return s[0];
}

/* (4 x 4) sums of products over the lanes of every panel: out[r][c] += sum a_r b_c. */
VEC_INLINE void outer_tile(const int rows, const int columns, float *out, int stride, const float *a,
	int a_panel, const float *b, int b_panel, int panels)
{
	vecn sum[MAX_ROWS][4];

	for (int r = 0; r < rows; r++)
		for (int c = 0; c < columns; c++)
			sum[r][c] = vec_splat(0);
	for (int p = 0; p < panels; p++, a += a_panel, b += b_panel)
		for (int v = 0; v < L; v += VEC_LANES) {
			vecn y[4];
			for (int c = 0; c < columns; c++)
				y[c] = vec_load(b + c * L + v);
			for (int r = 0; r < rows; r++) {
				vecn x = vec_load(a + r * L + v);
				for (int c = 0; c < columns; c++)
					sum[r][c] = vec_fma(x, y[c], sum[r][c]);
			}
		}
	for (int r = 0; r < rows; r++)
		for (int c = 0; c < columns; c++)
			out[r * stride + c] += sum_lanes(sum[r][c]);
}

VEC_INLINE void outer_rows(const int rows, float *out, int columns, int stride, const float *a, int a_panel,
	const float *b, int b_panel, int panels)
{
	int c = 0;

	for (; c + 4 <= columns; c += 4)
		outer_tile(rows, 4, out + c, stride, a, a_panel, b + (size_t)c * L, b_panel, panels);
	for (; c < columns; c++)
		outer_tile(rows, 1, out + c, stride, a, a_panel, b + (size_t)c * L, b_panel, panels);
}

/* out (rows,columns; rows `stride` apart) += sum over the lanes of `panels` panels of a (rows) times b
 * (columns); a_channels and b_channels are the channels in a panel of each. */
static void outer(float *out, int rows, int columns, int stride, const float *a, int a_channels,
	const float *b, int b_channels, int panels)
{
	int r = 0;

	for (; r + 4 <= rows; r += 4)
		outer_rows(4, out + (size_t)r * (size_t)stride, columns, stride, a + (size_t)r * L,
			a_channels * L, b, b_channels * L, panels);
	for (; r < rows; r++)
		outer_rows(1, out + (size_t)r * (size_t)stride, columns, stride, a + (size_t)r * L,
			a_channels * L, b, b_channels * L, panels);
}

/* out (rows) += sums of a's channels over the lanes. */
static void sum_channels(float *out, int rows, const float *a, int channels, int panels)
{
	for (int r = 0; r < rows; r++) {
		const float *row = a + r * L;
		vecn sum = vec_splat(0);
		for (int p = 0; p < panels; p++, row += channels * L)
			for (int v = 0; v < L; v += VEC_LANES)
				sum += vec_load(row + v);
		out[r] += sum_lanes(sum);
	}
}

/* Zeroes the gradient where the layer's output was not positive. */
static void relu_back(float *d, const float *value, int channels)
{
	for (int i = 0; i < channels * L; i += VEC_LANES)
		vec_store(d + i, vec_keep(vec_lt(vec_splat(0), vec_load(value + i)), vec_load(d + i)));
}
