#include "splat/blend.h"

#include <math.h>
#include <string.h>

const struct blend_kernels *blend_kernels(enum cpu_level level)
{
#if defined __x86_64__
	if (level == CPU_AVX512)
		return &blend_avx512;
	if (level == CPU_AVX2)
		return &blend_avx2;
#else
	(void)level;
#endif
	return &blend_plain;
}

void blend_start(struct blend_tile *t, int x0, int y0, int columns, int rows)
{
	memset(t, 0, sizeof *t);
	for (int i = 0; i < TILE_PIXELS; i++) {
		t->transmittance[i] = 1;
		t->cut[i] = INFINITY;
	}
	for (int y = 0; y < rows; y++)
		for (int x = 0; x < columns; x++) {
			int at = blend_place(x, y);
			t->cut[at] = BLEND_ALPHA_MIN_LOG2;
			t->live |= 1u << at / BLEND_LANES;
		}
	t->x = x0 + TILE_SIZE / 2;
	t->y = y0 + TILE_SIZE / 2;
}
