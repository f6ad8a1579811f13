#include "mask_help.h"

#include "base/mem.h"

#include <stdio.h>
#include <stdlib.h>

uint8_t *mask_random(struct rng *r, int height, int width, int kind)
{
	struct err e;
	uint8_t *m = mem_zalloc((size_t)height * (size_t)width, 1, "test", &e);
	double p = rng_uniform(r);
	int blobs = kind == 1 ? 1 + (int)rng_below(r, 4) : 0;

	if (!m)
		abort();
	for (int i = 0; i < height * width; i++)
		m[i] = kind == 0 ? rng_uniform(r) < p : kind == 3 ? 1 : kind == 4 ? i % 3 == 0 : 0;
	for (int b = 0; b < blobs; b++) {
		double y0 = rng_range(r, 0, height), x0 = rng_range(r, 0, width);
		double radius = rng_range(r, 0, 0.6 * (height < width ? height : width) + 1);
		for (int y = 0; y < height; y++)
			for (int x = 0; x < width; x++)
				m[y * width + x] |=
					(y - y0) * (y - y0) + (x - x0) * (x - x0) < radius * radius;
	}
	return m;
}

struct rle mask_rle(const uint8_t *pixels, int height, int width)
{
	struct rle r;
	struct err e;

	if (rle_encode(&r, pixels, height, width, &e)) {
		fprintf(stderr, "%s\n", e.message);
		abort();
	}
	return r;
}
