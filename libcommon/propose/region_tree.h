/* Regions of a scene, one inside another: a tree of which each Gaussian has one node, and is of that and of
 * all above it.
 *
 * A pixel's node is the lowest with more than half of the pixel's blend weight: of nodes with more than half
 * each is inside another, so that there is one lowest, and the mask of a region in a view is exactly the
 * pixels whose nodes are in its subtree. One picture of nodes so has the masks of all regions. */
#pragma once

#include "base/err.h"
#include "propose/linkage.h"
#include "splat/view_weights.h"

#include <stdint.h>

/* Nodes are numbered so that those of a subtree stand side by side, its top first. */
struct region_tree {
	size_t gaussians; /* N of the scene */
	int32_t n;
	int32_t *parent; /* (n) -1: none */
	int32_t *end;	 /* (n) the subtree is the nodes from its top to before this */
	int32_t *node;	 /* (N) of each Gaussian; -1: none */
};

/* 1 where a node, -1 being none, is of a region. */
static inline int region_tree_has(const struct region_tree *t, int32_t region, int32_t node)
{
	return node >= region && node < t->end[region];
}

/* Of a linkage of all Gaussians, the clusters of at least that size, but for those that have hardly grown
 * since the last. Returns 0, or -1 with *e; region_tree_free after either. */
int region_tree_make(struct region_tree *t, const struct linkage *l, double least, struct err *e);
/* Sets `end` by `parent`, which is below each node's number. */
void region_tree_span(struct region_tree *t);
void region_tree_free(struct region_tree *t);

/* at (P): the node of each pixel of a view, -1 for none. Returns 0, or -1 with *e set for want of memory. */
int region_tree_pixels(const struct region_tree *t, const struct view_weights *w, int32_t *at, struct err *e);

/* mask (pixels) of 0 and 1: what a picture of nodes has of a region. Returns how many are 1. */
size_t region_tree_mask(
	const struct region_tree *t, const int32_t *at, size_t pixels, int32_t node, uint8_t *mask);

/* area (n): the pixels of each region in a picture of nodes. */
void region_tree_areas(const struct region_tree *t, const int32_t *at, size_t pixels, float *area);

/* What a view shows of a region. */
struct region_shown {
	int32_t area; /* pixels */
	/* around them, but for REGION_TREE_TRIM of them on each side, as a few astray make a box much larger;
	 * right and bottom are outside, and nothing is set where area is 0 */
	int32_t left, top, right, bottom;
};
#define REGION_TREE_TRIM 0.02

/* shown (n) of a picture of nodes. Returns 0, or -1 with *e set for want of memory: a number for each node
 * and row and column. */
int region_tree_measure(const struct region_tree *t, const int32_t *at, int height, int width,
	struct region_shown *shown, struct err *e);

/* Intersection over union of what is shown and a box: left, top, right, bottom. */
double region_shown_agrees(const struct region_shown *s, const double box[4]);

/* The best regions by score (n), none of whose masks agree, by intersection over union, more than `agree`:
 * area (n) is that of all masks. chosen (most) gets them, the best first. Only those with a score above 0.
 * Returns how many, or -1 with *e set for want of memory. */
int32_t region_tree_nested(const struct region_tree *t, const double *score, const double *area, double agree,
	int32_t most, int32_t *chosen, struct err *e);

/* Regions none of which is in another, at most so many, with the largest sum of scores: chosen (most) rises.
 * Exact. */
int32_t region_tree_disjoint(
	const struct region_tree *t, const double *score, int32_t most, int32_t *chosen, struct err *e);
