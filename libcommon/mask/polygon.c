#include "mask/polygon.h"

#include <math.h>

/* The rows whose middle an edge passes get a flip at the first pixel whose centre is right of it. */
static void flip_edge(uint8_t *flips, int height, int width, const double *a, const double *b)
{
	const double *low = a[1] < b[1] ? a : b, *high = low == a ? b : a;
	const double first = ceil(low[1] - 0.5), last = ceil(high[1] - 0.5);

	for (int y = first > 0 ? (first < height ? (int)first : height) : 0; y < height && y < last; y++) {
		const double share = (y + 0.5 - low[1]) / (high[1] - low[1]);
		const double x = ceil(low[0] + share * (high[0] - low[0]) - 0.5);
		if (x < width)
			flips[(size_t)y * (size_t)width + (x > 0 ? (size_t)x : 0)] ^= 1;
	}
}

void polygon_fill(uint8_t *mask, uint8_t *flips, int height, int width, const double *points, size_t n)
{
	for (size_t i = 0; i < n; i++)
		flip_edge(flips, height, width, points + 2 * i, points + 2 * ((i + 1) % n));
	for (int y = 0; y < height; y++) {
		uint8_t inside = 0;
		for (size_t at = (size_t)y * (size_t)width, end = at + (size_t)width; at < end; at++) {
			inside ^= flips[at];
			flips[at] = 0;
			mask[at] |= inside;
		}
	}
}
