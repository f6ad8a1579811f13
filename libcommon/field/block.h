/* The training step's per-Gaussian work, on blocks of Gaussians small enough to stay in cache (design section
 * 4, "what is constant"). No 128-vector per Gaussian exists: the last layers of MLP_f and MLP_p and
 * everything that follows them are folded into small matrices over the last hidden layers (field/fold.h).
 *
 * With h_i, q_i in R^64 the last hidden layers, and nu_i = 1 (1/|p_i| for pcmi-proj), the kernels see
 *   g_i = [h_i; 1]   and   r_i = nu_i [q_i; 1]          (65 each)
 *   word-position logits    l_ji = y_j.g_i               beta_ji = softmax over i
 *   scores                  s_ij = uh_j.g_i + uq_j.r_i   alpha_ij = softmax over the words j of a sentence
 *   z_i = [g_i; r_i (add only); alpha_i]                 f'_i = C z_i
 *   response                m_i = k.z_i                              (dot)
 *                           m_i = k.z_i / sqrt(z_i^T G z_i + eps) + m0  (cosine, pcmi-proj)
 *
 * Arrays over Gaussians are stored in panels of 64: channel c of Gaussian i is at
 * array[(i / 64) * channels * 64 + c * 64 + i % 64]. N is padded to whole blocks; padding Gaussians take no
 * part. */
#pragma once

#include "field/referring_model.h"

#include <stddef.h>

enum {
	BLOCK_LANES = 64,			 /* Gaussians in a panel */
	BLOCK_PANELS = 8,			 /* panels in a block */
	BLOCK_SIZE = BLOCK_LANES * BLOCK_PANELS, /* Gaussians in a block */
	BLOCK_G = REFER_H + 1,			 /* channels of g and r */
	BLOCK_WORDS = 1024,			 /* most words in a step */
};

/* The folded model of one step: everything the kernels read. Row-major float32 matrices. */
struct block_model {
	size_t gaussians;  /* N without padding */
	int uses_position; /* has MLP_p, r */
	int is_add;	   /* z holds r */
	int is_projected;  /* nu = 1/|p| */
	int has_attention; /* uh, va; alpha */
	int has_positions; /* scores and word positions use r: uq */
	int has_words;	   /* word positions c_j: y, beta */
	int is_normalised; /* responses are divided by sqrt(z^T G z + eps) */
	int feature_width; /* d_r, channels of x */
	int words;	   /* n over all sentences of the step; 0 without attention */
	int sentences;	   /* S */
	const int *first;  /* (S+1) first word of each sentence */
	int z_size;	   /* channels of z for the sentence with most words */

	const float *feature0, *feature0_bias, *feature0_t;    /* (32,d_r), (32), (d_r,32) */
	const float *feature1, *feature1_bias, *feature1_t;    /* (64,32), (64), (32,64) */
	const float *position0, *position0_bias;	       /* (16,3), (16) */
	const float *position1, *position1_bias, *position1_t; /* (64,16), (64), (16,64) */
	const float *y, *y_t;				       /* (n,65), (65,n) */
	const float *uh, *uh_t;				       /* (n,65), (65,n) */
	const float *uq, *uq_t;				       /* (n,65), (65,n) */
	const float *p_gram;				       /* (65,65) [B b]^T [B b] */
	const float *k;	   /* (S,z_size): z order; the alphas of a sentence follow its g (and r) */
	const float *gram; /* (S,z_size,z_size) G, rows of z_size */
	const float *half; /* the lower triangle of gram with all but the diagonal doubled; 0 above */
	const float *m0;   /* (S) */
	float eps, floor;  /* z^T G z + eps, at least floor */

	/* Backward only. */
	const float *l_max, *l_scale; /* (n) beta = exp(l - l_max) * l_scale */
	const float *dc, *dc_t;	      /* (n,65), (65,n) gradient of the weighted mean of r under beta_j */
	const float *dc_dot;	      /* (n) dc_j . cbar_j */
	const float *dmean; /* (S,z_size) gradient of the mean of z (of z/sigma where normalised) over the top
			       set */
};

/* Per-Gaussian arrays, panels; NULL where the interaction has no use for them. */
struct block_arrays {
	const float *x;	       /* d_r channels */
	const float *position; /* 3 channels */
	float *g, *r;	       /* 65 channels */
	float *beta;	       /* n channels: logits l, then dl */
	float *alpha;	       /* n channels: alpha, then ds */
	float *m, *sigma;      /* S channels: responses; 1/sqrt(z^T G z + eps) */
	float *dm, *top;       /* S channels: dL/dm; 1/k for the top set, else 0 */
	float *dg, *dr;	       /* 65 channels, only where normalised */
	float *dx;	       /* d_r channels */
};

/* Sums over the Gaussians of a chunk of blocks; float32 within, added up in double by the caller. */
struct block_sums {
	float *l_max, *l_sum, *c_sum; /* (n), (n), (n,65): online softmax over Gaussians */
	float *duh, *duq, *dy;	      /* (n,65) */
	float *dk;		      /* (S,z_size), where responses are not normalised */
	float *dgram;	/* (S,z_size+1,z_size): lower triangle, anything above it; dk below it */
	float *dm0;	/* (S) */
	float *mean;	/* (S,z_size) sum of top * z (or top * z / sigma) */
	float *dp_gram; /* (65,65) */
	float *dfeature0, *dfeature0_bias; /* as in block_model */
	float *dfeature1, *dfeature1_bias;
	float *dposition0, *dposition0_bias;
	float *dposition1, *dposition1_bias;
};

/* Buffers of one thread, block_scratch_floats() long. */
size_t block_scratch_floats(const struct block_model *b);

/* One block each, `block` counted from 0. The phases of a step in order: */
struct block_kernels {
	const char *name; /* "avx512", "avx2", "plain" */
	/* MLPs; logits and the running word-position sums. */
	void (*hidden)(const struct block_model *, const struct block_arrays *, size_t block,
		struct block_sums *, float *scratch);
	/* Scores, alpha, responses. */
	void (*respond)(const struct block_model *, const struct block_arrays *, size_t block);
	/* Sum of z over the top set. */
	void (*gather)(
		const struct block_model *, const struct block_arrays *, size_t block, struct block_sums *);
	/* Backward through responses and scores: ds in place of alpha; duh, duq, dk, dgram, dm0. */
	void (*scores_back)(const struct block_model *, const struct block_arrays *, size_t block,
		struct block_sums *, float *scratch);
	/* Backward through word positions and the MLPs: dx and the weights' gradients. */
	void (*hidden_back)(const struct block_model *, const struct block_arrays *, size_t block,
		struct block_sums *, float *scratch);
};

/* The fastest set that this processor runs; `name` asks for one ("avx512", "avx2", "plain"; NULL: the
 * fastest). NULL where the name is unknown or the processor lacks it. */
const struct block_kernels *block_select(const char *name);
