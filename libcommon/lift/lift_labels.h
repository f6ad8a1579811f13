/* Labels of pictures lifted onto the Gaussians by majority: of the labels that a Gaussian's blend weight
 * falls on, the one with the most of it. The vote of Gaussian Grouping's identities (arXiv 2312.00732) in
 * closed form; FlashSplat (arXiv 2409.08270) shows that it is the best a label for each Gaussian can do. Of
 * equal ones the smaller label wins. */
#pragma once

#include "base/err.h"
#include "lift/extent.h"
#include "lift/lifted_model.h"
#include "lift/source_weights.h"

#include <stdint.h>

enum { LABEL_NONE = -1 };

struct lift_labels {
	size_t gaussians;
	int64_t *first; /* (N) of the Gaussian's votes, -1: none */
	struct lift_vote *votes;
	size_t n, capacity;
};

/* Returns 0, or -1 with *e set; lift_labels_free in any case. */
int lift_labels_init(struct lift_labels *l, size_t gaussians, struct err *e);
void lift_labels_free(struct lift_labels *l);

/* A view, whose source k has label[k]. Returns 0, or -1 with *e set for want of memory. */
int lift_labels_add(
	struct lift_labels *l, const struct source_weights *s, const int32_t *label, struct err *e);

/* label, the part of the weight that is its, and the weight (N each); LABEL_NONE, 0 and 0 without weight. */
void lift_labels_end(const struct lift_labels *l, int32_t *label, float *reliability, float *weight);

/* Which object each Gaussian of a scene belongs to, one number each, and a colour for each number. */

/* labels (N) gets for each Gaussian 1 + the object that has the largest share of it, of the objects in whose
 * extent it is (extents (O)); of equal shares the first. 0: no object's. Returns 0, or -1 with *e set. */
int labels_find(int32_t *labels, const struct lifted *l, const struct extent *extents, struct err *e);

/* The colour of a label from 1 on. Hues are a golden section of the circle apart, so that those of labels
 * that are near in number, and of few labels, differ most. */
void labels_colour(int32_t label, uint8_t rgb[3]);
