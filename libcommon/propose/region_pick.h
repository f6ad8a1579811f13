/* A thing that a person points at: the regions of a tree that clicks mean.
 *
 * The first click means a region that has its pixel: the one with the largest score, less so the more of the
 * view it covers, and a larger or smaller one where that is asked for. Each further click on what is missing
 * adds a small region, and each outside on what is too much takes one away. */
#pragma once

#include "propose/region_tree.h"

/* A node of region_tree_pixels, of any view. */
struct region_click {
	int32_t node;
	int is_outside;
};

/* area (nodes) is what the first click's view shows of each, by region_tree_areas. is_in (nodes) gets 1 for
 * the nodes of the regions that are meant. larger: so many steps up from the first, below 0 down towards the
 * click. Returns how many regions; 0 where no click is on any. */
int32_t region_pick(const struct region_tree *t, const float *score, const float *area,
	const struct region_click *clicks, size_t n, int larger, uint8_t *is_in);

/* The region whose box in a view agrees most with one, by intersection over union; -1: none does. */
int32_t region_pick_box(const struct region_tree *t, const struct region_shown *shown, const double box[4]);
