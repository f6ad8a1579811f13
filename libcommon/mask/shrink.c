#include "mask/shrink.h"

#include "base/mem.h"

#include <math.h>

/* Adds `share` of a row, shrunk to `to` pixels, to sums (to,3): each the mean over its part of the row. */
static void add_row(const uint8_t *row, int from, float *sums, int to, float share)
{
	const double step = (double)from / to;

	for (int x = 0; x < to; x++) {
		const double left = x * step, right = (x + 1) * step;
		for (int i = (int)left; i < from && i < right; i++) {
			const double begin = i > left ? i : left, end = i + 1 < right ? i + 1 : right;
			const float part = share * (float)((end - begin) / step);
			for (int k = 0; k < 3; k++)
				sums[3 * x + k] += part * row[3 * i + k];
		}
	}
}

uint8_t *shrink_picture(const uint8_t *rgb, int height, int width, int rows, int columns, struct err *e)
{
	const size_t n = 3 * (size_t)columns;
	const double step = (double)height / rows;
	uint8_t *to = mem_alloc((size_t)rows, n, "picture", e);
	SCOPED float *sums = to ? mem_alloc(n, sizeof *sums, "picture", e) : NULL;

	for (int y = 0; y < rows && sums; y++) {
		const double top = y * step, bottom = (y + 1) * step;
		memset(sums, 0, n * sizeof *sums);
		for (int i = (int)top; i < height && i < bottom; i++) {
			const double begin = i > top ? i : top, end = i + 1 < bottom ? i + 1 : bottom;
			add_row(rgb + 3 * (size_t)i * (size_t)width, width, sums, columns,
				(float)((end - begin) / step));
		}
		for (size_t k = 0; k < n; k++)
			to[(size_t)y * n + k] = (uint8_t)fminf(255, sums[k] + 0.5f);
	}
	if (!sums) {
		free(to);
		return NULL;
	}
	return to;
}
