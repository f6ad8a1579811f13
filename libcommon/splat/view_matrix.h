/* A view's blend weights in whichever of two forms they come. */
#pragma once

#include "splat/view_tiles.h"
#include "splat/view_weights.h"

struct view_matrix {
	int height, width; /* of the picture, P pixels */
	size_t gaussians;
	struct view_weights rows;	/* by pixels: rows.pixels is P */
	const struct view_tiles *tiles; /* by tiles, and rows have nothing; else NULL */
};
