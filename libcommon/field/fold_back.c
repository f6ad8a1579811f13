#include "field/fold_private.h"

#include <math.h>
#include <string.h>

static void layer_store(const struct layer *l, const struct refer_layout *layout, enum refer_tensor weight,
	float *gradient, int with_bias)
{
	const int columns = layout->tensors[weight].columns;
	float *dw = gradient + layout->tensors[weight].offset,
	      *dbias = gradient + layout->tensors[weight + 1].offset;

	for (int r = 0; r < D; r++) {
		for (int c = 0; c < columns; c++)
			dw[r * columns + c] += (float)l->dw[r * l->in + c];
		dbias[r] += (float)(with_bias ? l->dw[r * l->in + columns] : l->dbias[r]);
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
	if (dgram) /* G is symmetric, and so is its gradient: the lower triangle stands for both */
		for (int r = 0; r < channels; r++)
			for (int c = 0; c < channels; c++)
				axpy(dcz + r * D, 2 * over * dgram[r > c ? r * size + c : c * size + r],
					cz + c * D, D);
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
	/* The biases of the keys shift all scores of a Gaussian alike: the softmax does not see them, their
	 * gradient is 0. */
	for (int i = 0; i < D; i++)
		f->value.dbias[i] += dv[i];
	outer(&f->key, dkey, w, 1);
	outer(&f->key_position, dkey, f->c + j * D, 1);
	outer(&f->value, dv, w, 1);
	apply_t(dw, &f->key, dkey, 1);
	apply_t(dw, &f->value, dv, 1);
	apply_t(dc, &f->key_position, dkey, 1);
}

void fold_scores_back(struct fold *f, const double *duh, const double *duq, const double *dk,
	const double *dgram, const double *dm0, struct block_model *b)
{
	const int n = b->words, size = b->z_size;
	float *dcs = take(f, (size_t)n * G), *dots = take(f, (size_t)n);

	for (int s = 0; s < f->sentences; s++) {
		const double *own = dgram + s * (size + 1) * size;
		if (b->is_normalised)
			response_back(f, s, own + z_channels(f, s) * size, own, dm0 + s);
		else
			response_back(f, s, dk + s * size, NULL, dm0 + s);
	}
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
