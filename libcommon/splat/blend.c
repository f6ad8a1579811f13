#include "splat/blend.h"

#include <string.h>

void blend_start(struct blend_tile *t, int x0, int y0, int columns, int rows, int channels)
{
	for (int i = 0; i < TILE_PIXELS; i++) {
		t->transmittance[i] = 1;
		t->lit[i] = 0;
		t->count[i] = 0;
	}
	memset(t->sum, 0, (size_t)channels * sizeof t->sum[0]);
	t->live = 0;
	for (int y = 0; y < rows; y++)
		for (int x = 0; x < columns; x++) {
			int at = blend_place(x, y);
			t->lit[at] = 1;
			t->live |= 1u << at / BLEND_LANES;
		}
	t->x = x0 + TILE_SIZE / 2;
	t->y = y0 + TILE_SIZE / 2;
}
