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
	/* Counts and records them, as far as the records have room. Returns how many of the n are done; n
	 * also when every pixel has ended. */
	size_t (*weights)(struct blend_tile *t, const struct projected *p, const uint32_t *list, size_t n,
		struct blend_records *records);
};

/* The kernels of a level; a level that the program was not built for gives plain ones. */
const struct kernels *kernels_of(enum cpu_level level);

extern const struct kernels kernels_plain, kernels_avx2, kernels_avx512;
