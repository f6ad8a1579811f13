#include "refer/fold.h"

#include "base/mem.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { D = REFER_D, H = REFER_H, G = BLOCK_G };

/* A linear layer in both orders, and its gradient. */
struct layer {
	int in;
	double *w;  /* (D,in) */
	double *wt; /* (in,D) */
	double *dw; /* (D,in) */
	double bias[D], dbias[D];
};

struct fold {
	const struct refer_layout *layout;
	enum refer_similarity similarity;
	int max_words, max_sentences;
	int n, sentences, z_max;
	int *first;
	struct block_model *b;
	struct layer a, p;			     /* [A a], [B b]: in = 65, the bias as the last column */
	struct layer query, key, value, query_position, key_position; /* pcmi-proj */
	double gamma[D], beta[D], dgamma[D], dbeta[D];
	double score_scale, word_scale;		     /* 1/sqrt D, and what multiplies w.f in the word positions */
	double *w, *dw;				     /* (n,D) */
	double *s, *ds;				     /* (S,D) */
	double *cbar, *c;			     /* (n,G), (n,D) */
	double *keys, *kq, *kp, *v, *dv;	     /* (n,D) */
	double *cz, *dcz;			     /* (S,z_max,D): columns of C, of C centred for LayerNorm */
	double *mean, *cz_mean;			     /* (S,z_max), (S,D) */
	float *out;				     /* one slab for all of block_model's matrices */
	size_t out_used, out_size;
};

static void axpy(double *y, double scale, const double *x, int n)
{
	for (int i = 0; i < n; i++)
		y[i] += scale * x[i];
}

static double dot(const double *x, const double *y, int n)
{
	double sum = 0;

	for (int i = 0; i < n; i++)
		sum += x[i] * y[i];
	return sum;
}

/* y += scale W x for a layer (out D). */
static void apply(double *y, const struct layer *l, const double *x, double scale)
{
	for (int c = 0; c < l->in; c++)
		if (x[c] != 0)
			axpy(y, scale * x[c], l->wt + c * D, D);
}

/* y (in) += scale W^T x. */
static void apply_t(double *y, const struct layer *l, const double *x, double scale)
{
	for (int r = 0; r < D; r++)
		axpy(y, scale * x[r], l->w + r * l->in, l->in);
}

/* dW += scale d x^T. */
static void outer(struct layer *l, const double *d, const double *x, double scale)
{
	for (int r = 0; r < D; r++)
		axpy(l->dw + r * l->in, scale * d[r], x, l->in);
}

static int layer_alloc(struct layer *l, int in, struct err *e)
{
	size_t size = (size_t)D * (size_t)in;

	l->in = in;
	l->w = mem_zalloc(3 * size, sizeof(double), "folded layer", e);
	if (!l->w)
		return -1;
	l->wt = l->w + size;
	l->dw = l->wt + size;
	return 0;
}

/* Reads a linear layer; `with_bias` makes the bias the last column. */
static void layer_load(struct layer *l, const struct refer_layout *layout, enum refer_tensor weight, const float *parameters,
	int with_bias)
{
	const int columns = layout->tensors[weight].columns;
	const float *w = parameters + layout->tensors[weight].offset, *bias = parameters + layout->tensors[weight + 1].offset;

	for (int r = 0; r < D; r++) {
		for (int c = 0; c < columns; c++)
			l->w[r * l->in + c] = l->wt[c * D + r] = (double)w[r * columns + c];
		if (with_bias)
			l->w[r * l->in + columns] = l->wt[columns * D + r] = (double)bias[r];
		l->bias[r] = (double)bias[r];
	}
	memset(l->dw, 0, sizeof(double) * (size_t)D * (size_t)l->in);
	memset(l->dbias, 0, sizeof l->dbias);
}

static void layer_store(const struct layer *l, const struct refer_layout *layout, enum refer_tensor weight, float *gradient,
	int with_bias)
{
	const int columns = layout->tensors[weight].columns;
	float *dw = gradient + layout->tensors[weight].offset, *dbias = gradient + layout->tensors[weight + 1].offset;

	for (int r = 0; r < D; r++) {
		for (int c = 0; c < columns; c++)
			dw[r * columns + c] += (float)l->dw[r * l->in + c];
		dbias[r] += (float)(with_bias ? l->dw[r * l->in + columns] : l->dbias[r]);
	}
}

static int is_projected(const struct fold *f)
{
	return f->layout->interaction == REFER_PCMI_PROJ;
}

static int has_words(const struct fold *f)
{
	return f->layout->interaction >= REFER_PCMI;
}

struct fold *fold_new(const struct refer_layout *l, enum refer_similarity similarity, int words, int sentences,
	struct err *e)
{
	struct fold *f = mem_zalloc(1, sizeof *f, "folded model", e);

	if (!f)
		return NULL;
	f->layout = l;
	f->similarity = similarity;
	f->max_words = words;
	f->max_sentences = sentences;
	f->z_max = 2 * G + words;
	f->score_scale = 1 / sqrt(D);
	f->word_scale = is_projected(f) ? 1 : f->score_scale;
	size_t n = (size_t)words, s = (size_t)sentences, z = (size_t)f->z_max;
	size_t doubles = n * D * 9 + n * G + s * D * 3 + 2 * s * z * D + s * z;
	f->out_size = 8 * n * G + 4 * n + 2 * (size_t)G * G + s * (z * z + 2 * z + 1) + 32 * 1024;
	f->first = mem_zalloc(s + 1, sizeof *f->first, "folded model", e);
	f->w = mem_zalloc(doubles, sizeof(double), "folded model", e);
	f->out = mem_zalloc(f->out_size, sizeof(float), "folded model", e);
	if (!f->first || !f->w || !f->out || layer_alloc(&f->a, G, e) || layer_alloc(&f->p, G, e))
		goto fail;
	if (is_projected(f)) {
		struct layer *square[5] = {&f->query, &f->key, &f->value, &f->query_position, &f->key_position};
		for (int i = 0; i < 5; i++)
			if (layer_alloc(square[i], D, e))
				goto fail;
	}
	f->dw = f->w + n * D;
	f->c = f->dw + n * D;
	f->keys = f->c + n * D;
	f->kq = f->keys + n * D;
	f->kp = f->kq + n * D;
	f->v = f->kp + n * D;
	f->dv = f->v + n * D;
	f->cbar = f->dv + n * D;
	f->s = f->cbar + n * G;
	f->ds = f->s + s * D;
	f->cz_mean = f->ds + s * D;
	f->cz = f->cz_mean + s * D;
	f->dcz = f->cz + s * z * D;
	f->mean = f->dcz + s * z * D;
	return f;
fail:
	fold_free(f);
	return NULL;
}

void fold_free(struct fold *f)
{
	if (!f)
		return;
	struct layer *layers[7] = {&f->a, &f->p, &f->query, &f->key, &f->value, &f->query_position, &f->key_position};
	for (int i = 0; i < 7; i++)
		free(layers[i]->w);
	free(f->first);
	free(f->w);
	free(f->out);
	free(f);
}

static float *take(struct fold *f, size_t count)
{
	float *at = f->out + f->out_used;

	f->out_used += (count + 15) / 16 * 16;
	return at;
}

/* A tensor of the slab as it is, and transposed. */
static const float *tensor_of(const struct fold *f, const float *parameters, enum refer_tensor t)
{
	return parameters + f->layout->tensors[t].offset;
}

static const float *transposed(struct fold *f, const float *w, int rows, int columns)
{
	float *t = take(f, (size_t)rows * (size_t)columns);

	for (int r = 0; r < rows; r++)
		for (int c = 0; c < columns; c++)
			t[c * rows + r] = w[r * columns + c];
	return t;
}

static int z_fixed(const struct fold *f)
{
	return f->layout->interaction == REFER_ADD ? 2 * G : G;
}

static int has_attention(const struct fold *f)
{
	return f->layout->interaction != REFER_NONE && f->layout->interaction != REFER_ADD;
}

static int z_channels(const struct fold *f, int s)
{
	return z_fixed(f) + (has_attention(f) ? f->first[s + 1] - f->first[s] : 0);
}

void fold_begin(struct fold *f, const float *parameters, size_t gaussians, const int *first, int sentences,
	struct block_model *b)
{
	const enum refer_interaction interaction = f->layout->interaction;

	f->out_used = 0;
	f->sentences = sentences;
	f->n = first[sentences];
	memcpy(f->first, first, sizeof *first * (size_t)(sentences + 1));
	layer_load(&f->a, f->layout, FEATURE_2_WEIGHT, parameters, 1);
	*b = (struct block_model){.gaussians = gaussians,
		.uses_position = refer_uses_position(interaction),
		.is_add = interaction == REFER_ADD,
		.is_projected = is_projected(f),
		.has_attention = has_attention(f),
		.has_positions = interaction == REFER_ATTENTION_FP || has_words(f),
		.has_words = has_words(f),
		.is_normalised = is_projected(f) || f->similarity == REFER_COSINE,
		.words = has_attention(f) ? f->n : 0,
		.sentences = sentences,
		.first = f->first,
		.eps = is_projected(f) ? 1e-5f : 0,
		.floor = is_projected(f) ? 0 : 1e-24f};
	for (int s = 0; s < sentences; s++)
		b->z_size = z_channels(f, s) > b->z_size ? z_channels(f, s) : b->z_size;
	b->feature0 = tensor_of(f, parameters, FEATURE_0_WEIGHT);
	b->feature0_bias = tensor_of(f, parameters, FEATURE_0_BIAS);
	b->feature0_t = transposed(f, b->feature0, REFER_XH, REFER_X);
	b->feature1 = tensor_of(f, parameters, FEATURE_1_WEIGHT);
	b->feature1_bias = tensor_of(f, parameters, FEATURE_1_BIAS);
	b->feature1_t = transposed(f, b->feature1, H, REFER_XH);
	if (b->uses_position) {
		layer_load(&f->p, f->layout, POSITION_2_WEIGHT, parameters, 1);
		b->position0 = tensor_of(f, parameters, POSITION_0_WEIGHT);
		b->position0_bias = tensor_of(f, parameters, POSITION_0_BIAS);
		b->position1 = tensor_of(f, parameters, POSITION_1_WEIGHT);
		b->position1_bias = tensor_of(f, parameters, POSITION_1_BIAS);
		b->position1_t = transposed(f, b->position1, H, REFER_PH);
	}
	if (!is_projected(f))
		return;
	layer_load(&f->query, f->layout, QUERY_WEIGHT, parameters, 0);
	layer_load(&f->key, f->layout, KEY_WEIGHT, parameters, 0);
	layer_load(&f->value, f->layout, VALUE_WEIGHT, parameters, 0);
	layer_load(&f->query_position, f->layout, QUERY_POSITION_WEIGHT, parameters, 0);
	layer_load(&f->key_position, f->layout, KEY_POSITION_WEIGHT, parameters, 0);
	for (int i = 0; i < D; i++) {
		f->gamma[i] = (double)tensor_of(f, parameters, NORM_WEIGHT)[i];
		f->beta[i] = (double)tensor_of(f, parameters, NORM_BIAS)[i];
		f->dgamma[i] = f->dbeta[i] = 0;
	}
}

void fold_words(struct fold *f, const float *w, struct block_model *b)
{
	const int n = f->n;

	for (int i = 0; i < n * D; i++)
		f->w[i] = (double)w[i];
	memset(f->dw, 0, sizeof(double) * (size_t)n * D);
	memset(f->ds, 0, sizeof(double) * (size_t)f->sentences * D);
	memset(f->s, 0, sizeof(double) * (size_t)f->sentences * D);
	for (int s = 0; s < f->sentences; s++)
		for (int j = f->first[s]; j < f->first[s + 1]; j++) {
			const double *word = f->w + j * D;
			double length = f->similarity == REFER_COSINE ? fmax(sqrt(dot(word, word, D)), 1e-12) : 1;
			axpy(f->s + s * D, 1 / length, word, D);
		}
	if (b->has_words) {
		float *y = take(f, (size_t)n * G);
		double row[G];
		for (int j = 0; j < n; j++) {
			memset(row, 0, sizeof row);
			apply_t(row, &f->a, f->w + j * D, f->word_scale);
			row[H] = 0; /* the same for all Gaussians: no part in the softmax */
			for (int c = 0; c < G; c++)
				y[j * G + c] = (float)row[c];
		}
		b->y = y;
		b->y_t = transposed(f, y, n, G);
	}
	if (is_projected(f)) {
		float *gram = take(f, (size_t)G * G);
		for (int r = 0; r < G; r++)
			for (int c = 0; c < G; c++)
				gram[r * G + c] = (float)dot(f->p.wt + r * D, f->p.wt + c * D, D);
		b->p_gram = gram;
	}
}

/* Keys, values and what they fold to, for one word. */
static void fold_word(struct fold *f, int j, double *uh, double *uq)
{
	double *key = f->keys + j * D, *v = f->v + j * D, *kq = f->kq + j * D, *kp = f->kp + j * D;
	const double *w = f->w + j * D, *c = f->c + j * D;
	const double scale = f->score_scale;

	memset(uh, 0, sizeof *uh * G);
	memset(uq, 0, sizeof *uq * G);
	if (is_projected(f)) {
		for (int i = 0; i < D; i++)
			key[i] = f->key.bias[i] + f->key_position.bias[i];
		apply(key, &f->key, w, 1);
		apply(key, &f->key_position, c, 1);
		memcpy(v, f->value.bias, sizeof(double) * D);
		apply(v, &f->value, w, 1);
		memset(kq, 0, sizeof(double) * D);
		memset(kp, 0, sizeof(double) * D);
		apply_t(kq, &f->query, key, 1);
		apply_t(kp, &f->query_position, key, 1);
		uh[H] = scale * (dot(f->query.bias, key, D) + dot(f->query_position.bias, key, D));
	} else {
		memcpy(key, w, sizeof(double) * D);
		if (has_words(f))
			axpy(key, 1, c, D);
		memcpy(v, w, sizeof(double) * D);
		memcpy(kq, key, sizeof(double) * D);
		memcpy(kp, key, sizeof(double) * D);
	}
	apply_t(uh, &f->a, kq, scale);
	if (f->b->has_positions)
		apply_t(uq, &f->p, kp, scale);
}

/* The columns of C of one sentence, centred for LayerNorm. */
static void fold_columns(struct fold *f, int s)
{
	double *cz = f->cz + (size_t)s * (size_t)f->z_max * D;
	const int fixed = z_fixed(f), channels = z_channels(f, s);

	memcpy(cz, f->a.wt, sizeof(double) * G * D);
	if (fixed > G)
		memcpy(cz + G * D, f->p.wt, sizeof(double) * G * D);
	for (int j = fixed; j < channels; j++)
		memcpy(cz + j * D, f->v + (f->first[s] + j - fixed) * D, sizeof(double) * D);
	if (!is_projected(f))
		return;
	for (int j = 0; j < channels; j++) {
		double mean = 0;
		for (int i = 0; i < D; i++)
			mean += cz[j * D + i] / D;
		for (int i = 0; i < D; i++)
			cz[j * D + i] -= mean;
	}
}

/* s, scaled by LayerNorm's gamma. */
static void response_vector(const struct fold *f, int s, double *out)
{
	for (int i = 0; i < D; i++)
		out[i] = f->s[s * D + i] * (is_projected(f) ? f->gamma[i] : 1);
}

static void fold_response(struct fold *f, int s, float *k, float *gram, float *m0)
{
	const double *cz = f->cz + (size_t)s * (size_t)f->z_max * D;
	const double over = is_projected(f) ? 1.0 / D : 1;
	const int channels = z_channels(f, s), size = f->b->z_size;
	double vector[D];

	response_vector(f, s, vector);
	for (int c = 0; c < channels; c++)
		k[c] = (float)dot(cz + c * D, vector, D);
	if (!gram)
		return;
	for (int r = 0; r < channels; r++)
		for (int c = 0; c <= r; c++)
			gram[r * size + c] = gram[c * size + r] = (float)(over * dot(cz + r * D, cz + c * D, D));
	*m0 = is_projected(f) ? (float)dot(f->s + s * D, f->beta, D) : 0;
}

void fold_scores(struct fold *f, const double *cbar, const double *l_max, const double *l_sum, struct block_model *b)
{
	const int n = b->words, size = b->z_size;
	float *uh = take(f, (size_t)n * G), *uq = take(f, (size_t)n * G);

	f->b = b;
	if (b->has_words) {
		float *top = take(f, (size_t)n), *scale = take(f, (size_t)n);
		memcpy(f->cbar, cbar, sizeof(double) * (size_t)n * G);
		for (int j = 0; j < n; j++) {
			memset(f->c + j * D, 0, sizeof(double) * D);
			apply(f->c + j * D, &f->p, cbar + j * G, 1);
			top[j] = (float)l_max[j];
			scale[j] = (float)(1 / l_sum[j]);
		}
		b->l_max = top;
		b->l_scale = scale;
	}
	for (int j = 0; j < n; j++) {
		double row_h[G], row_q[G];
		fold_word(f, j, row_h, row_q);
		for (int c = 0; c < G; c++) {
			uh[j * G + c] = (float)row_h[c];
			uq[j * G + c] = (float)row_q[c];
		}
	}
	b->uh = uh;
	b->uq = uq;
	b->uh_t = transposed(f, uh, n, G);
	b->uq_t = transposed(f, uq, n, G);
	float *k = take(f, (size_t)f->sentences * (size_t)size), *m0 = take(f, (size_t)f->sentences), *gram = NULL;
	if (b->is_normalised)
		gram = take(f, (size_t)f->sentences * (size_t)size * (size_t)size);
	for (int s = 0; s < f->sentences; s++) {
		fold_columns(f, s);
		fold_response(f, s, k + s * size, gram ? gram + s * size * size : NULL, m0 + s);
	}
	b->k = k;
	b->m0 = m0;
	b->gram = gram;
}

void fold_top(struct fold *f, const double *mean, double *fg)
{
	const int size = f->b->z_size;

	for (int s = 0; s < f->sentences; s++) {
		const double *cz = f->cz + (size_t)s * (size_t)f->z_max * D;
		double *sum = f->cz_mean + s * D;
		memcpy(f->mean + s * f->z_max, mean + s * size, sizeof(double) * (size_t)z_channels(f, s));
		memset(sum, 0, sizeof(double) * D);
		for (int c = 0; c < z_channels(f, s); c++)
			axpy(sum, mean[s * size + c], cz + c * D, D);
		for (int i = 0; i < D; i++)
			fg[s * D + i] = is_projected(f) ? f->gamma[i] * sum[i] + f->beta[i] : sum[i];
	}
}

void fold_top_back(struct fold *f, const double *dfg, struct block_model *b)
{
	const int size = b->z_size;
	float *dmean = take(f, (size_t)f->sentences * (size_t)size);

	b->dmean = dmean;
	memset(f->dcz, 0, sizeof(double) * (size_t)f->sentences * (size_t)f->z_max * D);
	memset(dmean, 0, sizeof *dmean * (size_t)f->sentences * (size_t)size);
	for (int s = 0; dfg && s < f->sentences; s++) {
		const double *cz = f->cz + (size_t)s * (size_t)f->z_max * D, *d = dfg + s * D;
		double *dcz = f->dcz + (size_t)s * (size_t)f->z_max * D, scaled[D];
		for (int i = 0; i < D; i++) {
			scaled[i] = is_projected(f) ? f->gamma[i] * d[i] : d[i];
			if (is_projected(f)) {
				f->dgamma[i] += d[i] * f->cz_mean[s * D + i];
				f->dbeta[i] += d[i];
			}
		}
		for (int c = 0; c < z_channels(f, s); c++) {
			dmean[s * size + c] = (float)dot(cz + c * D, scaled, D);
			axpy(dcz + c * D, f->mean[s * f->z_max + c], scaled, D);
		}
	}
}

/* Gradients of k, G and m0 of one sentence to C, s and the norm; then C's columns to A, a, B, b and V. */
static void response_back(struct fold *f, int s, const double *dk, const double *dgram, const double *dm0)
{
	const double *cz = f->cz + (size_t)s * (size_t)f->z_max * D;
	double *dcz = f->dcz + (size_t)s * (size_t)f->z_max * D, vector[D], dvector[D] = {0};
	const int size = f->b->z_size, channels = z_channels(f, s), fixed = z_fixed(f);
	const double over = is_projected(f) ? 1.0 / D : 1;

	response_vector(f, s, vector);
	for (int c = 0; c < channels; c++) {
		axpy(dcz + c * D, dk[c], vector, D);
		axpy(dvector, dk[c], cz + c * D, D);
	}
	if (dgram)
		for (int r = 0; r < channels; r++)
			for (int c = 0; c < channels; c++)
				axpy(dcz + r * D, over * (dgram[r * size + c] + dgram[c * size + r]), cz + c * D, D);
	for (int i = 0; i < D; i++) {
		if (!is_projected(f)) {
			f->ds[s * D + i] += dvector[i];
			continue;
		}
		f->ds[s * D + i] += dvector[i] * f->gamma[i] + *dm0 * f->beta[i];
		f->dgamma[i] += dvector[i] * f->s[s * D + i];
		f->dbeta[i] += *dm0 * f->s[s * D + i];
	}
	if (is_projected(f))
		for (int c = 0; c < channels; c++) {
			double mean = 0;
			for (int i = 0; i < D; i++)
				mean += dcz[c * D + i] / D;
			for (int i = 0; i < D; i++)
				dcz[c * D + i] -= mean;
		}
	for (int i = 0; i < D; i++)
		for (int c = 0; c < G; c++) {
			f->a.dw[i * G + c] += dcz[c * D + i];
			if (fixed > G)
				f->p.dw[i * G + c] += dcz[(G + c) * D + i];
		}
	for (int j = fixed; j < channels; j++)
		memcpy(f->dv + (f->first[s] + j - fixed) * D, dcz + j * D, sizeof(double) * D);
}

/* Gradients of one word's folded scores and value to its key, the layers, the word and (dc) its position. */
static void word_back(struct fold *f, int j, const double *duh, const double *duq, double *dc)
{
	const double *key = f->keys + j * D, *w = f->w + j * D, *dv = f->dv + j * D;
	const double scale = f->score_scale;
	double dkq[D] = {0}, dkp[D] = {0}, dkey[D] = {0}, *dw = f->dw + j * D;

	outer(&f->a, f->kq + j * D, duh, scale);
	apply(dkq, &f->a, duh, scale);
	if (f->b->has_positions) {
		outer(&f->p, f->kp + j * D, duq, scale);
		apply(dkp, &f->p, duq, scale);
	}
	memset(dc, 0, sizeof(double) * D);
	if (!is_projected(f)) {
		axpy(dkey, 1, dkq, D);
		axpy(dkey, 1, dkp, D);
		axpy(dw, 1, dkey, D);
		axpy(dw, 1, dv, D);
		if (has_words(f))
			axpy(dc, 1, dkey, D);
		return;
	}
	outer(&f->query, key, dkq, 1);
	outer(&f->query_position, key, dkp, 1);
	apply(dkey, &f->query, dkq, 1);
	apply(dkey, &f->query_position, dkp, 1);
	for (int i = 0; i < D; i++) {
		f->query.dbias[i] += scale * duh[H] * key[i];
		f->query_position.dbias[i] += scale * duh[H] * key[i];
		dkey[i] += scale * duh[H] * (f->query.bias[i] + f->query_position.bias[i]);
	}
	/* The biases of the keys shift all scores of a Gaussian alike: the softmax does not see them, their gradient is 0. */
	for (int i = 0; i < D; i++)
		f->value.dbias[i] += dv[i];
	outer(&f->key, dkey, w, 1);
	outer(&f->key_position, dkey, f->c + j * D, 1);
	outer(&f->value, dv, w, 1);
	apply_t(dw, &f->key, dkey, 1);
	apply_t(dw, &f->value, dv, 1);
	apply_t(dc, &f->key_position, dkey, 1);
}

void fold_scores_back(struct fold *f, const double *duh, const double *duq, const double *dk, const double *dgram,
	const double *dm0, struct block_model *b)
{
	const int n = b->words, size = b->z_size;
	float *dcs = take(f, (size_t)n * G), *dots = take(f, (size_t)n);

	for (int s = 0; s < f->sentences; s++)
		response_back(f, s, dk + s * size, b->is_normalised ? dgram + s * size * size : NULL, dm0 + s);
	for (int j = 0; j < n; j++) {
		double dc[D], dcbar[G] = {0};
		word_back(f, j, duh + j * G, duq + j * G, dc);
		if (!b->has_words)
			continue;
		apply_t(dcbar, &f->p, dc, 1);
		outer(&f->p, dc, f->cbar + j * G, 1);
		for (int c = 0; c < G; c++)
			dcs[j * G + c] = (float)dcbar[c];
		dots[j] = (float)dot(dcbar, f->cbar + j * G, G);
	}
	b->dc = dcs;
	b->dc_t = transposed(f, dcs, n, G);
	b->dc_dot = dots;
}

/* From the response vector s to the words. */
static void sentence_back(struct fold *f, int s)
{
	const double *ds = f->ds + s * D;

	for (int j = f->first[s]; j < f->first[s + 1]; j++) {
		const double *w = f->w + j * D;
		double *dw = f->dw + j * D;
		double length = sqrt(dot(w, w, D));
		if (f->similarity == REFER_DOT) {
			axpy(dw, 1, ds, D);
		} else if (length > 1e-12) {
			axpy(dw, 1 / length, ds, D);
			axpy(dw, -dot(w, ds, D) / (length * length * length), w, D);
		} else {
			axpy(dw, 1e12, ds, D);
		}
	}
}

void fold_end(struct fold *f, const double *dy, const double *dp_gram, float *gradient, float *dw)
{
	const struct refer_layout *l = f->layout;

	for (int s = 0; s < f->sentences; s++)
		sentence_back(f, s);
	for (int j = 0; has_words(f) && j < f->n; j++) {
		double row[G];
		memcpy(row, dy + j * G, sizeof row);
		row[H] = 0;
		outer(&f->a, f->w + j * D, row, f->word_scale);
		apply(f->dw + j * D, &f->a, row, f->word_scale);
	}
	if (is_projected(f))
		for (int r = 0; r < G; r++)
			for (int c = 0; c < G; c++) {
				double d = dp_gram[r * G + c] + dp_gram[c * G + r];
				for (int i = 0; i < D; i++)
					f->p.dw[i * G + r] += d * f->p.wt[c * D + i];
			}
	layer_store(&f->a, l, FEATURE_2_WEIGHT, gradient, 1);
	if (refer_uses_position(l->interaction))
		layer_store(&f->p, l, POSITION_2_WEIGHT, gradient, 1);
	if (is_projected(f)) {
		layer_store(&f->query, l, QUERY_WEIGHT, gradient, 0);
		layer_store(&f->key, l, KEY_WEIGHT, gradient, 0);
		layer_store(&f->value, l, VALUE_WEIGHT, gradient, 0);
		layer_store(&f->query_position, l, QUERY_POSITION_WEIGHT, gradient, 0);
		layer_store(&f->key_position, l, KEY_POSITION_WEIGHT, gradient, 0);
		for (int i = 0; i < D; i++) {
			gradient[l->tensors[NORM_WEIGHT].offset + (size_t)i] += (float)f->dgamma[i];
			gradient[l->tensors[NORM_BIAS].offset + (size_t)i] += (float)f->dbeta[i];
		}
	}
	for (int i = 0; i < f->n * D; i++)
		dw[i] = (float)f->dw[i];
}
