/* Which Gaussians touch which tile of 16x16 pixels. */
#ifndef SPLAT_TILE_H
#define SPLAT_TILE_H

#include "base/err.h"
#include "splat/project.h"

#include <stdint.h>

enum { TILE_SIZE = 16, TILE_PIXELS = TILE_SIZE * TILE_SIZE };

struct tile_lists {
	int columns, rows; /* tiles, the last ones possibly cut by the image's edge */
	size_t *start; /* (columns*rows + 1), row-major: tile t has entries[start[t]] to entries[start[t+1]]
			*/
	uint32_t *entries; /* positions in the projected Gaussians, rising: front to back */
};

/* A Gaussian is in a tile's list when its ellipse a >= 1/255 meets the rectangle spanned by the tile's pixel
 * centres. Returns 0, or -1 with *e set and nothing to free. */
int tile_build(
	struct tile_lists *t, const struct projected *p, size_t n, int width, int height, struct err *e);
void tile_free(struct tile_lists *t);

#endif
