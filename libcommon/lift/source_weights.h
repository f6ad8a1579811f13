/* A view's blend weights by Gaussian and source: what is lifted comes from sources, which are a feature map's
 * cells, a picture's segments or its labels, and the pixels of one source are all the same to a Gaussian. So
 * S_is = sum of w_pi over the pixels p of source s is all that a view has to say, in as many numbers as
 * Gaussians touch sources, and each feature is added to a Gaussian once. */
#pragma once

#include "base/err.h"
#include "splat/view_weights.h"

#include <stdint.h>

struct source_weights {
	size_t gaussians;
	/* Gaussian i has the items indptr[i] to indptr[i+1] of the next two */
	int64_t *indptr; /* (N+1) */
	int32_t *source; /* rising within a Gaussian */
	float *weight;	 /* S_is, added in the order of the pixels */

	/* room that views share */
	size_t room, gaussian_room, source_room, pixel_room;
	int32_t *last;	/* (N) the source that a Gaussian was seen in last */
	int64_t *start; /* (sources+1) */
	int32_t *order; /* (P) pixels by source */
};

/* Of a zeroed struct, or of one that has another view. source (P) is below `sources`, or SOURCE_NONE where a
 * pixel has none. The same for any number of threads. Returns 0, or -1 with *e set for want of memory;
 * source_weights_free in any case. */
enum { SOURCE_NONE = -1 };
int source_weights_make(struct source_weights *s, const struct view_weights *w, const int32_t *source,
	size_t sources, struct err *e);
void source_weights_free(struct source_weights *s);

/* to (height,width) gets for each pixel the cell of a map (map_height,map_width) that has its centre: row
 * floor((i + 1/2) map_height / height), and the column alike; -1 is never given. */
void source_cells(int32_t *to, int height, int width, size_t map_height, size_t map_width);
