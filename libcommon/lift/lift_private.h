/* What the parts of lift/lift_objects share. */
#pragma once

#include "lift/lift_objects.h"

/* agreement (v->n): soft intersection over union of each object's mask with what is claimed for it, rendered;
 * two empty ones agree. fit (v->n): of the mask, cut at one half, with what is above each cut. Returns 0, or
 * -1 with *e set for want of memory. */
int lift_agreement(const struct lift_objects *l, const struct lift_view *v, const struct view_matrix *w,
	double *agreement, float (*fit)[LIFT_CUTS], struct err *e);

/* l->shares and l->claims of what the views have and vote. 0, or -1 with *e. */
int lift_shares(struct lift_objects *l, int is_last, struct err *e);

/* Where a view has an object's mask: its row, or v->n. */
size_t lift_row(const struct lift_view *v, size_t object);

/* The vote of a mask that agrees so far. */
float lift_vote(double agreement);
