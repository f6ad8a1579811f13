/* The innermost loops, built once for each instruction set. */
#pragma once

#include "base/cpu.h"
#include "splat/blend.h"
#include "splat/project.h"

#include <stddef.h>
#include <stdint.h>

/* A tile's list names its Gaussians in p, front to back. */
struct kernels {
	/* Projects n Gaussians; the same on every instruction set, to the bit. */
	void (*project)(const struct project_lens *lens, struct project_batch *b, int n);
	/* Blends up to BLEND_CHANNELS values, which stand at values[list[k] * channels]. */
	void (*values)(struct blend_tile *t, const struct projected *p, const uint32_t *list, size_t n,
		const float *values, int channels);
	/* Counts the weights of each pixel. */
	void (*counts)(struct blend_tile *t, const struct projected *p, const uint32_t *list, size_t n);
	/* The weights of block b alone, which ends it. The tile's list is kept in chunks (n/BLEND_CHUNK,
	 * rounded up) as far as any block needed it, *made of them; rows have room for n. */
	void (*rows)(struct blend_tile *t, const struct projected *p, const uint32_t *list, size_t n, int b,
		struct blend_chunk *chunks, size_t *made, struct blend_rows *rows);
	/* Puts 0 in place of the smallest weights of each pixel (of equal ones the farther) while what is out
	 * is at most `tolerance` of the pixel's sum, and then of those below `least`. Weights are at least
	 * 2^-29, and at most 1 in sum. dropped[l] gets the sum of what is out of lane l, at most 1, which
	 * bounds the error of a response: |dM| <= dropped max|m|. Rows that are empty then go. The same
	 * on every instruction set, to the bit. */
	void (*prune)(struct blend_rows *rows, double tolerance, float least, float dropped[BLEND_LANES]);
};

/* The kernels of a level; a level that the program was not built for gives plain ones. */
const struct kernels *kernels_of(enum cpu_level level);

extern const struct kernels kernels_plain, kernels_avx2, kernels_avx512;
