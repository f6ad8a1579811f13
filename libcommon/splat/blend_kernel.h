/* The blending kernels, for the instruction set in force where this is included; BLEND_TABLE names the
 * result.
 *
 * A tile's row is VEC_PARTS vectors. With (u, v) the Gaussian's Cholesky coordinates (splat/project.h), v is
 * constant along a row and u is linear, so a pixel costs e = c - u^2, c = log2(o) - v^2, and a = 2^e. u and v
 * of the tile's centre are computed in double; what is added in float is small, so that a needle far from its
 * mean keeps its digits. */
#include "base/vecmath.h"
#include "splat/blend.h"

#include <math.h>

enum { VEC_PARTS = TILE_SIZE / VEC_LANES };

static const float blend_offsets[TILE_SIZE] __attribute__((aligned(64))) = {-7.5f, -6.5f, -5.5f, -4.5f, -3.5f,
	-2.5f, -1.5f, -0.5f, 0.5f, 1.5f, 2.5f, 3.5f, 4.5f, 5.5f, 6.5f, 7.5f};

/* u at the row's middle and c of each row of the tile. */
struct blend_rows {
	float u[TILE_SIZE] __attribute__((aligned(64)));
	float c[TILE_SIZE] __attribute__((aligned(64)));
	float slope; /* of u along a row */
};

/* Fills *rows; returns a bit for each row that the ellipse a >= 1/255 may meet. */
VEC_INLINE uint32_t blend_setup(
	struct blend_rows *rows, const struct blend_tile *t, const struct projected *p)
{
	double dx = t->x - p->x, dy = t->y - p->y;
	vecn u0 = vec_splat((float)(p->l11 * dx + p->l21 * dy)), v0 = vec_splat((float)(p->l22 * dy));
	vecn l21 = vec_splat((float)p->l21), l22 = vec_splat((float)p->l22),
	     log_opacity = vec_splat(p->log_opacity);
	float slope = (float)p->l11;
	uint32_t bits = 0;

	rows->slope = slope;
	for (int i = 0; i < VEC_PARTS; i++) {
		vecn offset = vec_load(blend_offsets + i * VEC_LANES);
		vecn u = vec_fma(l21, offset, u0), v = vec_fma(l22, offset, v0),
		     c = vec_fnma(v, v, log_opacity);
		/* the least |u| between the first and the last column */
		vecn gap = vec_max(vec_max(u, -u) - 7.5f * slope, vec_splat(0));
		vec_store(rows->u + i * VEC_LANES, u);
		vec_store(rows->c + i * VEC_LANES, c);
		/* 1e-3 covers rounding; each pixel decides by itself */
		bits |= vec_bits(vec_fnma(gap, gap, c) >= BLEND_ALPHA_MIN_LOG2 - 1e-3f) << (i * VEC_LANES);
	}
	return bits;
}

/* The weights of part i of row r, zero where none. Updates transmittance, cut and live. */
VEC_INLINE vecn blend_part(struct blend_tile *t, const struct blend_rows *rows, int r, int i)
{
	int at = r * TILE_SIZE + i * VEC_LANES;
	vecn u = vec_fma(
		vec_splat(rows->slope), vec_load(blend_offsets + i * VEC_LANES), vec_splat(rows->u[r]));
	vecn e = vec_fnma(u, u, vec_splat(rows->c[r])), cut = vec_load(t->cut + at);
	vecni keep = e >= cut;
	/* where e is out of range for vec_exp2 it is below the cut, and what comes out is masked */
	vecn a = (vecn)((vecni)vec_min(vec_exp2(e), vec_splat(BLEND_ALPHA_MAX)) & keep);
	vecn before = vec_load(t->transmittance + at), w = a * before, after = before - w;
	vecni stop = (after < BLEND_STOP) & keep;

	if (__builtin_expect(vec_bits(stop) != 0, 0)) {
		float all[TILE_SIZE];
		int is_live = 0;
		w = (vecn)((vecni)w & ~stop);
		after = before - w;
		cut = (vecn)(((vecni)cut & ~stop) | ((vecni)vec_splat(INFINITY) & stop));
		vec_store(t->cut + at, cut);
		memcpy(all, t->cut + r * TILE_SIZE, sizeof all);
		for (int k = 0; k < TILE_SIZE; k++)
			is_live |= all[k] < INFINITY;
		t->live &= ~((uint32_t)!is_live << r);
	}
	vec_store(t->transmittance + at, after);
	return w;
}

VEC_INLINE void blend_channels(struct blend_tile *t, const struct projected *p, const uint32_t *list,
	size_t n, const float *values, int channels)
{
	struct blend_rows rows;

	for (size_t k = 0; k < n && t->live; k++) {
		const float *value = values + (size_t)list[k] * (size_t)channels;
		if (k + 8 < n)
			__builtin_prefetch(&p[list[k + 8]]);
		for (uint32_t left = blend_setup(&rows, t, &p[list[k]]) & t->live; left; left &= left - 1) {
			int r = __builtin_ctz(left);
			for (int i = 0; i < VEC_PARTS; i++) {
				vecn w = blend_part(t, &rows, r, i);
				for (int c = 0; c < channels; c++) {
					float *sum = t->sum[c] + r * TILE_SIZE + i * VEC_LANES;
					vec_store(sum, vec_fma(w, vec_splat(value[c]), vec_load(sum)));
				}
			}
		}
	}
}

static void blend_values(struct blend_tile *t, const struct projected *p, const uint32_t *list, size_t n,
	const float *values, int channels)
{
	if (channels == 1)
		blend_channels(t, p, list, n, values, 1);
	else if (channels == 3)
		blend_channels(t, p, list, n, values, 3);
	else
		blend_channels(t, p, list, n, values, channels);
}

/* Stores the lanes of w that `lanes` names side by side; may write VEC_LANES floats. */
VEC_INLINE void blend_pack(float *out, vecn w, uint32_t lanes)
{
#if VEC_LANES == 16
	_mm512_storeu_ps(out, _mm512_maskz_compress_ps((__mmask16)lanes, (__m512)w));
#else
	for (; lanes; lanes &= lanes - 1)
		*out++ = w[__builtin_ctz(lanes)];
#endif
}

static size_t blend_weights(struct blend_tile *t, const struct projected *p, const uint32_t *list, size_t n,
	struct blend_records *records)
{
	struct blend_rows rows;

	for (size_t k = 0; k < n; k++) {
		const struct projected *one = &p[list[k]];
		if (!t->live)
			return n;
		if (records->capacity - records->count < BLEND_RECORD_ROOM ||
			records->weight_capacity - records->weight_count < BLEND_WEIGHT_ROOM)
			return k;
		if (k + 8 < n)
			__builtin_prefetch(&p[list[k + 8]]);
		for (uint32_t left = blend_setup(&rows, t, one) & t->live; left; left &= left - 1) {
			int r = __builtin_ctz(left);
			uint32_t all = 0;
			for (int i = 0; i < VEC_PARTS; i++) {
				vecn w = blend_part(t, &rows, r, i);
				vecni has = w > 0;
				uint32_t lanes = vec_bits(has);
				int32_t *count = t->count + r * TILE_SIZE + i * VEC_LANES;
				vecni counts;
				memcpy(&counts, count, sizeof counts);
				counts -= has;
				memcpy(count, &counts, sizeof counts);
				blend_pack(records->weights + records->weight_count, w, lanes);
				records->weight_count += (size_t)__builtin_popcount(lanes);
				all |= lanes << (i * VEC_LANES);
			}
			records->items[records->count] =
				(struct blend_record){one->index, (uint16_t)r, (uint16_t)all};
			records->count += all != 0;
		}
	}
	return n;
}

const struct blend_kernels BLEND_TABLE = {blend_values, blend_weights};
