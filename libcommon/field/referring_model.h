/* clang-format off */
/* The referring model (ReferSplat, ICML 2025; design section 4): what is learned, and how it is laid out.
 *
 * N Gaussians, or rows that Gaussians share (field/rows.h), a sentence of n words, D = 128. [W;b](x) is a
 * linear layer W x + b with W (out,in) row-major.
 *   w_j  = MLP_t(BERT word j)      D_text-512-256-128, ReLU between layers
 *   e    = mean_j w_j              sentence embedding
 *   f_i  = MLP_f(x_i)              d_r-32-64-128, x_i the referring feature, d_r wide
 *   p_i  = MLP_p(mu_i)             3-16-64-128, mu_i the mean scaled to [-1,1] by the scene's robust bounds
 * Interaction gives f'_i:
 *   none          f'_i = f_i
 *   add           f'_i = f_i + p_i
 *   attention     f'_i = f_i + sum_j softmax_j(f_i.w_j / sqrt D) w_j
 *   attention+fp  f'_i = f_i + sum_j softmax_j((f_i+p_i).w_j / sqrt D) w_j
 *   pcmi          f'_i = f_i + sum_j softmax_j((f_i+p_i).(w_j+c_j) / sqrt D) w_j,
 *                 c_j  = sum_i softmax_i(w_j.f_i / sqrt D) p_i
 *   pcmi-proj     p^_i = p_i / |p_i|
 *                 c_j  = sum_i softmax_i(w_j.f_i) p^_i                       (no 1/sqrt D here)
 *                 Q_i  = [query](f_i) + [query_position](p^_i),  K_j = [key](w_j) + [key_position](c_j),
 *                 V_j  = [value](w_j)
 *                 f'_i = LayerNorm(f_i + sum_j softmax_j(Q_i.K_j / sqrt D) V_j), eps 1e-5, scale and shift learned
 *
 * Response: dot     m_i = sum_j f'_i.w_j
 *           cosine  m_i = sum_j f'_i.w_j / (|f'_i| |w_j|), each norm at least 1e-12 (not with pcmi-proj)
 * M(v) = sum_i w_vi m_i over the view's blend weights; where m_i was fitted as the logit of Gaussian i alone
 * (train/warm_start.h), sum_i w_vi (2 sigmoid(m_i) - 1): of shares, as logits differ in size without meaning.
 *
 * Loss of one sentence r in one view: L = L_bce + lambda L_con.
 * L_bce  mean over pixels of the binary cross-entropy with logits M against the mask
 * L_con  = -1/|E+| sum_{e+ in E+} log( exp(s(e+)/T) / sum_{all e} exp(s(e)/T) )    (contrast dot, cosine)
 *          log(1 + sum_{e- not in E+} sum_{e+ in E+} exp((s(e-) - s(e+))/T))         (pairs, the released code's)
 *        E+ the sentences of r's object, "all" the scene's training sentences, or of either kind a sample, each
 *        counted as often as makes up for the rest (struct step_others); s(e) = f_g.e (contrast dot) or
 *        f_g.e/(|f_g||e|) (cosine, pairs); f_g = mean of f'_i over the k Gaussians of largest m_i (ties: lower
 *        index first), k = max(1, floor(tau N)), tau = max(0.005, 0.1 * 0.6^(iteration/1000)), where Gaussians
 *        that share a row count each; the choice itself has no gradient. */
/* clang-format on */
#pragma once

#include "base/err.h"
#include "base/rng.h"

enum {
	REFER_D = 128,	  /* width of words and features */
	REFER_H = 64,	  /* last hidden width of MLP_f and MLP_p */
	REFER_MAX_X = 32, /* widest referring feature; 1 at least */
	REFER_XH = 32,	  /* first hidden width of MLP_f */
	REFER_PH = 16,	  /* first hidden width of MLP_p */
	REFER_T1 = 512,	  /* hidden widths of MLP_t */
	REFER_T2 = 256,
};

/* In the order of the choices of --interaction, --similarity, --query and --contrast. */
enum refer_interaction {
	REFER_NONE,
	REFER_ATTENTION,
	REFER_ATTENTION_FP,
	REFER_ADD,
	REFER_PCMI,
	REFER_PCMI_PROJ,
	REFER_INTERACTIONS
};
enum refer_similarity { REFER_DOT, REFER_COSINE };
/* What stands for a sentence: the words of the encoder, as in the paper, or of its parse (field/query.h). */
enum refer_query { REFER_WORDS, REFER_PARSES };
/* What is blended over a pixel. */
enum refer_blend { REFER_LOGITS, REFER_SHARES };
enum refer_contrast {
	REFER_CONTRAST_NONE,
	REFER_CONTRAST_DOT,
	REFER_CONTRAST_COSINE,
	REFER_CONTRAST_PAIRS,
	REFER_CONTRASTS
};

#define REFER_INTERACTION_CHOICES "none|attention|attention+fp|add|pcmi|pcmi-proj"
#define REFER_SIMILARITY_CHOICES "dot|cosine"
#define REFER_QUERY_CHOICES "words|parses"
#define REFER_CONTRAST_CHOICES "none|dot|cosine|pairs"

/* The name of an interaction / similarity / contrast, and back (-1: unknown). */
const char *refer_interaction_name(enum refer_interaction i);
int refer_interaction_parse(const char *name);
const char *refer_similarity_name(enum refer_similarity s);
int refer_similarity_parse(const char *name);
const char *refer_query_name(enum refer_query q);
int refer_query_parse(const char *name);
const char *refer_blend_name(enum refer_blend b);
int refer_blend_parse(const char *name);
const char *refer_contrast_name(enum refer_contrast c);

/* One learned array of the slab. */
enum refer_tensor {
	TEXT_0_WEIGHT,
	TEXT_0_BIAS,
	TEXT_1_WEIGHT,
	TEXT_1_BIAS,
	TEXT_2_WEIGHT,
	TEXT_2_BIAS,
	FEATURE_0_WEIGHT,
	FEATURE_0_BIAS,
	FEATURE_1_WEIGHT,
	FEATURE_1_BIAS,
	FEATURE_2_WEIGHT,
	FEATURE_2_BIAS,
	POSITION_0_WEIGHT,
	POSITION_0_BIAS,
	POSITION_1_WEIGHT,
	POSITION_1_BIAS,
	POSITION_2_WEIGHT,
	POSITION_2_BIAS,
	QUERY_WEIGHT,
	QUERY_BIAS,
	KEY_WEIGHT,
	KEY_BIAS,
	VALUE_WEIGHT,
	VALUE_BIAS,
	QUERY_POSITION_WEIGHT,
	QUERY_POSITION_BIAS,
	KEY_POSITION_WEIGHT,
	KEY_POSITION_BIAS,
	NORM_WEIGHT,
	NORM_BIAS,
	REFER_TENSORS
};

/* Where each array lies in the parameter slab. Arrays that an interaction does not use are absent (rows 0).
 */
struct refer_layout {
	enum refer_interaction interaction;
	int text_width;	   /* D_text */
	int feature_width; /* d_r, 1 to REFER_MAX_X */
	struct {
		const char *name;  /* "text.0.weight" */
		int rows, columns; /* a bias has columns 1 */
		size_t offset;	   /* in floats from the slab's start */
	} tensors[REFER_TENSORS];
	size_t count; /* floats in the slab */
};

void refer_layout_init(
	struct refer_layout *l, enum refer_interaction interaction, int text_width, int feature_width);

/* 1 when the interaction has MLP_p. */
int refer_uses_position(enum refer_interaction i);

/* Weights and biases uniform in +-1/sqrt(fan_in), as PyTorch's nn.Linear; LayerNorm 1 and 0. (count) floats.
 */
void refer_init(const struct refer_layout *l, float *parameters, struct rng *r);
