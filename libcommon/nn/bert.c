#include "nn/bert.h"

#include "base/hash.h"
#include "base/mem.h"
#include "nn/linear.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Hands out consecutive arrays, and hashes those that are there. With slab NULL it only counts; -1 in `bad`
 * when the count does not fit. */
struct layout {
	float *slab;
	size_t used;
	int bad;
	uint64_t *hash; /* NULL: do not read them */
};

static float *take(struct layout *l, size_t rows, size_t columns)
{
	const size_t limit = SIZE_MAX / 8;
	size_t count;
	float *at = l->slab ? l->slab + l->used : NULL;

	if (l->hash)
		*l->hash = hash64(at, rows * columns * sizeof *at, *l->hash);
	if (mem_size(rows, columns, &count) || (count = (count + 15) / 16 * 16) > limit - l->used) {
		l->bad = -1;
		return NULL;
	}
	l->used += count; /* a multiple of 16: each array begins on a 64-byte boundary */
	return at;
}

static void take_linear(struct layout *l, struct bert_linear *linear, int in, int out)
{
	linear->weight = take(l, (size_t)out, (size_t)in);
	linear->bias = take(l, (size_t)out, 1);
}

static void take_norm(struct layout *l, struct bert_norm *norm, int width)
{
	norm->scale = take(l, (size_t)width, 1);
	norm->shift = take(l, (size_t)width, 1);
}

static void lay_out(struct bert *b, struct layout *l)
{
	size_t width = (size_t)b->width;

	b->word = take(l, (size_t)b->words, width);
	b->position = take(l, (size_t)b->positions, width);
	b->type = take(l, (size_t)b->types, width);
	take_norm(l, &b->norm, b->width);
	for (int i = 0; i < b->layer_count; i++) {
		struct bert_layer *layer = &b->layers[i];
		take_linear(l, &layer->query, b->width, b->width);
		take_linear(l, &layer->key, b->width, b->width);
		take_linear(l, &layer->value, b->width, b->width);
		take_linear(l, &layer->attention_out, b->width, b->width);
		take_norm(l, &layer->attention_norm, b->width);
		take_linear(l, &layer->inner, b->width, b->inner);
		take_linear(l, &layer->outer, b->inner, b->width);
		take_norm(l, &layer->norm, b->width);
	}
}

int bert_alloc(struct bert *b, struct err *e)
{
	struct layout count = {0}, place = {0};

	b->slab = NULL;
	b->layers = mem_zalloc((size_t)b->layer_count, sizeof *b->layers, "encoder", e);
	if (!b->layers)
		return -1;
	lay_out(b, &count);
	if (count.bad)
		err_set(e, ERR_SYSTEM, "encoder: its weights do not fit in memory");
	else
		b->slab = mem_alloc(count.used, sizeof *b->slab, "encoder", e);
	if (!b->slab) {
		bert_free(b);
		return -1;
	}
	place.slab = b->slab;
	lay_out(b, &place);
	return 0;
}

uint64_t bert_hash(const struct bert *b, uint64_t seed)
{
	struct bert same = *b; /* its arrays are handed out again, where they are */
	struct layout l = {.slab = b->slab, .hash = &seed};

	lay_out(&same, &l);
	return seed;
}

void bert_free(struct bert *b)
{
	free(b->layers);
	free(b->slab);
	*b = (struct bert){0};
}

/* Mean and variance in double, so that a long row with a large mean keeps its digits. */
static void normalise(const struct bert *b, float *x, const struct bert_norm *norm)
{
	size_t n = (size_t)b->width;
	double sum = 0, square = 0;

	for (size_t i = 0; i < n; i++)
		sum += x[i];
	double mean = sum / (double)n;
	for (size_t i = 0; i < n; i++)
		square += (x[i] - mean) * (x[i] - mean);
	double scale = 1 / sqrt(square / (double)n + b->eps);
	for (size_t i = 0; i < n; i++)
		x[i] = (float)((x[i] - mean) * scale) * norm->scale[i] + norm->shift[i];
}

/* x = LayerNorm(x + y), by row. */
static void add_and_normalise(
	const struct bert *b, float *x, const float *y, size_t rows, const struct bert_norm *norm)
{
	size_t width = (size_t)b->width;

#pragma omp parallel for schedule(static)
	for (size_t r = 0; r < rows; r++) {
		for (size_t i = 0; i < width; i++)
			x[r * width + i] += y[r * width + i];
		normalise(b, x + r * width, norm);
	}
}

static void activate(enum bert_activation kind, float *x, size_t n)
{
#pragma omp parallel for schedule(static)
	for (size_t i = 0; i < n; i++) {
		float v = x[i];
		if (kind == BERT_GELU)
			x[i] = 0.5f * v * (1 + erff(v * 0.70710678f));
		else if (kind == BERT_GELU_TANH)
			x[i] = 0.5f * v * (1 + tanhf(0.79788456f * (v + 0.044715f * v * v * v)));
		else
			x[i] = v > 0 ? v : 0;
	}
}

static void embed(const struct bert *b, const int32_t *ids, const size_t *starts, size_t n, float *x)
{
	size_t width = (size_t)b->width;

#pragma omp parallel for schedule(static)
	for (size_t s = 0; s < n; s++)
		for (size_t r = starts[s]; r < starts[s + 1]; r++) {
			const float *word = b->word + (size_t)ids[r] * width;
			const float *position = b->position + (r - starts[s]) * width;
			float *row = x + (r - starts[0]) * width;
			for (size_t i = 0; i < width; i++)
				row[i] = word[i] + b->type[i] + position[i];
			normalise(b, row, &b->norm);
		}
}

static void softmax(float *x, size_t n)
{
	float most = x[0];
	double sum = 0;

	for (size_t i = 1; i < n; i++)
		most = x[i] > most ? x[i] : most;
	for (size_t i = 0; i < n; i++) {
		x[i] = expf(x[i] - most);
		sum += x[i];
	}
	for (size_t i = 0; i < n; i++)
		x[i] = (float)(x[i] / sum);
}

/* One head of one sequence of n tokens: q, k, v and c point at its first row and column; score is (n,n). */
static void attend(const struct bert *b, const float *q, const float *k, const float *v, float *c,
	float *score, size_t n)
{
	size_t width = (size_t)b->width, d = width / (size_t)b->heads;
	struct linear_matrix query = {q, width, 1}, key = {k, 1, width}, value = {v, width, 1},
			     share = {score, n, 1};
	float scale = (float)(1 / sqrt((double)d));

	linear_product(score, n, NULL, 0, query, key, n, n, d);
	for (size_t i = 0; i < n; i++) {
		for (size_t j = 0; j < n; j++)
			score[i * n + j] *= scale;
		softmax(score + i * n, n);
	}
	linear_product(c, width, NULL, 0, share, value, n, d, n);
}

/* What one forward pass works in. */
struct work {
	float *query, *key, *value, *context; /* (rows,width) */
	float *inner;			      /* (rows,inner) */
	float *scores; /* sequence s, head h from (its first row heads + n h) longest on */
	size_t rows, longest;
};

static void lay_out_work(const struct bert *b, struct work *w, struct layout *l)
{
	size_t width = (size_t)b->width, floats = 0;

	w->query = take(l, w->rows, width);
	w->key = take(l, w->rows, width);
	w->value = take(l, w->rows, width);
	w->context = take(l, w->rows, width);
	w->inner = take(l, w->rows, (size_t)b->inner);
	if (mem_size(w->rows, (size_t)b->heads, &floats))
		l->bad = -1;
	w->scores = take(l, floats, w->longest);
}

int bert_scratch(const struct bert *b, size_t rows, size_t longest, size_t *floats)
{
	struct work w = {.rows = rows, .longest = longest};
	struct layout count = {0};

	lay_out_work(b, &w, &count);
	*floats = count.used;
	return count.bad;
}

static void attention(const struct bert *b, const struct bert_layer *layer, struct work *w,
	const size_t *starts, size_t n, const float *x)
{
	size_t width = (size_t)b->width, heads = (size_t)b->heads, d = width / heads;

	linear_forward(w->query, x, layer->query.weight, layer->query.bias, w->rows, width, width);
	linear_forward(w->key, x, layer->key.weight, layer->key.bias, w->rows, width, width);
	linear_forward(w->value, x, layer->value.weight, layer->value.bias, w->rows, width, width);
#pragma omp parallel for collapse(2) schedule(dynamic)
	for (size_t s = 0; s < n; s++)
		for (size_t h = 0; h < heads; h++) {
			size_t first = starts[s] - starts[0], tokens = starts[s + 1] - starts[s],
			       at = first * width + h * d;
			float *score = w->scores + (first * heads + tokens * h) * w->longest;
			if (tokens)
				attend(b, w->query + at, w->key + at, w->value + at, w->context + at, score,
					tokens);
		}
}

void bert_forward(
	const struct bert *b, const int32_t *ids, const size_t *starts, size_t n, float *out, float *scratch)
{
	size_t rows = starts[n] - starts[0], width = (size_t)b->width, inner = (size_t)b->inner;
	struct work w = {.rows = rows};
	struct layout place = {.slab = scratch};

	for (size_t s = 0; s < n; s++)
		w.longest = starts[s + 1] - starts[s] > w.longest ? starts[s + 1] - starts[s] : w.longest;
	lay_out_work(b, &w, &place);
	embed(b, ids, starts, n, out);
	for (int i = 0; i < b->layer_count; i++) {
		const struct bert_layer *layer = &b->layers[i];
		attention(b, layer, &w, starts, n, out);
		linear_forward(w.query, w.context, layer->attention_out.weight, layer->attention_out.bias,
			rows, width, width);
		add_and_normalise(b, out, w.query, rows, &layer->attention_norm);
		linear_forward(w.inner, out, layer->inner.weight, layer->inner.bias, rows, width, inner);
		activate(b->activation, w.inner, rows * inner);
		linear_forward(w.query, w.inner, layer->outer.weight, layer->outer.bias, rows, inner, width);
		add_and_normalise(b, out, w.query, rows, &layer->norm);
	}
}

void bert_static(const struct bert *b, const int32_t *ids, size_t n, float *out)
{
	const size_t width = (size_t)b->width;

	for (size_t k = 0; k < n; k++)
		memcpy(out + k * width, b->word + (size_t)ids[k] * width, width * sizeof *out);
}
