/* The state of a tile while it is blended; the loops over it are in blend_kernel.h. */
#pragma once

#include "splat/tile.h"

#include <stddef.h>
#include <stdint.h>

enum {
	BLEND_CHANNELS = 16, /* the most that one pass blends */
	BLEND_SIDE = 4,	     /* a tile is 4x4 blocks of 4x4 pixels */
	BLEND_BLOCKS = 16,
	BLEND_LANES = 16,
	BLEND_CHUNK = 64, /* Gaussians whose blocks are found before any is blended */
};

#define BLEND_ALPHA_MAX 0.99f
#define BLEND_ALPHA_MIN_LOG2 (-7.99435344f) /* log2(1/255) */
#define BLEND_STOP 1e-4f /* a Gaussian that would bring T below this ends the pixel instead */

/* State of a tile's pixels, block by block (blend_place). */
struct blend_tile {
	float transmittance[TILE_PIXELS];
	float lit[TILE_PIXELS]; /* the same, 0 where the pixel has ended or lies outside the image */
	float sum[BLEND_CHANNELS][TILE_PIXELS]; /* blended values */
	int32_t count[TILE_PIXELS];		/* weights */
	double x, y;				/* the tile's centre, pixels */
	uint32_t live;				/* bit b: some pixel of block b has not ended */
};

/* Weights in the order they are made: one record is a Gaussian's in one block of a tile. */
struct blend_record {
	int32_t index;
	uint16_t block;
	uint16_t lanes; /* bit l: pixel l of the block has a weight */
};

struct blend_records {
	struct blend_record *items;
	size_t count, capacity;
	float *weights; /* of all records in order, of each record by rising lane */
	size_t weight_count, weight_capacity;
};

/* The room that a chunk may need: weights are stored by whole blocks. */
enum {
	BLEND_RECORD_ROOM = BLEND_CHUNK * BLEND_BLOCKS,
	BLEND_WEIGHT_ROOM = BLEND_CHUNK * TILE_PIXELS + BLEND_LANES
};

/* Where the arrays of blend_tile hold the pixel at column x and row y of the tile. */
static inline int blend_place(int x, int y)
{
	return (y / BLEND_SIDE * BLEND_SIDE + x / BLEND_SIDE) * BLEND_LANES + y % BLEND_SIDE * BLEND_SIDE +
	       x % BLEND_SIDE;
}

/* Starts a tile of which `columns` x `rows` pixels lie in the image; (x0, y0) is its corner. Of the sums only
 * those of `channels` channels are set. */
void blend_start(struct blend_tile *t, int x0, int y0, int columns, int rows, int channels);
