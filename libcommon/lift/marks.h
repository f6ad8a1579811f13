/* A set of Gaussians, gathered in any order and taken out by rising number: a bit for each. */
#pragma once

#include "base/err.h"

#include <stdint.h>

/* For that many Gaussians, none marked; free() it. NULL with *e set for want of memory. */
uint64_t *marks_make(size_t gaussians, struct err *e);

static inline void marks_add(uint64_t *marks, size_t i)
{
	marks[i / 64] |= (uint64_t)1 << i % 64;
}

size_t marks_count(const uint64_t *marks, size_t gaussians);

/* index (as many as are marked) gets them, rising, and none is marked. Returns how many. */
size_t marks_take(uint64_t *marks, size_t gaussians, int32_t *index);
