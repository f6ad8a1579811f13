/* How well boxes in space match true ones: the figures of 3D grounding (Chen et al. 2020, ScanRefer: the
 * share of sentences whose box has an IoU of 0.25, or of 0.5, with the true one). */
#pragma once

#include "geom/box.h"

#include <stddef.h>

/* A true box along the world's axes, the same turned, and what was said of it. */
struct box_pair {
	const char *name; /* of the object */
	int is_missing;	  /* nobody said anything */
	int is_empty;	  /* said to be nowhere */
	struct box aligned, turned, true_aligned, true_turned;
};

/* Means; a missing or empty box has an IoU of 0. */
struct box_figures {
	double iou, p25, p50; /* shares of IoU >= 0.25 and >= 0.5 */
};

struct box_score {
	size_t pairs, missing, empty;
	struct box_figures aligned, turned;
	/* Means over the pairs with a box (NAN without any): from centre to centre of the aligned boxes, in
	 * units of the world, and over the true box's diagonal. */
	double distance, relative;
};

/* Sums in the order of the pairs. All 0 but for distance and relative where n is 0. */
void box_score_sum(struct box_score *s, const struct box_pair *pairs, size_t n);
