#include "base/half.h"

#include <math.h>
#include <string.h>

enum { BLOCK = 1 << 16 }; /* numbers that one thread takes at a time */

/* The exponent of a half is 112 less than a float's; the product is exact, also for subnormal halves.
 * Infinities and NaN get the float's largest exponent. */
static inline float to_float(uint16_t h)
{
	uint32_t bits = (uint32_t)(h & 0x7fff) << 13;
	float f;

	memcpy(&f, &bits, 4);
	f *= 0x1p112f;
	memcpy(&bits, &f, 4);
	bits |= (h & 0x7c00) == 0x7c00 ? 0x7f800000 : 0;
	bits |= (uint32_t)(h & 0x8000) << 16;
	memcpy(&f, &bits, 4);
	return f;
}

float half_to_float(uint16_t h)
{
	return to_float(h);
}

#if defined(__x86_64__) && defined(__GLIBC__)
__attribute__((target_clones("avx512f", "avx2", "default")))
#endif
static void
block_to_floats(const unsigned char *p, size_t n, float *out)
{
	for (size_t i = 0; i < n; i++) {
		uint16_t h;
		memcpy(&h, p + 2 * i, sizeof h);
		out[i] = to_float(h);
	}
}

void half_to_floats(const void *halves, size_t n, float *out)
{
	const unsigned char *p = halves;

#pragma omp parallel for schedule(static) if (n > BLOCK)
	for (size_t i = 0; i < n; i += BLOCK)
		block_to_floats(p + 2 * i, n - i < BLOCK ? n - i : BLOCK, out + i);
}

uint16_t half_of_float(float f)
{
	uint32_t bits;

	memcpy(&bits, &f, 4);
	uint16_t sign = (uint16_t)(bits >> 16 & 0x8000);
	bits &= 0x7fffffff;
	if (bits > 0x7f800000)
		return sign | 0x7e00;
	if (bits >= 0x477ff000)
		return sign | 0x7c00;
	if (bits < 0x38800000) { /* subnormal or zero: exact scaling, then round to nearest even */
		float a;
		memcpy(&a, &bits, 4);
		return sign | (uint16_t)lrintf(a * 0x1p24f);
	}
	bits += 0xfff + (bits >> 13 & 1);
	return sign | (uint16_t)((bits >> 13) - (112 << 10));
}
