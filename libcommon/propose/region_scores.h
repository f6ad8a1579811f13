/* How likely each region of a tree is a thing: as far as its masks are what photographs and detections show.
 *
 * By boxes, in a view the largest IoU^2 sqrt(score) of the box around the region's mask and a detected one.
 * By the photograph, the largest IoU^2 of the mask and a segment of any level. Both are means over the views
 * that show enough of the region. A vote for what it is, is by class the mean of the largest IoU^2 score. */
#pragma once

#include "base/err.h"
#include "propose/affinity.h"
#include "propose/pieces.h"
#include "propose/region_tree.h"

#include <stdint.h>

struct region_scores {
	int32_t n, classes;
	double *image, *box; /* (n) sums over views */
	double *views;	     /* (n) how many show it */
	double *area;	     /* (n) pixels of all masks, in shares of a picture */
	double *votes;	     /* (n,classes) sums over views; after region_scores_end means */
};

/* Returns 0, or -1 with *e; region_scores_free after either. */
int region_scores_init(struct region_scores *s, int32_t n, int32_t classes, struct err *e);
void region_scores_free(struct region_scores *s);

/* Adds a view: nodes (height,width) of region_tree_pixels, and the pieces of its photograph. Returns 0, or -1
 * with *e set for want of memory. */
int region_scores_view(struct region_scores *s, const struct region_tree *t, const int32_t *nodes,
	const struct pieces *p, const struct affinity_box *boxes, size_t box_count, struct err *e);

/* score (n): by boxes where there were any, else by photographs. */
void region_scores_end(struct region_scores *s, int has_boxes, double *score);

/* value (n) of a score, for regions none of which is in another: score^2 sqrt(area). The sum of the scores
 * alone is largest for the parts of things. */
void region_scores_value(const struct region_scores *s, const double *score, double *value);
