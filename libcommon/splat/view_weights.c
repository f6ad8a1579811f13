#include "splat/view_weights.h"

#include "base/cpu.h"

#include <string.h>
#if defined __x86_64__
#include <immintrin.h>
#endif

enum { AHEAD = 512 }; /* weights to fetch before their use: the processor's own prefetching falls behind */

enum { LANES = 16 }; /* partial sums of a pixel: lane k takes every 16th weight */

static inline float fold_lanes(float sums[LANES])
{
	for (int half = LANES / 2; half; half /= 2)
		for (int i = 0; i < half; i++)
			sums[i] += sums[i + half];
	return sums[0];
}

static void blend_plain(const struct view_weights *w, const float *m, float *image, size_t from, size_t to)
{
	for (size_t p = from; p < to; p++) {
		float sums[LANES] = {0};
		int64_t begin = w->indptr[p], end = w->indptr[p + 1];
		for (int64_t k = begin; k < end; k++)
			sums[(k - begin) % LANES] += w->weight[k] * m[w->index[k]];
		image[p] = fold_lanes(sums);
	}
}

#if defined __x86_64__
__attribute__((target("avx512f"))) static void blend_avx512(
	const struct view_weights *w, const float *m, float *image, size_t from, size_t to)
{
	for (size_t p = from; p < to; p++) {
		__m512 sum = _mm512_setzero_ps();
		for (int64_t k = w->indptr[p], end = w->indptr[p + 1]; k < end; k += LANES) {
			int64_t left = end - k;
			_mm_prefetch((const char *)(w->index + k + AHEAD), _MM_HINT_T0);
			_mm_prefetch((const char *)(w->weight + k + AHEAD), _MM_HINT_T0);
			__mmask16 mask = left >= LANES ? 0xffff : (__mmask16)((1u << left) - 1);
			__m512i index = _mm512_maskz_loadu_epi32(mask, w->index + k);
			__m512 value = _mm512_mask_i32gather_ps(_mm512_setzero_ps(), mask, index, m, 4);
			sum = _mm512_fmadd_ps(_mm512_maskz_loadu_ps(mask, w->weight + k), value, sum);
		}
		float sums[LANES];
		_mm512_storeu_ps(sums, sum);
		image[p] = fold_lanes(sums);
	}
}

/* Lanes 0 to 7 and 8 to 15 of the same, to the bit. */
__attribute__((target("avx2,fma"))) static void blend_avx2(
	const struct view_weights *w, const float *m, float *image, size_t from, size_t to)
{
	const __m256i lanes = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);

	for (size_t p = from; p < to; p++) {
		__m256 half[2] = {_mm256_setzero_ps(), _mm256_setzero_ps()};
		for (int64_t k = w->indptr[p], end = w->indptr[p + 1]; k < end; k += LANES) {
			_mm_prefetch((const char *)(w->index + k + AHEAD), _MM_HINT_T0);
			_mm_prefetch((const char *)(w->weight + k + AHEAD), _MM_HINT_T0);
			for (int h = 0; h < 2 && k + h * LANES / 2 < end; h++) {
				const int64_t at = k + h * LANES / 2, left = end - at;
				const __m256i mask = _mm256_cmpgt_epi32(
					_mm256_set1_epi32(left < LANES ? (int)left : LANES), lanes);
				const __m256i index = _mm256_maskload_epi32(w->index + at, mask);
				const __m256 value = _mm256_mask_i32gather_ps(
					_mm256_setzero_ps(), m, index, _mm256_castsi256_ps(mask), 4);
				half[h] = _mm256_fmadd_ps(
					_mm256_maskload_ps(w->weight + at, mask), value, half[h]);
			}
		}
		float sums[LANES];
		_mm256_storeu_ps(sums, half[0]);
		_mm256_storeu_ps(sums + LANES / 2, half[1]);
		image[p] = fold_lanes(sums);
	}
}
#endif

void view_blend(const struct view_weights *w, const float *m, size_t from, size_t to, float *image)
{
#if defined __x86_64__
	if (cpu_level() >= CPU_AVX512) {
		blend_avx512(w, m, image, from, to);
		return;
	}
	if (cpu_level() >= CPU_AVX2) {
		blend_avx2(w, m, image, from, to);
		return;
	}
#endif
	blend_plain(w, m, image, from, to);
}

void view_blend_back(const struct view_weights *w, const float *dimage, size_t from, size_t to, float *dm)
{
	const int32_t *index = w->index;
	const float *weight = w->weight;

	for (size_t p = from; p < to; p++) {
		const float d = dimage[p];
		for (int64_t k = w->indptr[p], end = w->indptr[p + 1]; k < end; k++)
			dm[index[k]] += weight[k] * d;
	}
}

void view_blend_group(const struct view_weights *w, const float *m, int count, size_t from, size_t to,
	float *image, size_t stride)
{
	for (size_t p = from; p < to; p++) {
		float sums[VIEW_GROUP] = {0};
		for (int64_t i = w->indptr[p]; i < w->indptr[p + 1]; i++) {
			const float *values = m + (size_t)w->index[i] * VIEW_GROUP;
			for (int k = 0; k < VIEW_GROUP; k++)
				sums[k] += w->weight[i] * values[k];
		}
		for (int k = 0; k < count; k++)
			image[(size_t)k * stride + p] = sums[k];
	}
}

void view_blend_back_group(const struct view_weights *w, const float *dimage, size_t stride, int count,
	size_t from, size_t to, float *dm)
{
	for (size_t p = from; p < to; p++) {
		float d[VIEW_GROUP] = {0};
		for (int k = 0; k < count; k++)
			d[k] = dimage[(size_t)k * stride + p];
		for (int64_t i = w->indptr[p]; i < w->indptr[p + 1]; i++) {
			float *to_row = dm + (size_t)w->index[i] * VIEW_GROUP;
			for (int k = 0; k < VIEW_GROUP; k++)
				to_row[k] += w->weight[i] * d[k];
		}
	}
}

void view_join(const float *slabs, size_t gaussians, float *dm)
{
#pragma omp parallel for schedule(static)
	for (size_t i = 0; i < gaussians; i++) {
		float sum = 0;
		for (size_t slab = 0; slab < VIEW_SLABS; slab++)
			sum += slabs[slab * gaussians + i];
		dm[i] = sum;
	}
}
