/* What fold.c (forward) and fold_back.c (backward) share. */
#pragma once

#include "base/dot.h"
#include "field/fold.h"

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
	int n, sentences, z_max;
	int *first;
	struct block_model *b;
	struct layer a, p; /* [A a], [B b]: in = 65, the bias as the last column */
	struct layer query, key, value, query_position, key_position; /* pcmi-proj */
	double gamma[D], beta[D], dgamma[D], dbeta[D];
	double score_scale, word_scale;	 /* 1/sqrt D, and what multiplies w.f in the word positions */
	double *w, *dw;			 /* (n,D) */
	double *s, *ds;			 /* (S,D) */
	double *cbar, *c;		 /* (n,G), (n,D) */
	double *keys, *kq, *kp, *v, *dv; /* (n,D) */
	double *cz, *dcz;		 /* (S,z_max,D): columns of C, of C centred for LayerNorm */
	double *mean, *cz_mean;		 /* (S,z_max), (S,D) */
	float *out;			 /* one slab for all of block_model's matrices */
	size_t out_used, out_size;
};

static inline void axpy(double *y, double scale, const double *x, int n)
{
	for (int i = 0; i < n; i++)
		y[i] += scale * x[i];
}

/* y += scale W x for a layer (out D). */
static inline void apply(double *y, const struct layer *l, const double *x, double scale)
{
	for (int c = 0; c < l->in; c++)
		if (x[c] != 0)
			axpy(y, scale * x[c], l->wt + c * D, D);
}

/* y (in) += scale W^T x. */
static inline void apply_t(double *y, const struct layer *l, const double *x, double scale)
{
	for (int r = 0; r < D; r++)
		axpy(y, scale * x[r], l->w + r * l->in, l->in);
}

/* dW += scale d x^T. */
static inline void outer(struct layer *l, const double *d, const double *x, double scale)
{
	for (int r = 0; r < D; r++)
		axpy(l->dw + r * l->in, scale * d[r], x, l->in);
}

static inline int is_projected(const struct fold *f)
{
	return f->layout->interaction == REFER_PCMI_PROJ;
}

static inline int has_words(const struct fold *f)
{
	return f->layout->interaction >= REFER_PCMI;
}

static inline int z_fixed(const struct fold *f)
{
	return f->layout->interaction == REFER_ADD ? 2 * G : G;
}

static inline int has_attention(const struct fold *f)
{
	return f->layout->interaction != REFER_NONE && f->layout->interaction != REFER_ADD;
}

static inline int z_channels(const struct fold *f, int s)
{
	return z_fixed(f) + (has_attention(f) ? f->first[s + 1] - f->first[s] : 0);
}

/* s, scaled by LayerNorm's gamma. */
static inline void response_vector(const struct fold *f, int s, double *out)
{
	for (int i = 0; i < D; i++)
		out[i] = f->s[s * D + i] * (is_projected(f) ? f->gamma[i] : 1);
}

/* `count` floats of block_model's matrices. */
static inline float *take(struct fold *f, size_t count)
{
	float *at = f->out + f->out_used;

	f->out_used += (count + 15) / 16 * 16;
	return at;
}

static inline const float *transposed(struct fold *f, const float *w, int rows, int columns)
{
	float *t = take(f, (size_t)rows * (size_t)columns);

	for (int r = 0; r < rows; r++)
		for (int c = 0; c < columns; c++)
			t[c * rows + r] = w[r * columns + c];
	return t;
}
