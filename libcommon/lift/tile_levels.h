/* A view's weights by tiles, made ready to be summed over masks: levels in place of their differences, where
 * those of each entry begin, and the sum of them. */
#pragma once

#include "base/err.h"
#include "splat/view_tiles.h"

#include <stddef.h>
#include <stdint.h>

struct tile_levels {
	const struct view_tiles *tiles;
	size_t *begin;	 /* (entries) */
	uint8_t *levels; /* weights in 1/255 */
	uint16_t *total; /* (entries) at most 64 times 255 */
};

/* Returns 0, or -1 with *e set for want of memory and nothing to free. */
int tile_levels_make(struct tile_levels *l, const struct view_tiles *t, struct err *e);
void tile_levels_free(struct tile_levels *l);

/* The sum over the pixels of a tile that have a bit, of an entry's levels. */
static inline uint32_t tile_levels_sum(const struct tile_levels *l, size_t entry, uint64_t bits)
{
	const uint64_t map = view_tiles_map(l->tiles, entry);
	uint32_t sum = 0;

	if (!(map & bits))
		return 0;
	if (!(map & ~bits))
		return l->total[entry];
	const uint8_t *level = l->levels + l->begin[entry];
	for (uint64_t left = map; left; left &= left - 1)
		sum += *level++ & -(uint32_t)(bits >> __builtin_ctzll(left) & 1);
	return sum;
}
