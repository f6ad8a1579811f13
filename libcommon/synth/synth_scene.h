/* A table in a room, with objects, as Gaussians and cameras. The same options give the same scene. */
#pragma once

#include "base/err.h"
#include "geom/camera.h"
#include "splat/render.h"
#include "splat/splats.h"
#include "synth/presets.h"

#include <stdint.h>

enum {
	SYNTH_MIN_VIEWS = 2,
	SYNTH_MAX_VIEWS = 1000, /* names have three digits */
	SYNTH_SH_COEFFICIENTS = 4,
};

struct synth_scene {
	const struct synth_preset *preset;
	int is_moving; /* no shadows and nothing left out under feet: neither would go with what moves */
	struct synth_table table;
	int object_count;
	struct synth_object *objects; /* (object_count) */
	struct splats splats;	      /* SH degree 1 */
	int32_t *owner;		      /* (splats.n) the object a Gaussian belongs to, or -1 */
	/* Those of object i are first[i] to first[i+1]. */
	size_t first[SYNTH_MAX_OBJECTS + 1];
	struct cameras cameras; /* "view_000" ..., without image */
};

/* Returns 0, or -1 with *e set and *s zeroed: memory, or (ERR_CHECK) something is hidden in most training
 * views; another seed then helps. */
int synth_scene_make(struct synth_scene *s, const struct synth_options *o, struct err *e);
void synth_scene_free(struct synth_scene *s);

/* Fills s->splats (allocated), owner and first: Gaussians alike in kind to those of a trained scene, needles
 * and flakes, many of them faint, a few large, some astray (formats/scene/synth.md). What there is to be seen
 * depends on the seed alone, how fine it is on their number. Returns 0, or -1 with *e set. */
int synth_gaussians_make(struct synth_scene *s, uint64_t seed, struct err *e);

/* masks (object_count,P) gets 1 where the object's share of the pixel's blend weights, sum of w_i over its
 * own Gaussians, is above one half. Hidden parts are therefore 0. Returns 0, or -1 with *e set. */
int synth_truth_visible(const struct synth_scene *s, const struct render_view *view, size_t pixels,
	uint8_t *masks, struct err *e);

/* The same as if nothing else were there: the object's own Gaussians rendered alone. */
int synth_truth_whole(const struct synth_scene *s, const struct camera *c, uint8_t *masks, struct err *e);
