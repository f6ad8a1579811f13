/* From where things hide each other. */
#ifndef SYNTH_HIDING_H
#define SYNTH_HIDING_H

#include "base/err.h"
#include "geom/camera.h"
#include "synth/objects.h"
#include "synth/presets.h"

/* Whether the training cameras see enough: each object at least half visible to at least a third of them.
 * Returns 0; -1 with *e set (ERR_CHECK: the name of one that is not). */
int synth_hiding_check(const struct cameras *c, const struct synth_object *objects, int n, struct err *e);

/* Moves the test cameras of *c: low, and so placed that over all (test view, object) pairs about the share
 * o->preset->hidden is less than half visible, a quarter of those hardly at all, and next to none out of
 * sight; no camera is where another is. Does nothing where that share is 0. Returns 0, or -1 with *e set. */
int synth_hiding_cameras(struct cameras *c, const struct synth_options *o, const struct synth_object *objects,
	const struct synth_table *table, struct err *e);

#endif
