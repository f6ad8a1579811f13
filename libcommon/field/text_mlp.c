#include "field/text_mlp.h"

#include "base/mem.h"
#include "nn/linear.h"

/* Words of the longest sentence. */
static size_t find_longest(size_t sentences, const int64_t *offsets)
{
	int64_t longest = 0;

	for (size_t r = 0; r < sentences; r++)
		if (offsets[r + 1] - offsets[r] > longest)
			longest = offsets[r + 1] - offsets[r];
	return (size_t)longest;
}

int text_mlp_init(struct text_mlp *w, const struct refer_layout *l, size_t sentences, const int64_t *offsets,
	const float *input, enum text_mlp_purpose purpose, struct err *e)
{
	const int learns = purpose == TEXT_MLP_LEARNING;
	const size_t rows = learns ? (size_t)offsets[sentences] : find_longest(sentences, offsets);
	const size_t most = learns ? sentences : 1, sides = learns ? 2 : 1; /* values, and their gradients */

	*w = (struct text_mlp){.layout = l, .sentences = sentences, .offsets = offsets, .input = input};
	w->h1 = mem_alloc(rows, sides * sizeof(float) * (REFER_T1 + REFER_T2), "words", e);
	w->mean = mem_zalloc(most, sides * sizeof(float) * (REFER_T2 + REFER_D), "words", e);
	w->copied = mem_alloc(learns ? rows : 0, (size_t)l->text_width * sizeof *w->copied, "words", e);
	w->at = mem_zalloc(most + 1, sizeof *w->at, "words", e);
	if (!w->h1 || !w->mean || !w->copied || !w->at)
		return -1;
	w->h2 = w->h1 + rows * REFER_T1;
	w->e = w->mean + most * REFER_T2;
	if (!learns)
		return 0;
	w->dh1 = w->h2 + rows * REFER_T2;
	w->dh2 = w->dh1 + rows * REFER_T1;
	w->dmean = w->e + most * REFER_D;
	w->de = w->dmean + most * REFER_T2;
	return 0;
}

void text_mlp_free(struct text_mlp *w)
{
	mem_free_all(w->h1, w->mean, w->copied, w->at);
	*w = (struct text_mlp){0};
}

static const float *tensor_of(const struct text_mlp *w, const float *parameters, enum refer_tensor t)
{
	return parameters + w->layout->tensors[t].offset;
}

static float *gradient_of(const struct text_mlp *w, float *gradient, enum refer_tensor t)
{
	return gradient + w->layout->tensors[t].offset;
}

static void relu(float *x, size_t count)
{
#pragma omp parallel for schedule(static)
	for (size_t i = 0; i < count; i++)
		x[i] = x[i] > 0 ? x[i] : 0;
}

static void relu_back(float *d, const float *value, size_t count)
{
#pragma omp parallel for schedule(static)
	for (size_t i = 0; i < count; i++)
		d[i] = value[i] > 0 ? d[i] : 0;
}

void text_mlp_choose(struct text_mlp *w, const size_t *list, size_t count)
{
	const size_t width = (size_t)w->layout->text_width;
	int is_input = count == w->sentences || count == 1;

	w->count = count;
	for (size_t k = 0; k < count; k++) {
		w->at[k + 1] = w->at[k] + w->offsets[list[k] + 1] - w->offsets[list[k]];
		is_input = is_input && (count == 1 || list[k] == k);
	}
	if (is_input) {
		w->chosen = w->input + (count ? (size_t)w->offsets[list[0]] * width : 0);
		return;
	}
	w->chosen = w->copied;
	for (size_t k = 0; k < count; k++)
		memcpy(w->copied + (size_t)w->at[k] * width, w->input + (size_t)w->offsets[list[k]] * width,
			(size_t)(w->at[k + 1] - w->at[k]) * width * sizeof *w->copied);
}

void text_mlp_hidden(struct text_mlp *w, const float *p)
{
	const size_t rows = (size_t)w->at[w->count], width = (size_t)w->layout->text_width;

	linear_forward(w->h1, w->chosen, tensor_of(w, p, TEXT_0_WEIGHT), tensor_of(w, p, TEXT_0_BIAS), rows,
		width, REFER_T1);
	relu(w->h1, rows * REFER_T1);
	linear_forward(w->h2, w->h1, tensor_of(w, p, TEXT_1_WEIGHT), tensor_of(w, p, TEXT_1_BIAS), rows,
		REFER_T1, REFER_T2);
	relu(w->h2, rows * REFER_T2);
}

void text_mlp_vectors(const struct text_mlp *w, const float *p, size_t place, float *out)
{
	const size_t first = (size_t)w->at[place], rows = (size_t)w->at[place + 1] - first;

	linear_forward(out, w->h2 + first * REFER_T2, tensor_of(w, p, TEXT_2_WEIGHT),
		tensor_of(w, p, TEXT_2_BIAS), rows, REFER_T2, REFER_D);
}

void text_mlp_embed(struct text_mlp *w, const float *p)
{
	for (size_t s = 0; s < w->count; s++) {
		const int64_t from = w->at[s], to = w->at[s + 1];
		float *mean = w->mean + s * REFER_T2;
		memset(mean, 0, sizeof *mean * REFER_T2);
		for (int64_t j = from; j < to; j++)
			for (int c = 0; c < REFER_T2; c++)
				mean[c] += w->h2[j * REFER_T2 + c];
		for (int c = 0; c < REFER_T2 && to > from; c++)
			mean[c] /= (float)(to - from);
	}
	linear_forward(w->e, w->mean, tensor_of(w, p, TEXT_2_WEIGHT), tensor_of(w, p, TEXT_2_BIAS), w->count,
		REFER_T2, REFER_D);
}

void text_mlp_back_begin(struct text_mlp *w, const float *p, float *gradient, int has_embeddings)
{
	if (!has_embeddings) {
		memset(w->dh2, 0, sizeof(float) * (size_t)w->at[w->count] * REFER_T2);
		return;
	}
	linear_backward(w->dmean, gradient_of(w, gradient, TEXT_2_WEIGHT),
		gradient_of(w, gradient, TEXT_2_BIAS), w->de, w->mean, tensor_of(w, p, TEXT_2_WEIGHT),
		w->count, REFER_T2, REFER_D);
	for (size_t s = 0; s < w->count; s++)
		for (int64_t j = w->at[s]; j < w->at[s + 1]; j++)
			for (int c = 0; c < REFER_T2; c++)
				w->dh2[j * REFER_T2 + c] =
					w->dmean[s * REFER_T2 + (size_t)c] / (float)(w->at[s + 1] - w->at[s]);
}

void text_mlp_back_vectors(struct text_mlp *w, const float *p, float *gradient, size_t place, const float *dw)
{
	const size_t first = (size_t)w->at[place], rows = (size_t)w->at[place + 1] - first;
	float *dh2 = w->dh2 + first * REFER_T2;
	float *din = w->dh1 + first * REFER_T1; /* free until text_mlp_back_end; wide enough */

	linear_backward(din, gradient_of(w, gradient, TEXT_2_WEIGHT), gradient_of(w, gradient, TEXT_2_BIAS),
		dw, w->h2 + first * REFER_T2, tensor_of(w, p, TEXT_2_WEIGHT), rows, REFER_T2, REFER_D);
	for (size_t i = 0; i < rows * REFER_T2; i++)
		dh2[i] += din[i];
}

void text_mlp_back_end(struct text_mlp *w, const float *p, float *gradient)
{
	const size_t rows = (size_t)w->at[w->count], width = (size_t)w->layout->text_width;

	relu_back(w->dh2, w->h2, rows * REFER_T2);
	linear_backward(w->dh1, gradient_of(w, gradient, TEXT_1_WEIGHT),
		gradient_of(w, gradient, TEXT_1_BIAS), w->dh2, w->h1, tensor_of(w, p, TEXT_1_WEIGHT), rows,
		REFER_T1, REFER_T2);
	relu_back(w->dh1, w->h1, rows * REFER_T1);
	linear_backward(NULL, gradient_of(w, gradient, TEXT_0_WEIGHT), gradient_of(w, gradient, TEXT_0_BIAS),
		w->dh1, w->chosen, tensor_of(w, p, TEXT_0_WEIGHT), rows, width, REFER_T1);
}
