#include "pack_whole.h"

#include "base/mem.h"

#include <stdlib.h>

int pack_whole(struct weights_pack *p, int width, int height, size_t gaussians, const int64_t *indptr,
	const int32_t *index, const float *weight, struct err *e)
{
	const int count = (height + VIEW_TILE - 1) / VIEW_TILE;
	struct weights_pack *rows = mem_zalloc((size_t)count, sizeof *rows, "rows", e);
	struct weights_packer packer;
	int bad = weights_packer_make(&packer, gaussians, e);

	for (int r = 0; r < count && !bad; r++) {
		const int top = r * VIEW_TILE, left = height - top;
		const struct weights_picture picture = {width, left < VIEW_TILE ? left : VIEW_TILE,
			indptr + (size_t)top * (size_t)width, index, weight};
		bad = weights_pack_part(&rows[r], &packer, &picture, e);
	}
	*p = (struct weights_pack){0};
	bad = bad || weights_pack_join(p, rows, count, e);
	for (int r = 0; r < count; r++)
		weights_pack_free(&rows[r]);
	weights_packer_free(&packer);
	free(rows);
	return bad;
}
