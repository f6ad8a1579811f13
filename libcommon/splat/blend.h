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

/* One Gaussian in one tile. */
struct blend_splat {
	float u, v;	     /* at the tile's centre */
	float l11, l21, l22; /* what they change by from there, a pixel */
	float log_opacity;
};

struct blend_chunk {
	struct blend_splat splats[BLEND_CHUNK];
	uint16_t blocks[BLEND_CHUNK] __attribute__((aligned(64))); /* bit b: it may meet block b */
};

/* The weights of one block: a row for each Gaussian that has any, front to back; 0 where it has none. */
enum { BLEND_ROWS_MORE = 4 }; /* rows that there is room for behind the last */
struct blend_rows {
	float (*weights)[BLEND_LANES]; /* (n + BLEND_ROWS_MORE) aligned to 64 bytes */
	uint32_t *places;	       /* (n + 1) where they stand in the tile's list */
	uint16_t *lanes;	       /* (n + 1) bit l: lane l has a weight */
	size_t n;
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
