#include "field/fold_private.h"

#include "base/mem.h"

#include <math.h>

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
static void layer_load(struct layer *l, const struct refer_layout *layout, enum refer_tensor weight,
	const float *parameters, int with_bias)
{
	const int columns = layout->tensors[weight].columns;
	const float *w = parameters + layout->tensors[weight].offset,
		    *bias = parameters + layout->tensors[weight + 1].offset;

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

struct fold *fold_new(const struct refer_layout *l, enum refer_similarity similarity, int longest,
	int sentences, struct err *e)
{
	struct fold *f = mem_zalloc(1, sizeof *f, "folded model", e);

	if (!f)
		return NULL;
	f->layout = l;
	f->similarity = similarity;
	f->z_max = 2 * G + longest;
	f->score_scale = 1 / sqrt(D);
	f->word_scale = is_projected(f) ? 1 : f->score_scale;
	const int is_normalised = is_projected(f) || similarity == REFER_COSINE;
	size_t s = (size_t)sentences, n = s * (size_t)longest, z = (size_t)f->z_max;
	size_t doubles = n * D * 9 + n * G + s * D * 3 + 2 * s * z * D + s * z;
	f->out_size = 8 * n * G + 4 * n + 2 * (size_t)G * G + s * (2 * z + 1) + 32 * 1024;
	if (is_normalised)
		f->out_size += 2 * s * z * z;
	f->first = mem_zalloc(s + 1, sizeof *f->first, "folded model", e);
	f->w = mem_zalloc(doubles, sizeof(double), "folded model", e);
	f->out = mem_zalloc(f->out_size, sizeof(float), "folded model", e);
	if (!f->first || !f->w || !f->out || layer_alloc(&f->a, G, e) || layer_alloc(&f->p, G, e))
		goto fail;
	if (is_projected(f)) {
		struct layer *square[5] = {
			&f->query, &f->key, &f->value, &f->query_position, &f->key_position};
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
	struct layer *layers[7] = {
		&f->a, &f->p, &f->query, &f->key, &f->value, &f->query_position, &f->key_position};
	for (int i = 0; i < 7; i++)
		free(layers[i]->w);
	mem_free_all(f->first, f->w, f->out, f);
}

/* A tensor of the slab. */
static const float *tensor_of(const struct fold *f, const float *parameters, enum refer_tensor t)
{
	return parameters + f->layout->tensors[t].offset;
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
		.feature_width = f->layout->feature_width,
		.words = has_attention(f) ? f->n : 0,
		.sentences = sentences,
		.first = f->first,
		.eps = is_projected(f) ? 1e-5f : 0,
		.floor = is_projected(f) ? 0 : 1e-24f};
	for (int s = 0; s < sentences; s++)
		b->z_size = z_channels(f, s) > b->z_size ? z_channels(f, s) : b->z_size;
	b->feature0 = tensor_of(f, parameters, FEATURE_0_WEIGHT);
	b->feature0_bias = tensor_of(f, parameters, FEATURE_0_BIAS);
	b->feature0_t = transposed(f, b->feature0, REFER_XH, b->feature_width);
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
			double length =
				f->similarity == REFER_COSINE ? fmax(sqrt(dot(word, word, D)), 1e-12) : 1;
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

static void fold_response(struct fold *f, int s, float *k, float *gram, float *half, float *m0)
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
		for (int c = 0; c <= r; c++) {
			const float element = (float)(over * dot(cz + r * D, cz + c * D, D));
			gram[r * size + c] = gram[c * size + r] = element;
			half[r * size + c] = c < r ? 2 * element : element;
			if (c < r)
				half[c * size + r] = 0;
		}
	*m0 = is_projected(f) ? (float)dot(f->s + s * D, f->beta, D) : 0;
}

void fold_scores(
	struct fold *f, const double *cbar, const double *l_max, const double *l_sum, struct block_model *b)
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
	float *k = take(f, (size_t)f->sentences * (size_t)size), *m0 = take(f, (size_t)f->sentences),
	      *gram = NULL, *half = NULL;
	if (b->is_normalised) {
		gram = take(f, (size_t)f->sentences * (size_t)size * (size_t)size);
		half = take(f, (size_t)f->sentences * (size_t)size * (size_t)size);
	}
	for (int s = 0; s < f->sentences; s++) {
		fold_columns(f, s);
		fold_response(f, s, k + s * size, gram ? gram + s * size * size : NULL,
			half ? half + s * size * size : NULL, m0 + s);
	}
	b->k = k;
	b->m0 = m0;
	b->gram = gram;
	b->half = half;
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
