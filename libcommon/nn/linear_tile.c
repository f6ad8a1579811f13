#include "nn/linear_tile.h"

#include "base/cpu.h"

#include <math.h>

/* For any processor: 4 x 8 in vectors of four floats, which the compiler maps to what there is. */
#define FOUR float __attribute__((vector_size(16), may_alias))

static FOUR plain_madd(FOUR x, FOUR y, FOUR sum)
{
#ifdef FP_FAST_FMAF
	for (int i = 0; i < 4; i++)
		sum[i] = fmaf(x[i], y[i], sum[i]);
	return sum;
#else
	return sum + x * y;
#endif
}

static void run_plain(float *c, size_t stride, const float *start, size_t start_stride, const float *a,
	size_t row, size_t column, const float *b, size_t k)
{
	FOUR sum[4][2];

#pragma GCC unroll 4
	for (int i = 0; i < 4; i++)
		sum[i][0] = sum[i][1] = (FOUR){0};
	for (size_t t = 0; t < k; t++, a += column, b += 8) {
		FOUR b0 = *(const FOUR *)b, b1 = *(const FOUR *)(b + 4);
#pragma GCC unroll 4
		for (size_t i = 0; i < 4; i++) {
			float x = a[i * row];
			sum[i][0] = plain_madd((FOUR){x, x, x, x}, b0, sum[i][0]);
			sum[i][1] = plain_madd((FOUR){x, x, x, x}, b1, sum[i][1]);
		}
	}
#pragma GCC unroll 4
	for (size_t i = 0; i < 4; i++)
		for (size_t j = 0; j < 8; j++)
			c[i * stride + j] = start[i * start_stride + j] + sum[i][j / 4][j % 4];
}

static const struct linear_tile plain = {"plain", 4, 8, run_plain};

#ifdef __x86_64__
#include <immintrin.h>

/* Rows come in threes: a base pointer and the multiples 0, 1 and 2 of the row stride are addresses that the
 * processor forms by itself, so that the pointers of all rows stay in registers. */

/* 12 x 32: 24 sums of 16 floats, 2 parts of b and one element of a in the 32 AVX-512 registers. */
__attribute__((target("avx512f"))) static void run_avx512(float *c, size_t stride, const float *start,
	size_t start_stride, const float *a, size_t row, size_t column, const float *b, size_t k)
{
	__m512 sum[12][2];
	const float *base[4] = {a, a + 3 * row, a + 6 * row, a + 9 * row};

#pragma GCC unroll 12
	for (int i = 0; i < 12; i++)
		sum[i][0] = sum[i][1] = _mm512_setzero_ps();
	for (size_t t = 0; t < k; t++, b += 32) {
		__m512 b0 = _mm512_load_ps(b), b1 = _mm512_load_ps(b + 16);
#pragma GCC unroll 4
		for (int g = 0; g < 4; g++) {
#pragma GCC unroll 3
			for (int i = 0; i < 3; i++) {
				__m512 x = _mm512_set1_ps(base[g][(size_t)i * row]);
				sum[3 * g + i][0] = _mm512_fmadd_ps(x, b0, sum[3 * g + i][0]);
				sum[3 * g + i][1] = _mm512_fmadd_ps(x, b1, sum[3 * g + i][1]);
			}
			base[g] += column;
		}
	}
#pragma GCC unroll 12
	for (int i = 0; i < 12; i++, c += stride, start += start_stride) {
		_mm512_storeu_ps(c, _mm512_add_ps(_mm512_loadu_ps(start), sum[i][0]));
		_mm512_storeu_ps(c + 16, _mm512_add_ps(_mm512_loadu_ps(start + 16), sum[i][1]));
	}
}

/* 24 x 16: as many sums, 1 part of b. For narrow results. */
__attribute__((target("avx512f"))) static void run_narrow(float *c, size_t stride, const float *start,
	size_t start_stride, const float *a, size_t row, size_t column, const float *b, size_t k)
{
	__m512 sum[24];
	const float *base[8];

#pragma GCC unroll 24
	for (int i = 0; i < 24; i++)
		sum[i] = _mm512_setzero_ps();
#pragma GCC unroll 8
	for (size_t g = 0; g < 8; g++)
		base[g] = a + 3 * g * row;
	for (size_t t = 0; t < k; t++, b += 16) {
		const __m512 b0 = _mm512_load_ps(b);
#pragma GCC unroll 8
		for (int g = 0; g < 8; g++) {
#pragma GCC unroll 3
			for (int i = 0; i < 3; i++)
				sum[3 * g + i] = _mm512_fmadd_ps(
					_mm512_set1_ps(base[g][(size_t)i * row]), b0, sum[3 * g + i]);
			base[g] += column;
		}
	}
#pragma GCC unroll 24
	for (int i = 0; i < 24; i++, c += stride, start += start_stride)
		_mm512_storeu_ps(c, _mm512_add_ps(_mm512_loadu_ps(start), sum[i]));
}

/* 6 x 16: 12 sums of 8 floats, 2 parts of b and one element of a in the 16 AVX registers. */
__attribute__((target("avx2,fma"))) static void run_avx2(float *c, size_t stride, const float *start,
	size_t start_stride, const float *a, size_t row, size_t column, const float *b, size_t k)
{
	__m256 sum[6][2];
	const float *base[2] = {a, a + 3 * row};

#pragma GCC unroll 6
	for (int i = 0; i < 6; i++)
		sum[i][0] = sum[i][1] = _mm256_setzero_ps();
	for (size_t t = 0; t < k; t++, b += 16) {
		__m256 b0 = _mm256_load_ps(b), b1 = _mm256_load_ps(b + 8);
#pragma GCC unroll 2
		for (int g = 0; g < 2; g++) {
#pragma GCC unroll 3
			for (int i = 0; i < 3; i++) {
				__m256 x = _mm256_set1_ps(base[g][(size_t)i * row]);
				sum[3 * g + i][0] = _mm256_fmadd_ps(x, b0, sum[3 * g + i][0]);
				sum[3 * g + i][1] = _mm256_fmadd_ps(x, b1, sum[3 * g + i][1]);
			}
			base[g] += column;
		}
	}
#pragma GCC unroll 6
	for (int i = 0; i < 6; i++, c += stride, start += start_stride) {
		_mm256_storeu_ps(c, _mm256_add_ps(_mm256_loadu_ps(start), sum[i][0]));
		_mm256_storeu_ps(c + 8, _mm256_add_ps(_mm256_loadu_ps(start + 8), sum[i][1]));
	}
}

static const struct linear_tile avx512 = {"avx512", 12, 32, run_avx512},
				narrow = {"avx512, narrow", 24, 16, run_narrow},
				avx2 = {"avx2", 6, 16, run_avx2};

const struct linear_tile *linear_tile_get(int i)
{
	const enum cpu_level level = cpu_level();

	if (level >= CPU_AVX512 && i-- == 0)
		return &avx512;
	if (level >= CPU_AVX512 && i-- == 0)
		return &narrow;
	if (level >= CPU_AVX2 && i-- == 0)
		return &avx2;
	return i == 0 ? &plain : NULL;
}

const struct linear_tile *linear_tile_best(size_t rows, size_t columns)
{
	/* These give the same bytes; a narrower one wastes less of a narrow result. */
	const struct linear_tile *tile = linear_tile_get(0);

	if (tile != &avx512 || columns > narrow.columns)
		return tile;
	return rows >= 2 * narrow.rows ? &narrow : &avx2;
}
#else
const struct linear_tile *linear_tile_get(int i)
{
	return i == 0 ? &plain : NULL;
}

const struct linear_tile *linear_tile_best(size_t rows, size_t columns)
{
	(void)rows;
	(void)columns;
	return &plain;
}
#endif
