#include "fit/photograph.h"

#include "base/mem.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

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

/* Each pixel becomes the mean over its area. */
static int shrink(
	const uint8_t *rgb, int height, int width, uint8_t *to, int rows, int columns, struct err *e)
{
	const size_t n = 3 * (size_t)columns;
	float *sums = mem_alloc(n, sizeof *sums, "photograph", e);
	const double step = (double)height / rows;

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
	free(sums);
	return sums ? 0 : -1;
}

int photograph_make(struct photograph *p, const struct camera *c, double scale, const uint8_t *rgb,
	int height, int width, struct err *e)
{
	*p = (struct photograph){0};
	scale = fmin(scale, (double)width / c->width);
	for (int k = 0; k < FIT_LEVELS; k++) {
		int w, h;
		camera_scaled_size(c, scale / (1 << k), &w, &h);
		p->camera[k] = camera_resize(c, w, h);
		p->rgb[k] = mem_alloc((size_t)w * (size_t)h, 3, "photograph", e);
		if (!p->rgb[k] || shrink(rgb, height, width, p->rgb[k], h, w, e)) {
			photograph_free(p);
			return -1;
		}
	}
	return 0;
}

int photograph_ignore(struct photograph *p, const uint8_t *mask, int height, int width, struct err *e)
{
	for (int k = 0; k < FIT_LEVELS; k++) {
		const size_t h = (size_t)p->camera[k].height, w = (size_t)p->camera[k].width;
		uint8_t *to = p->ignored[k] = mem_zalloc(h * w, 1, "mask", e);
		if (!to)
			return -1;
		/* each of the larger in turn, so that none is left out between */
		const size_t rows = h > (size_t)height ? h : (size_t)height,
			     columns = w > (size_t)width ? w : (size_t)width;
		for (size_t y = 0; y < rows; y++)
			for (size_t x = 0; x < columns; x++)
				to[y * h / rows * w + x * w / columns] |=
					mask[y * (size_t)height / rows * (size_t)width +
						x * (size_t)width / columns] != 0;
	}
	return 0;
}

void photograph_free(struct photograph *p)
{
	for (int k = 0; k < FIT_LEVELS; k++) {
		free(p->rgb[k]);
		free(p->ignored[k]);
	}
	*p = (struct photograph){0};
}
