/* The forward kernels of field/block.h, and what both directions use. Included by block_kernel.h. */
#include "field/block_product.h"

#include <math.h>
#include <string.h>

static const float *panel_of(const float *array, int channels, size_t panel)
{
	return array + panel * (size_t)channels * L;
}

static float *panel_at(float *array, int channels, size_t panel)
{
	return array + panel * (size_t)channels * L;
}

/* The panel of BLOCK_G channels to fetch ahead; NULL where there is none. */
static const float *panel_ahead(const struct block_model *b, const float *array, size_t panel)
{
	return array && panel * L < b->gaussians ? panel_of(array, BLOCK_G, panel) : NULL;
}

/* Lanes of a panel that hold Gaussians. */
static int panel_lanes(const struct block_model *b, size_t panel)
{
	size_t first = panel * L;

	return first >= b->gaussians ? 0 : b->gaussians - first < L ? (int)(b->gaussians - first) : L;
}

/* r_i = nu_i [q_i; 1] in place of [q_i; 1], nu = 1/|p|, |p|^2 = [q;1]^T P [q;1]. */
static void scale_positions(const struct block_model *b, float *r, float *scratch)
{
	product_set(scratch, b->p_gram, BLOCK_G, BLOCK_G, BLOCK_G, r);
	for (int v = 0; v < L; v += VEC_LANES) {
		vecn squared = vec_splat(0);
		for (int c = 0; c < BLOCK_G; c++)
			squared += vec_load(scratch + c * L + v) * vec_load(r + c * L + v);
		vecn nu = vec_splat(1) / vec_sqrt(vec_max(squared, vec_splat(1e-24f)));
		for (int c = 0; c < BLOCK_G; c++)
			vec_store(r + c * L + v, vec_load(r + c * L + v) * nu);
	}
}

/* Adds a block's share to the softmax over Gaussians: e = exp(l - max) summed, and summed times r. */
static void add_word_positions(const struct block_model *b, const float *logits, const float *r, size_t panel,
	struct block_sums *sums, float *e)
{
	const int n = b->words;

	for (int j = 0; j < n; j++) {
		vecn top = vec_splat(-INFINITY);
		for (int p = 0; p < BLOCK_PANELS; p++) {
			int lanes = panel_lanes(b, panel + (size_t)p);
			const float *l = panel_of(logits, n, (size_t)p) + j * L;
			for (int v = 0; v < L; v += VEC_LANES)
				top = vec_max(top, vec_first(vec_load(l + v), lanes - v, -INFINITY));
		}
		float largest = sums->l_max[j];
		float lanes_top[VEC_LANES];
		vec_store(lanes_top, top);
		for (int i = 0; i < VEC_LANES; i++)
			largest = fmaxf(largest, lanes_top[i]);
		if (largest > sums->l_max[j]) {
			float shrink = expf(sums->l_max[j] - largest);
			sums->l_sum[j] *= shrink;
			for (int c = 0; c < BLOCK_G; c++)
				sums->c_sum[j * BLOCK_G + c] *= shrink;
			sums->l_max[j] = largest;
		}
		for (int p = 0; p < BLOCK_PANELS; p++) {
			int lanes = panel_lanes(b, panel + (size_t)p);
			const float *l = panel_of(logits, n, (size_t)p) + j * L;
			float *to = panel_at(e, n, (size_t)p) + j * L;
			for (int v = 0; v < L; v += VEC_LANES)
				vec_store(to + v, vec_first(vec_exp(vec_load(l + v) - vec_splat(largest)),
							  lanes - v, 0));
		}
	}
	sum_channels(sums->l_sum, n, e, n, BLOCK_PANELS);
	outer(sums->c_sum, n, BLOCK_G, BLOCK_G, e, n, r, BLOCK_G, BLOCK_PANELS);
}

static void hidden(const struct block_model *b, const struct block_arrays *a, size_t block,
	struct block_sums *sums, float *scratch)
{
	const size_t first = block * BLOCK_PANELS;
	const int width = b->feature_width;

	for (size_t panel = first; panel < first + BLOCK_PANELS; panel++) {
		float *g = panel_at(a->g, BLOCK_G, panel);
		product_relu(scratch, b->feature0, REFER_XH, width, panel_of(a->x, width, panel),
			b->feature0_bias, NULL);
		product_relu(g, b->feature1, REFER_H, REFER_XH, scratch, b->feature1_bias,
			panel_ahead(b, a->g, panel + 1));
		for (int v = 0; v < L; v += VEC_LANES)
			vec_store(g + REFER_H * L + v, vec_splat(1));
		if (b->has_words)
			product_set(panel_at(a->beta, b->words, panel), b->y, b->words, BLOCK_G, BLOCK_G, g);
		if (!b->uses_position)
			continue;
		float *r = panel_at(a->r, BLOCK_G, panel);
		product_relu(scratch, b->position0, REFER_PH, 3, panel_of(a->position, 3, panel),
			b->position0_bias, NULL);
		product_relu(r, b->position1, REFER_H, REFER_PH, scratch, b->position1_bias,
			panel_ahead(b, a->r, panel + 1));
		for (int v = 0; v < L; v += VEC_LANES)
			vec_store(r + REFER_H * L + v, vec_splat(1));
		if (b->is_projected)
			scale_positions(b, r, scratch);
	}
	if (b->has_words)
		add_word_positions(b, panel_of(a->beta, b->words, first), panel_of(a->r, BLOCK_G, first),
			first, sums, scratch);
}

/* alpha in place of scores for the words [from,to) of one panel. */
static void softmax_words(float *s, int from, int to)
{
	for (int v = 0; v < L; v += VEC_LANES) {
		vecn top = vec_load(s + from * L + v), sum = vec_splat(0);
		for (int j = from + 1; j < to; j++)
			top = vec_max(top, vec_load(s + j * L + v));
		for (int j = from; j < to; j++) {
			vecn e = vec_exp(vec_load(s + j * L + v) - top);
			sum += e;
			vec_store(s + j * L + v, e);
		}
		vecn scale = vec_splat(1) / sum;
		for (int j = from; j < to; j++)
			vec_store(s + j * L + v, vec_load(s + j * L + v) * scale);
	}
}

/* Channels of z of one sentence, without its alphas. */
static int z_fixed(const struct block_model *b)
{
	return b->is_add ? 2 * BLOCK_G : BLOCK_G;
}

static int z_channels(const struct block_model *b, int s)
{
	return z_fixed(b) + (b->has_attention ? b->first[s + 1] - b->first[s] : 0);
}

/* A part of z, where it lies: `count` of the `channels` of a panel, which are z's from `start` on. */
struct stretch {
	const float *at;
	int channels, start, count;
};

enum { STRETCHES = 3 };

/* z of one sentence and panel. Returns how many stretches it has. */
static int stretches(const struct block_model *b, const struct block_arrays *a, size_t panel, int s,
	struct stretch z[STRETCHES])
{
	int count = 0;

	z[count++] = (struct stretch){panel_of(a->g, BLOCK_G, panel), BLOCK_G, 0, BLOCK_G};
	if (b->is_add)
		z[count++] = (struct stretch){panel_of(a->r, BLOCK_G, panel), BLOCK_G, BLOCK_G, BLOCK_G};
	if (b->has_attention)
		z[count++] = (struct stretch){panel_of(a->alpha, b->words, panel) + b->first[s] * L, b->words,
			z_fixed(b), b->first[s + 1] - b->first[s]};
	return count;
}

/* m = k.z */
static void plain_response(
	const struct block_model *b, const struct block_arrays *a, size_t panel, int s, float *m)
{
	const float *k = b->k + (size_t)s * (size_t)b->z_size;
	struct stretch z[STRETCHES];
	struct term terms[STRETCHES];
	const int count = stretches(b, a, panel, s, z);

	for (int i = 0; i < count; i++)
		terms[i] = (struct term){k + z[i].start, z[i].count, z[i].count, z[i].at};
	product_sum(m, NULL, 1, terms, count, no_panels);
}

/* Adds the share of `rows` rows of the triangle H, from row r of z's stretch `own` on, to z^T H z and to k.z.
 */
VEC_INLINE void quadratic_tile(const int rows, const float *half, const float *k, int size,
	const struct stretch *z, int own, int r, int v, vecn squared[TILE], vecn along[TILE])
{
	const float *row = half + (size_t)(z[own].start + r) * (size_t)size;
	vecn sum[ROWS][TILE];

#pragma GCC unroll 6
	for (int i = 0; i < rows; i++)
#pragma GCC unroll 4
		for (int w = 0; w < TILE; w++)
			sum[i][w] = vec_splat(0);
	for (int p = 0; p <= own; p++)
		tile_add(rows, sum, row + z[p].start, size, p < own ? z[p].count : r + rows, z[p].at + v);
#pragma GCC unroll 6
	for (int i = 0; i < rows; i++) {
		const vecn scale = vec_splat(k[z[own].start + r + i]);
#pragma GCC unroll 4
		for (int w = 0; w < TILE; w++) {
			vecn x = vec_load(z[own].at + (r + i) * L + v + VEC_LANES * w);
			squared[w] = vec_fma(sum[i][w], x, squared[w]);
			along[w] = vec_fma(scale, x, along[w]);
		}
	}
}

static void normalised_response(
	const struct block_model *b, const struct block_arrays *a, size_t panel, int s, float *m)
{
	const int size = b->z_size;
	const float *half = b->half + (size_t)s * (size_t)size * (size_t)size,
		    *k = b->k + (size_t)s * (size_t)size;
	float *sigma = panel_at(a->sigma, b->sentences, panel) + s * L;
	struct stretch z[STRETCHES];
	const int count = stretches(b, a, panel, s, z);

	for (int v = 0; v < L; v += TILE * VEC_LANES) {
		vecn squared[TILE], along[TILE];
		for (int w = 0; w < TILE; w++) {
			squared[w] = vec_splat(b->eps);
			along[w] = vec_splat(0);
		}
		for (int own = 0; own < count; own++) {
			int r = 0;
			for (; r + ROWS <= z[own].count; r += ROWS) {
				if (own == 0 && v == 0) {
					fetch_part(panel_ahead(b, a->g, panel + 1), r / ROWS,
						z[own].count / ROWS);
					fetch_part(panel_ahead(b, a->r, panel + 1), r / ROWS,
						z[own].count / ROWS);
				}
				quadratic_tile(ROWS, half, k, size, z, own, r, v, squared, along);
			}
			for (; r + 2 <= z[own].count; r += 2)
				quadratic_tile(2, half, k, size, z, own, r, v, squared, along);
			for (; r < z[own].count; r++)
				quadratic_tile(1, half, k, size, z, own, r, v, squared, along);
		}
		for (int w = 0; w < TILE; w++) {
			vecn scale = vec_splat(1) / vec_sqrt(vec_max(squared[w], vec_splat(b->floor)));
			vec_store(sigma + v + VEC_LANES * w, scale);
			vec_store(m + v + VEC_LANES * w, along[w] * scale + vec_splat(b->m0[s]));
		}
	}
}

static void respond(const struct block_model *b, const struct block_arrays *a, size_t block)
{
	for (size_t panel = block * BLOCK_PANELS; panel < (block + 1) * BLOCK_PANELS; panel++) {
		float *m = panel_at(a->m, b->sentences, panel);
		if (b->has_attention) {
			float *s = panel_at(a->alpha, b->words, panel);
			const struct term terms[2] = {
				{b->uh, BLOCK_G, BLOCK_G, panel_of(a->g, BLOCK_G, panel)},
				{b->uq, BLOCK_G, BLOCK_G,
					b->has_positions ? panel_of(a->r, BLOCK_G, panel) : NULL}};
			product_sum(s, NULL, b->words, terms, b->has_positions ? 2 : 1, no_panels);
		}
		for (int s = 0; s < b->sentences; s++) {
			if (b->has_attention)
				softmax_words(
					panel_at(a->alpha, b->words, panel), b->first[s], b->first[s + 1]);
			if (b->is_normalised)
				normalised_response(b, a, panel, s, m + s * L);
			else
				plain_response(b, a, panel, s, m + s * L);
		}
	}
}

static int is_zero(const float *p)
{
	for (int i = 0; i < L; i++)
		if (p[i] != 0)
			return 0;
	return 1;
}

static void gather(
	const struct block_model *b, const struct block_arrays *a, size_t block, struct block_sums *sums)
{
	for (size_t panel = block * BLOCK_PANELS; panel < (block + 1) * BLOCK_PANELS; panel++)
		for (int s = 0; s < b->sentences; s++) {
			const float *top = panel_of(a->top, b->sentences, panel) + s * L;
			float weight[L], *mean = sums->mean + (size_t)s * (size_t)b->z_size;
			struct stretch z[STRETCHES];
			if (is_zero(top))
				continue;
			memcpy(weight, top, sizeof weight);
			if (b->is_projected) {
				const float *sigma = panel_of(a->sigma, b->sentences, panel) + s * L;
				for (int i = 0; i < L; i++)
					weight[i] *= sigma[i];
			}
			const int count = stretches(b, a, panel, s, z);
			for (int i = 0; i < count; i++)
				outer(mean + z[i].start, 1, z[i].count, b->z_size, weight, 1, z[i].at,
					z[i].channels, 1);
		}
}
