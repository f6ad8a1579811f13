/* The backward blending kernel, for the instruction set in force where this is included. It walks as the
 * forward one does (splat/blend_kernel.h) and finds the same weights. */
#include "fit/back.h"
#include "splat/blend_kernel.h"

/* 1/x for x in [0.01, 1], within 2 ulp: Newton's method from the bits, as fast as a division is not, and the
 * same bits on all machines that fuse. */
VEC_INLINE vecn back_inverse(vecn x)
{
	vecn y = (vecn)(0x7ef311c7 - (vecni)x);

	for (int i = 0; i < 3; i++)
		y = vec_fma(y, vec_fnma(x, y, vec_splat(1)), y);
	return y;
}

struct back_block {
	struct blend_block at;
	vecn d[3][BLEND_PARTS], rest[BLEND_PARTS];
};

VEC_INLINE void back_add(float *sum, vecn x)
{
	vec_store(sum, vec_load(sum) + x);
}

/* Adds part i of a block to the sums of one Gaussian. */
VEC_INLINE void back_part(struct back_block *b, const struct blend_splat *s, const float *color,
	float (*sums)[BLEND_LANES], int i)
{
	const int lanes = i * VEC_LANES;
	vecn u = vec_fma(
		vec_splat(s->l11), b->at.x[i], vec_fma(vec_splat(s->l21), b->at.y[i], vec_splat(s->u)));
	vecn v = vec_fma(vec_splat(s->l22), b->at.y[i], vec_splat(s->v));
	vecn e = vec_fnma(u, u, vec_fnma(v, v, vec_splat(s->log_opacity)));
	vecm is_seen = vec_ge(e, vec_splat(BLEND_ALPHA_MIN_LOG2));
	vecn free = vec_exp2(e), a = vec_keep(is_seen, vec_min(free, vec_splat(BLEND_ALPHA_MAX)));
	vecn lit = b->at.lit[i], after = vec_fnma(a, lit, lit);
	vecm on = vec_ge(after, vec_splat(BLEND_STOP));
	vecn w = vec_keep(on, a * lit);
	vecn along = w * vec_fma(b->d[0][i], vec_splat(color[0]),
				 vec_fma(b->d[1][i], vec_splat(color[1]), b->d[2][i] * color[2]));
	vecn rest = b->rest[i] - along, g = vec_fnma(a * back_inverse(1 - a), rest, along);

	/* at its limit a does not change; where it has ended nothing does */
	g = vec_keep(on, vec_keep(vec_ge(vec_splat(BLEND_ALPHA_MAX), free), vec_keep(is_seen, g)));
	b->at.lit[i] = vec_keep(on, after);
	b->rest[i] = rest;
	vecn gu = g * u, gv = g * v;
	back_add(sums[BACK_G] + lanes, g);
	back_add(sums[BACK_U] + lanes, gu);
	back_add(sums[BACK_V] + lanes, gv);
	back_add(sums[BACK_UU] + lanes, gu * u);
	back_add(sums[BACK_UV] + lanes, gu * v);
	back_add(sums[BACK_VV] + lanes, gv * v);
	for (int c = 0; c < 3; c++)
		back_add(sums[BACK_RED + c] + lanes, w * b->d[c][i]);
	back_add(sums[BACK_WEIGHT] + lanes, w);
}

VEC_INLINE void back_block(struct blend_tile *t, struct back_tile *tile, struct back_sums *sums,
	const struct blend_chunk *chunk, uint64_t column, int k, const uint32_t *list, const float *colors)
{
	struct back_block b;

	blend_load(&b.at, t, k);
	for (int i = 0; i < BLEND_PARTS; i++) {
		const int at = k * BLEND_LANES + i * VEC_LANES;
		b.rest[i] = vec_load(tile->rest + at);
		for (int c = 0; c < 3; c++)
			b.d[c][i] = vec_load(tile->d[c] + at);
	}
	for (; column; column &= column - 1) {
		const int one = __builtin_ctzll(column);
		for (int i = 0; i < BLEND_PARTS; i++)
			back_part(&b, &chunk->splats[one], colors + 3 * (size_t)list[one], sums->of[one], i);
	}
	for (int i = 0; i < BLEND_PARTS; i++)
		vec_store(tile->rest + k * BLEND_LANES + i * VEC_LANES, b.rest[i]);
	blend_store(&b.at, t, k);
}

/* The sum over a block's places, in an order that does not depend on the instruction set. */
VEC_INLINE float back_total(const float *x)
{
	float half[8];

	for (int l = 0; l < 8; l++)
		half[l] = x[l] + x[l + 8];
	for (int l = 0; l < 4; l++)
		half[l] += half[l + 4];
	return (half[0] + half[2]) + (half[1] + half[3]);
}

static size_t back_tile(struct blend_tile *t, struct back_tile *b, struct back_sums *sums,
	const struct projected *p, const uint32_t *list, size_t n, const float *colors, float *out)
{
	struct blend_chunk chunk;
	size_t at = 0;

	blend_fetch(p, list, blend_chunk_size(n), colors, 3);
	while (at < n && t->live) {
		const size_t now = blend_chunk_size(n - at), next = at + now;
		blend_fetch(p, list + next, blend_chunk_size(n - next), colors, 3);
		blend_chunk_make(&chunk, t, p, list + at, now);
		memset(sums->of, 0, now * sizeof sums->of[0]);
		for (uint32_t live = t->live; live; live &= live - 1) {
			const int k = __builtin_ctz(live);
			const uint64_t column = blend_column(&chunk, k);
			if (column)
				back_block(t, b, sums, &chunk, column, k, list + at, colors);
		}
		for (size_t k = 0; k < now; k++)
			for (int s = 0; s < BACK_SUMS; s++)
				out[(at + k) * BACK_SUMS + (size_t)s] = back_total(sums->of[k][s]);
		at = next;
	}
	return at;
}
