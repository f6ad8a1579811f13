/* A view's blend weights by tiles of pixels, as a packed file has them (formats/scene/weights.md): what needs
 * a pass over them and no rows of pixels is spared those, which take five times the memory. */
#pragma once

#include <stddef.h>
#include <stdint.h>

enum { VIEW_TILE = 8, VIEW_TILE_PIXELS = VIEW_TILE * VIEW_TILE };

/* The picture is cut into across x down tiles of 8x8 pixels, the last ones possibly cut by its edge. An entry
 * is a Gaussian in a tile; those of a tile have rising ids. */
struct view_tiles {
	int width, height, across, down;
	size_t *begin;	     /* (across*down + 1) row-major: where the entries of each tile begin */
	int32_t *ids;	     /* (entries) Gaussians */
	uint8_t *maps;	     /* (entries,8) see view_tiles_map */
	size_t *level_begin; /* (down + 1) where the levels of each row of tiles begin */
	uint8_t *levels; /* for each bit of each map the weight in 1/255, less that of the entry's bit before,
			    mod 256 */
};

/* Bit i: the entry has a weight in pixel i of its tile, in its column i mod 8 and row i / 8. */
static inline uint64_t view_tiles_map(const struct view_tiles *t, size_t entry)
{
	const uint8_t *byte = t->maps + 8 * entry;
	uint64_t map = 0;

	for (int k = 0; k < 8; k++)
		map |= (uint64_t)byte[k] << 8 * k;
	return map;
}

/* What each level is, and where each pixel of a tile is from the tile's first one, in the picture: looked up,
 * as a division costs more than all else that a weight takes. */
struct view_tiles_lookup {
	float weight[256];
	int64_t pixel[VIEW_TILE_PIXELS];
};

/* image (VIEW_GROUP,P) = W m (N,VIEW_GROUP), to the bit what view_blend_group makes of rows of pixels in
 * which the Gaussians rise. */
void view_tiles_blend_group(const struct view_tiles *t, const float *m, float *image);

void view_tiles_lookup_make(struct view_tiles_lookup *l, const struct view_tiles *t);

void view_tiles_free(struct view_tiles *t);
