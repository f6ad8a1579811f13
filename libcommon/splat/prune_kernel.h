/* Leaving out the smallest weights of a block's pixels, all its pixels side by side.
 *
 * Sums are exact in double, so that they may be taken in any order: weights from 2^-29 on are whole numbers
 * of 2^-52, and those of a pixel are at most 1 in sum. Bins of weights are by their exponent and some more
 * bits. Bisection by rounded sums finds a bin below which about a pixel's share is; from there on the least
 * goes, one after another. */
#include "base/vecmath.h"
#include "splat/kernels.h"

#include <math.h>

enum {
	PRUNE_PARTS = BLEND_LANES / VEC_LANES,
	PRUNE_FINE = 6,				/* bits of a bin, beside the exponent */
	PRUNE_FIRST = (127 - 29) << PRUNE_FINE, /* the bin of 2^-29 */
	PRUNE_BINS =
		((127 + 1) << PRUNE_FINE) - PRUNE_FIRST, /* the first and the last have all that is beyond */
	PRUNE_STEPS = 11,				 /* of bisection: 2^11 > PRUNE_BINS */
};

/* The least weights of bins. A float's bits rise with it. */
VEC_INLINE vecn prune_begin(vecni bin)
{
	return (vecn)((bin + PRUNE_FIRST) << (23 - PRUNE_FINE));
}

/* The sum of what is below `limit` in part i of the block, rounded. Four rows at a time, as an addition waits
 * for the one before; behind the last are rows of zeros. */
VEC_INLINE vecn prune_near_sum(const struct blend_rows *rows, int i, vecn limit)
{
	vecn sum[BLEND_ROWS_MORE] = {{0}};

	for (size_t k = 0; k < rows->n; k += BLEND_ROWS_MORE)
		for (int j = 0; j < BLEND_ROWS_MORE; j++) {
			vecn w = vec_load(rows->weights[k + (size_t)j] + i * VEC_LANES);
			sum[j] += vec_keep(vec_lt(w, limit), w);
		}
	return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

/* Of each lane of part i a bin below which about `most` is, and hardly more. */
VEC_INLINE vecni prune_bisect(const struct blend_rows *rows, int i, vecn most)
{
	vecni bin = {0}, high = bin + (PRUNE_BINS - 1);

	for (int step = 0; step < PRUNE_STEPS; step++) {
		const vecni middle = (bin + high + 1) >> 1;
		const vecm fits = vec_ge(most, prune_near_sum(rows, i, prune_begin(middle)));
		bin = (vecni)vec_choose(fits, (vecn)middle, (vecn)bin);
		high = (vecni)vec_choose(fits, (vecn)high, (vecn)(middle - 1));
	}
	return bin;
}

/* The sums of what is below `limit`, lane by lane, exactly. */
VEC_INLINE void prune_sums(
	const struct blend_rows *rows, const float limit[BLEND_LANES], double sums[BLEND_LANES])
{
	for (int i = 0; i < PRUNE_PARTS; i++) {
		const vecn below = vec_load(limit + i * VEC_LANES);
		vecd low = {0}, high = {0}, next_low = {0}, next_high = {0};
		for (size_t k = 0; k < rows->n; k += 2) {
			vecn w = vec_load(rows->weights[k] + i * VEC_LANES),
			     next = vec_load(rows->weights[k + 1] + i * VEC_LANES);
			w = vec_keep(vec_lt(w, below), w);
			next = vec_keep(vec_lt(next, below), next);
			low += vec_low(w);
			high += vec_high(w);
			next_low += vec_low(next);
			next_high += vec_high(next);
		}
		low += next_low;
		high += next_high;
		memcpy(sums + i * VEC_LANES, &low, sizeof low);
		memcpy(sums + i * VEC_LANES + VEC_LANES / 2, &high, sizeof high);
	}
}

/* What of a block's pixels goes. */
struct prune_share {
	double most[BLEND_LANES];  /* may go */
	double below[BLEND_LANES]; /* goes, as it is below begin */
	double out[BLEND_LANES];   /* goes in all */
	float begin[BLEND_LANES];  /* of a bin, near which the share ends */
};

VEC_INLINE void prune_find(const struct blend_rows *rows, double tolerance, struct prune_share *s)
{
	float most[BLEND_LANES];
	int is_over = 1;

	for (int l = 0; l < BLEND_LANES; l++)
		s->begin[l] = INFINITY;
	prune_sums(rows, s->begin, s->most);
	for (int l = 0; l < BLEND_LANES; l++) {
		s->most[l] *= tolerance;
		most[l] = (float)s->most[l];
	}
	for (int i = 0; i < PRUNE_PARTS; i++)
		vec_store(s->begin + i * VEC_LANES,
			prune_begin(prune_bisect(rows, i, vec_load(most + i * VEC_LANES))));
	while (is_over) { /* again where rounding said so, and from the start */
		prune_sums(rows, s->begin, s->below);
		is_over = 0;
		for (int l = 0; l < BLEND_LANES; l++)
			if (s->below[l] > s->most[l]) {
				s->begin[l] = 0;
				is_over = 1;
			}
	}
	memcpy(s->out, s->below, sizeof s->out);
}

/* The least weight of each lane from `from` on, the farthest of equal ones, and its row; infinity where none.
 */
VEC_INLINE void prune_least(const struct blend_rows *rows, const float from[BLEND_LANES],
	float least[BLEND_LANES], int32_t at[BLEND_LANES])
{
	for (int i = 0; i < PRUNE_PARTS; i++) {
		const vecn begin = vec_load(from + i * VEC_LANES);
		vecn best = vec_splat(INFINITY);
		vecni row = {0};
		for (size_t k = 0; k < rows->n; k++) {
			const vecn w = vec_load(rows->weights[k] + i * VEC_LANES);
			const vecm less = vec_ge(w, begin) & vec_ge(best, w);
			best = vec_choose(less, w, best);
			row = (vecni)vec_choose(less, (vecn)((int32_t)k - (vecni){0}), (vecn)row);
		}
		vec_store(least + i * VEC_LANES, best);
		memcpy(at + i * VEC_LANES, &row, sizeof row);
	}
}

/* Takes the least from `begin` on, as long as the sum allows. */
VEC_INLINE void prune_bin(struct blend_rows *rows, struct prune_share *s)
{
	float from[BLEND_LANES], least[BLEND_LANES];
	int32_t at[BLEND_LANES];
	int goes_on = 1;

	for (int l = 0; l < BLEND_LANES; l++)
		from[l] = s->begin[l] > 0 ? s->begin[l] : 0x1p-126F; /* no weight is 0 */
	while (goes_on) {
		goes_on = 0;
		prune_least(rows, from, least, at);
		for (int l = 0; l < BLEND_LANES; l++) {
			const double out = s->out[l] + (double)least[l];
			if (out <= s->most[l]) {
				s->out[l] = out;
				rows->weights[at[l]][l] = 0;
				goes_on = 1;
			} else {
				from[l] = INFINITY;
			}
		}
	}
}

/* Puts 0 in place of what is below `limit`, the sums of which are given, and takes out the rows that are
 * empty then. */
VEC_INLINE void prune_below(struct blend_rows *rows, const float limit[BLEND_LANES], double sums[BLEND_LANES])
{
	size_t left = 0;

	prune_sums(rows, limit, sums);
	for (size_t k = 0; k < rows->n; k++) {
		uint32_t lanes = 0;
		for (int i = 0; i < PRUNE_PARTS; i++) {
			const vecn w = vec_load(rows->weights[k] + i * VEC_LANES),
				   kept = vec_keep(vec_ge(w, vec_load(limit + i * VEC_LANES)), w);
			vec_store(rows->weights[left] + i * VEC_LANES, kept);
			lanes |= vec_bits(vec_lt(vec_splat(0), kept)) << (i * VEC_LANES);
		}
		rows->places[left] = rows->places[k];
		rows->lanes[left] = (uint16_t)lanes;
		left += lanes != 0;
	}
	rows->n = left;
}

__attribute__((unused)) static void prune_rows(
	struct blend_rows *rows, double tolerance, float least, float dropped[BLEND_LANES])
{
	struct prune_share s = {.begin = {0}};
	float limit[BLEND_LANES];
	double sums[BLEND_LANES];

	memset(rows->weights[rows->n], 0, BLEND_ROWS_MORE * sizeof rows->weights[0]);
	if (tolerance > 0) {
		prune_find(rows, tolerance, &s);
		prune_bin(rows, &s);
	}
	for (int l = 0; l < BLEND_LANES; l++)
		limit[l] = least > s.begin[l] ? least : s.begin[l];
	prune_below(rows, limit, sums);
	for (int l = 0; l < BLEND_LANES; l++) {
		const double all = (double)(float)s.out[l] + (sums[l] - s.below[l]);
		dropped[l] = all < 1 ? (float)all : 1;
	}
}
