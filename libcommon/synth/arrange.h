/* Which things are in a scene, and where they stand. */
#ifndef SYNTH_ARRANGE_H
#define SYNTH_ARRANGE_H

#include "synth/objects.h"
#include "synth/presets.h"

#include <stdint.h>

/* Chooses n objects (SYNTH_MIN_OBJECTS to SYNTH_MAX_OBJECTS) and puts them on a table of fitting size.
 *
 * Of four objects or more half are in groups of two or three of one shape and colour, and mostly of one
 * finish; of the sizes of a group all are the same. No other two are alike in shape and colour. Where the
 * preset stacks, one object in six stands on a book, box or plate, within its flat top; one thing carries at
 * most one other, and none that carries stands on another. Otherwise none touches another. */
void synth_arrange(struct synth_object *objects, int n, struct synth_table *table,
	const struct synth_preset *preset, uint64_t seed);

#endif
