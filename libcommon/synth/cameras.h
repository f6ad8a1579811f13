/* The cameras of a synthetic scene: someone walks round the table's front twice, low and high. */
#pragma once

#include "base/err.h"
#include "geom/camera.h"
#include "synth/objects.h"
#include "synth/presets.h"

/* o->views views of one size, all looking at the table; split set: of V views the share of the preset is for
 * testing, at least one, spread evenly and the last among them. 0, or -1 with *e; cameras_free after either.
 */
int synth_cameras_make(
	struct cameras *c, const struct synth_options *o, const struct synth_table *table, struct err *e);

/* How far the cameras are from the table's middle, but for some tenths. */
double synth_cameras_distance(const struct synth_table *table, const struct synth_preset *preset);

/* Puts a camera at `centre` with `target` in its middle, turned by `roll` (radians) about its axis. */
void synth_cameras_aim(struct camera *c, const double centre[3], const double target[3], double roll);

/* The reference viewpoint of spatial words: the mean of the training cameras' centres, looking at the table's
 * middle. right and away are its unit directions in the plane of the table. */
void synth_cameras_reference(const struct cameras *c, double centre[3], double right[2], double away[2]);

/* Whether the training cameras see enough: each object at least half visible to at least a third of them.
 * Returns 0; -1 with *e set (ERR_CHECK: the name of one that is not). */
int synth_cameras_check(const struct cameras *c, const struct synth_object *objects, int n, struct err *e);

/* Moves the test cameras of *c: low, and so placed that over all (test view, object) pairs about the share
 * o->preset->hidden is less than half visible, a quarter of those hardly at all, and next to none out of
 * sight; no camera is where another is. Does nothing where that share is 0. Returns 0, or -1 with *e set. */
int synth_cameras_hide(struct cameras *c, const struct synth_options *o, const struct synth_object *objects,
	const struct synth_table *table, struct err *e);
