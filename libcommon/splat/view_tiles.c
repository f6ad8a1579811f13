#include "splat/view_tiles.h"

#include <stdlib.h>

void view_tiles_lookup_make(struct view_tiles_lookup *l, const struct view_tiles *t)
{
	for (int k = 0; k < 256; k++)
		l->weight[k] = (float)k / 255;
	for (int i = 0; i < VIEW_TILE_PIXELS; i++)
		l->pixel[i] = (int64_t)(i / VIEW_TILE) * t->width + i % VIEW_TILE;
}

void view_tiles_free(struct view_tiles *t)
{
	free(t->begin);
	free(t->ids);
	free(t->maps);
	free(t->level_begin);
	free(t->levels);
	*t = (struct view_tiles){0};
}
