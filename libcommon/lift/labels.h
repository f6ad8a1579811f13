/* Which object each Gaussian of a scene belongs to, one number each, and a colour for each number. */
#pragma once

#include "base/err.h"
#include "lift/extent.h"
#include "lift/lifted_model.h"

#include <stdint.h>

/* labels (N) gets for each Gaussian 1 + the object that has the largest share of it, of the objects in whose
 * extent it is (extents (O)); of equal shares the first. 0: no object's. Returns 0, or -1 with *e set. */
int labels_find(int32_t *labels, const struct lifted *l, const struct extent *extents, struct err *e);

/* The colour of a label from 1 on. Hues are a golden section of the circle apart, so that those of labels
 * that are near in number, and of few labels, differ most. */
void labels_colour(int32_t label, uint8_t rgb[3]);
