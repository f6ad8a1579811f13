/* The referring model as it is written in field/referring_model.h: float64, every 128-vector made, nothing
 * folded, one thread. It is what the fast paths are compared with, and is meant to be read next to that
 * header.
 *
 * Shapes below: N Gaussians, R sentences, W words of all sentences together, n words of the target sentence,
 * P pixels, D = REFER_D. All arrays are row-major. */
#ifndef REFERENCE_H
#define REFERENCE_H

#include "base/err.h"
#include "field/referring_model.h"

#include <stddef.h>
#include <stdint.h>

/* One training step's input: a view, a sentence, and the sentences it is contrasted with. Nothing here is
 * owned. */
struct refer_problem {
	const struct refer_layout *layout;
	const double *parameters; /* (layout->count) */

	size_t n;		/* N >= 1 */
	const double *x;	/* (N,d_r) referring features */
	const double *position; /* (N,3) means scaled to [-1,1] */
	const uint32_t *counts; /* (N) how many Gaussians each stands for; NULL: one */

	size_t sentences;      /* R >= 1, "all sentences" of the contrast */
	const size_t *offsets; /* (R+1) sentence r has the words offsets[r] .. offsets[r+1]-1, one at least */
	const double *words;   /* (W, text_width) */
	const double *times;   /* (R) how often each counts in the sum over all; NULL: once */
	const int *objects;    /* (R) E+ are the sentences with the target's object */
	size_t target;	       /* r < R */

	size_t pixels;	       /* P >= 1 */
	const int64_t *indptr; /* (P+1) pixel v has the entries indptr[v] .. indptr[v+1]-1, or none */
	const int32_t *index;  /* (indptr[P]) Gaussian in [0,N) */
	const double *weight;  /* (indptr[P]) */
	const uint8_t *mask;   /* (P) 0 or not 0 */

	enum refer_similarity similarity; /* REFER_PCMI_PROJ has REFER_DOT only */
	enum refer_contrast contrast;
	double temperature; /* T > 0 */
	double lambda;	    /* weight of the contrast in the loss */
	double tau;	    /* in [0,1], share of the Gaussians in f_g: k = max(1, floor(tau of all)) */
};

/* Everything the forward pass computes, under the names of field/referring_model.h; the backward pass reads
 * it. Arrays that the interaction does not have are zero. Hidden layers are after their ReLU. Released with
 * reference_free. */
struct refer_result {
	double *text_hidden0, *text_hidden1, *w;	 /* (W,512) (W,256) (W,D) */
	double *e;					 /* (R,D) */
	double *feature_hidden0, *feature_hidden1, *f;	 /* (N,32) (N,64) (N,D) */
	double *position_hidden0, *position_hidden1, *p; /* (N,16) (N,64) (N,D) */
	double *place;	     /* (N,D) what c is a mean of: p, or p^ for pcmi-proj */
	double *beta;	     /* (n,N) softmax over Gaussians */
	double *c;	     /* (n,D) */
	double *query;	     /* (N,D) what is multiplied with the keys: f, f+p or Q */
	double *key, *value; /* (n,D) w or w+c or K; w or V */
	double *alpha;	     /* (N,n) softmax over words */
	double *sum;	     /* (N,D) f' before the LayerNorm */
	double *rstd;	     /* (N) 1 / standard deviation of a row of sum, eps included (pcmi-proj) */
	double *refined;     /* (N,D) f' */
	double *m;	     /* (N) */
	double *image;	     /* (P) M(v) */
	size_t *top;	     /* (top_count) Gaussians of f_g, largest m first */
	size_t top_count;
	double *top_share; /* (top_count) the share of each in the mean: its count, the last cut, over k */
	double *f_g;	   /* (D) */
	double bce, contrast, loss; /* loss = bce + lambda contrast; contrast is 0 where there is none */
	double *slab;		    /* holds all arrays but top */
};

/* Fills *out. Returns 0; or -1 with *e set and *out zeroed: ERR_FORMAT where the problem breaks a bound named
 * above, ERR_SYSTEM where memory is out. */
int reference_forward(const struct refer_problem *problem, struct refer_result *out, struct err *e);

/* The gradient of the loss. dx (N,d_r) and dparameters (layout->count) are overwritten. Returns 0, or -1 with
 * *e set. */
int reference_backward(const struct refer_problem *problem, const struct refer_result *result, double *dx,
	double *dparameters, struct err *e);

/* The contrast alone, from f_g and e of a result: for the loss under another contrast than the problem's.
 * Returns 0, or -1 with *e set. */
int reference_contrast(const struct refer_problem *problem, const struct refer_result *result,
	double *contrast, struct err *e);

void reference_free(struct refer_result *result);

/* The loss and d loss / d M(v) of one pixel with logit M: binary cross-entropy that no logit overflows. */
double reference_bce(double logit, int is_set);
double reference_bce_slope(double logit, int is_set);

/* v / max(|v|, 1e-12), D wide; returns max(|v|, 1e-12). */
double reference_normalize(const double *v, double *unit);

/* How often a sentence counts. */
double reference_times(const struct refer_problem *problem, size_t sentence);

/* s(e) / T of each sentence into (R). */
void reference_sentence_scores(
	const struct refer_problem *problem, const struct refer_result *result, double *scores);

/* Softmax of count values in place, the maximum taken out; returns the log of the sum of exp. */
double reference_softmax(double *values, size_t count);

#endif
