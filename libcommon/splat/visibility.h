/* Which Gaussians the training views show. Those under and inside things shine through a little, and so take
 * part in an object's masks without being of it: a plate's outline must not have the table under it. */
#pragma once

#include "base/err.h"
#include "geom/camera.h"
#include "splat/splats.h"

enum {
	VISIBILITY_VIEWS = 16, /* most views looked at, spread evenly over the training views */
	VISIBILITY_SIDE = 320, /* their longer side in pixels at most */
};
#define VISIBILITY_LEAST 0.1f /* of its opacity a Gaussian in sight has as blend weight in some pixel */

/* most (s->n) gets the largest blend weight of each Gaussian in any pixel. A scene without training views is
 * looked at from all its views; without any, everything is in sight, with a weight of 1. 0, or -1 with *e. */
int visibility_most(const struct splats *s, const struct cameras *cameras, float *most, struct err *e);

/* in_sight (s->n) gets 0 or 1. */
int visibility_find(const struct splats *s, const struct cameras *cameras, char *in_sight, struct err *e);
