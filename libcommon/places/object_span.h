/* Where an object begins and ends along an axis. */
#pragma once

#include "base/quantile.h"

struct object_span {
	double low, high, middle;
};

/* By where its n > 0 points are, which change places: the middle 80% of their weight, a tenth longer either
 * way; on the upright axis up to the tip of what tapers. middle: of the 80%. */
struct object_span object_span(struct quantile_item *along, size_t n, int is_upright);
