/* How many bits of a word are set: without the instruction for it, which not every processor has, the
 * compiler's own is a call. */
#pragma once

#include <stdint.h>

static inline uint32_t ones(uint64_t x)
{
	x -= x >> 1 & 0x5555555555555555;
	x = (x & 0x3333333333333333) + (x >> 2 & 0x3333333333333333);
	x = (x + (x >> 4)) & 0x0f0f0f0f0f0f0f0f;
	return (uint32_t)(x * 0x0101010101010101 >> 56);
}
