/* The true boxes of the things on the table: exact, from their surfaces. */
#ifndef SYNTH_TRUE_BOXES_H
#define SYNTH_TRUE_BOXES_H

#include "geom/box.h"
#include "synth/objects.h"

/* The smallest box along the world's axes, and the one that is turned with the object: along its sides, or a
 * mug's handle. What is round all about fits every turn, and has both the same. */
void synth_object_boxes(const struct synth_object *o, struct box *aligned, struct box *turned);

#endif
