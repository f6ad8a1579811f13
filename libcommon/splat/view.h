/* What render_prepare makes; for the rasteriser, its way back in training (fit), and tests. */
#pragma once

#include "base/cpu.h"
#include "splat/order.h"
#include "splat/project.h"
#include "splat/tile.h"
#include "splat/wanted.h"

#include <stddef.h>

struct render_view {
	enum cpu_level level; /* of the kernels: this machine's, or a lower one */
	size_t gaussians;     /* N of the scene */
	size_t visible;
	struct tile_grid grid;
	struct wanted wanted;		 /* tiles; the lists of others may lack Gaussians */
	struct projected *projected;	 /* (N), those that are visible */
	const struct order_item *sorted; /* (visible) front to back */
	struct tile_lists tiles;

	/* how the lists are made, kept for the next camera: items that there is room for, then what for */
	size_t gaussian_room, block_room, tally_room;
	struct order_item *order; /* (2,N) */
	uint32_t *covers;	  /* (N), those that are visible */
	struct tile_spans *spans; /* (blocks) */
	size_t *found;		  /* (blocks) how many are visible */
	uint32_t *tallies;	  /* (threads,tile_tallies) */
};
