/* Numbers in bytes, the least significant first, whatever the machine's own order. */
#pragma once

#include <stdint.h>
#include <string.h>

/* The number in the `size` bytes at p, 1 to 8. */
static inline uint64_t little_get(const unsigned char *p, int size)
{
	uint64_t bits = 0;

	for (int i = 0; i < size; i++)
		bits |= (uint64_t)p[i] << 8 * i;
	return bits;
}

static inline float little_get_f32(const unsigned char *p)
{
	const uint32_t bits = (uint32_t)little_get(p, 4);
	float value;

	memcpy(&value, &bits, 4);
	return value;
}

static inline double little_get_f64(const unsigned char *p)
{
	const uint64_t bits = little_get(p, 8);
	double value;

	memcpy(&value, &bits, 8);
	return value;
}

/* Each writes at p and returns the place after it. */
static inline unsigned char *little_put(unsigned char *p, uint64_t bits, int size)
{
	for (int i = 0; i < size; i++)
		*p++ = (unsigned char)(bits >> 8 * i);
	return p;
}

static inline unsigned char *little_put_f32(unsigned char *p, double value)
{
	const float single = (float)value;
	uint32_t bits;

	memcpy(&bits, &single, 4);
	return little_put(p, bits, 4);
}

static inline unsigned char *little_put_f64(unsigned char *p, double value)
{
	uint64_t bits;

	memcpy(&bits, &value, 8);
	return little_put(p, bits, 8);
}
