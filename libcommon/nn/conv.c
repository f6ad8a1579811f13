#include "nn/conv.h"

#include "nn/linear.h"

#include <string.h>

/* The pixels under a kernel of 3 x 3, a row for each pixel of the result; beyond the edge they are 0. */
static void gather(float *to, struct conv_image in, size_t step, size_t height, size_t width)
{
	const size_t n = in.channels;

#pragma omp parallel for schedule(static)
	for (size_t y = 0; y < height; y++) {
		float *row = to + y * width * 9 * n;
		for (size_t x = 0; x < width; x++)
			for (size_t k = 0; k < 9; k++, row += n) {
				/* one more than the place, which may be -1 */
				const size_t i = y * step + k / 3, j = x * step + k % 3;
				if (i < 1 || j < 1 || i > in.height || j > in.width)
					memset(row, 0, n * sizeof *row);
				else
					memcpy(row, in.data + ((i - 1) * in.width + j - 1) * in.stride,
						n * sizeof *row);
			}
	}
}

void conv_forward(
	const struct conv *c, struct conv_image out, struct conv_image in, float leak, float *scratch)
{
	const size_t pixels = out.height * out.width, terms = c->side * c->side * c->in;
	struct linear_matrix a = {in.data, in.stride, 1}, b = {c->weight, c->out, 1};

	if (c->side > 1) {
		gather(scratch, in, c->step, out.height, out.width);
		a = (struct linear_matrix){scratch, terms, 1};
	}
	linear_product(out.data, out.stride, c->bias, 0, a, b, pixels, c->out, terms);
	if (leak == 1)
		return;
#pragma omp parallel for schedule(static)
	for (size_t p = 0; p < pixels; p++) {
		float *x = out.data + p * out.stride;
		for (size_t k = 0; k < c->out; k++)
			x[k] = x[k] > 0 ? x[k] : leak * x[k];
	}
}

void conv_largest(struct conv_image out, struct conv_image in)
{
#pragma omp parallel for schedule(static)
	for (size_t y = 0; y < out.height; y++)
		for (size_t x = 0; x < out.width; x++) {
			float *most = out.data + (y * out.width + x) * out.stride;
			memcpy(most, in.data + (2 * y * in.width + 2 * x) * in.stride,
				in.channels * sizeof *most);
			for (size_t i = y ? 2 * y - 1 : 0; i < in.height && i < 2 * y + 2; i++)
				for (size_t j = x ? 2 * x - 1 : 0; j < in.width && j < 2 * x + 2; j++) {
					const float *from = in.data + (i * in.width + j) * in.stride;
					for (size_t k = 0; k < in.channels; k++)
						most[k] = from[k] > most[k] ? from[k] : most[k];
				}
		}
}

/* The two places of a line of `from` that place i of `to` lies between, and how near it is to the second. */
static float between(size_t i, size_t to, size_t from, size_t place[2])
{
	const float at = ((float)i + 0.5f) * (float)from / (float)to - 0.5f, inside = at > 0 ? at : 0;

	place[0] = (size_t)inside;
	place[1] = place[0] + 1 < from ? place[0] + 1 : from - 1;
	return inside - (float)place[0];
}

void conv_add_resized(struct conv_image out, struct conv_image in)
{
#pragma omp parallel for schedule(static)
	for (size_t y = 0; y < out.height; y++)
		for (size_t x = 0; x < out.width; x++) {
			size_t i[2], j[2];
			const float down = between(y, out.height, in.height, i),
				    right = between(x, out.width, in.width, j);
			const float *a = in.data + (i[0] * in.width + j[0]) * in.stride,
				    *b = in.data + (i[0] * in.width + j[1]) * in.stride,
				    *c = in.data + (i[1] * in.width + j[0]) * in.stride,
				    *d = in.data + (i[1] * in.width + j[1]) * in.stride;
			float *sum = out.data + (y * out.width + x) * out.stride;
			for (size_t k = 0; k < in.channels; k++) {
				const float above = a[k] + right * (b[k] - a[k]),
					    below = c[k] + right * (d[k] - c[k]);
				sum[k] += above + down * (below - above);
			}
		}
}
