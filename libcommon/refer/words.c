#include "refer/words.h"

#include "base/mem.h"
#include "nn/linear.h"

#include <stdlib.h>
#include <string.h>

int words_init(struct words *w, const struct refer_layout *l, size_t sentences, const int64_t *offsets,
	const float *input, struct err *e)
{
	const size_t rows = (size_t)offsets[sentences];

	*w = (struct words){.layout = l, .sentences = sentences, .offsets = offsets, .input = input};
	w->h1 = mem_alloc(rows, 2 * sizeof(float) * (REFER_T1 + REFER_T2), "words", e);
	w->mean = mem_zalloc(sentences, 2 * sizeof(float) * (REFER_T2 + REFER_D), "words", e);
	if (!w->h1 || !w->mean) {
		words_free(w);
		return -1;
	}
	w->h2 = w->h1 + rows * REFER_T1;
	w->dh1 = w->h2 + rows * REFER_T2;
	w->dh2 = w->dh1 + rows * REFER_T1;
	w->dmean = w->mean + sentences * REFER_T2;
	w->e = w->dmean + sentences * REFER_T2;
	w->de = w->e + sentences * REFER_D;
	return 0;
}

void words_free(struct words *w)
{
	free(w->h1);
	free(w->mean);
	*w = (struct words){0};
}

static const float *tensor_of(const struct words *w, const float *parameters, enum refer_tensor t)
{
	return parameters + w->layout->tensors[t].offset;
}

static float *gradient_of(const struct words *w, float *gradient, enum refer_tensor t)
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

void words_hidden(struct words *w, const float *p, size_t from, size_t to)
{
	const size_t first = (size_t)w->offsets[from], rows = (size_t)w->offsets[to] - first;
	const size_t width = (size_t)w->layout->text_width;
	float *h1 = w->h1 + first * REFER_T1, *h2 = w->h2 + first * REFER_T2;

	linear_forward(h1, w->input + first * width, tensor_of(w, p, TEXT_0_WEIGHT),
		tensor_of(w, p, TEXT_0_BIAS), rows, width, REFER_T1);
	relu(h1, rows * REFER_T1);
	linear_forward(h2, h1, tensor_of(w, p, TEXT_1_WEIGHT), tensor_of(w, p, TEXT_1_BIAS), rows, REFER_T1,
		REFER_T2);
	relu(h2, rows * REFER_T2);
}

void words_vectors(const struct words *w, const float *p, size_t sentence, float *out)
{
	const size_t first = (size_t)w->offsets[sentence], rows = (size_t)w->offsets[sentence + 1] - first;

	linear_forward(out, w->h2 + first * REFER_T2, tensor_of(w, p, TEXT_2_WEIGHT),
		tensor_of(w, p, TEXT_2_BIAS), rows, REFER_T2, REFER_D);
}

void words_embed(struct words *w, const float *p)
{
	for (size_t s = 0; s < w->sentences; s++) {
		const int64_t from = w->offsets[s], to = w->offsets[s + 1];
		float *mean = w->mean + s * REFER_T2;
		memset(mean, 0, sizeof *mean * REFER_T2);
		for (int64_t j = from; j < to; j++)
			for (int c = 0; c < REFER_T2; c++)
				mean[c] += w->h2[j * REFER_T2 + c];
		for (int c = 0; c < REFER_T2 && to > from; c++)
			mean[c] /= (float)(to - from);
	}
	linear_forward(w->e, w->mean, tensor_of(w, p, TEXT_2_WEIGHT), tensor_of(w, p, TEXT_2_BIAS),
		w->sentences, REFER_T2, REFER_D);
}

void words_back_begin(
	struct words *w, const float *p, float *gradient, size_t from, size_t to, int has_embeddings)
{
	if (!has_embeddings) {
		const size_t first = (size_t)w->offsets[from], rows = (size_t)w->offsets[to] - first;
		memset(w->dh2 + first * REFER_T2, 0, sizeof(float) * rows * REFER_T2);
		return;
	}
	linear_backward(w->dmean, gradient_of(w, gradient, TEXT_2_WEIGHT),
		gradient_of(w, gradient, TEXT_2_BIAS), w->de, w->mean, tensor_of(w, p, TEXT_2_WEIGHT),
		w->sentences, REFER_T2, REFER_D);
	for (size_t s = from; s < to; s++)
		for (int64_t j = w->offsets[s]; j < w->offsets[s + 1]; j++)
			for (int c = 0; c < REFER_T2; c++)
				w->dh2[j * REFER_T2 + c] = w->dmean[s * REFER_T2 + (size_t)c] /
							   (float)(w->offsets[s + 1] - w->offsets[s]);
}

void words_back_vectors(struct words *w, const float *p, float *gradient, size_t sentence, const float *dw)
{
	const size_t first = (size_t)w->offsets[sentence], rows = (size_t)w->offsets[sentence + 1] - first;
	float *dh2 = w->dh2 + first * REFER_T2;
	float *din = w->dh1 + first * REFER_T1; /* free until words_back_end; wide enough */

	linear_backward(din, gradient_of(w, gradient, TEXT_2_WEIGHT), gradient_of(w, gradient, TEXT_2_BIAS),
		dw, w->h2 + first * REFER_T2, tensor_of(w, p, TEXT_2_WEIGHT), rows, REFER_T2, REFER_D);
	for (size_t i = 0; i < rows * REFER_T2; i++)
		dh2[i] += din[i];
}

void words_back_end(struct words *w, const float *p, float *gradient, size_t from, size_t to)
{
	const size_t first = (size_t)w->offsets[from], rows = (size_t)w->offsets[to] - first;
	const size_t width = (size_t)w->layout->text_width;
	float *dh1 = w->dh1 + first * REFER_T1, *dh2 = w->dh2 + first * REFER_T2;
	const float *h1 = w->h1 + first * REFER_T1;

	relu_back(dh2, w->h2 + first * REFER_T2, rows * REFER_T2);
	linear_backward(dh1, gradient_of(w, gradient, TEXT_1_WEIGHT), gradient_of(w, gradient, TEXT_1_BIAS),
		dh2, h1, tensor_of(w, p, TEXT_1_WEIGHT), rows, REFER_T1, REFER_T2);
	relu_back(dh1, h1, rows * REFER_T1);
	linear_backward(NULL, gradient_of(w, gradient, TEXT_0_WEIGHT), gradient_of(w, gradient, TEXT_0_BIAS),
		dh1, w->input + first * width, tensor_of(w, p, TEXT_0_WEIGHT), rows, width, REFER_T1);
}
