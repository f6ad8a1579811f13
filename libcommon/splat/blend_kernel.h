/* The blending kernels, for the instruction set in force where this is included.
 *
 * A tile is 4x4 blocks of 4x4 pixels, and a block is BLEND_PARTS vectors: small Gaussians leave fewer lanes
 * idle so than in rows of 16 (on a trained scene a third fewer vectors). Of a chunk of Gaussians the blocks
 * that each may meet are found first; then block after block is blended, its pixels in registers. u and v
 * (splat/project.h) of the tile's centre are computed in double; what is added in float is small, so that a
 * needle far from its mean keeps its digits. */
#include "base/vecmath.h"
#include "splat/kernels.h"

enum { BLEND_PARTS = BLEND_LANES / VEC_LANES };

/* Offsets of a block's pixels from its centre; times 4, of a tile's block centres from the tile's. */
static const float blend_x[BLEND_LANES] __attribute__((aligned(64))) = {-1.5f, -0.5f, 0.5f, 1.5f, -1.5f,
	-0.5f, 0.5f, 1.5f, -1.5f, -0.5f, 0.5f, 1.5f, -1.5f, -0.5f, 0.5f, 1.5f};
static const float blend_y[BLEND_LANES] __attribute__((aligned(64))) = {-1.5f, -1.5f, -1.5f, -1.5f, -0.5f,
	-0.5f, -0.5f, -0.5f, 0.5f, 0.5f, 0.5f, 0.5f, 1.5f, 1.5f, 1.5f, 1.5f};

/* A bit for each block that the ellipse a >= 1/255 may meet. */
VEC_INLINE uint32_t blend_blocks(const struct blend_splat *s)
{
	vecn l11 = vec_splat(s->l11), l21 = vec_splat(s->l21), l22 = vec_splat(s->l22);
	/* how far u and v stray from their values at a block's centre */
	vecn du = 1.5f * (l11 + vec_max(l21, -l21)), dv = 1.5f * l22;
	uint32_t bits = 0;

	for (int i = 0; i < BLEND_PARTS; i++) {
		vecn x = 4 * vec_load(blend_x + i * VEC_LANES), y = 4 * vec_load(blend_y + i * VEC_LANES);
		vecn u = vec_fma(l11, x, vec_fma(l21, y, vec_splat(s->u)));
		vecn v = vec_fma(l22, y, vec_splat(s->v));
		/* the least |u| and |v| in the block */
		u = vec_max(vec_max(u, -u) - du, vec_splat(0));
		v = vec_max(vec_max(v, -v) - dv, vec_splat(0));
		/* 1e-3 covers rounding; each pixel decides by itself */
		vecn most = vec_fnma(u, u, vec_fnma(v, v, vec_splat(s->log_opacity)));
		bits |= vec_bits(vec_ge(most, vec_splat(BLEND_ALPHA_MIN_LOG2 - 1e-3f))) << (i * VEC_LANES);
	}
	return bits;
}

VEC_INLINE void blend_chunk_make(struct blend_chunk *chunk, const struct blend_tile *t,
	const struct projected *p, const uint32_t *list, size_t n)
{
	for (size_t k = 0; k < n; k++) {
		const struct projected *one = &p[list[k]];
		struct blend_splat *s = &chunk->splats[k];
		double dx = t->x - one->x, dy = t->y - one->y;
		*s = (struct blend_splat){(float)(one->l11 * dx + one->l21 * dy), (float)(one->l22 * dy),
			one->slope[0], one->slope[1], one->slope[2], one->log_opacity};
		chunk->blocks[k] = (uint16_t)blend_blocks(s);
	}
	for (size_t k = n; k < BLEND_CHUNK; k++)
		chunk->blocks[k] = 0;
}

/* Bit k: Gaussian k of the chunk may meet block b. */
VEC_INLINE uint64_t blend_column(const struct blend_chunk *chunk, int b)
{
	uint64_t column = 0;

#if VEC_LANES == 16
	const __m512i bit = _mm512_set1_epi16((short)(1 << b));
	column = _mm512_test_epi16_mask(_mm512_load_si512(chunk->blocks), bit);
	column |= (uint64_t)_mm512_test_epi16_mask(_mm512_load_si512(chunk->blocks + 32), bit) << 32;
#elif VEC_LANES == 8
	const __m256i bit = _mm256_set1_epi16((short)(1 << b));
	for (int k = 0; k < BLEND_CHUNK; k += 32) {
		const __m256i *at = (const __m256i *)(chunk->blocks + k);
		__m256i low = _mm256_cmpeq_epi16(_mm256_and_si256(_mm256_load_si256(at), bit), bit);
		__m256i high = _mm256_cmpeq_epi16(_mm256_and_si256(_mm256_load_si256(at + 1), bit), bit);
		/* packs within halves: the quarters come as 0, 2, 1, 3 */
		__m256i both = _mm256_permute4x64_epi64(_mm256_packs_epi16(low, high), 0xd8);
		column |= (uint64_t)(uint32_t)_mm256_movemask_epi8(both) << k;
	}
#else
	for (int k = 0; k < BLEND_CHUNK; k++)
		column |= (uint64_t)(chunk->blocks[k] >> b & 1) << k;
#endif
	return column;
}

/* A block's pixels. */
struct blend_block {
	vecn x[BLEND_PARTS], y[BLEND_PARTS]; /* from the tile's centre */
	vecn left[BLEND_PARTS];		     /* transmittance */
	vecn lit[BLEND_PARTS];		     /* the same, 0 where the pixel has ended or is none */
};

VEC_INLINE void blend_load(struct blend_block *block, const struct blend_tile *t, int b)
{
	for (int i = 0; i < BLEND_PARTS; i++) {
		int at = b * BLEND_LANES + i * VEC_LANES;
		block->x[i] = vec_load(blend_x + i * VEC_LANES) + (float)(BLEND_SIDE * (b % BLEND_SIDE) - 6);
		block->y[i] = vec_load(blend_y + i * VEC_LANES) + (float)(BLEND_SIDE * (b / BLEND_SIDE) - 6);
		block->left[i] = vec_load(t->transmittance + at);
		block->lit[i] = vec_load(t->lit + at);
	}
}

/* Puts a block back; it is not live any more when no pixel of it is left. */
VEC_INLINE void blend_store(const struct blend_block *block, struct blend_tile *t, int b)
{
	uint32_t live = 0;

	for (int i = 0; i < BLEND_PARTS; i++) {
		int at = b * BLEND_LANES + i * VEC_LANES;
		vec_store(t->transmittance + at, block->left[i]);
		vec_store(t->lit + at, block->lit[i]);
		live |= vec_bits(vec_lt(vec_splat(0), block->lit[i]));
	}
	if (!live)
		t->live &= ~(1u << b);
}

/* The weights of one Gaussian in part i of a block, zero where none. */
VEC_INLINE vecn blend_part(struct blend_block *block, const struct blend_splat *s, int i)
{
	vecn u = vec_fma(
		vec_splat(s->l11), block->x[i], vec_fma(vec_splat(s->l21), block->y[i], vec_splat(s->u)));
	vecn v = vec_fma(vec_splat(s->l22), block->y[i], vec_splat(s->v));
	vecn e = vec_fnma(u, u, vec_fnma(v, v, vec_splat(s->log_opacity)));
	/* where e is out of range for vec_exp2 it is below the least, and what comes out is masked */
	vecn a = vec_keep(
		vec_ge(e, vec_splat(BLEND_ALPHA_MIN_LOG2)), vec_min(vec_exp2(e), vec_splat(BLEND_ALPHA_MAX)));
	vecn lit = block->lit[i], after = vec_fnma(a, lit, lit);
	/* No branch where a pixel ends: that would wait for all that is before it. */
	vecm on = vec_ge(after, vec_splat(BLEND_STOP));

	block->lit[i] = vec_keep(on, after);
	block->left[i] = vec_choose(on, after, block->left[i]);
	return vec_keep(on, a * lit);
}

/* Blends the Gaussians of `column` into block b; their values stand at values[list[k] * channels]. */
VEC_INLINE void blend_block_values(struct blend_tile *t, const struct blend_chunk *chunk, uint64_t column,
	int b, const uint32_t *list, const float *values, int channels)
{
	struct blend_block block;
	vecn sum[BLEND_CHANNELS][BLEND_PARTS];

	blend_load(&block, t, b);
	for (int c = 0; c < channels; c++)
		for (int i = 0; i < BLEND_PARTS; i++)
			sum[c][i] = vec_load(t->sum[c] + b * BLEND_LANES + i * VEC_LANES);
	for (; column; column &= column - 1) {
		int k = __builtin_ctzll(column);
		const float *value = values + (size_t)list[k] * (size_t)channels;
		for (int i = 0; i < BLEND_PARTS; i++) {
			vecn w = blend_part(&block, &chunk->splats[k], i);
			for (int c = 0; c < channels; c++)
				sum[c][i] = vec_fma(w, vec_splat(value[c]), sum[c][i]);
		}
	}
	for (int c = 0; c < channels; c++)
		for (int i = 0; i < BLEND_PARTS; i++)
			vec_store(t->sum[c] + b * BLEND_LANES + i * VEC_LANES, sum[c][i]);
	blend_store(&block, t, b);
}

/* Brings p into the cache by a read: a prefetch does nothing where the page's address is not at hand. */
VEC_INLINE void blend_touch(const void *p)
{
	(void)*(const volatile char *)p;
}

/* What the next chunk looks up is read while this one is blended. values may be NULL. */
VEC_INLINE void blend_fetch(
	const struct projected *p, const uint32_t *list, size_t n, const float *values, int channels)
{
	for (size_t k = 0; k < n; k++) {
		blend_touch(&p[list[k]]);
		if (values)
			blend_touch(values + (size_t)list[k] * (size_t)channels);
	}
}

VEC_INLINE size_t blend_chunk_size(size_t left)
{
	return left < BLEND_CHUNK ? left : BLEND_CHUNK;
}

VEC_INLINE void blend_channels(struct blend_tile *t, const struct projected *p, const uint32_t *list,
	size_t n, const float *values, int channels)
{
	struct blend_chunk chunk;

	blend_fetch(p, list, blend_chunk_size(n), values, channels);
	for (size_t at = 0; at < n && t->live; at += BLEND_CHUNK) {
		size_t now = blend_chunk_size(n - at), next = at + now;
		blend_fetch(p, list + next, blend_chunk_size(n - next), values, channels);
		blend_chunk_make(&chunk, t, p, list + at, now);
		for (uint32_t live = t->live; live; live &= live - 1) {
			int b = __builtin_ctz(live);
			uint64_t column = blend_column(&chunk, b);
			if (column)
				blend_block_values(t, &chunk, column, b, list + at, values, channels);
		}
	}
}

__attribute__((unused)) static void blend_values(struct blend_tile *t, const struct projected *p,
	const uint32_t *list, size_t n, const float *values, int channels)
{
	/* so that the sums of a block stay in registers */
	if (channels == 1)
		blend_channels(t, p, list, n, values, 1);
	else if (channels == 3)
		blend_channels(t, p, list, n, values, 3);
	else if (channels == BLEND_CHANNELS)
		blend_channels(t, p, list, n, values, BLEND_CHANNELS);
	else
		blend_channels(t, p, list, n, values, channels);
}

/* Counts the weights of the Gaussians of `column` in block b. */
VEC_INLINE void blend_block_counts(
	struct blend_tile *t, const struct blend_chunk *chunk, uint64_t column, int b)
{
	struct blend_block block;

	blend_load(&block, t, b);
	for (; column; column &= column - 1)
		for (int i = 0; i < BLEND_PARTS; i++)
			vec_count(t->count + b * BLEND_LANES + i * VEC_LANES,
				vec_lt(vec_splat(0),
					blend_part(&block, &chunk->splats[__builtin_ctzll(column)], i)));
	blend_store(&block, t, b);
}

__attribute__((unused)) static void blend_counts(
	struct blend_tile *t, const struct projected *p, const uint32_t *list, size_t n)
{
	struct blend_chunk chunk;

	blend_fetch(p, list, blend_chunk_size(n), NULL, 0);
	for (size_t at = 0; at < n && t->live; at += BLEND_CHUNK) {
		size_t now = blend_chunk_size(n - at), next = at + now;
		blend_fetch(p, list + next, blend_chunk_size(n - next), NULL, 0);
		blend_chunk_make(&chunk, t, p, list + at, now);
		for (uint32_t live = t->live; live; live &= live - 1) {
			int b = __builtin_ctz(live);
			uint64_t column = blend_column(&chunk, b);
			if (column)
				blend_block_counts(t, &chunk, column, b);
		}
	}
}

/* Blends the Gaussians of `column`, which stand in the list from `at` on, into rows. */
VEC_INLINE void blend_column_rows(struct blend_block *block, const struct blend_chunk *chunk, uint64_t column,
	size_t at, struct blend_rows *rows)
{
	for (; column; column &= column - 1) {
		int k = __builtin_ctzll(column);
		uint32_t lanes = 0;
		for (int i = 0; i < BLEND_PARTS; i++) {
			vecn w = blend_part(block, &chunk->splats[k], i);
			vec_store(rows->weights[rows->n] + i * VEC_LANES, w);
			lanes |= vec_bits(vec_lt(vec_splat(0), w)) << (i * VEC_LANES);
		}
		rows->places[rows->n] = (uint32_t)(at + (size_t)k);
		rows->lanes[rows->n] = (uint16_t)lanes;
		rows->n += lanes != 0;
	}
}

__attribute__((unused)) static void blend_rows(struct blend_tile *t, const struct projected *p,
	const uint32_t *list, size_t n, int b, struct blend_chunk *chunks, size_t *made,
	struct blend_rows *rows)
{
	struct blend_block block;
	size_t at = 0;

	rows->n = 0;
	for (; at < n && t->live >> b & 1; at += BLEND_CHUNK) {
		struct blend_chunk *chunk = &chunks[at / BLEND_CHUNK];
		size_t now = blend_chunk_size(n - at), next = at + now;
		if (at / BLEND_CHUNK == *made) {
			blend_fetch(p, list + next, blend_chunk_size(n - next), NULL, 0);
			blend_chunk_make(chunk, t, p, list + at, now);
			++*made;
		}
		uint64_t column = blend_column(chunk, b);
		if (!column)
			continue;
		blend_load(&block, t, b);
		blend_column_rows(&block, chunk, column, at, rows);
		blend_store(&block, t, b);
	}
}
