/* The kernels of refer/block.h, included by one file for each instruction set, which names itself BLOCK_ISA and selects its
 * target before (see base/vecmath.h). */
#include "refer/block.h"

#include "base/vecmath.h"

#include <math.h>
#include <string.h>

#define PASTE(a, b) a##_##b
#define EXPAND(a, b) PASTE(a, b)
#define TEXT(a) #a
#define NAME_TEXT(a) TEXT(a)

enum {
	L = BLOCK_LANES,
	TILE = VEC_LANES == 16 ? 4 : 2, /* vectors held in registers for each row of a product */
	MAX_ROWS = 4,
};

VEC_INLINE vecn vec_sqrt(vecn x)
{
	for (int i = 0; i < VEC_LANES; i++)
		x[i] = sqrtf(x[i]);
	return x;
}

/* x in the first `count` lanes, `fill` in the others. */
VEC_INLINE vecn vec_first(vecn x, int count, float fill)
{
	static const float lanes[16] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};

	return vec_choose(vec_lt(vec_load(lanes), vec_splat((float)count)), x, vec_splat(fill));
}

/* `rows` rows of out = [base +] W in, over TILE vectors. base: 0 nothing, 1 what out holds, 2 bias. */
VEC_INLINE void product_tile(const int rows, float *out, const float *w, int stride, int columns, const float *in,
	const float *bias, const int base, const int relu)
{
	vecn sum[MAX_ROWS][TILE];

	for (int r = 0; r < rows; r++)
		for (int v = 0; v < TILE; v++)
			sum[r][v] = base == 1 ? vec_load(out + r * L + VEC_LANES * v) : vec_splat(base == 2 ? bias[r] : 0);
	for (int c = 0; c < columns; c++) {
		vecn x[TILE];
		for (int v = 0; v < TILE; v++)
			x[v] = vec_load(in + c * L + VEC_LANES * v);
		for (int r = 0; r < rows; r++) {
			vecn scale = vec_splat(w[r * stride + c]);
			for (int v = 0; v < TILE; v++)
				sum[r][v] = vec_fma(scale, x[v], sum[r][v]);
		}
	}
	for (int r = 0; r < rows; r++)
		for (int v = 0; v < TILE; v++) {
			if (relu)
				sum[r][v] = vec_max(sum[r][v], vec_splat(0));
			vec_store(out + r * L + VEC_LANES * v, sum[r][v]);
		}
}

/* out (rows,L) = [base +] w (rows,columns; rows `stride` apart) in (columns,L), for one panel. */
VEC_INLINE void product(float *out, const float *w, int rows, int columns, int stride, const float *in, const float *bias,
	const int base, const int relu)
{
	for (int v = 0; v < L; v += TILE * VEC_LANES) {
		int r = 0;
		for (; r + 4 <= rows; r += 4)
			product_tile(4, out + r * L + v, w + r * stride, stride, columns, in + v, bias + r, base, relu);
		if (rows - r == 3)
			product_tile(3, out + r * L + v, w + r * stride, stride, columns, in + v, bias + r, base, relu);
		else if (rows - r == 2)
			product_tile(2, out + r * L + v, w + r * stride, stride, columns, in + v, bias + r, base, relu);
		else if (rows - r == 1)
			product_tile(1, out + r * L + v, w + r * stride, stride, columns, in + v, bias + r, base, relu);
	}
}

static const float no_bias[BLOCK_WORDS];

static void product_set(float *out, const float *w, int rows, int columns, int stride, const float *in)
{
	product(out, w, rows, columns, stride, in, no_bias, 0, 0);
}

static void product_add(float *out, const float *w, int rows, int columns, int stride, const float *in)
{
	product(out, w, rows, columns, stride, in, no_bias, 1, 0);
}

static void product_relu(float *out, const float *w, int rows, int columns, const float *in, const float *bias)
{
	product(out, w, rows, columns, columns, in, bias, 2, 1);
}

VEC_INLINE float sum_lanes(vecn v)
{
	float s[VEC_LANES];

	vec_store(s, v);
	for (int half = VEC_LANES / 2; half; half /= 2)
		for (int i = 0; i < half; i++)
			s[i] += s[i + half];
	return s[0];
}

/* (4 x 4) sums of products over the lanes of every panel: out[r][c] += sum a_r b_c. */
VEC_INLINE void outer_tile(const int rows, const int columns, float *out, int stride, const float *a, int a_panel,
	const float *b, int b_panel, int panels)
{
	vecn sum[MAX_ROWS][4];

	for (int r = 0; r < rows; r++)
		for (int c = 0; c < columns; c++)
			sum[r][c] = vec_splat(0);
	for (int p = 0; p < panels; p++, a += a_panel, b += b_panel)
		for (int v = 0; v < L; v += VEC_LANES) {
			vecn y[4];
			for (int c = 0; c < columns; c++)
				y[c] = vec_load(b + c * L + v);
			for (int r = 0; r < rows; r++) {
				vecn x = vec_load(a + r * L + v);
				for (int c = 0; c < columns; c++)
					sum[r][c] = vec_fma(x, y[c], sum[r][c]);
			}
		}
	for (int r = 0; r < rows; r++)
		for (int c = 0; c < columns; c++)
			out[r * stride + c] += sum_lanes(sum[r][c]);
}

VEC_INLINE void outer_rows(const int rows, float *out, int columns, int stride, const float *a, int a_panel, const float *b,
	int b_panel, int panels)
{
	int c = 0;

	for (; c + 4 <= columns; c += 4)
		outer_tile(rows, 4, out + c, stride, a, a_panel, b + (size_t)c * L, b_panel, panels);
	for (; c < columns; c++)
		outer_tile(rows, 1, out + c, stride, a, a_panel, b + (size_t)c * L, b_panel, panels);
}

/* out (rows,columns; rows `stride` apart) += sum over the lanes of `panels` panels of a (rows) times b (columns);
 * a_channels and b_channels are the channels in a panel of each. */
static void outer(float *out, int rows, int columns, int stride, const float *a, int a_channels, const float *b,
	int b_channels, int panels)
{
	int r = 0;

	for (; r + 4 <= rows; r += 4)
		outer_rows(4, out + (size_t)r * (size_t)stride, columns, stride, a + (size_t)r * L, a_channels * L, b, b_channels * L, panels);
	for (; r < rows; r++)
		outer_rows(1, out + (size_t)r * (size_t)stride, columns, stride, a + (size_t)r * L, a_channels * L, b, b_channels * L, panels);
}

/* out (rows) += sums of a's channels over the lanes. */
static void sum_channels(float *out, int rows, const float *a, int channels, int panels)
{
	for (int r = 0; r < rows; r++) {
		const float *row = a + r * L;
		vecn sum = vec_splat(0);
		for (int p = 0; p < panels; p++, row += channels * L)
			for (int v = 0; v < L; v += VEC_LANES)
				sum += vec_load(row + v);
		out[r] += sum_lanes(sum);
	}
}

/* Zeroes the gradient where the layer's output was not positive. */
static void relu_back(float *d, const float *value, int channels)
{
	for (int i = 0; i < channels * L; i += VEC_LANES)
		vec_store(d + i, vec_keep(vec_lt(vec_splat(0), vec_load(value + i)), vec_load(d + i)));
}

static const float *panel_of(const float *array, int channels, size_t panel)
{
	return array + panel * (size_t)channels * L;
}

static float *panel_at(float *array, int channels, size_t panel)
{
	return array + panel * (size_t)channels * L;
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
				vec_store(to + v, vec_first(vec_exp(vec_load(l + v) - vec_splat(largest)), lanes - v, 0));
		}
	}
	sum_channels(sums->l_sum, n, e, n, BLOCK_PANELS);
	outer(sums->c_sum, n, BLOCK_G, BLOCK_G, e, n, r, BLOCK_G, BLOCK_PANELS);
}

static void hidden(const struct block_model *b, const struct block_arrays *a, size_t block, struct block_sums *sums,
	float *scratch)
{
	const size_t first = block * BLOCK_PANELS;

	for (size_t panel = first; panel < first + BLOCK_PANELS; panel++) {
		float *g = panel_at(a->g, BLOCK_G, panel);
		product_relu(scratch, b->feature0, REFER_XH, REFER_X, panel_of(a->x, REFER_X, panel), b->feature0_bias);
		product_relu(g, b->feature1, REFER_H, REFER_XH, scratch, b->feature1_bias);
		for (int v = 0; v < L; v += VEC_LANES)
			vec_store(g + REFER_H * L + v, vec_splat(1));
		if (b->has_words)
			product_set(panel_at(a->beta, b->words, panel), b->y, b->words, BLOCK_G, BLOCK_G, g);
		if (!b->uses_position)
			continue;
		float *r = panel_at(a->r, BLOCK_G, panel);
		product_relu(scratch, b->position0, REFER_PH, 3, panel_of(a->position, 3, panel), b->position0_bias);
		product_relu(r, b->position1, REFER_H, REFER_PH, scratch, b->position1_bias);
		for (int v = 0; v < L; v += VEC_LANES)
			vec_store(r + REFER_H * L + v, vec_splat(1));
		if (b->is_projected)
			scale_positions(b, r, scratch);
	}
	if (b->has_words)
		add_word_positions(b, panel_of(a->beta, b->words, first), panel_of(a->r, BLOCK_G, first), first, sums, scratch);
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

/* z of one sentence and panel, copied together. */
static void make_z(const struct block_model *b, const struct block_arrays *a, size_t panel, int s, float *z)
{
	memcpy(z, panel_of(a->g, BLOCK_G, panel), sizeof(float) * BLOCK_G * L);
	if (b->is_add)
		memcpy(z + BLOCK_G * L, panel_of(a->r, BLOCK_G, panel), sizeof(float) * BLOCK_G * L);
	if (b->has_attention)
		memcpy(z + z_fixed(b) * L, panel_of(a->alpha, b->words, panel) + b->first[s] * L,
			sizeof(float) * (size_t)(b->first[s + 1] - b->first[s]) * L);
}

/* m = k.z without a copy of z. */
static void plain_response(const struct block_model *b, const struct block_arrays *a, size_t panel, int s, float *m)
{
	const float *k = b->k + (size_t)s * (size_t)b->z_size;

	product_set(m, k, 1, BLOCK_G, BLOCK_G, panel_of(a->g, BLOCK_G, panel));
	if (b->is_add)
		product_add(m, k + BLOCK_G, 1, BLOCK_G, BLOCK_G, panel_of(a->r, BLOCK_G, panel));
	if (b->has_attention) {
		int words = b->first[s + 1] - b->first[s];
		product_add(m, k + z_fixed(b), 1, words, words, panel_of(a->alpha, b->words, panel) + b->first[s] * L);
	}
}

static void normalised_response(
	const struct block_model *b, const struct block_arrays *a, size_t panel, int s, float *m, float *scratch)
{
	const int size = b->z_size, channels = z_channels(b, s);
	float *z = scratch, *gz = scratch + size * L;
	float *sigma = panel_at(a->sigma, b->sentences, panel) + s * L;

	make_z(b, a, panel, s, z);
	product_set(gz, b->gram + (size_t)s * (size_t)size * (size_t)size, channels, channels, size, z);
	product_set(m, b->k + (size_t)s * (size_t)size, 1, channels, size, z);
	for (int v = 0; v < L; v += VEC_LANES) {
		vecn squared = vec_splat(b->eps);
		for (int c = 0; c < channels; c++)
			squared += vec_load(gz + c * L + v) * vec_load(z + c * L + v);
		vecn scale = vec_splat(1) / vec_sqrt(vec_max(squared, vec_splat(b->floor)));
		vec_store(sigma + v, scale);
		vec_store(m + v, vec_load(m + v) * scale + vec_splat(b->m0[s]));
	}
}

static void respond(const struct block_model *b, const struct block_arrays *a, size_t block, float *scratch)
{
	for (size_t panel = block * BLOCK_PANELS; panel < (block + 1) * BLOCK_PANELS; panel++) {
		float *m = panel_at(a->m, b->sentences, panel);
		if (b->has_attention) {
			float *s = panel_at(a->alpha, b->words, panel);
			product_set(s, b->uh, b->words, BLOCK_G, BLOCK_G, panel_of(a->g, BLOCK_G, panel));
			if (b->has_positions)
				product_add(s, b->uq, b->words, BLOCK_G, BLOCK_G, panel_of(a->r, BLOCK_G, panel));
		}
		for (int s = 0; s < b->sentences; s++) {
			if (b->has_attention)
				softmax_words(panel_at(a->alpha, b->words, panel), b->first[s], b->first[s + 1]);
			if (b->is_normalised)
				normalised_response(b, a, panel, s, m + s * L, scratch);
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

static void gather(const struct block_model *b, const struct block_arrays *a, size_t block, struct block_sums *sums,
	float *scratch)
{
	float *weight = scratch, *z = scratch + L;

	for (size_t panel = block * BLOCK_PANELS; panel < (block + 1) * BLOCK_PANELS; panel++)
		for (int s = 0; s < b->sentences; s++) {
			const float *top = panel_of(a->top, b->sentences, panel) + s * L;
			if (is_zero(top))
				continue;
			memcpy(weight, top, sizeof(float) * L);
			if (b->is_projected) {
				const float *sigma = panel_of(a->sigma, b->sentences, panel) + s * L;
				for (int i = 0; i < L; i++)
					weight[i] *= sigma[i];
			}
			make_z(b, a, panel, s, z);
			outer(sums->mean + (size_t)s * (size_t)b->z_size, 1, z_channels(b, s), b->z_size, weight, 1, z, b->z_size,
				1);
		}
}

/* dz = dm k + top dmean for the alphas of a sentence where m = k.z, in `dz`. */
static void plain_dalpha(const struct block_model *b, const struct block_arrays *a, size_t panel, int s, float *dz)
{
	const float *dm = panel_of(a->dm, b->sentences, panel) + s * L;
	const float *top = panel_of(a->top, b->sentences, panel) + s * L;
	const float *k = b->k + (size_t)s * (size_t)b->z_size + z_fixed(b);
	const float *dmean = b->dmean + (size_t)s * (size_t)b->z_size + z_fixed(b);
	const int words = b->first[s + 1] - b->first[s];

	for (int v = 0; v < L; v += VEC_LANES) {
		vecn x = vec_load(dm + v), y = vec_load(top + v);
		for (int j = 0; j < words; j++)
			vec_store(dz + j * L + v, x * vec_splat(k[j]) + y * vec_splat(dmean[j]));
	}
}

/* The same for a normalised response: all of dz, with dg (and dr) kept for hidden_back, and the sums of k, G and m0.
 * m = (k.z) u + m0 with u = (z^T G z + eps)^(-1/2), and the top set averages t = z u. */
static void normalised_back(const struct block_model *b, const struct block_arrays *a, size_t panel, int s,
	struct block_sums *sums, float *scratch)
{
	const int size = b->z_size, channels = z_channels(b, s), fixed = z_fixed(b);
	const float *dm = panel_of(a->dm, b->sentences, panel) + s * L;
	const float *top = panel_of(a->top, b->sentences, panel) + s * L;
	const float *sigma = panel_of(a->sigma, b->sentences, panel) + s * L;
	const float *k = b->k + (size_t)s * (size_t)size, *dmean = b->dmean + (size_t)s * (size_t)size;
	float *z = scratch, *gz = z + size * L, *dz = gz + size * L, *dnumerator = dz + size * L, *dsquared = dnumerator + L;
	float *weighted = dsquared + L;
	const int averages_scaled = b->is_projected; /* LayerNorm: the top set averages z u; cosine: z itself */

	make_z(b, a, panel, s, z);
	product_set(gz, b->gram + (size_t)s * (size_t)size * (size_t)size, channels, channels, size, z);
	for (int v = 0; v < L; v += VEC_LANES) {
		vecn kz = vec_splat(0), tz = vec_splat(0), squared = vec_splat(b->eps);
		for (int c = 0; c < channels; c++) {
			vecn x = vec_load(z + c * L + v);
			kz += vec_splat(k[c]) * x;
			tz += vec_splat(dmean[c]) * x;
			squared += vec_load(gz + c * L + v) * x;
		}
		vecn u = vec_load(sigma + v), d = vec_load(dm + v), t = averages_scaled ? vec_load(top + v) : vec_splat(0);
		vecn du = d * kz + t * tz;
		vecn inside = vec_keep(vec_lt(vec_splat(b->floor), squared), vec_splat(1));
		vecn ds = vec_splat(-0.5f) * du * u * u * u * inside;
		vecn mean_scale = averages_scaled ? vec_load(top + v) * u : vec_load(top + v);
		vec_store(dnumerator + v, d * u);
		vec_store(dsquared + v, ds);
		for (int c = 0; c < channels; c++) {
			vecn g = vec_splat(k[c]) * d * u + vec_splat(dmean[c]) * mean_scale;
			vec_store(dz + c * L + v, g + vec_splat(2) * ds * vec_load(gz + c * L + v));
			vec_store(weighted + c * L + v, ds * vec_load(z + c * L + v));
		}
	}
	float *dg = panel_at(a->dg, BLOCK_G, panel);
	for (int i = 0; i < BLOCK_G * L; i += VEC_LANES)
		vec_store(dg + i, (s ? vec_load(dg + i) : vec_splat(0)) + vec_load(dz + i));
	if (b->is_add) {
		float *dr = panel_at(a->dr, BLOCK_G, panel);
		for (int i = 0; i < BLOCK_G * L; i += VEC_LANES)
			vec_store(dr + i, (s ? vec_load(dr + i) : vec_splat(0)) + vec_load(dz + BLOCK_G * L + i));
	}
	outer(sums->dk + (size_t)s * (size_t)size, 1, channels, size, dnumerator, 1, z, size, 1);
	outer(sums->dgram + (size_t)s * (size_t)size * (size_t)size, channels, channels, size, weighted, size, z, size, 1);
	sum_channels(sums->dm0 + s, 1, dm, b->sentences, 1);
	if (fixed < channels)
		memmove(scratch, dz + fixed * L, sizeof(float) * (size_t)(channels - fixed) * L);
}

/* Through the softmax over words: ds = alpha (dalpha - alpha.dalpha), in place of alpha. */
static void softmax_back(float *alpha, const float *dalpha, int words)
{
	for (int v = 0; v < L; v += VEC_LANES) {
		vecn dot = vec_splat(0);
		for (int j = 0; j < words; j++)
			dot += vec_load(alpha + j * L + v) * vec_load(dalpha + j * L + v);
		for (int j = 0; j < words; j++)
			vec_store(alpha + j * L + v, vec_load(alpha + j * L + v) * (vec_load(dalpha + j * L + v) - dot));
	}
}

static void scores_back(const struct block_model *b, const struct block_arrays *a, size_t block, struct block_sums *sums,
	float *scratch)
{
	const size_t first = block * BLOCK_PANELS;
	const int n = b->words, fixed = z_fixed(b);

	if (!b->is_normalised)
		for (int s = 0; s < b->sentences; s++) {
			const float *dm = panel_of(a->dm, b->sentences, first) + s * L;
			float *dk = sums->dk + (size_t)s * (size_t)b->z_size;
			outer(dk, 1, BLOCK_G, b->z_size, dm, b->sentences, panel_of(a->g, BLOCK_G, first), BLOCK_G, BLOCK_PANELS);
			if (b->is_add)
				outer(dk + BLOCK_G, 1, BLOCK_G, b->z_size, dm, b->sentences, panel_of(a->r, BLOCK_G, first), BLOCK_G,
					BLOCK_PANELS);
			if (b->has_attention)
				outer(dk + fixed, 1, b->first[s + 1] - b->first[s], b->z_size, dm, b->sentences,
					panel_of(a->alpha, n, first) + b->first[s] * L, n, BLOCK_PANELS);
		}
	for (size_t panel = first; panel < first + BLOCK_PANELS; panel++)
		for (int s = 0; s < b->sentences; s++) {
			if (b->is_normalised)
				normalised_back(b, a, panel, s, sums, scratch);
			else if (b->has_attention)
				plain_dalpha(b, a, panel, s, scratch);
			if (b->has_attention)
				softmax_back(panel_at(a->alpha, n, panel) + b->first[s] * L, scratch, b->first[s + 1] - b->first[s]);
		}
	if (!b->has_attention)
		return;
	const float *ds = panel_of(a->alpha, n, first);
	outer(sums->duh, n, BLOCK_G, BLOCK_G, ds, n, panel_of(a->g, BLOCK_G, first), BLOCK_G, BLOCK_PANELS);
	if (b->has_positions)
		outer(sums->duq, n, BLOCK_G, BLOCK_G, ds, n, panel_of(a->r, BLOCK_G, first), BLOCK_G, BLOCK_PANELS);
}

/* Where m = k.z: d(g or r) = sum_s dm_s k_s + top_s dmean_s, for the 65 channels from `at` in z. */
static void plain_dz(const struct block_model *b, const struct block_arrays *a, size_t panel, int at, float *d)
{
	for (int s = 0; s < b->sentences; s++) {
		const float *dm = panel_of(a->dm, b->sentences, panel) + s * L;
		const float *top = panel_of(a->top, b->sentences, panel) + s * L;
		const float *k = b->k + (size_t)s * (size_t)b->z_size + at;
		const float *dmean = b->dmean + (size_t)s * (size_t)b->z_size + at;
		for (int v = 0; v < L; v += VEC_LANES) {
			vecn x = vec_load(dm + v), y = vec_load(top + v);
			for (int c = 0; c < BLOCK_G; c++) {
				vecn old = s ? vec_load(d + c * L + v) : vec_splat(0);
				vec_store(d + c * L + v, old + x * vec_splat(k[c]) + y * vec_splat(dmean[c]));
			}
		}
	}
}

/* beta_ji (r_i.dc_j - cbar_j.dc_j) in place of the logits, and dr += sum_j beta_ji dc_j. */
static void word_positions_back(const struct block_model *b, size_t panel, float *logits, const float *r, float *dr,
	float *scratch)
{
	const int n = b->words, lanes = panel_lanes(b, panel);
	float *beta = scratch, *along = scratch + n * L;

	product_set(along, b->dc, n, BLOCK_G, BLOCK_G, r);
	for (int j = 0; j < n; j++)
		for (int v = 0; v < L; v += VEC_LANES) {
			vecn e = vec_exp(vec_load(logits + j * L + v) - vec_splat(b->l_max[j])) * vec_splat(b->l_scale[j]);
			e = vec_first(e, lanes - v, 0);
			vec_store(beta + j * L + v, e);
			vec_store(logits + j * L + v, e * (vec_load(along + j * L + v) - vec_splat(b->dc_dot[j])));
		}
	product_add(dr, b->dc_t, BLOCK_G, n, n, beta);
}

/* From r = nu [q;1] to q: d in place of dr's first 64 channels; and the gradient of P. */
static void scale_positions_back(const struct block_model *b, const float *r, float *dr, struct block_sums *sums,
	float *scratch)
{
	float *pr = scratch, *weighted = scratch + BLOCK_G * L;

	product_set(pr, b->p_gram, BLOCK_G, BLOCK_G, BLOCK_G, r);
	for (int v = 0; v < L; v += VEC_LANES) {
		vecn nu = vec_load(r + REFER_H * L + v), dot = vec_splat(0);
		for (int c = 0; c < BLOCK_G; c++)
			dot += vec_load(dr + c * L + v) * vec_load(r + c * L + v);
		/* dnu = dot/nu; d|p|^2 = -nu^3 dnu / 2 */
		for (int c = 0; c < BLOCK_G; c++) {
			vec_store(weighted + c * L + v, vec_splat(-0.5f) * dot * vec_load(r + c * L + v));
			vec_store(dr + c * L + v, nu * (vec_load(dr + c * L + v) - dot * vec_load(pr + c * L + v)));
		}
	}
	outer(sums->dp_gram, BLOCK_G, BLOCK_G, BLOCK_G, weighted, BLOCK_G, r, BLOCK_G, 1);
}

static void hidden_back(const struct block_model *b, const struct block_arrays *a, size_t block, struct block_sums *sums,
	float *scratch)
{
	const size_t first = block * BLOCK_PANELS;
	const int n = b->words;
	float *dg = scratch, *dr = dg + BLOCK_PANELS * BLOCK_G * L, *hidden0 = dr + BLOCK_PANELS * BLOCK_G * L;
	float *dhidden0 = hidden0 + BLOCK_PANELS * REFER_XH * L, *rest = dhidden0 + BLOCK_PANELS * REFER_XH * L;

	for (int p = 0; p < BLOCK_PANELS; p++) {
		size_t panel = first + (size_t)p;
		float *d = panel_at(dg, BLOCK_G, (size_t)p), *e = panel_at(dr, BLOCK_G, (size_t)p);
		if (b->is_normalised)
			memcpy(d, panel_of(a->dg, BLOCK_G, panel), sizeof(float) * BLOCK_G * L);
		else
			plain_dz(b, a, panel, 0, d);
		if (b->has_attention)
			product_add(d, b->uh_t, BLOCK_G, n, n, panel_of(a->alpha, n, panel));
		if (b->uses_position) {
			if (!b->is_add)
				memset(e, 0, sizeof(float) * BLOCK_G * L);
			else if (b->is_normalised)
				memcpy(e, panel_of(a->dr, BLOCK_G, panel), sizeof(float) * BLOCK_G * L);
			else
				plain_dz(b, a, panel, BLOCK_G, e);
			if (b->has_positions)
				product_add(e, b->uq_t, BLOCK_G, n, n, panel_of(a->alpha, n, panel));
		}
		if (b->has_words) {
			float *logits = panel_at(a->beta, n, panel);
			word_positions_back(b, panel, logits, panel_of(a->r, BLOCK_G, panel), e, rest);
			product_add(d, b->y_t, BLOCK_G, n, n, logits);
		}
		relu_back(d, panel_of(a->g, BLOCK_G, panel), REFER_H);
		float *h0 = panel_at(hidden0, REFER_XH, (size_t)p), *d0 = panel_at(dhidden0, REFER_XH, (size_t)p);
		product_relu(h0, b->feature0, REFER_XH, REFER_X, panel_of(a->x, REFER_X, panel), b->feature0_bias);
		product_set(d0, b->feature1_t, REFER_XH, REFER_H, REFER_H, d);
		relu_back(d0, h0, REFER_XH);
		product_set(panel_at(a->dx, REFER_X, panel), b->feature0_t, REFER_X, REFER_XH, REFER_XH, d0);
	}
	if (b->has_words)
		outer(sums->dy, n, BLOCK_G, BLOCK_G, panel_of(a->beta, n, first), n, panel_of(a->g, BLOCK_G, first), BLOCK_G,
			BLOCK_PANELS);
	outer(sums->dfeature1, REFER_H, REFER_XH, REFER_XH, dg, BLOCK_G, hidden0, REFER_XH, BLOCK_PANELS);
	sum_channels(sums->dfeature1_bias, REFER_H, dg, BLOCK_G, BLOCK_PANELS);
	outer(sums->dfeature0, REFER_XH, REFER_X, REFER_X, dhidden0, REFER_XH, panel_of(a->x, REFER_X, first), REFER_X,
		BLOCK_PANELS);
	sum_channels(sums->dfeature0_bias, REFER_XH, dhidden0, REFER_XH, BLOCK_PANELS);
	if (!b->uses_position)
		return;
	for (int p = 0; p < BLOCK_PANELS; p++) {
		size_t panel = first + (size_t)p;
		float *e = panel_at(dr, BLOCK_G, (size_t)p);
		const float *r = panel_of(a->r, BLOCK_G, panel);
		if (b->is_projected)
			scale_positions_back(b, r, e, sums, rest);
		relu_back(e, r, REFER_H);
		float *h0 = panel_at(hidden0, REFER_PH, (size_t)p), *d0 = panel_at(dhidden0, REFER_PH, (size_t)p);
		product_relu(h0, b->position0, REFER_PH, 3, panel_of(a->position, 3, panel), b->position0_bias);
		product_set(d0, b->position1_t, REFER_PH, REFER_H, REFER_H, e);
		relu_back(d0, h0, REFER_PH);
	}
	outer(sums->dposition1, REFER_H, REFER_PH, REFER_PH, dr, BLOCK_G, hidden0, REFER_PH, BLOCK_PANELS);
	sum_channels(sums->dposition1_bias, REFER_H, dr, BLOCK_G, BLOCK_PANELS);
	outer(sums->dposition0, REFER_PH, 3, 3, dhidden0, REFER_PH, panel_of(a->position, 3, first), 3, BLOCK_PANELS);
	sum_channels(sums->dposition0_bias, REFER_PH, dhidden0, REFER_PH, BLOCK_PANELS);
}

extern const struct block_kernels EXPAND(block_kernels, BLOCK_ISA);
const struct block_kernels EXPAND(block_kernels, BLOCK_ISA) = {
	NAME_TEXT(BLOCK_ISA), hidden, respond, gather, scores_back, hidden_back};
