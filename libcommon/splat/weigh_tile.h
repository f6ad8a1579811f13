/* The weights of a tile, one block of its pixels (splat/blend.h) after another. */
#pragma once

#include "base/err.h"
#include "splat/blend.h"
#include "splat/place.h"
#include "splat/render.h"

/* One thread's, zeroed before its first tile; its memory serves one tile after the other. */
struct weigh_tile {
	struct blend_tile pixels;   /* what is left in blocks that are done */
	float dropped[TILE_PIXELS]; /* of them, by blend_place */
	struct place at;	    /* of the tile in the picture */
	const struct render_view *view;
	const uint32_t *list; /* (n) its Gaussians */
	size_t n, made;
	struct blend_chunk *chunks;
	struct blend_rows rows;
	size_t chunks_room, weights_room, places_room, lanes_room;
};

/* Tile k of the view. Returns 0, or -1 with *e set; free after either. */
int weigh_tile_start(struct weigh_tile *t, const struct render_view *v, size_t k, struct err *e);
void weigh_tile_free(struct weigh_tile *t);

/* The weights of block b in t->rows, without what the limits leave out. Returns how many there are: those of
 * a pixel are one in each row where it has not 0. */
size_t weigh_tile_block(struct weigh_tile *t, int b, const struct render_limits *limits);
