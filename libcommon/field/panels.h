/* Arrays over Gaussians in panels, as the kernels of field/block.h read them: channel c of Gaussian i is at
 * array[(i / 64) * channels * 64 + c * 64 + i % 64], and N is padded with zeros to whole blocks. */
#pragma once

#include "field/block.h"

#include <stddef.h>

/* Where channel c of Gaussian i is. */
static inline size_t panels_index(size_t i, int channels, int c)
{
	return i / BLOCK_LANES * (size_t)channels * BLOCK_LANES + (size_t)c * BLOCK_LANES + i % BLOCK_LANES;
}

/* N padded. */
size_t panels_padded(size_t gaussians);

/* x (N,channels) row-major to panels of panels_padded(N), and back. */
void panels_pack(const float *x, size_t gaussians, int channels, float *panels);
void panels_unpack(const float *panels, size_t gaussians, int channels, float *x);

/* One channel of panels of `padded` Gaussians: to `out`, or from `in` (padded). */
void panels_get(const float *panels, size_t padded, int channels, int c, float *out);
void panels_put(float *panels, size_t padded, int channels, int c, const float *in);
