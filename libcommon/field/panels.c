#include "field/panels.h"

#include <string.h>

enum { L = BLOCK_LANES };

size_t panels_padded(size_t gaussians)
{
	return (gaussians + BLOCK_SIZE - 1) / BLOCK_SIZE * BLOCK_SIZE;
}

void panels_pack(const float *x, size_t gaussians, int channels, float *panels)
{
	memset(panels, 0, sizeof *panels * panels_padded(gaussians) * (size_t)channels);
	for (size_t i = 0; i < gaussians; i++)
		for (int c = 0; c < channels; c++)
			panels[panels_index(i, channels, c)] = x[i * (size_t)channels + (size_t)c];
}

void panels_unpack(const float *panels, size_t gaussians, int channels, float *x)
{
	for (size_t i = 0; i < gaussians; i++)
		for (int c = 0; c < channels; c++)
			x[i * (size_t)channels + (size_t)c] = panels[panels_index(i, channels, c)];
}

void panels_get(const float *panels, size_t padded, int channels, int c, float *out)
{
	for (size_t i = 0; i < padded; i += L)
		memcpy(out + i, panels + panels_index(i, channels, c), sizeof(float) * L);
}

void panels_put(float *panels, size_t padded, int channels, int c, const float *in)
{
	for (size_t i = 0; i < padded; i += L)
		memcpy(panels + panels_index(i, channels, c), in + i, sizeof(float) * L);
}
