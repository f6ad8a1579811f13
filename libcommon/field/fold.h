/* Folding: the last layers of MLP_f and MLP_p, the words and the projections become the small matrices of
 * struct block_model, in float64, and their gradients come back (design section 4, "what is constant", 2 to
 * 5).
 *
 * A, a and B, b are the last layers of MLP_f and MLP_p, g = [h;1], r = nu [q;1]:
 *   f = [A a] g, nu p = [B b] r, f' = C z with C = [A a | B b (add) | V_1 .. V_n] (its rows centred for
 * LayerNorm). Order of calls in a step: fold_begin, fold_words, (hidden), fold_scores, (respond, gather),
 * fold_top, fold_top_back, (scores_back), fold_scores_back, (hidden_back), fold_end. */
#pragma once

#include "base/err.h"
#include "field/block.h"
#include "field/referring_model.h"

struct fold;

/* Buffers for steps of at most `sentences` sentences of at most `longest` words each. NULL with *e set. */
struct fold *fold_new(const struct refer_layout *l, enum refer_similarity similarity, int longest,
	int sentences, struct err *e);
void fold_free(struct fold *f);

/* Converts the parameters of this step and sets up *b, whose pointers stay valid until the next fold_begin.
 * `first` (sentences+1) is copied. */
void fold_begin(struct fold *f, const float *parameters, size_t gaussians, const int *first, int sentences,
	struct block_model *b);

/* Takes the words w (n,128). Fills y and P. */
void fold_words(struct fold *f, const float *w, struct block_model *b);

/* Takes cbar (n,65), the mean of r under each word's softmax over Gaussians, and its logarithm of the sum as
 * l_max, l_sum (n). Fills everything that respond needs, and l_max, l_scale. NULLs without word positions. */
void fold_scores(
	struct fold *f, const double *cbar, const double *l_max, const double *l_sum, struct block_model *b);

/* f_g (S,128) of the mean (S,z_size) of z (z/sigma for pcmi-proj) over the top sets. */
void fold_top(struct fold *f, const double *mean, double *fg);

/* Takes df_g (S,128) (NULL: zero); fills dmean. */
void fold_top_back(struct fold *f, const double *dfg, struct block_model *b);

/* Takes the sums of scores_back; fills dc and dc_dot. */
void fold_scores_back(struct fold *f, const double *duh, const double *duq, const double *dk,
	const double *dgram, const double *dm0, struct block_model *b);

/* Takes the sums of hidden_back; adds the gradients of the last layers, projections and norm to `gradient`
 * (the parameter slab's layout), and gives those of the words, dw (n,128). */
void fold_end(struct fold *f, const double *dy, const double *dp_gram, float *gradient, float *dw);
