/* A view's weights rendered, pruned and packed part by part (formats/scene/weights.md, "Packed"): a part
 * stays in the processor's cache, where the whole matrix takes a hundred megabytes. */
#ifndef CMD_LIFT_WEIGHING_PACKED_H
#define CMD_LIFT_WEIGHING_PACKED_H

#include "base/err.h"
#include "formats/scene/weights_pack.h"
#include "geom/camera.h"
#include "splat/render.h"

struct packing_room;

/* Zeroed before the first view; its memory serves one view after the other. */
struct weighed_packed {
	struct weights_pack pack;
	size_t weights; /* how many, before they are rounded */
	size_t covered; /* pixels that are more scene than background */

	struct weights_pack *rows; /* (row_count) of tiles, empty between views */
	int row_count, room_count;
	struct packing_room **rooms; /* (room_count) of the threads */
};
void weighed_packed_free(struct weighed_packed *w);

/* Of a prepared view of a scene of so many Gaussians, by its camera; dropped (P) as of prune_weights. Returns
 * 0, or -1 with *e set. */
int weigh_packed(struct weighed_packed *to, const struct render_view *v, const struct camera *c,
	size_t gaussians, double tolerance, float *dropped, struct err *e);

/* How many of the pixels are more scene than background. */
size_t weighing_cover(const float *transmittance, size_t pixels);

#endif
