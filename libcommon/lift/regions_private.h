/* What the parts of lift/regions share. */
#ifndef LIFT_REGIONS_PRIVATE_H
#define LIFT_REGIONS_PRIVATE_H

#include "lift/regions.h"

/* sum (N) of the weight in the chosen candidates' masks, and all (N) of that in their views. chosen (views)
 * has a candidate or REGIONS_NONE. */
void regions_sum(const struct regions *r, const size_t *chosen, float *sum, float *all);

#endif
