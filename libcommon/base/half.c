#include "base/half.h"

#include "base/cpu.h"

#include <math.h>
#include <string.h>
#ifdef __x86_64__
#include <immintrin.h>
#endif

enum { BLOCK = 1 << 16 }; /* numbers that one thread takes at a time */

/* The exponent of a half is 112 less than a float's; the product is exact, also for subnormal halves.
 * Infinities and NaN get the float's largest exponent,
 * and a NaN is a quiet one, as the processors' own instructions have it. */
static inline float to_float(uint16_t h)
{
	uint32_t bits = (uint32_t)(h & 0x7fff) << 13;
	float f;

	memcpy(&f, &bits, 4);
	f *= 0x1p112f;
	memcpy(&bits, &f, 4);
	bits |= (h & 0x7c00) == 0x7c00 ? 0x7f800000 : 0;
	bits |= (h & 0x7fff) > 0x7c00 ? 0x00400000 : 0;
	bits |= (uint32_t)(h & 0x8000) << 16;
	memcpy(&f, &bits, 4);
	return f;
}

float half_to_float(uint16_t h)
{
	return to_float(h);
}

#ifdef __x86_64__
__attribute__((target("avx512f"))) static size_t whole_avx512(const unsigned char *p, size_t n, float *out)
{
	size_t i = 0;

	for (; i + 16 <= n; i += 16)
		_mm512_storeu_ps(out + i, _mm512_cvtph_ps(_mm256_loadu_si256((const void *)(p + 2 * i))));
	return i;
}

__attribute__((target("avx2,f16c"))) static size_t whole_avx2(const unsigned char *p, size_t n, float *out)
{
	size_t i = 0;

	for (; i + 8 <= n; i += 8)
		_mm256_storeu_ps(out + i, _mm256_cvtph_ps(_mm_loadu_si128((const void *)(p + 2 * i))));
	return i;
}
#endif

static void block_to_floats(const unsigned char *p, size_t n, float *out)
{
	size_t i = 0;

#ifdef __x86_64__
	const enum cpu_level level = cpu_level();
	if (level >= CPU_AVX2)
		i = level >= CPU_AVX512 ? whole_avx512(p, n, out) : whole_avx2(p, n, out);
#endif
	for (; i < n; i++) {
		uint16_t h;
		memcpy(&h, p + 2 * i, sizeof h);
		out[i] = to_float(h);
	}
}

void half_to_floats(const void *halves, size_t n, float *out)
{
	const unsigned char *p = halves;

	if (n <= BLOCK) {
		block_to_floats(p, n, out);
		return;
	}
#pragma omp parallel for schedule(static)
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

#if defined(__x86_64__) && defined(__GLIBC__)
__attribute__((target_clones("avx512f", "avx2", "default")))
#endif
static int
is_finite(const unsigned char *p, size_t n)
{
	unsigned bad = 0;

	for (size_t i = 0; i < n; i++) {
		uint16_t h;
		memcpy(&h, p + 2 * i, sizeof h);
		bad |= (h & 0x7c00) == 0x7c00;
	}
	return !bad;
}

size_t half_count_finite(const void *halves, size_t n)
{
	enum { STEP = 1 << 12 };
	const unsigned char *p = halves;
	size_t i = 0;

	while (n - i >= STEP && is_finite(p + 2 * i, STEP))
		i += STEP;
	while (i < n && is_finite(p + 2 * i, 1))
		i++;
	return i;
}
