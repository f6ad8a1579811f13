/* The blending kernels, for the instruction set in force where this is included; BLEND_TABLE names the
 * result.
 *
 * A tile is 4x4 blocks of 4x4 pixels, and a block is BLEND_PARTS vectors: small Gaussians leave fewer lanes
 * idle so than in rows of 16 (on a trained scene a third fewer vectors). u and v (splat/project.h) of the
 * tile's centre are computed in double; what is added in float is small, so that a needle far from its mean
 * keeps its digits. */
#include "base/vecmath.h"
#include "splat/kernels.h"

#include <math.h>

enum { BLEND_PARTS = BLEND_LANES / VEC_LANES };

/* Offsets of a block's pixels from its centre; times 4, of a tile's block centres from the tile's. */
static const float blend_x[BLEND_LANES] __attribute__((aligned(64))) = {-1.5f, -0.5f, 0.5f, 1.5f, -1.5f,
	-0.5f, 0.5f, 1.5f, -1.5f, -0.5f, 0.5f, 1.5f, -1.5f, -0.5f, 0.5f, 1.5f};
static const float blend_y[BLEND_LANES] __attribute__((aligned(64))) = {-1.5f, -1.5f, -1.5f, -1.5f, -0.5f,
	-0.5f, -0.5f, -0.5f, 0.5f, 0.5f, 0.5f, 0.5f, 1.5f, 1.5f, 1.5f, 1.5f};

/* One Gaussian in one tile. */
struct blend_splat {
	float u[BLEND_BLOCKS] __attribute__((aligned(64))); /* at the blocks' centres */
	float v[BLEND_BLOCKS] __attribute__((aligned(64)));
	vecn du[BLEND_PARTS], dv[BLEND_PARTS]; /* what a pixel's place in its block adds */
	vecn log_opacity;
};

/* Fills *s; returns a bit for each block that the ellipse a >= 1/255 may meet. */
VEC_INLINE uint32_t blend_setup(struct blend_splat *s, const struct blend_tile *t, const struct projected *p)
{
	double dx = t->x - p->x, dy = t->y - p->y;
	vecn u0 = vec_splat((float)(p->l11 * dx + p->l21 * dy)), v0 = vec_splat((float)(p->l22 * dy));
	vecn l11 = vec_splat((float)p->l11), l21 = vec_splat((float)p->l21), l22 = vec_splat((float)p->l22);
	/* how far u and v stray from their values at a block's centre */
	vecn du = 1.5f * (l11 + vec_max(l21, -l21)), dv = 1.5f * l22;
	uint32_t bits = 0;

	s->log_opacity = vec_splat(p->log_opacity);
	for (int i = 0; i < BLEND_PARTS; i++) {
		vecn x = vec_load(blend_x + i * VEC_LANES), y = vec_load(blend_y + i * VEC_LANES);
		s->du[i] = vec_fma(l11, x, l21 * y);
		s->dv[i] = l22 * y;
		vecn u = vec_fma(vec_splat(4), s->du[i], u0), v = vec_fma(vec_splat(4), s->dv[i], v0);
		vec_store(s->u + i * VEC_LANES, u);
		vec_store(s->v + i * VEC_LANES, v);
		/* the least |u| and |v| in the block */
		u = vec_max(vec_max(u, -u) - du, vec_splat(0));
		v = vec_max(vec_max(v, -v) - dv, vec_splat(0));
		/* 1e-3 covers rounding; each pixel decides by itself */
		vecn most = vec_fnma(u, u, vec_fnma(v, v, s->log_opacity));
		bits |= vec_bits(vec_ge(most, vec_splat(BLEND_ALPHA_MIN_LOG2 - 1e-3f))) << (i * VEC_LANES);
	}
	return bits;
}

/* Ends the pixels of `stop` in the part at `at` of block b, and the block when no pixel of it is left. */
VEC_INLINE void blend_stop(struct blend_tile *t, int b, int at, vecm stop)
{
	int is_live = 0;

	vec_store(t->cut + at, vec_choose(stop, vec_splat(INFINITY), vec_load(t->cut + at)));
	for (int i = 0; i < BLEND_PARTS; i++)
		is_live |= vec_bits(vec_lt(vec_load(t->cut + b * BLEND_LANES + i * VEC_LANES),
				   vec_splat(INFINITY))) != 0;
	if (!is_live)
		t->live &= ~(1u << b);
}

/* The weights of part i of block b, zero where none. Updates transmittance, cut and live. */
VEC_INLINE vecn blend_part(struct blend_tile *t, const struct blend_splat *s, int b, int i)
{
	int at = b * BLEND_LANES + i * VEC_LANES;
	vecn u = s->du[i] + vec_splat(s->u[b]), v = s->dv[i] + vec_splat(s->v[b]);
	vecn e = vec_fnma(u, u, vec_fnma(v, v, s->log_opacity));
	vecm keep = vec_ge(e, vec_load(t->cut + at));
	/* where e is out of range for vec_exp2 it is below the cut, and what comes out is masked */
	vecn a = vec_keep(keep, vec_min(vec_exp2(e), vec_splat(BLEND_ALPHA_MAX)));
	vecn before = vec_load(t->transmittance + at), w = a * before, after = before - w;
	vecm stop = vec_lt(after, vec_splat(BLEND_STOP)) & keep;

	if (__builtin_expect(vec_bits(stop) != 0, 0)) {
		w = vec_choose(stop, vec_splat(0), w);
		after = before - w;
		blend_stop(t, b, at, stop);
	}
	vec_store(t->transmittance + at, after);
	return w;
}

VEC_INLINE void blend_channels(struct blend_tile *t, const struct projected *p, const uint32_t *list,
	size_t n, const float *values, int channels)
{
	struct blend_splat s;

	for (size_t k = 0; k < n && t->live; k++) {
		const float *value = values + (size_t)list[k] * (size_t)channels;
		if (k + 8 < n)
			__builtin_prefetch(&p[list[k + 8]]);
		for (uint32_t left = blend_setup(&s, t, &p[list[k]]) & t->live; left; left &= left - 1) {
			int b = __builtin_ctz(left);
			for (int i = 0; i < BLEND_PARTS; i++) {
				vecn w = blend_part(t, &s, b, i);
				for (int c = 0; c < channels; c++) {
					float *sum = t->sum[c] + b * BLEND_LANES + i * VEC_LANES;
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
	struct blend_splat s;

	for (size_t k = 0; k < n; k++) {
		const struct projected *one = &p[list[k]];
		if (!t->live)
			return n;
		if (records->capacity - records->count < BLEND_RECORD_ROOM ||
			records->weight_capacity - records->weight_count < BLEND_WEIGHT_ROOM)
			return k;
		if (k + 8 < n)
			__builtin_prefetch(&p[list[k + 8]]);
		for (uint32_t left = blend_setup(&s, t, one) & t->live; left; left &= left - 1) {
			int b = __builtin_ctz(left);
			uint32_t all = 0;
			for (int i = 0; i < BLEND_PARTS; i++) {
				vecn w = blend_part(t, &s, b, i);
				vecm has = vec_lt(vec_splat(0), w);
				uint32_t lanes = vec_bits(has);
				vec_count(t->count + b * BLEND_LANES + i * VEC_LANES, has);
				blend_pack(records->weights + records->weight_count, w, lanes);
				records->weight_count += (size_t)__builtin_popcount(lanes);
				all |= lanes << (i * VEC_LANES);
			}
			records->items[records->count] =
				(struct blend_record){one->index, (uint16_t)b, (uint16_t)all};
			records->count += all != 0;
		}
	}
	return n;
}
