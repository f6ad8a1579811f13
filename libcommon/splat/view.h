/* What render_prepare makes; for the rasteriser and its tests. */
#ifndef SPLAT_VIEW_H
#define SPLAT_VIEW_H

#include "base/cpu.h"
#include "splat/project.h"
#include "splat/tile.h"

#include <stddef.h>

struct render_view {
	int width, height;
	size_t gaussians; /* N of the scene */
	size_t visible;
	struct projected *projected; /* (visible) front to back */
	struct tile_lists tiles;
	enum cpu_level level; /* of the kernels: this machine's, or a lower one */
};

#endif
