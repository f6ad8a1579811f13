/* Which tiles of a view are wanted: those that Gaussians of a kind may show in. */
#pragma once

#include "base/err.h"
#include "splat/kernels.h"
#include "splat/project.h"
#include "splat/splats.h"
#include "splat/tile.h"

#include <stdint.h>

struct wanted {
	/* (columns+1,rows+1) wanted tiles above and left of a corner, row-major; unused where is_all */
	uint32_t *sums;
	size_t room;
	int is_all;
	/* a Gaussian reaches no farther in x and in y than this times its largest scale over z */
	double reach[2];
};

/* Tiles that the Gaussians with is_wanted[i] (N) may show in; NULL: all tiles. 0, or -1 with *e. */
int wanted_find(struct wanted *w, const struct tile_grid *g, const struct splats *s,
	const struct project_lens *lens, const struct kernels *kernels, const uint8_t *is_wanted,
	struct err *e);
void wanted_free(struct wanted *w);

/* Whether tile k is. */
int wanted_tile(const struct wanted *w, const struct tile_grid *g, size_t k);
/* Whether lane l of a batch may show in one. */
int wanted_lane(const struct wanted *w, const struct tile_grid *g, const struct project_batch *b, int l);
/* Whether Gaussian i may: 1 also for many that do not, much faster than projecting. */
int wanted_reach(const struct wanted *w, const struct tile_grid *g, const struct splats *s,
	const struct project_lens *lens, size_t i);
