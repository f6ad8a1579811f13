#include "reference.h"

#include "base/mem.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { D = REFER_D };

/* The gradients of the arrays of refer_result, same shapes; everything below adds to them. */
struct gradients {
	double *w, *f, *p, *place, *c, *query, *key, *value, *sum, *refined;
	double *parameters; /* the caller's */
	double *slab;
};

/* What every stage needs to know: the target's words and their gradient, n of them. */
struct pass {
	const struct refer_problem *problem;
	const struct refer_result *result;
	struct gradients *d;
	const double *w;
	double *dw;
	size_t n;
};

static double dot(const double *a, const double *b)
{
	double sum = 0;

	for (size_t d = 0; d < D; d++)
		sum += a[d] * b[d];
	return sum;
}

/* y += a x, D wide */
static void add(double *y, double a, const double *x)
{
	for (size_t d = 0; d < D; d++)
		y[d] += a * x[d];
}

/* out = W in + b: adds to the gradients of W, b and, unless din is NULL, of in. */
static void linear_back(const struct pass *pass, enum refer_tensor weight, size_t rows, const double *in,
	const double *dout, double *din)
{
	const struct refer_layout *l = pass->problem->layout;
	const size_t width_in = (size_t)l->tensors[weight].columns,
		     width_out = (size_t)l->tensors[weight].rows;
	const double *w = pass->problem->parameters + l->tensors[weight].offset;
	double *dw = pass->d->parameters + l->tensors[weight].offset;
	double *db = pass->d->parameters + l->tensors[weight + 1].offset;

	for (size_t r = 0; r < rows; r++)
		for (size_t o = 0; o < width_out; o++) {
			const double slope = dout[r * width_out + o];
			db[o] += slope;
			for (size_t i = 0; i < width_in; i++)
				dw[o * width_in + i] += slope * in[r * width_in + i];
			for (size_t i = 0; din && i < width_in; i++)
				din[r * width_in + i] += slope * w[o * width_in + i];
		}
}

/* Where a ReLU gave 0, nothing flows back. */
static void relu_back(const double *after, double *gradient, size_t count)
{
	for (size_t i = 0; i < count; i++)
		if (!(after[i] > 0))
			gradient[i] = 0;
}

/* The three layers of mlp() in reference_forward.c. din may be NULL. */
static int mlp_back(const struct pass *pass, enum refer_tensor first, size_t rows, const double *in,
	const double *hidden0, const double *hidden1, const double *dout, double *din, struct err *e)
{
	const struct refer_layout *l = pass->problem->layout;
	const size_t count0 = rows * (size_t)l->tensors[first].rows;
	const size_t count1 = rows * (size_t)l->tensors[first + 2].rows;
	double *dhidden0 = mem_zalloc(count0, sizeof *dhidden0, "reference", e);
	double *dhidden1 = mem_zalloc(count1, sizeof *dhidden1, "reference", e);

	if (dhidden0 && dhidden1) {
		linear_back(pass, first + 4, rows, hidden1, dout, dhidden1);
		relu_back(hidden1, dhidden1, count1);
		linear_back(pass, first + 2, rows, hidden0, dhidden1, dhidden0);
		relu_back(hidden0, dhidden0, count0);
		linear_back(pass, first, rows, in, dhidden0, din);
	}
	const int failed = !dhidden0 || !dhidden1;
	free(dhidden0);
	free(dhidden1);
	return failed ? -1 : 0;
}

/* unit = v / |v|: adds to dv. A vector shorter than the floor is divided by a constant. */
static void normalize_back(const double *v, const double *dunit, double *dv)
{
	double unit[D];
	const double norm = reference_normalize(v, unit);

	add(dv, 1 / norm, dunit);
	if (norm > 1e-12)
		add(dv, -dot(unit, dunit) / norm, unit);
}

/* gradient of a softmax's input, in place of the gradient of its output */
static void softmax_back(const double *softmax, double *gradient, size_t count)
{
	double mean = 0;

	for (size_t i = 0; i < count; i++)
		mean += softmax[i] * gradient[i];
	for (size_t i = 0; i < count; i++)
		gradient[i] = softmax[i] * (gradient[i] - mean);
}

/* Slopes of the contrast by the scores, which they replace. Softmaxed: softmax - (1/|E+| in E+). */
static void score_slopes(const struct refer_problem *problem, double *slope)
{
	const int object = problem->objects[problem->target];
	double positives = 0;

	for (size_t r = 0; r < problem->sentences; r++) {
		slope[r] += log(reference_times(problem, r));
		positives += problem->objects[r] == object && reference_times(problem, r) > 0;
	}
	reference_softmax(slope, problem->sentences);
	for (size_t r = 0; r < problem->sentences; r++)
		if (problem->objects[r] == object && reference_times(problem, r) > 0)
			slope[r] -= 1 / positives;
}

/* The same of pairs: each pair's share of 1 + their sum, up for the negative and down for the positive. */
static int pair_slopes(const struct refer_problem *problem, double *slope, struct err *e)
{
	const size_t R = problem->sentences;
	const int object = problem->objects[problem->target];
	double *found = mem_zalloc(R, sizeof *found, "reference", e), sum = 1;

	for (size_t a = 0; found && a < R; a++)
		for (size_t b = 0; b < R; b++)
			if (problem->objects[a] != object && problem->objects[b] == object) {
				const double pair = reference_times(problem, a) *
						    reference_times(problem, b) * exp(slope[a] - slope[b]);
				sum += pair;
				found[a] += pair;
				found[b] -= pair;
			}
	for (size_t r = 0; found && r < R; r++)
		slope[r] = found[r] / sum;
	free(found);
	return found ? 0 : -1;
}

/* L_con: to the words of all sentences, and to f' of the top Gaussians. */
static int contrast_back(const struct pass *pass, struct err *e)
{
	const struct refer_problem *problem = pass->problem;
	const struct refer_result *result = pass->result;
	double df_g[D] = {0};

	if (problem->contrast == REFER_CONTRAST_NONE)
		return 0;
	double *slope = mem_alloc(problem->sentences, sizeof *slope, "reference", e);
	if (!slope)
		return -1;
	reference_sentence_scores(problem, result, slope);
	if (problem->contrast != REFER_CONTRAST_PAIRS) {
		score_slopes(problem, slope);
	} else if (pair_slopes(problem, slope, e)) {
		free(slope);
		return -1;
	}
	for (size_t r = 0; r < problem->sentences; r++) {
		const double *embedding = result->e + r * D;
		double de[D] = {0};
		const double ds = problem->lambda * slope[r] / problem->temperature;
		if (problem->contrast != REFER_CONTRAST_DOT) {
			double object[D], sentence[D], dobject[D] = {0}, dsentence[D] = {0};
			reference_normalize(result->f_g, object);
			reference_normalize(embedding, sentence);
			add(dobject, ds, sentence);
			add(dsentence, ds, object);
			normalize_back(result->f_g, dobject, df_g);
			normalize_back(embedding, dsentence, de);
		} else {
			add(df_g, ds, embedding);
			add(de, ds, result->f_g);
		}
		const size_t begin = problem->offsets[r], end = problem->offsets[r + 1];
		for (size_t j = begin; j < end; j++)
			add(pass->d->w + j * D, 1 / (double)(end - begin), de);
	}
	for (size_t t = 0; t < result->top_count; t++)
		add(pass->d->refined + result->top[t] * D, result->top_share[t], df_g);
	free(slope);
	return 0;
}

/* L_bce, through the image and the responses, to f' and the target's words. */
static int respond_back(const struct pass *pass, struct err *e)
{
	const struct refer_problem *problem = pass->problem;
	const double *refined = pass->result->refined;
	double *dm = mem_zalloc(problem->n, sizeof *dm, "reference", e);

	if (!dm)
		return -1;
	for (size_t v = 0; v < problem->pixels; v++) {
		const double slope = reference_bce_slope(pass->result->image[v], problem->mask[v]);
		for (int64_t k = problem->indptr[v]; k < problem->indptr[v + 1]; k++)
			dm[problem->index[k]] += problem->weight[k] * slope / (double)problem->pixels;
	}
	for (size_t i = 0; i < problem->n; i++)
		for (size_t j = 0; j < pass->n; j++) {
			const double *fi = refined + i * D, *wj = pass->w + j * D;
			double *dfi = pass->d->refined + i * D, *dwj = pass->dw + j * D;
			if (problem->similarity == REFER_COSINE) {
				double feature[D], word[D], dfeature[D] = {0}, dword[D] = {0};
				reference_normalize(fi, feature);
				reference_normalize(wj, word);
				add(dfeature, dm[i], word);
				add(dword, dm[i], feature);
				normalize_back(fi, dfeature, dfi);
				normalize_back(wj, dword, dwj);
			} else {
				add(dfi, dm[i], wj);
				add(dwj, dm[i], fi);
			}
		}
	free(dm);
	return 0;
}

static void layer_norm_back(const struct pass *pass)
{
	const struct refer_layout *l = pass->problem->layout;
	const double *scale = pass->problem->parameters + l->tensors[NORM_WEIGHT].offset;
	double *dscale = pass->d->parameters + l->tensors[NORM_WEIGHT].offset;
	double *dshift = pass->d->parameters + l->tensors[NORM_BIAS].offset;

	for (size_t i = 0; i < pass->problem->n; i++) {
		const double *in = pass->result->sum + i * D, *dout = pass->d->refined + i * D;
		const double rstd = pass->result->rstd[i];
		double mean = 0, normed[D], dnormed[D], dmean = 0;
		for (size_t d = 0; d < D; d++)
			mean += in[d] / D;
		for (size_t d = 0; d < D; d++) {
			normed[d] = (in[d] - mean) * rstd;
			dnormed[d] = dout[d] * scale[d];
			dmean += dnormed[d] / D;
			dscale[d] += dout[d] * normed[d];
			dshift[d] += dout[d];
		}
		const double along = dot(dnormed, normed) / D;
		for (size_t d = 0; d < D; d++)
			pass->d->sum[i * D + d] += rstd * (dnormed[d] - dmean - normed[d] * along);
	}
}

/* From sum to query, key and value. */
static int attend_back(const struct pass *pass, struct err *e)
{
	const struct refer_result *result = pass->result;
	double *slope = mem_alloc(pass->n, sizeof *slope, "reference", e);

	if (!slope)
		return -1;
	for (size_t i = 0; i < pass->problem->n; i++) {
		const double *alpha = result->alpha + i * pass->n, *dsum = pass->d->sum + i * D;
		for (size_t j = 0; j < pass->n; j++) {
			slope[j] = dot(dsum, result->value + j * D);
			add(pass->d->value + j * D, alpha[j], dsum);
		}
		softmax_back(alpha, slope, pass->n);
		for (size_t j = 0; j < pass->n; j++) {
			add(pass->d->query + i * D, slope[j] / sqrt(D), result->key + j * D);
			add(pass->d->key + j * D, slope[j] / sqrt(D), result->query + i * D);
		}
	}
	free(slope);
	return 0;
}

/* From c to place, f and the words; `scale` as in the forward pass. */
static int word_positions_back(const struct pass *pass, double scale, struct err *e)
{
	const struct refer_result *result = pass->result;
	const size_t N = pass->problem->n;
	double *slope = mem_alloc(N, sizeof *slope, "reference", e);

	if (!slope)
		return -1;
	for (size_t j = 0; j < pass->n; j++) {
		const double *beta = result->beta + j * N, *dc = pass->d->c + j * D;
		for (size_t i = 0; i < N; i++) {
			slope[i] = dot(dc, result->place + i * D);
			add(pass->d->place + i * D, beta[i], dc);
		}
		softmax_back(beta, slope, N);
		for (size_t i = 0; i < N; i++) {
			add(pass->dw + j * D, slope[i] * scale, result->f + i * D);
			add(pass->d->f + i * D, slope[i] * scale, pass->w + j * D);
		}
	}
	free(slope);
	return 0;
}

static int plain_attention_back(const struct pass *pass, struct err *e)
{
	const enum refer_interaction kind = pass->problem->layout->interaction;

	for (size_t i = 0; i < pass->problem->n; i++) {
		add(pass->d->f + i * D, 1, pass->d->query + i * D);
		if (kind != REFER_ATTENTION)
			add(pass->d->p + i * D, 1, pass->d->query + i * D);
	}
	for (size_t j = 0; j < pass->n; j++) {
		add(pass->dw + j * D, 1, pass->d->key + j * D);
		add(pass->dw + j * D, 1, pass->d->value + j * D);
	}
	if (kind != REFER_PCMI)
		return 0;
	for (size_t j = 0; j < pass->n; j++)
		add(pass->d->c + j * D, 1, pass->d->key + j * D);
	if (word_positions_back(pass, 1 / sqrt(D), e))
		return -1;
	for (size_t i = 0; i < pass->problem->n; i++)
		add(pass->d->p + i * D, 1, pass->d->place + i * D);
	return 0;
}

static int projected_attention_back(const struct pass *pass, struct err *e)
{
	const struct refer_result *result = pass->result;
	const struct gradients *d = pass->d;
	const size_t N = pass->problem->n;

	linear_back(pass, QUERY_WEIGHT, N, result->f, d->query, d->f);
	linear_back(pass, QUERY_POSITION_WEIGHT, N, result->place, d->query, d->place);
	linear_back(pass, KEY_WEIGHT, pass->n, pass->w, d->key, pass->dw);
	linear_back(pass, KEY_POSITION_WEIGHT, pass->n, result->c, d->key, d->c);
	linear_back(pass, VALUE_WEIGHT, pass->n, pass->w, d->value, pass->dw);
	if (word_positions_back(pass, 1, e))
		return -1;
	for (size_t i = 0; i < N; i++)
		normalize_back(result->p + i * D, d->place + i * D, d->p + i * D);
	return 0;
}

/* From f' to f, p and the target's words. */
static int interact_back(const struct pass *pass, struct err *e)
{
	const enum refer_interaction kind = pass->problem->layout->interaction;

	if (kind == REFER_PCMI_PROJ)
		layer_norm_back(pass);
	else
		memcpy(pass->d->sum, pass->d->refined, pass->problem->n * D * sizeof(double));
	for (size_t i = 0; i < pass->problem->n; i++) {
		add(pass->d->f + i * D, 1, pass->d->sum + i * D);
		if (kind == REFER_ADD)
			add(pass->d->p + i * D, 1, pass->d->sum + i * D);
	}
	if (kind == REFER_NONE || kind == REFER_ADD)
		return 0;
	if (attend_back(pass, e))
		return -1;
	return kind == REFER_PCMI_PROJ ? projected_attention_back(pass, e) : plain_attention_back(pass, e);
}

static int allocate(struct gradients *d, size_t N, size_t W, size_t n, struct err *e)
{
	/* The forward pass has allocated arrays of these shapes and more, so the sizes fit. */
	double **const over_gaussians[] = {&d->f, &d->p, &d->place, &d->query, &d->sum, &d->refined};
	double **const over_words[] = {&d->c, &d->key, &d->value};

	d->slab = mem_zalloc((6 * N + 3 * n + W) * D, sizeof *d->slab, "reference", e);
	if (!d->slab)
		return -1;
	double *at = d->slab;
	for (size_t i = 0; i < 6; i++, at += N * D)
		*over_gaussians[i] = at;
	for (size_t i = 0; i < 3; i++, at += n * D)
		*over_words[i] = at;
	d->w = at;
	return 0;
}

int reference_backward(const struct refer_problem *problem, const struct refer_result *result, double *dx,
	double *dparameters, struct err *e)
{
	const size_t begin = problem->offsets[problem->target], W = problem->offsets[problem->sentences];
	struct gradients d = {.parameters = dparameters};
	struct pass pass = {.problem = problem, .result = result, .d = &d};
	int status = -1;

	pass.n = problem->offsets[problem->target + 1] - begin;
	if (allocate(&d, problem->n, W, pass.n, e))
		return -1;
	pass.w = result->w + begin * D;
	pass.dw = d.w + begin * D;
	memset(dx, 0, problem->n * (size_t)problem->layout->feature_width * sizeof *dx);
	memset(dparameters, 0, problem->layout->count * sizeof *dparameters);

	if (contrast_back(&pass, e) || respond_back(&pass, e) || interact_back(&pass, e))
		goto done;
	if (mlp_back(&pass, TEXT_0_WEIGHT, W, problem->words, result->text_hidden0, result->text_hidden1, d.w,
		    NULL, e))
		goto done;
	if (mlp_back(&pass, FEATURE_0_WEIGHT, problem->n, problem->x, result->feature_hidden0,
		    result->feature_hidden1, d.f, dx, e))
		goto done;
	if (refer_uses_position(problem->layout->interaction) &&
		mlp_back(&pass, POSITION_0_WEIGHT, problem->n, problem->position, result->position_hidden0,
			result->position_hidden1, d.p, NULL, e))
		goto done;
	status = 0;
done:
	free(d.slab);
	return status;
}
