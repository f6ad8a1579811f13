/* Which region of a scene's tree each pixel of a view is of: what pseudomask-propose and mask-pick look at.
 */
#pragma once

#include "base/err.h"
#include "formats/scene/scene.h"
#include "propose/region_tree.h"

struct region_picture {
	int height, width;
	int32_t *nodes; /* (height,width) of region_tree_pixels; NULL: not yet looked at */
};

/* By a view's blend weights, of the picture's size. Returns 0, or -1 with *e set; free nodes after either. */
int region_picture_take(struct region_picture *p, const struct region_tree *t,
	const struct view_weights *rows, struct err *e);

/* The same of a view that is rendered at a share of its size. */
int region_picture_render(struct region_picture *p, const struct region_tree *t, const struct scene *scene,
	const struct camera *camera, double scale, struct err *e);
