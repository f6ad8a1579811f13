#include "nn/transformer.h"

#include "base/mem.h"

#include <math.h>

/* The clones give the machine's vector width; correctly rounded operations give the same bytes. */
#if defined(__x86_64__) && defined(__GLIBC__)
#define CLONES __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define CLONES
#endif

static void take_linear(struct slab *s, struct transformer_linear *linear, int in, int out)
{
	slab_take_weight(s, &linear->weight, (size_t)out, (size_t)in);
	linear->bias = slab_take(s, (size_t)out, 1);
}

void transformer_take_norm(const struct transformer *t, struct transformer_norm *norm, struct slab *s)
{
	norm->scale = slab_take(s, (size_t)t->width, 1);
	norm->shift = slab_take(s, (size_t)t->width, 1);
}

void transformer_take(struct transformer *t, struct slab *s)
{
	for (int i = 0; i < t->layer_count; i++) {
		struct transformer_layer *layer = &t->layers[i];
		take_linear(s, &layer->query, t->width, t->width);
		take_linear(s, &layer->key, t->width, t->width);
		take_linear(s, &layer->value, t->width, t->width);
		take_linear(s, &layer->attention_out, t->width, t->width);
		transformer_take_norm(t, &layer->attention_norm, s);
		take_linear(s, &layer->inner, t->width, t->inner);
		take_linear(s, &layer->outer, t->inner, t->width);
		transformer_take_norm(t, &layer->norm, s);
	}
}

/* The sum of x - less, or of its squares, in double, so that a long row with a large mean keeps its digits:
 * eight sums, which vectors of any width add alike. */
CLONES static double sum_of(const float *x, size_t n, double less, int is_squared)
{
	enum { LANES = 8 };
	typedef float floats __attribute__((vector_size(4 * LANES)));
	typedef double doubles __attribute__((vector_size(8 * LANES)));
	doubles sums = {0}, d;
	floats some;
	double sum = 0;
	size_t i = 0;

	for (; i + LANES <= n; i += LANES) {
		memcpy(&some, x + i, sizeof some);
		d = __builtin_convertvector(some, doubles) - less;
		sums += is_squared ? d * d : d;
	}
	for (; i < n; i++)
		sum += is_squared ? (x[i] - less) * (x[i] - less) : x[i] - less;
	for (int k = 0; k < LANES; k++)
		sum += sums[k];
	return sum;
}

void transformer_normalise(const struct transformer *t, float *x, const struct transformer_norm *norm)
{
	const size_t n = (size_t)t->width;
	const double mean = sum_of(x, n, 0, 0) / (double)n;
	const double scale = 1 / sqrt(sum_of(x, n, mean, 1) / (double)n + t->eps);

	for (size_t i = 0; i < n; i++)
		x[i] = (float)((x[i] - mean) * scale) * norm->scale[i] + norm->shift[i];
}

/* x = LayerNorm(x + y), by row. */
static void add_and_normalise(const struct transformer *t, float *x, const float *y, size_t rows,
	const struct transformer_norm *norm)
{
	size_t width = (size_t)t->width;

#pragma omp parallel for schedule(static)
	for (size_t r = 0; r < rows; r++) {
		for (size_t i = 0; i < width; i++)
			x[r * width + i] += y[r * width + i];
		transformer_normalise(t, x + r * width, norm);
	}
}

/* y = LayerNorm(x), by row. */
static void copy_normalised(const struct transformer *t, float *y, const float *x, size_t rows,
	const struct transformer_norm *norm)
{
	size_t width = (size_t)t->width;

#pragma omp parallel for schedule(static)
	for (size_t r = 0; r < rows; r++) {
		memcpy(y + r * width, x + r * width, width * sizeof *y);
		transformer_normalise(t, y + r * width, norm);
	}
}

static void add(float *x, const float *y, size_t n)
{
#pragma omp parallel for schedule(static)
	for (size_t i = 0; i < n; i++)
		x[i] += y[i];
}

/* erf(z) = z p(z z / 8 - 1) within 1e-8 for |z| < 4, by interpolation at Chebyshev's points; 1 in a float
 * beyond. In double, as a float's digits are lost where 1 + erf is small. */
CLONES static void gelu(float *x, size_t n)
{
	static const double p[] = {0.000572087096343, -0.00137052044348, 0.000713755510814, -0.00108552910178,
		0.00541989023641, -0.0100730577306, 0.0140410128124, -0.0216723195703, 0.0331549293389,
		-0.0460103311746, 0.0598717301071, -0.0746883651476, 0.0902100852368, -0.107713284331,
		0.131675094101, -0.176576173922, 0.353530995643};

	for (size_t i = 0; i < n; i++) {
		const double v = x[i], z = v * 0.70710678118654752, u = z * z * 0.125 - 1;
		double sum = p[0];
		for (size_t k = 1; k < sizeof p / sizeof *p; k++)
			sum = sum * u + p[k];
		sum *= z;
		sum = z >= 4 ? 1 : z <= -4 ? -1 : sum;
		x[i] = (float)(0.5 * v * (1 + sum));
	}
}

void transformer_gelu(float *x, size_t n)
{
	enum { BLOCK = 4096 };

#pragma omp parallel for schedule(static) if (n > BLOCK)
	for (size_t i = 0; i < n; i += BLOCK)
		gelu(x + i, n - i < BLOCK ? n - i : BLOCK);
}

static void activate(enum transformer_activation kind, float *x, size_t n)
{
	if (kind == TRANSFORMER_GELU) {
		transformer_gelu(x, n);
		return;
	}
#pragma omp parallel for schedule(static)
	for (size_t i = 0; i < n; i++) {
		float v = x[i];
		if (kind == TRANSFORMER_GELU_TANH)
			x[i] = 0.5f * v * (1 + tanhf(0.79788456f * (v + 0.044715f * v * v * v)));
		else if (kind == TRANSFORMER_QUICK_GELU)
			x[i] = v / (1 + expf(-1.702f * v));
		else
			x[i] = v > 0 ? v : 0;
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
static void attend(const struct transformer *t, const float *q, const float *k, const float *v, float *c,
	float *score, size_t n)
{
	size_t width = (size_t)t->width, d = width / (size_t)t->heads;
	struct linear_matrix query = {q, width, 1}, key = {k, 1, width}, value = {v, width, 1},
			     share = {score, n, 1};
	float scale = (float)(1 / sqrt((double)d));

	linear_product(score, n, NULL, 0, query, key, n, n, d);
	for (size_t i = 0; i < n; i++) {
		for (size_t j = 0; j < n; j++)
			score[i * n + j] *= scale;
		const size_t seen = t->is_causal ? i + 1 : n;
		softmax(score + i * n, seen);
		for (size_t j = seen; j < n; j++)
			score[i * n + j] = 0;
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

static void lay_out_work(const struct transformer *t, struct work *w, struct slab *s)
{
	size_t width = (size_t)t->width, floats = 0;

	w->query = slab_take(s, w->rows, width);
	w->key = slab_take(s, w->rows, width);
	w->value = slab_take(s, w->rows, width);
	w->context = slab_take(s, w->rows, width);
	w->inner = slab_take(s, w->rows, (size_t)t->inner);
	if (mem_size(w->rows, (size_t)t->heads, &floats))
		s->bad = -1;
	w->scores = slab_take(s, floats, w->longest);
}

int transformer_scratch(const struct transformer *t, size_t rows, size_t longest, size_t *floats)
{
	struct work w = {.rows = rows, .longest = longest};
	struct slab count = {0};

	lay_out_work(t, &w, &count);
	*floats = count.used;
	return count.bad;
}

static void apply(
	float *out, const float *x, const struct transformer_linear *l, size_t rows, size_t in, size_t width)
{
	linear_layer_run(&(struct linear_layer){out, x, l->weight, l->bias, rows, in, width});
}

/* w->query = attend(x) */
static void attend_all(const struct transformer *t, const struct transformer_layer *layer, struct work *w,
	const size_t *starts, size_t n, const float *x)
{
	size_t width = (size_t)t->width, heads = (size_t)t->heads, d = width / heads;

	apply(w->query, x, &layer->query, w->rows, width, width);
	apply(w->key, x, &layer->key, w->rows, width, width);
	apply(w->value, x, &layer->value, w->rows, width, width);
#pragma omp parallel for collapse(2) schedule(dynamic)
	for (size_t s = 0; s < n; s++)
		for (size_t h = 0; h < heads; h++) {
			size_t first = starts[s] - starts[0], tokens = starts[s + 1] - starts[s],
			       at = first * width + h * d;
			float *score = w->scores + (first * heads + tokens * h) * w->longest;
			if (tokens)
				attend(t, w->query + at, w->key + at, w->value + at, w->context + at, score,
					tokens);
		}
	apply(w->query, w->context, &layer->attention_out, w->rows, width, width);
}

/* w->query = feed(x) */
static void feed(
	const struct transformer *t, const struct transformer_layer *layer, struct work *w, const float *x)
{
	size_t width = (size_t)t->width, inner = (size_t)t->inner;

	apply(w->inner, x, &layer->inner, w->rows, width, inner);
	activate(t->activation, w->inner, w->rows * inner);
	apply(w->query, w->inner, &layer->outer, w->rows, inner, width);
}

static void run_layer(const struct transformer *t, const struct transformer_layer *layer, struct work *w,
	const size_t *starts, size_t n, float *x)
{
	attend_all(t, layer, w, starts, n, x);
	add_and_normalise(t, x, w->query, w->rows, &layer->attention_norm);
	feed(t, layer, w, x);
	add_and_normalise(t, x, w->query, w->rows, &layer->norm);
}

/* The normalised rows lie where the context will. */
static void run_layer_norm_first(const struct transformer *t, const struct transformer_layer *layer,
	struct work *w, const size_t *starts, size_t n, float *x)
{
	copy_normalised(t, w->context, x, w->rows, &layer->attention_norm);
	attend_all(t, layer, w, starts, n, w->context);
	add(x, w->query, w->rows * (size_t)t->width);
	copy_normalised(t, w->context, x, w->rows, &layer->norm);
	feed(t, layer, w, w->context);
	add(x, w->query, w->rows * (size_t)t->width);
}

int transformer_middle(const struct transformer *t)
{
	return t->layer_count / 2;
}

void transformer_forward(
	const struct transformer *t, const size_t *starts, size_t n, float *x, float *middle, float *scratch)
{
	struct work w = {.rows = starts[n] - starts[0]};
	struct slab place = {.at = scratch};

	for (size_t s = 0; s < n; s++)
		w.longest = starts[s + 1] - starts[s] > w.longest ? starts[s + 1] - starts[s] : w.longest;
	lay_out_work(t, &w, &place);
	for (int i = 0; i < t->layer_count; i++) {
		if (middle && i == transformer_middle(t))
			memcpy(middle, x, w.rows * (size_t)t->width * sizeof *x);
		if (t->is_norm_first)
			run_layer_norm_first(t, &t->layers[i], &w, starts, n, x);
		else
			run_layer(t, &t->layers[i], &w, starts, n, x);
	}
}
