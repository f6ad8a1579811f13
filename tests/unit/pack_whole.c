#include "pack_whole.h"

#include "base/mem.h"

#include <stdlib.h>

/* The tile whose corner is at column x and row y. */
static int pack_tile(struct weights_packer *packer, int x, int y, int width, int height, size_t gaussians,
	const int64_t *indptr, const int32_t *index, const float *weight, struct weights_pack *row,
	struct err *e)
{
	if (weights_packer_start(packer, gaussians, e))
		return -1;
	for (int i = 0; i < VIEW_TILE_PIXELS; i++) {
		const int column = x + i % VIEW_TILE, line = y + i / VIEW_TILE;
		const int64_t at = (int64_t)line * width + column;
		for (int64_t k = column < width && line < height ? indptr[at] : 0;
			column < width && line < height && k < indptr[at + 1]; k++) {
			const uint8_t level = (uint8_t)(weight[k] * 255 + 0.5F);
			if (level)
				weights_packer_levels(packer, (size_t)index[k], (uint32_t)index[k])[i] =
					level;
		}
	}
	return weights_packer_end(packer, gaussians, row, e);
}

int pack_whole(struct weights_pack *p, int width, int height, size_t gaussians, const int64_t *indptr,
	const int32_t *index, const float *weight, struct err *e)
{
	const int count = (height + VIEW_TILE - 1) / VIEW_TILE;
	struct weights_pack *rows = mem_zalloc((size_t)count, sizeof *rows, "rows", e);
	struct weights_packer packer = {0};
	int bad = 0;

	for (int r = 0; r < count; r++)
		for (int x = 0; x < width && !bad; x += VIEW_TILE)
			bad = pack_tile(&packer, x, r * VIEW_TILE, width, height, gaussians, indptr, index,
				weight, &rows[r], e);
	*p = (struct weights_pack){0};
	bad = bad || weights_pack_join(p, rows, count, e);
	for (int r = 0; r < count; r++)
		weights_pack_free(&rows[r]);
	weights_packer_free(&packer);
	free(rows);
	return bad;
}
