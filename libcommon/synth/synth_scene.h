/* A table in a room, with objects, as Gaussians and cameras. Deterministic: the same options give the same
 * scene. */
#ifndef SYNTH_SYNTH_SCENE_H
#define SYNTH_SYNTH_SCENE_H

#include "base/err.h"
#include "geom/camera.h"
#include "splat/splats.h"
#include "synth/objects.h"
#include "synth/presets.h"

#include <stddef.h>
#include <stdint.h>

enum {
	SYNTH_MIN_VIEWS = 2,
	SYNTH_MAX_VIEWS = 1000, /* names have three digits */
	SYNTH_SH_COEFFICIENTS = 4,
};

struct synth_scene {
	const struct synth_preset *preset;
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

#endif
