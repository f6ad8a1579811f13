#include "reference.h"

#include "base/mem.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { D = REFER_D };

static double dot(const double *a, const double *b, size_t count)
{
	double sum = 0;

#pragma omp simd reduction(+ : sum)
	for (size_t i = 0; i < count; i++)
		sum += a[i] * b[i];
	return sum;
}

double reference_normalize(const double *v, double *unit)
{
	const double norm = fmax(sqrt(dot(v, v, D)), 1e-12);

	for (size_t d = 0; d < D; d++)
		unit[d] = v[d] / norm;
	return norm;
}

double reference_softmax(double *values, size_t count)
{
	double largest = values[0], sum = 0;

	for (size_t i = 1; i < count; i++)
		largest = fmax(largest, values[i]);
	for (size_t i = 0; i < count; i++)
		sum += exp(values[i] - largest);
	for (size_t i = 0; i < count; i++)
		values[i] = exp(values[i] - largest) / sum;
	return largest + log(sum);
}

double reference_bce(double logit, int is_set)
{
	return fmax(logit, 0) - (is_set ? logit : 0) + log1p(exp(-fabs(logit)));
}

double reference_bce_slope(double logit, int is_set)
{
	return is_set ? -1 / (1 + exp(logit)) : 1 / (1 + exp(-logit));
}

/* out += W in + b for each row; `weight` names W, and its bias is the next tensor. */
static void linear_add(const struct refer_problem *problem, enum refer_tensor weight, size_t rows,
	const double *in, double *out)
{
	const size_t width_in = (size_t)problem->layout->tensors[weight].columns;
	const size_t width_out = (size_t)problem->layout->tensors[weight].rows;
	const double *w = problem->parameters + problem->layout->tensors[weight].offset;
	const double *b = problem->parameters + problem->layout->tensors[weight + 1].offset;

	for (size_t o = 0; o < width_out; o++)
		for (size_t r = 0; r < rows; r++)
			out[r * width_out + o] += dot(w + o * width_in, in + r * width_in, width_in) + b[o];
}

static void relu(double *values, size_t count)
{
	for (size_t i = 0; i < count; i++)
		values[i] = values[i] > 0 ? values[i] : 0;
}

/* Three layers from tensor `first` on, ReLU between them. hidden0, hidden1 and out are zero at first. */
static void mlp(const struct refer_problem *problem, enum refer_tensor first, size_t rows, const double *in,
	double *hidden0, double *hidden1, double *out)
{
	linear_add(problem, first, rows, in, hidden0);
	relu(hidden0, rows * (size_t)problem->layout->tensors[first].rows);
	linear_add(problem, first + 2, rows, hidden0, hidden1);
	relu(hidden1, rows * (size_t)problem->layout->tensors[first + 2].rows);
	linear_add(problem, first + 4, rows, hidden1, out);
}

static int check(const struct refer_problem *problem, struct err *e)
{
	const struct refer_layout *l = problem->layout;

	if (problem->n < 1 || problem->n > INT32_MAX || problem->sentences < 1 || problem->pixels < 1)
		return err_set(e, ERR_FORMAT,
			"reference: %zu Gaussians, %zu sentences, %zu pixels: at least one of each",
			problem->n, problem->sentences, problem->pixels);
	if (problem->target >= problem->sentences)
		return err_set(e, ERR_FORMAT, "reference: target %zu of %zu sentences", problem->target,
			problem->sentences);
	if (l->interaction == REFER_PCMI_PROJ && problem->similarity == REFER_COSINE)
		return err_set(e, ERR_FORMAT, "reference: pcmi-proj has no cosine similarity");
	if (!(problem->temperature > 0) || !(problem->tau >= 0 && problem->tau <= 1))
		return err_set(e, ERR_FORMAT, "reference: temperature %g, tau %g", problem->temperature,
			problem->tau);
	for (size_t r = 0; r < problem->sentences; r++)
		if (problem->offsets[r + 1] <= problem->offsets[r])
			return err_set(e, ERR_FORMAT, "reference: sentence %zu has no words", r);
	if (problem->offsets[0] != 0 || problem->indptr[0] != 0)
		return err_set(e, ERR_FORMAT, "reference: offsets and indptr start at 0");
	for (size_t v = 0; v < problem->pixels; v++) {
		if (problem->indptr[v + 1] < problem->indptr[v])
			return err_set(e, ERR_FORMAT, "reference: indptr falls at pixel %zu", v);
		for (int64_t k = problem->indptr[v]; k < problem->indptr[v + 1]; k++)
			if (problem->index[k] < 0 || (size_t)problem->index[k] >= problem->n)
				return err_set(e, ERR_FORMAT,
					"reference: entry %lld is of Gaussian %d of %zu", (long long)k,
					problem->index[k], problem->n);
	}
	return 0;
}

static int allocate(const struct refer_problem *problem, struct refer_result *out, struct err *e)
{
	const size_t N = problem->n, R = problem->sentences, W = problem->offsets[R];
	const size_t n = problem->offsets[problem->target + 1] - problem->offsets[problem->target];
	const struct {
		double **array;
		size_t rows, columns;
	} arrays[] = {
		{&out->text_hidden0, W, REFER_T1},
		{&out->text_hidden1, W, REFER_T2},
		{&out->w, W, D},
		{&out->e, R, D},
		{&out->feature_hidden0, N, REFER_XH},
		{&out->feature_hidden1, N, REFER_H},
		{&out->f, N, D},
		{&out->position_hidden0, N, REFER_PH},
		{&out->position_hidden1, N, REFER_H},
		{&out->p, N, D},
		{&out->place, N, D},
		{&out->beta, n, N},
		{&out->c, n, D},
		{&out->query, N, D},
		{&out->key, n, D},
		{&out->value, n, D},
		{&out->alpha, N, n},
		{&out->sum, N, D},
		{&out->rstd, N, 1},
		{&out->refined, N, D},
		{&out->m, N, 1},
		{&out->image, problem->pixels, 1},
		{&out->f_g, D, 1},
		{&out->top_share, N, 1},
	};
	enum { ARRAYS = sizeof arrays / sizeof *arrays };
	size_t total = 0;

	*out = (struct refer_result){0};
	for (size_t i = 0; i < ARRAYS; i++) {
		size_t count;
		if (mem_size(arrays[i].rows, arrays[i].columns, &count) || total + count < total)
			return err_set(e, ERR_SYSTEM, "reference: the problem does not fit in memory");
		total += count;
	}
	out->slab = mem_zalloc(total, sizeof *out->slab, "reference", e);
	out->top = mem_alloc(N, sizeof *out->top, "reference", e);
	if (!out->slab || !out->top) {
		reference_free(out);
		return -1;
	}
	double *at = out->slab;
	for (size_t i = 0; i < ARRAYS; i++) {
		*arrays[i].array = at;
		at += arrays[i].rows * arrays[i].columns;
	}
	return 0;
}

/* e_r = the mean of the sentence's words. */
static void embed(const struct refer_problem *problem, struct refer_result *out)
{
	for (size_t r = 0; r < problem->sentences; r++) {
		const size_t begin = problem->offsets[r], end = problem->offsets[r + 1];
		for (size_t j = begin; j < end; j++)
			for (size_t d = 0; d < D; d++)
				out->e[r * D + d] += out->w[j * D + d] / (double)(end - begin);
	}
}

/* c_j = sum_i softmax_i(scale w_j.f_i) place_i */
static void word_positions(const struct refer_problem *problem, struct refer_result *out, const double *w,
	size_t n, double scale)
{
	const size_t N = problem->n;

	for (size_t j = 0; j < n; j++) {
		double *beta = out->beta + j * N;
		for (size_t i = 0; i < N; i++)
			beta[i] = scale * dot(w + j * D, out->f + i * D, D);
		reference_softmax(beta, N);
		for (size_t i = 0; i < N; i++)
			for (size_t d = 0; d < D; d++)
				out->c[j * D + d] += beta[i] * out->place[i * D + d];
	}
}

/* query, key and value of the interactions that have no learned maps. */
static void plain_attention(
	const struct refer_problem *problem, struct refer_result *out, const double *w, size_t n)
{
	const enum refer_interaction kind = problem->layout->interaction;

	memcpy(out->place, out->p, problem->n * D * sizeof *out->p);
	if (kind == REFER_PCMI)
		word_positions(problem, out, w, n, 1 / sqrt(D));
	for (size_t i = 0; i < problem->n * D; i++)
		out->query[i] = out->f[i] + (kind == REFER_ATTENTION ? 0 : out->p[i]);
	for (size_t i = 0; i < n * D; i++) {
		out->key[i] = w[i] + out->c[i]; /* c is zero but for pcmi */
		out->value[i] = w[i];
	}
}

static void projected_attention(
	const struct refer_problem *problem, struct refer_result *out, const double *w, size_t n)
{
	for (size_t i = 0; i < problem->n; i++)
		reference_normalize(out->p + i * D, out->place + i * D);
	word_positions(problem, out, w, n, 1);
	linear_add(problem, QUERY_WEIGHT, problem->n, out->f, out->query);
	linear_add(problem, QUERY_POSITION_WEIGHT, problem->n, out->place, out->query);
	linear_add(problem, KEY_WEIGHT, n, w, out->key);
	linear_add(problem, KEY_POSITION_WEIGHT, n, out->c, out->key);
	linear_add(problem, VALUE_WEIGHT, n, w, out->value);
}

/* sum_i += sum_j softmax_j(query_i.key_j / sqrt D) value_j */
static void attend(const struct refer_problem *problem, struct refer_result *out, size_t n)
{
	for (size_t i = 0; i < problem->n; i++) {
		double *alpha = out->alpha + i * n;
		for (size_t j = 0; j < n; j++)
			alpha[j] = dot(out->query + i * D, out->key + j * D, D) / sqrt(D);
		reference_softmax(alpha, n);
		for (size_t j = 0; j < n; j++)
			for (size_t d = 0; d < D; d++)
				out->sum[i * D + d] += alpha[j] * out->value[j * D + d];
	}
}

static void layer_norm(const struct refer_problem *problem, struct refer_result *out)
{
	const double *scale = problem->parameters + problem->layout->tensors[NORM_WEIGHT].offset;
	const double *shift = problem->parameters + problem->layout->tensors[NORM_BIAS].offset;

	for (size_t i = 0; i < problem->n; i++) {
		const double *in = out->sum + i * D;
		double mean = 0, variance = 0;
		for (size_t d = 0; d < D; d++)
			mean += in[d] / D;
		for (size_t d = 0; d < D; d++)
			variance += (in[d] - mean) * (in[d] - mean) / D;
		out->rstd[i] = 1 / sqrt(variance + 1e-5);
		for (size_t d = 0; d < D; d++)
			out->refined[i * D + d] = (in[d] - mean) * out->rstd[i] * scale[d] + shift[d];
	}
}

/* f'_i */
static void interact(const struct refer_problem *problem, struct refer_result *out, const double *w, size_t n)
{
	const enum refer_interaction kind = problem->layout->interaction;

	for (size_t i = 0; i < problem->n * D; i++)
		out->sum[i] = out->f[i] + (kind == REFER_ADD ? out->p[i] : 0);
	if (kind == REFER_PCMI_PROJ)
		projected_attention(problem, out, w, n);
	else if (kind != REFER_NONE && kind != REFER_ADD)
		plain_attention(problem, out, w, n);
	if (kind != REFER_NONE && kind != REFER_ADD)
		attend(problem, out, n);
	if (kind == REFER_PCMI_PROJ)
		layer_norm(problem, out);
	else
		memcpy(out->refined, out->sum, problem->n * D * sizeof *out->sum);
}

/* m_i, and M(v) = sum_i w_vi m_i */
static void respond(const struct refer_problem *problem, struct refer_result *out, const double *w, size_t n)
{
	for (size_t i = 0; i < problem->n; i++)
		for (size_t j = 0; j < n; j++) {
			double feature[D], word[D];
			if (problem->similarity == REFER_COSINE) {
				reference_normalize(out->refined + i * D, feature);
				reference_normalize(w + j * D, word);
				out->m[i] += dot(feature, word, D);
			} else {
				out->m[i] += dot(out->refined + i * D, w + j * D, D);
			}
		}
	for (size_t v = 0; v < problem->pixels; v++)
		for (int64_t k = problem->indptr[v]; k < problem->indptr[v + 1]; k++)
			out->image[v] += problem->weight[k] * out->m[problem->index[k]];
}

/* The k Gaussians of largest m, of equal ones the lower index first, by plain selection. */
static void choose_top(const struct refer_problem *problem, struct refer_result *out)
{
	const size_t N = problem->n;
	double all = 0, left, k;

	for (size_t i = 0; i < N; i++) {
		out->top[i] = i;
		all += problem->counts ? problem->counts[i] : 1;
	}
	left = k = fmax(1, floor(problem->tau * all));
	for (; left > 0; out->top_count++) {
		const size_t place = out->top_count;
		size_t best = place;
		for (size_t i = place + 1; i < N; i++) {
			const double mi = out->m[out->top[i]], mb = out->m[out->top[best]];
			if (mi > mb || (mi == mb && out->top[i] < out->top[best]))
				best = i;
		}
		const size_t chosen = out->top[best];
		out->top[best] = out->top[place];
		out->top[place] = chosen;
		const double taken = fmin(left, problem->counts ? problem->counts[chosen] : 1);
		out->top_share[place] = taken / k;
		left -= taken;
		for (size_t d = 0; d < D; d++)
			out->f_g[d] += out->refined[chosen * D + d] * out->top_share[place];
	}
}

double reference_times(const struct refer_problem *problem, size_t sentence)
{
	return problem->times ? problem->times[sentence] : 1;
}

void reference_sentence_scores(
	const struct refer_problem *problem, const struct refer_result *result, double *scores)
{
	for (size_t r = 0; r < problem->sentences; r++) {
		const double *e = result->e + r * D;
		double object[D], sentence[D];
		if (problem->contrast != REFER_CONTRAST_DOT) {
			reference_normalize(result->f_g, object);
			reference_normalize(e, sentence);
			scores[r] = dot(object, sentence, D) / problem->temperature;
		} else {
			scores[r] = dot(result->f_g, e, D) / problem->temperature;
		}
	}
}

/* log(1 + sum of t- t+ exp(s- - s+) over pairs of a negative and a positive) */
static double pairs_contrast(const struct refer_problem *problem, const double *scores)
{
	double sum = 1;

	for (size_t a = 0; a < problem->sentences; a++)
		for (size_t b = 0; b < problem->sentences; b++)
			if (problem->objects[a] != problem->objects[problem->target] &&
				problem->objects[b] == problem->objects[problem->target])
				sum += reference_times(problem, a) * reference_times(problem, b) *
				       exp(scores[a] - scores[b]);
	return log(sum);
}

int reference_contrast(const struct refer_problem *problem, const struct refer_result *result,
	double *contrast, struct err *e)
{
	double positive = 0, count = 0;

	*contrast = 0;
	if (problem->contrast == REFER_CONTRAST_NONE)
		return 0;
	double *scores = mem_alloc(problem->sentences, sizeof *scores, "reference", e);
	if (!scores)
		return -1;
	reference_sentence_scores(problem, result, scores);
	for (size_t r = 0; r < problem->sentences; r++) {
		const double times = reference_times(problem, r);
		if (problem->objects[r] == problem->objects[problem->target] && times > 0) {
			positive += scores[r];
			count++;
		}
	}
	if (problem->contrast == REFER_CONTRAST_PAIRS) {
		*contrast = pairs_contrast(problem, scores);
	} else {
		for (size_t r = 0; r < problem->sentences; r++)
			scores[r] += log(reference_times(problem, r));
		*contrast = reference_softmax(scores, problem->sentences) - positive / count;
	}
	free(scores);
	return 0;
}

int reference_forward(const struct refer_problem *problem, struct refer_result *out, struct err *e)
{
	*out = (struct refer_result){0};
	if (check(problem, e) || allocate(problem, out, e))
		return -1;
	const size_t n = problem->offsets[problem->target + 1] - problem->offsets[problem->target];
	const double *w = out->w + problem->offsets[problem->target] * D;

	mlp(problem, TEXT_0_WEIGHT, problem->offsets[problem->sentences], problem->words, out->text_hidden0,
		out->text_hidden1, out->w);
	embed(problem, out);
	mlp(problem, FEATURE_0_WEIGHT, problem->n, problem->x, out->feature_hidden0, out->feature_hidden1,
		out->f);
	if (refer_uses_position(problem->layout->interaction))
		mlp(problem, POSITION_0_WEIGHT, problem->n, problem->position, out->position_hidden0,
			out->position_hidden1, out->p);
	interact(problem, out, w, n);
	respond(problem, out, w, n);
	choose_top(problem, out);
	for (size_t v = 0; v < problem->pixels; v++)
		out->bce += reference_bce(out->image[v], problem->mask[v]) / (double)problem->pixels;
	if (reference_contrast(problem, out, &out->contrast, e)) {
		reference_free(out);
		return -1;
	}
	out->loss = out->bce + problem->lambda * out->contrast;
	return 0;
}

void reference_free(struct refer_result *result)
{
	free(result->slab);
	free(result->top);
	*result = (struct refer_result){0};
}
