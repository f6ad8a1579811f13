#include "mask/overlay.h"

#include <stddef.h>

/* Whether the pixels within `reach` of (row,column) along both axes all have its value. */
static int is_inner(const uint8_t *mask, int height, int width, int row, int column, int reach)
{
	const uint8_t own = mask[(size_t)row * (size_t)width + (size_t)column];

	for (int d = -reach; d <= reach; d++) {
		int r = row + d, c = column + d;
		if (r >= 0 && r < height && mask[(size_t)r * (size_t)width + (size_t)column] != own)
			return 0;
		if (c >= 0 && c < width && mask[(size_t)row * (size_t)width + (size_t)c] != own)
			return 0;
	}
	return 1;
}

void overlay_draw(uint8_t *rgb, const uint8_t *mask, int height, int width)
{
	static const int tint[3] = {255, 64, 32}, line[3] = {255, 235, 0};
	const int reach = (height > width ? height : width) / 600 + 1;

#pragma omp parallel for schedule(static)
	for (int row = 0; row < height; row++)
		for (int column = 0; column < width; column++) {
			const size_t at = (size_t)row * (size_t)width + (size_t)column;
			const int is_edge = mask[at] && !is_inner(mask, height, width, row, column, reach);
			for (int c = 0; c < 3; c++) {
				uint8_t *p = &rgb[3 * at + (size_t)c];
				if (is_edge)
					*p = (uint8_t)line[c];
				else if (mask[at])
					*p = (uint8_t)((*p * 6 + tint[c] * 4) / 10);
				else
					*p = (uint8_t)((*p * 7 + 255 * 2) / 9);
			}
		}
}
