/* The backward kernels of field/block.h. Included by block_kernel.h. */
#include "field/block_forward.h"

/* dz = dm k + top dmean for the alphas of a sentence where m = k.z, in `dalpha`. */
static void plain_dalpha(
	const struct block_model *b, const struct block_arrays *a, size_t panel, int s, float *dalpha)
{
	const float *dm = panel_of(a->dm, b->sentences, panel) + s * L;
	const float *top = panel_of(a->top, b->sentences, panel) + s * L;
	const float *k = b->k + (size_t)s * (size_t)b->z_size + z_fixed(b);
	const float *dmean = b->dmean + (size_t)s * (size_t)b->z_size + z_fixed(b);
	const int words = b->first[s + 1] - b->first[s];

	for (int v = 0; v < L; v += VEC_LANES) {
		vecn x = vec_load(dm + v), y = vec_load(top + v);
		for (int j = 0; j < words; j++)
			vec_store(dalpha + j * L + v, x * vec_splat(k[j]) + y * vec_splat(dmean[j]));
	}
}

/* out = x k + y t + w Gz for `count` channels, added to what it holds unless `is_first`; weighted = d z. */
static void normalised_channels(const struct stretch *z, const float *k, const float *t, const float *gz,
	const float *x, const float *y, const float *d, int is_first, float *out, float *weighted)
{
	for (int c = 0; c < z->count; c++) {
		const vecn scale = vec_splat(k[c]), mean = vec_splat(t[c]);
#pragma GCC unroll 4
		for (int v = 0; v < L; v += VEC_LANES) {
			vecn ds = vec_load(d + v), sum = is_first ? vec_splat(0) : vec_load(out + c * L + v);
			sum = vec_fma(scale, vec_load(x + v), sum);
			sum = vec_fma(mean, vec_load(y + v), sum);
			vec_store(out + c * L + v, vec_fma(ds + ds, vec_load(gz + c * L + v), sum));
			vec_store(weighted + c * L + v, ds * vec_load(z->at + c * L + v));
		}
	}
}

/* out = k.z */
static void along_z(const float *k, const struct stretch *z, int count, float *out)
{
	vecn sum[L / VEC_LANES];

	for (int v = 0; v < L / VEC_LANES; v++)
		sum[v] = vec_splat(0);
	for (int i = 0; i < count; i++)
		for (int c = 0; c < z[i].count; c++)
			for (int v = 0; v < L / VEC_LANES; v++)
				sum[v] = vec_fma(vec_splat(k[z[i].start + c]),
					vec_load(z[i].at + c * L + VEC_LANES * v), sum[v]);
	for (int v = 0; v < L / VEC_LANES; v++)
		vec_store(out + VEC_LANES * v, sum[v]);
}

/* One panel of a normalised response: dz, of which dg (and dr) are kept for hidden_back, with `weighted` = ds
 * z and `numerator` = dL/d(k.z) for the sums. m = (k.z) u + m0 with u = (z^T G z + eps)^(-1/2); LayerNorm's
 * top set averages z u, cosine's z itself. */
static void normalised_panel(const struct block_model *b, const struct block_arrays *a, size_t panel, int s,
	float *dalpha, float *weighted, float *numerator, float *gz)
{
	const int size = b->z_size, channels = z_channels(b, s), averages_scaled = b->is_projected;
	const float *dm = panel_of(a->dm, b->sentences, panel) + s * L;
	const float *top = panel_of(a->top, b->sentences, panel) + s * L;
	const float *sigma = panel_of(a->sigma, b->sentences, panel) + s * L;
	const float *k = b->k + (size_t)s * (size_t)size, *dmean = b->dmean + (size_t)s * (size_t)size;
	const float *gram = b->gram + (size_t)s * (size_t)size * (size_t)size;
	const vecn largest =
		vec_splat(1) / vec_sqrt(vec_splat(b->floor)); /* u at the floor, where it is constant */
	float kz[L], tz[L] = {0}, mean[L], d[L];
	struct stretch z[STRETCHES];
	struct term terms[STRETCHES];
	const int count = stretches(b, a, panel, s, z);

	for (int i = 0; i < count; i++)
		terms[i] = (struct term){gram + z[i].start, size, z[i].count, z[i].at};
	product_sum(gz, NULL, channels, terms, count,
		(const float *const[AHEAD]){panel_ahead(b, a->dg, panel), panel_ahead(b, a->g, panel + 1),
			b->has_positions ? panel_ahead(b, a->r, panel) : NULL});
	along_z(k, z, count, kz);
	if (averages_scaled)
		along_z(dmean, z, count, tz);
	for (int v = 0; v < L; v += VEC_LANES) {
		vecn u = vec_load(sigma + v), t = vec_load(top + v), from = vec_load(dm + v);
		vecn du = from * vec_load(kz + v) + t * vec_load(tz + v);
		du = vec_keep(vec_lt(u, largest), du);
		vec_store(d + v, vec_splat(-0.5f) * du * u * u * u);
		vec_store(mean + v, averages_scaled ? t * u : t);
		vec_store(numerator + v, from * u);
	}
	for (int i = 0; i < count; i++) {
		const int at = z[i].start, is_alpha = b->has_attention && i == count - 1;
		float *out = is_alpha ? dalpha : panel_at(i ? a->dr : a->dg, BLOCK_G, panel);
		normalised_channels(z + i, k + at, dmean + at, gz + at * L, numerator, mean, d,
			is_alpha || !s, out, weighted + at * L);
	}
}

/* A block of normalised responses, with the sums of G, k (as the row below G) and m0. */
static void normalised_back(const struct block_model *b, const struct block_arrays *a, size_t first, int s,
	struct block_sums *sums, float *dalpha, float *scratch)
{
	const int size = b->z_size, channels = z_channels(b, s), words = channels - z_fixed(b),
		  rows = size + 1;
	float *dgram = sums->dgram + (size_t)s * (size_t)rows * (size_t)size;
	float *weighted = scratch, *gz = weighted + BLOCK_PANELS * rows * L;
	struct stretch z[STRETCHES];
	const int count = stretches(b, a, first, s, z);

	for (int p = 0; p < BLOCK_PANELS; p++) {
		float *own = panel_at(weighted, rows, (size_t)p);
		normalised_panel(b, a, first + (size_t)p, s, panel_at(dalpha, words, (size_t)p), own,
			own + channels * L, gz);
	}
	for (int i = 0; i < count; i++) {
		const int height = z[i].count + (i == count - 1);
		float *out = dgram + (size_t)z[i].start * (size_t)size;
		const float *left = weighted + z[i].start * L;
		for (int j = 0; j < i; j++)
			outer(out + z[j].start, height, z[j].count, size, left, rows, z[j].at, z[j].channels,
				BLOCK_PANELS);
		outer_lower(out + z[i].start, height, z[i].count, size, left, rows, z[i].at, z[i].channels,
			BLOCK_PANELS);
	}
	sum_channels(
		sums->dm0 + s, 1, panel_of(a->dm, b->sentences, first) + s * L, b->sentences, BLOCK_PANELS);
}

/* Through the softmax over words: ds = alpha (dalpha - alpha.dalpha), in place of alpha; dalpha is
 * overwritten. That of the word with the largest alpha is taken out first: where alpha is nearly 1, what is
 * left after the subtraction would else be rounding. */
static void softmax_back(float *alpha, float *dalpha, int words)
{
	for (int v = 0; v < L; v += VEC_LANES) {
		vecn most = vec_load(alpha + v), of_most = vec_load(dalpha + v), dot = vec_splat(0);
		for (int j = 1; j < words; j++) {
			const vecn own = vec_load(alpha + j * L + v);
			of_most = vec_choose(vec_lt(most, own), vec_load(dalpha + j * L + v), of_most);
			most = vec_max(own, most);
		}
		for (int j = 0; j < words; j++) {
			const vecn left = vec_load(dalpha + j * L + v) - of_most;
			vec_store(dalpha + j * L + v, left);
			dot += vec_load(alpha + j * L + v) * left;
		}
		for (int j = 0; j < words; j++)
			vec_store(alpha + j * L + v,
				vec_load(alpha + j * L + v) * (vec_load(dalpha + j * L + v) - dot));
	}
}

static void scores_back(const struct block_model *b, const struct block_arrays *a, size_t block,
	struct block_sums *sums, float *scratch)
{
	const size_t first = block * BLOCK_PANELS;
	const int n = b->words;

	for (int s = 0; s < b->sentences; s++) {
		const int words = z_channels(b, s) - z_fixed(b);
		float *dalpha = scratch, *rest = dalpha + BLOCK_SIZE * words;
		if (b->is_normalised) {
			normalised_back(b, a, first, s, sums, dalpha, rest);
		} else {
			struct stretch z[STRETCHES];
			const int count = stretches(b, a, first, s, z);
			for (int i = 0; i < count; i++)
				outer(sums->dk + (size_t)s * (size_t)b->z_size + z[i].start, 1, z[i].count,
					b->z_size, panel_of(a->dm, b->sentences, first) + s * L, b->sentences,
					z[i].at, z[i].channels, BLOCK_PANELS);
		}
		for (size_t p = 0; p < BLOCK_PANELS && b->has_attention; p++) {
			if (!b->is_normalised)
				plain_dalpha(b, a, first + p, s, panel_at(dalpha, words, p));
			softmax_back(panel_at(a->alpha, n, first + p) + b->first[s] * L,
				panel_at(dalpha, words, p), words);
		}
	}
	if (!b->has_attention)
		return;
	const float *ds = panel_of(a->alpha, n, first);
	outer(sums->duh, n, BLOCK_G, BLOCK_G, ds, n, panel_of(a->g, BLOCK_G, first), BLOCK_G, BLOCK_PANELS);
	if (b->has_positions)
		outer(sums->duq, n, BLOCK_G, BLOCK_G, ds, n, panel_of(a->r, BLOCK_G, first), BLOCK_G,
			BLOCK_PANELS);
}

/* Where m = k.z: d(g or r) = sum_s dm_s k_s + top_s dmean_s, for the 65 channels from `at` in z. */
static void plain_dz(
	const struct block_model *b, const struct block_arrays *a, size_t panel, int at, float *d)
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

/* beta_ji (r_i.dc_j - cbar_j.dc_j) in place of the logits; beta (n channels). */
static void word_positions_back(
	const struct block_model *b, size_t panel, float *logits, const float *r, float *beta, float *along)
{
	const int n = b->words, lanes = panel_lanes(b, panel);

	product_set(along, b->dc, n, BLOCK_G, BLOCK_G, r);
	for (int j = 0; j < n; j++)
		for (int v = 0; v < L; v += VEC_LANES) {
			vecn e = vec_exp(vec_load(logits + j * L + v) - vec_splat(b->l_max[j])) *
				 vec_splat(b->l_scale[j]);
			e = vec_first(e, lanes - v, 0);
			vec_store(beta + j * L + v, e);
			vec_store(logits + j * L + v,
				e * (vec_load(along + j * L + v) - vec_splat(b->dc_dot[j])));
		}
}

/* From r = nu [q;1] to q: d in place of dr's first 64 channels; and the gradient of P. */
static void scale_positions_back(
	const struct block_model *b, const float *r, float *dr, struct block_sums *sums, float *scratch)
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
			vec_store(dr + c * L + v,
				nu * (vec_load(dr + c * L + v) - dot * vec_load(pr + c * L + v)));
		}
	}
	outer(sums->dp_gram, BLOCK_G, BLOCK_G, BLOCK_G, weighted, BLOCK_G, r, BLOCK_G, 1);
}

static void hidden_back(const struct block_model *b, const struct block_arrays *a, size_t block,
	struct block_sums *sums, float *scratch)
{
	const size_t first = block * BLOCK_PANELS;
	const int n = b->words, width = b->feature_width;
	float *dg = scratch, *dr = dg + BLOCK_PANELS * BLOCK_G * L,
	      *hidden0 = dr + BLOCK_PANELS * BLOCK_G * L;
	float *dhidden0 = hidden0 + BLOCK_PANELS * REFER_XH * L,
	      *rest = dhidden0 + BLOCK_PANELS * REFER_XH * L;

	for (int p = 0; p < BLOCK_PANELS; p++) {
		size_t panel = first + (size_t)p;
		float *d = panel_at(dg, BLOCK_G, (size_t)p), *e = panel_at(dr, BLOCK_G, (size_t)p);
		const float *alpha = b->has_attention ? panel_of(a->alpha, n, panel) : NULL;
		struct term to_g[2], to_r[2];
		int g_terms = 0, r_terms = 0;
		if (b->has_attention)
			to_g[g_terms++] = (struct term){b->uh_t, n, n, alpha};
		if (b->has_positions)
			to_r[r_terms++] = (struct term){b->uq_t, n, n, alpha};
		if (b->has_words) {
			float *logits = panel_at(a->beta, n, panel), *beta = rest, *along = rest + n * L;
			word_positions_back(b, panel, logits, panel_of(a->r, BLOCK_G, panel), beta, along);
			to_g[g_terms++] = (struct term){b->y_t, n, n, logits};
			to_r[r_terms++] = (struct term){b->dc_t, n, n, beta};
		}
		if (!b->is_normalised)
			plain_dz(b, a, panel, 0, d);
		product_sum(d, b->is_normalised ? panel_of(a->dg, BLOCK_G, panel) : d, BLOCK_G, to_g, g_terms,
			(const float *const[AHEAD]){
				panel_ahead(b, a->dg, panel + 1), panel_ahead(b, a->g, panel + 1)});
		if (b->uses_position) {
			const float *from = !b->is_add	       ? NULL
					    : b->is_normalised ? panel_of(a->dr, BLOCK_G, panel)
							       : e;
			if (from == e)
				plain_dz(b, a, panel, BLOCK_G, e);
			product_sum(e, from, BLOCK_G, to_r, r_terms,
				(const float *const[AHEAD]){panel_ahead(b, a->r, panel + 1)});
		}
		relu_back(d, panel_of(a->g, BLOCK_G, panel), REFER_H);
		float *h0 = panel_at(hidden0, REFER_XH, (size_t)p),
		      *d0 = panel_at(dhidden0, REFER_XH, (size_t)p);
		product_relu(h0, b->feature0, REFER_XH, width, panel_of(a->x, width, panel), b->feature0_bias,
			NULL);
		product_set(d0, b->feature1_t, REFER_XH, REFER_H, REFER_H, d);
		relu_back(d0, h0, REFER_XH);
		product_set(panel_at(a->dx, width, panel), b->feature0_t, width, REFER_XH, REFER_XH, d0);
	}
	if (b->has_words)
		outer(sums->dy, n, BLOCK_G, BLOCK_G, panel_of(a->beta, n, first), n,
			panel_of(a->g, BLOCK_G, first), BLOCK_G, BLOCK_PANELS);
	outer(sums->dfeature1, REFER_H, REFER_XH, REFER_XH, dg, BLOCK_G, hidden0, REFER_XH, BLOCK_PANELS);
	sum_channels(sums->dfeature1_bias, REFER_H, dg, BLOCK_G, BLOCK_PANELS);
	outer(sums->dfeature0, REFER_XH, width, width, dhidden0, REFER_XH, panel_of(a->x, width, first),
		width, BLOCK_PANELS);
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
		float *h0 = panel_at(hidden0, REFER_PH, (size_t)p),
		      *d0 = panel_at(dhidden0, REFER_PH, (size_t)p);
		product_relu(h0, b->position0, REFER_PH, 3, panel_of(a->position, 3, panel),
			b->position0_bias, NULL);
		product_set(d0, b->position1_t, REFER_PH, REFER_H, REFER_H, e);
		relu_back(d0, h0, REFER_PH);
	}
	outer(sums->dposition1, REFER_H, REFER_PH, REFER_PH, dr, BLOCK_G, hidden0, REFER_PH, BLOCK_PANELS);
	sum_channels(sums->dposition1_bias, REFER_H, dr, BLOCK_G, BLOCK_PANELS);
	outer(sums->dposition0, REFER_PH, 3, 3, dhidden0, REFER_PH, panel_of(a->position, 3, first), 3,
		BLOCK_PANELS);
	sum_channels(sums->dposition0_bias, REFER_PH, dhidden0, REFER_PH, BLOCK_PANELS);
}
