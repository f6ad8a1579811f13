#include "synth/outline.h"

#include "base/mem.h"
#include "geom/vector.h"

#include <math.h>

struct box {
	int top, left, height, width;
};

size_t synth_outline_area(const uint8_t *mask, size_t pixels)
{
	size_t area = 0;

	for (size_t p = 0; p < pixels; p++)
		area += mask[p] != 0;
	return area;
}

/* The smallest box that holds the mask, widened by `margin` in the image; height 0: empty. */
static struct box bounds(const uint8_t *mask, int height, int width, int margin)
{
	int top = height, bottom = -1, left = width, right = -1;

	for (int i = 0; i < height; i++)
		for (int j = 0; j < width; j++)
			if (mask[(size_t)i * (size_t)width + (size_t)j]) {
				top = i < top ? i : top;
				bottom = i;
				left = j < left ? j : left;
				right = j > right ? j : right;
			}
	if (bottom < 0)
		return (struct box){0};
	top = top > margin ? top - margin : 0;
	left = left > margin ? left - margin : 0;
	bottom = bottom + margin < height ? bottom + margin : height - 1;
	right = right + margin < width ? right + margin : width - 1;
	return (struct box){top, left, bottom - top + 1, right - left + 1};
}

/* Mean over 2 radius + 1 items of a line; what lies outside counts as its last item. */
static void blur_line(float *line, float *copy, int n, size_t stride, int radius)
{
	double sum = 0;

	for (int i = 0; i < n; i++)
		copy[i] = line[(size_t)i * stride];
	for (int i = -radius; i <= radius; i++)
		sum += copy[i < 0 ? 0 : i < n ? i : n - 1];
	for (int i = 0; i < n; i++) {
		line[(size_t)i * stride] = (float)(sum / (2 * radius + 1));
		int in = i + radius + 1, out = i - radius;
		sum += copy[in < n ? in : n - 1] - copy[out > 0 ? out : 0];
	}
}

int synth_outline_rag(uint8_t *mask, int height, int width, double rag, double shrink,
	const struct synth_noise *noise, struct rng *r, struct err *e)
{
	size_t area = synth_outline_area(mask, (size_t)height * (size_t)width);
	int radius = (int)fmax(1, round(0.04 * sqrt((double)area)));
	struct box b = bounds(mask, height, width, 2 * radius + 1);
	double cell = fmax(2, 0.12 * sqrt((double)area));
	double x = rng_range(r, 0, SYNTH_NOISE_PERIOD), y = rng_range(r, 0, SYNTH_NOISE_PERIOD);

	if (!area)
		return 0;
	size_t h = (size_t)b.height, w = (size_t)b.width;
	SCOPED float *soft = mem_alloc(h * w, sizeof *soft, "soft mask", e);
	SCOPED float *line = mem_alloc(h + w, sizeof *line, "mask line", e);
	if (!soft || !line)
		return -1;
	for (size_t i = 0; i < h; i++)
		for (size_t j = 0; j < w; j++)
			soft[i * w + j] =
				mask[((size_t)b.top + i) * (size_t)width + (size_t)b.left + j] ? 1 : 0;
	for (int pass = 0; pass < 2; pass++) {
		for (size_t i = 0; i < h; i++)
			blur_line(soft + i * w, line, b.width, 1, radius);
		for (size_t j = 0; j < w; j++)
			blur_line(soft + j, line, b.height, w, radius);
	}
	for (size_t i = 0; i < h; i++)
		for (size_t j = 0; j < w; j++) {
			double shaken = synth_noise_at(noise, x + (double)j / cell, y + (double)i / cell) +
					0.5 * synth_noise_at(noise, y + 3 * (double)j / cell,
						      x + 3 * (double)i / cell);
			mask[((size_t)b.top + i) * (size_t)width + (size_t)b.left + j] =
				soft[i * w + j] > 0.5 + shrink + rag * shaken;
		}
	return 0;
}

void synth_outline_cut(uint8_t *mask, int height, int width, double share, struct rng *r)
{
	double turn = rng_range(r, 0, 2 * PI), c = cos(turn), s = sin(turn), low = INFINITY, high = -INFINITY;
	struct box b = bounds(mask, height, width, 0);
	size_t area = synth_outline_area(mask, (size_t)height * (size_t)width);

	for (int i = b.top; i < b.top + b.height; i++)
		for (int j = b.left; j < b.left + b.width; j++)
			if (mask[(size_t)i * (size_t)width + (size_t)j]) {
				low = fmin(low, c * j + s * i);
				high = fmax(high, c * j + s * i);
			}
	/* The line that leaves the share, by bisection. */
	for (int step = 0; step < 20 && area; step++) {
		double at = (low + high) / 2;
		size_t kept = 0;
		for (int i = b.top; i < b.top + b.height; i++)
			for (int j = b.left; j < b.left + b.width; j++)
				kept += mask[(size_t)i * (size_t)width + (size_t)j] && c * j + s * i < at;
		if ((double)kept < share * (double)area)
			low = at;
		else
			high = at;
	}
	for (int i = b.top; i < b.top + b.height; i++)
		for (int j = b.left; j < b.left + b.width; j++)
			if (c * j + s * i >= high)
				mask[(size_t)i * (size_t)width + (size_t)j] = 0;
}
