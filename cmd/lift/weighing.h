/* The blend weights of a scene's views, rendered, pruned and written: gs-weigh. formats/scene/weights.md. */
#pragma once

#include "base/err.h"
#include "base/report.h"
#include "formats/arrays/precision.h"
#include "formats/scene/scene.h"
#include "geom/camera.h"
#include "splat/render.h"
#include "splat/weights_pack.h"

enum { WEIGHING_TRAIN, WEIGHING_TEST, WEIGHING_ALL };

struct weighing_options {
	const char *scene, *folder; /* the scene's name for messages, and where to write to */
	int split;		    /* the views: WEIGHING_... */
	enum precision precision;
	int is_packed;	  /* with PRECISION_U8 */
	double scale;	  /* of the image, as a share of the view's */
	double tolerance; /* the share of a pixel's weight that may be left out */
};

/* A scene that covers less of every view than this part of its pixels, more scene than background, is not
 * seen. The desk covers all of each; a lone thing of a thirtieth of its width still does. */
#define WEIGHING_COVERED 1e-3

/* Writes a file for each view, and a note of it. ERR_FORMAT where no view is of the split. ERR_FORMAT also,
 * and nothing is left, where the scene is seen in none of the views. Returns 0, or -1 with *e set. */
int weigh(const struct scene *s, const struct weighing_options *o, const struct report *to, struct err *e);

/* A view's weights rendered, pruned and packed part by part (formats/scene/weights.md, "Packed"): a part
 * stays in the processor's cache, where the whole matrix takes a hundred megabytes. */

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
