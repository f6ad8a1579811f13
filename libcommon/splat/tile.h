/* Which Gaussians touch which tile of 16x16 pixels. */
#pragma once

#include "base/err.h"
#include "splat/order.h"
#include "splat/project.h"

#include <stdint.h>

enum { TILE_SIZE = 16, TILE_PIXELS = TILE_SIZE * TILE_SIZE };

struct tile_grid {
	int width, height; /* pixels */
	int columns, rows; /* tiles, the last ones possibly cut by the image's edge */
};

struct tile_grid tile_grid(int width, int height);

/* The tiles of a Gaussian. Up to 2x2, as nearly all are: bits 0 to 11 the first tile row, 12 to 23 the first
 * column, and 24 to 27 which of the four there are, in rows. Else TILE_MANY and a place in tile_spans. */
enum { TILE_COLUMN_BIT = 12, TILE_MASK_BIT = 24 };
#define TILE_MANY 0x80000000u

/* Tiles first to last of a tile row; none where first > last. */
struct tile_span {
	uint16_t first, last;
};

/* Covers of some Gaussians, one after the other: the first tile row and how many, then their spans. */
struct tile_spans {
	struct tile_span *items;
	size_t n, capacity;
};

enum { TILE_BLOCK = 4096 }; /* Gaussians that share a tile_spans */

/* How many tallies there are for a grid: a tile's each, and some that stay 0, as neighbours of the last. */
static inline size_t tile_tallies(const struct tile_grid *g)
{
	return (size_t)g->columns * ((size_t)g->rows + 1) + 1;
}

/* *cover gets that of lane l of a batch: the tiles whose rectangle of pixel centres meets the ellipse a >=
 * 1/255. Adds 1 to tally[t] for each tile t of it, and to `spans` what it needs there. 0, or -1 with *e. */
int tile_cover(const struct tile_grid *g, const struct project_batch *b, int l, uint32_t *cover,
	struct tile_spans *spans, uint32_t *tally, struct err *e);

struct tile_lists {
	size_t *start; /* (columns*rows + 1), row-major: tile t has entries[start[t]] to entries[start[t+1]]
			*/
	uint32_t *entries;			 /* Gaussians, front to back */
	size_t start_capacity, entries_capacity; /* items that the arrays have room for */
};

/* Fills the lists with the n Gaussians of `order`; what they held is lost. covers (Gaussians of the scene),
 * spans (one for each TILE_BLOCK of them), and tallies (tally_count,tile_tallies), whose sum is the length of
 * each list. Returns 0, or -1 with *e set. */
int tile_bin(struct tile_lists *t, const struct tile_grid *g, const struct order_item *order, size_t n,
	const uint32_t *covers, const struct tile_spans *spans, const uint32_t *tallies, int tally_count,
	struct err *e);
void tile_free(struct tile_lists *t);
