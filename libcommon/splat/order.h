/* Depth order: a stable radix sort of indices. */
#pragma once

#include "base/err.h"
#include "splat/project.h"

#include <stdint.h>

struct order_item {
	uint32_t key; /* order_key of the depth */
	uint32_t index;
};

/* Rises with depth >= 0, though not for every bit of it. */
uint32_t order_key(double depth);

/* Sorts n items, which come by rising index, by p[index].depth and then by index. `spare` has room for n
 * more. Returns the one of the two that has the result; NULL with *e set when memory is out. */
struct order_item *order_sort(struct order_item *items, struct order_item *spare, size_t n,
	const struct projected *p, struct err *e);
