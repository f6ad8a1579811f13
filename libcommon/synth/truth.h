/* What each object shows in a view, told by the blend weights. */
#ifndef SYNTH_TRUTH_H
#define SYNTH_TRUTH_H

#include "base/err.h"
#include "splat/render.h"
#include "synth/synth_scene.h"

#include <stddef.h>
#include <stdint.h>

/* masks (object_count,P) gets 1 where the object's share of the pixel's blend weights, sum of w_i over its
 * own Gaussians, is above one half. Hidden parts are therefore 0. Returns 0, or -1 with *e set. */
int synth_truth_visible(const struct synth_scene *s, const struct render_view *view, size_t pixels,
	uint8_t *masks, struct err *e);

/* The same as if nothing else were there: the object's own Gaussians rendered alone. */
int synth_truth_whole(const struct synth_scene *s, const struct camera *c, uint8_t *masks, struct err *e);

#endif
