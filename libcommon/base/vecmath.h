/* Vectors of floats for hot kernels: fused multiply-add, exp, exp2, masks, on the target's widest registers.
 *
 * vecn has VEC_LANES lanes: 16 with AVX-512, 8 with AVX2 and FMA, else 4. Arithmetic and indexing are the
 * compiler's own (GCC vector extensions); vecni holds as many int32_t; vecm is the mask that a comparison
 * gives. A kernel is written once, in a file that is included by one .c file for each instruction set, which
 * selects it before it includes this header:
 *
 *	#pragma GCC target("avx512f,avx512dq,avx512bw,avx512vl,avx2,fma")
 *	#pragma GCC target("avx2,fma")
 *
 * or nothing; cpu_level() (base/cpu.h) chooses among them at run time. All functions are inlined, so that no
 * vector crosses a call. Results are the same on every machine, with AVX-512 and with AVX2, to the bit, as
 * long as sums over lanes are added in one order; plain ones differ in the last bits, as plain has no fma. */
#pragma once

#include <stdint.h>
#include <string.h>
#if defined __x86_64__
#include <immintrin.h>
#endif

#if defined __GNUC__ && !defined __clang__
#pragma GCC diagnostic ignored "-Wpsabi" /* about vectors in calls: there are none, everything is inlined */
#endif

#define VEC_INLINE static inline __attribute__((always_inline, unused))

#if defined __AVX512F__ && defined __AVX512DQ__
#define VEC_LANES 16
#elif defined __AVX2__ && defined __FMA__
#define VEC_LANES 8
#else
#define VEC_LANES 4
#endif

typedef float vecn __attribute__((vector_size(4 * VEC_LANES)));
typedef int32_t vecni __attribute__((vector_size(4 * VEC_LANES)));
#if VEC_LANES == 16
typedef __mmask16 vecm;
#else
typedef vecni vecm;
#endif
typedef double vecd __attribute__((vector_size(4 * VEC_LANES))); /* of half as many lanes */

VEC_INLINE vecn vec_splat(float x)
{
	return x - (vecn){0};
}

/* VEC_LANES floats at any alignment. */
VEC_INLINE vecn vec_load(const float *p)
{
	vecn x;

	memcpy(&x, p, sizeof x);
	return x;
}

VEC_INLINE void vec_store(float *p, vecn x)
{
	memcpy(p, &x, sizeof x);
}

/* a b + c, rounded once where the target can. */
VEC_INLINE vecn vec_fma(vecn a, vecn b, vecn c)
{
#if VEC_LANES == 16
	return (vecn)_mm512_fmadd_ps((__m512)a, (__m512)b, (__m512)c);
#elif VEC_LANES == 8
	return (vecn)_mm256_fmadd_ps((__m256)a, (__m256)b, (__m256)c);
#else
	return a * b + c;
#endif
}

/* c - a b, rounded once where the target can. */
VEC_INLINE vecn vec_fnma(vecn a, vecn b, vecn c)
{
#if VEC_LANES == 16
	return (vecn)_mm512_fnmadd_ps((__m512)a, (__m512)b, (__m512)c);
#elif VEC_LANES == 8
	return (vecn)_mm256_fnmadd_ps((__m256)a, (__m256)b, (__m256)c);
#else
	return c - a * b;
#endif
}

/* The second where either is NaN, as the instructions have it. */
VEC_INLINE vecn vec_min(vecn a, vecn b)
{
#if VEC_LANES == 16
	return (vecn)_mm512_min_ps((__m512)a, (__m512)b);
#elif VEC_LANES == 8
	return (vecn)_mm256_min_ps((__m256)a, (__m256)b);
#elif defined __x86_64__
	return (vecn)_mm_min_ps((__m128)a, (__m128)b);
#else
	vecni less = a < b;
	return (vecn)((less & (vecni)a) | (~less & (vecni)b));
#endif
}

VEC_INLINE vecn vec_max(vecn a, vecn b)
{
#if VEC_LANES == 16
	return (vecn)_mm512_max_ps((__m512)a, (__m512)b);
#elif VEC_LANES == 8
	return (vecn)_mm256_max_ps((__m256)a, (__m256)b);
#elif defined __x86_64__
	return (vecn)_mm_max_ps((__m128)a, (__m128)b);
#else
	vecni more = a > b;
	return (vecn)((more & (vecni)a) | (~more & (vecni)b));
#endif
}

VEC_INLINE vecm vec_lt(vecn a, vecn b)
{
#if VEC_LANES == 16
	return _mm512_cmp_ps_mask((__m512)a, (__m512)b, _CMP_LT_OQ);
#else
	return a < b;
#endif
}

VEC_INLINE vecm vec_ge(vecn a, vecn b)
{
#if VEC_LANES == 16
	return _mm512_cmp_ps_mask((__m512)a, (__m512)b, _CMP_GE_OQ);
#else
	return a >= b;
#endif
}

/* mask ? a : b, lane by lane. */
VEC_INLINE vecn vec_choose(vecm mask, vecn a, vecn b)
{
#if VEC_LANES == 16
	return (vecn)_mm512_mask_blend_ps(mask, (__m512)b, (__m512)a);
#elif VEC_LANES == 8
	return (vecn)_mm256_blendv_ps((__m256)b, (__m256)a, (__m256)mask);
#else
	return (vecn)((mask & (vecni)a) | (~mask & (vecni)b));
#endif
}

/* mask ? x : 0 */
VEC_INLINE vecn vec_keep(vecm mask, vecn x)
{
#if VEC_LANES == 16
	return (vecn)_mm512_maskz_mov_ps(mask, (__m512)x);
#else
	return (vecn)(mask & (vecni)x);
#endif
}

/* Adds one to the integers at p where the mask is set. */
VEC_INLINE void vec_count(int32_t *p, vecm mask)
{
	vecni x;

	memcpy(&x, p, sizeof x);
#if VEC_LANES == 16
	x = (vecni)_mm512_mask_add_epi32((__m512i)x, mask, (__m512i)x, _mm512_set1_epi32(1));
#else
	x -= mask;
#endif
	memcpy(p, &x, sizeof x);
}

/* Bit l is lane l of the mask. */
VEC_INLINE uint32_t vec_bits(vecm mask)
{
#if VEC_LANES == 16
	return mask;
#elif VEC_LANES == 8
	return (uint32_t)_mm256_movemask_ps((__m256)mask);
#elif defined __x86_64__
	return (uint32_t)_mm_movemask_ps((__m128)mask);
#else
	uint32_t bits = 0;
	for (int l = 0; l < VEC_LANES; l++)
		bits |= (uint32_t)(mask[l] & 1) << l;
	return bits;
#endif
}

/* The first half of the lanes in double, and the other. */
VEC_INLINE vecd vec_low(vecn x)
{
#if VEC_LANES == 16
	return (vecd)_mm512_cvtps_pd(_mm512_castps512_ps256((__m512)x));
#elif VEC_LANES == 8
	return (vecd)_mm256_cvtps_pd(_mm256_castps256_ps128((__m256)x));
#else
	return (vecd){(double)x[0], (double)x[1]};
#endif
}

VEC_INLINE vecd vec_high(vecn x)
{
#if VEC_LANES == 16
	return (vecd)_mm512_cvtps_pd(_mm512_extractf32x8_ps((__m512)x, 1));
#elif VEC_LANES == 8
	return (vecd)_mm256_cvtps_pd(_mm256_extractf128_ps((__m256)x, 1));
#else
	return (vecd){(double)x[2], (double)x[3]};
#endif
}

/* Nearest whole number, ties to even, for |x| < 2^22. */
VEC_INLINE vecn vec_round(vecn x)
{
	return (x + 12582912.0f) - 12582912.0f;
}

/* e^x: within 1.1 ulp; 0 below -104 (denormals in between), infinity above 88.73, NaN for NaN. */
VEC_INLINE vecn vec_exp(vecn x)
{
	x = vec_min(vec_splat(89.0f), vec_max(vec_splat(-104.5f), x));
	vecn n = vec_round(x * 1.44269504f);
	/* ln 2 in two parts, the first short enough that n times it is exact even without fma */
	vecn r = vec_fma(n, vec_splat(-0.693359375f), x);
	r = vec_fma(n, vec_splat(2.12194440e-4f), r);
	/* e^r = 1 + r + r^2 p(r) on |r| <= ln(2)/2 */
	vecn p = vec_splat(1.9875691500e-4f);
	p = vec_fma(p, r, vec_splat(1.3981999507e-3f));
	p = vec_fma(p, r, vec_splat(8.3334519073e-3f));
	p = vec_fma(p, r, vec_splat(4.1665795894e-2f));
	p = vec_fma(p, r, vec_splat(1.6666665459e-1f));
	p = vec_fma(p, r, vec_splat(5.0000001201e-1f));
	p = vec_fma(p, r * r, r) + 1.0f;
	/* times 2^n in two steps, each a normal power of two */
	vecni whole = __builtin_convertvector(n, vecni), half = whole >> 1;
	return p * (vecn)((half + 127) << 23) * (vecn)((whole - half + 127) << 23);
}

/* 2^x for -126 < x <= 126: within 2.2 ulp, and cheaper than vec_exp, as no range is checked. */
VEC_INLINE vecn vec_exp2(vecn x)
{
#if VEC_LANES >= 8
	/* r = x - floor(x), rounded down, and floor(x) goes to the exponent */
#if VEC_LANES == 16
	vecn r = (vecn)_mm512_reduce_ps((__m512)x, _MM_FROUND_TO_NEG_INF);
#else
	/* only above -1 is it not exact: it was rounded up where what is taken back from x is more than x */
	vecn whole = (vecn)_mm256_floor_ps((__m256)x), r = x - whole;
	r = (vecn)((vecni)r + (x < r + whole));
#endif
	/* minimax in relative error on 0 <= r <= 1: 7.6e-08 */
	vecn p = vec_splat(0.00187556923f);
	p = vec_fma(p, r, vec_splat(0.00899467524f));
	p = vec_fma(p, r, vec_splat(0.0558212101f));
	p = vec_fma(p, r, vec_splat(0.240155727f));
	p = vec_fma(p, r, vec_splat(0.693152726f));
	p = vec_fma(p, r, vec_splat(0.99999994f));
#if VEC_LANES == 16
	return (vecn)_mm512_scalef_ps((__m512)p, (__m512)x);
#else
	return (vecn)((vecni)p + ((vecni)_mm256_cvtps_epi32((__m256)whole) << 23));
#endif
#else
	/* the sum holds round(x) in its low bits, from where it goes to the exponent */
	vecn shifted = x + 12582912.0f, r = x - (shifted - 12582912.0f);
	/* minimax in relative error on |r| <= 1/2: 9.2e-8 */
	vecn p = vec_splat(1.3264727e-3f);
	p = vec_fma(p, r, vec_splat(9.6715130e-3f));
	p = vec_fma(p, r, vec_splat(5.5507336e-2f));
	p = vec_fma(p, r, vec_splat(2.4022242e-1f));
	p = vec_fma(p, r, vec_splat(6.9314700e-1f));
	p = vec_fma(p, r, vec_splat(1.0f));
	return (vecn)((vecni)p + ((vecni)shifted << 23));
#endif
}
