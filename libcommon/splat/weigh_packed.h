/* A view's weights, packed as they are made (formats/scene/weights.md, "Packed"): a tile stays in the
 * processor's cache, where the whole matrix takes a hundred megabytes. */
#pragma once

#include "base/err.h"
#include "splat/render.h"
#include "splat/weights_pack.h"

struct weigh_room;

/* Zeroed before the first view; its memory serves one view after the other. */
struct weighed_packed {
	struct weights_pack pack;
	size_t weights; /* how many, before they are rounded */
	size_t covered; /* pixels that are more scene than background */

	struct weights_pack *rows; /* (row_count) of tiles, empty between views */
	struct weigh_room *rooms;  /* (room_count) of the threads */
	int row_count, room_count;
};
void weighed_packed_free(struct weighed_packed *w);

/* Of a prepared view; limits and dropped (P) as of render_weights_within. Returns 0, or -1 with *e set. */
int weigh_packed(struct weighed_packed *to, const struct render_view *v, const struct render_limits *limits,
	float *dropped, struct err *e);

/* How many of the pixels are more scene than background. */
size_t weigh_covered(const float *transmittance, size_t pixels);
