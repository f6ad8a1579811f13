/* What the parts of lift/lift_objects share. */
#ifndef LIFT_LIFT_PRIVATE_H
#define LIFT_LIFT_PRIVATE_H

#include "lift/lift_objects.h"

/* A view's weights: as rows of pixels or, where those are NULL, as tiles. */
struct lift_weights {
	const struct view_weights *rows;
	const struct view_tiles *tiles;
};

static inline size_t lift_weights_pixels(const struct lift_weights *w)
{
	return w->rows ? w->rows->pixels : (size_t)w->tiles->width * (size_t)w->tiles->height;
}

/* agreement (v->n): soft intersection over union of each object's mask in images (v->n,P) with what is
 * claimed for it, rendered; two empty ones agree. Returns 0, or -1 with *e set for want of memory. */
int lift_agreement(const struct lift_objects *l, const struct lift_view *v, const struct lift_weights *of,
	const float *images, double *agreement, struct err *e);

/* l->shares and l->claims of what the views have and vote. Returns 0, or -1 with *e set for want of memory.
 */
int lift_shares(struct lift_objects *l, int is_last, struct err *e);

#endif
