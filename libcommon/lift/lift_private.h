/* What the parts of lift/lift_objects share. */
#ifndef LIFT_LIFT_PRIVATE_H
#define LIFT_LIFT_PRIVATE_H

#include "lift/lift_objects.h"

/* A view's weights: as rows of pixels or, where those are NULL, as tiles. */
struct lift_weights {
	const struct view_weights *rows;
	const struct view_tiles *tiles;
	int height, width;
};

/* Room for a x b items of `size` bytes, of the scratch: mem_room. */
int lift_room(void **block, size_t *room, size_t a, size_t b, size_t size, struct err *e);

/* agreement (v->n): soft intersection over union of each object's mask in s->images with what is claimed for
 * it, rendered; two empty ones agree. Returns 0, or -1 with *e set for want of memory. */
int lift_agreement(const struct lift_objects *l, const struct lift_view *v, const struct lift_weights *of,
	struct lift_scratch *s, double *agreement, struct err *e);

/* l->shares and l->claims of what the views have and vote. Returns 0, or -1 with *e set for want of memory.
 */
int lift_shares(struct lift_objects *l, int is_last, struct err *e);

#endif
