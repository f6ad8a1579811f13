/* The model's hard cases: losses, responses and gradients of the folded float32 step against
 * tests/unit/reference.h, with all kernels that the machine has. */
#include "stability.h"

#include "tests/unit/reference_floats.h"

#include "base/mem.h"
#include "base/rng.h"
#include "nn/loss.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char *const kernel_names[] = {"plain", "avx2", "avx512"};

/* What a step's errors are: relative, the losses' to the larger of the loss and 1. */
struct errors {
	double responses, losses, gradients;
	double largest;	 /* response */
	double rounding; /* what rounding every parameter to float32 would change in the reference's gradients
			  */
};

static double largest_of(const double *values, size_t n)
{
	double most = 0;

	for (size_t i = 0; i < n; i++)
		most = fmax(most, fabs(values[i]));
	return most;
}

/* The worst tensor's distance from the reference's gradient, as a share of that, or of the largest tensor's
 * where it is small. */
static double gradient_error(const struct refer_layout *l, const double *gradient, const double *expected)
{
	double worst = 0, sizes[REFER_TENSORS], most = 0;

	for (int t = 0; t < REFER_TENSORS; t++) {
		const size_t count = (size_t)l->tensors[t].rows * (size_t)l->tensors[t].columns;
		sizes[t] = largest_of(expected + l->tensors[t].offset, count);
		most = fmax(most, sizes[t]);
	}
	for (int t = 0; t < REFER_TENSORS; t++) {
		const size_t count = (size_t)l->tensors[t].rows * (size_t)l->tensors[t].columns;
		const size_t at = l->tensors[t].offset;
		double off = 0;
		for (size_t k = 0; k < count; k++) {
			const double own = fabs(gradient[at + k] - expected[at + k]);
			off = own > off || isnan(own) ? own : off;
		}
		const double size = fmax(sizes[t], 1e-6 * most);
		off = size > 0 ? off / size : off;
		worst = off > worst || isnan(off) ? off : worst;
	}
	return worst;
}

/* NaN wins, unlike fmax. */
static void keep(double *worst, double own)
{
	*worst = own > *worst || isnan(own) ? own : *worst;
}

/* One kernel's step; `wide` is the same problem with more copies of each Gaussian, of which the first are
 * compared. */
static void run_step(const struct reference_sample *wide, const struct refer_problem *p, const char *kernels,
	const struct refer_result *result, const double *dparameters, struct errors *worst)
{
	struct floats f;
	struct err e;

	floats_init(&f, wide);
	struct step *step = make_step(wide, &f, 1, kernels);
	float *m = mem_alloc(wide->problem.n, sizeof *m, "responses", &e);
	double *gradient = mem_alloc(wide->layout.count, sizeof *gradient, "gradient", &e);
	if (!step || !m || !gradient)
		abort();
	const struct view_weights view = view_of(&wide->problem, &f);
	const struct step_target target = {p->target, f.mask};
	const struct step_losses losses = step_run(step, f.parameters, f.panels, &view, &target, 1,
		top_count(&wide->problem), NULL, f.gradient, f.dpanels);
	step_respond(step, f.parameters, f.panels, p->target, m);
	keep(&worst->responses, distance(m, result->m, p->n));
	keep(&worst->losses, fabs(losses.bce - result->bce) / fmax(1, result->bce));
	keep(&worst->losses, fabs(losses.contrast - result->contrast) / fmax(1, result->contrast));
	for (size_t k = 0; k < wide->layout.count; k++)
		gradient[k] = (double)f.gradient[k];
	keep(&worst->gradients, gradient_error(&wide->layout, gradient, dparameters));
	free(gradient);
	free(m);
	step_free(step);
	floats_free(&f);
}

/* The reference's gradients where each parameter is moved by half a unit of float32's last place, one way or
 * the other. */
static double rounding_of(const struct reference_sample *s, const double *dparameters)
{
	struct reference_sample moved;
	struct refer_result result;
	struct rng r;
	struct err e;

	reference_sample_copy(&moved, s);
	double *gradient = mem_alloc(s->layout.count, sizeof *gradient, "gradient", &e);
	double *dx = mem_alloc(s->problem.n * (size_t)s->layout.feature_width, sizeof *dx, "dx", &e);
	rng_seed(&r, 1, 1);
	for (size_t k = 0; k < s->layout.count; k++)
		moved.parameters[k] *= 1 + (rng_below(&r, 2) ? 1 : -1) * 0x1p-24;
	if (!gradient || !dx || reference_forward(&moved.problem, &result, &e) ||
		reference_backward(&moved.problem, &result, dx, gradient, &e))
		abort();
	const double change = gradient_error(&s->layout, gradient, dparameters);
	reference_free(&result);
	reference_sample_free(&moved);
	free(gradient);
	free(dx);
	return change;
}

static struct errors compare(const struct reference_sample *s, const struct reference_sample *wide)
{
	const struct refer_problem *p = &s->problem;
	struct errors worst = {0};
	struct refer_result result;
	struct err e;
	double *dx = mem_alloc(p->n * (size_t)s->layout.feature_width, sizeof *dx, "dx", &e);
	double *dparameters = mem_alloc(s->layout.count, sizeof *dparameters, "gradient", &e);

	if (!dx || !dparameters || reference_forward(p, &result, &e) ||
		reference_backward(p, &result, dx, dparameters, &e))
		abort();
	worst.largest = largest_of(result.m, p->n);
	for (size_t k = 0; k < sizeof kernel_names / sizeof *kernel_names; k++)
		if (block_select(kernel_names[k]))
			run_step(wide, p, kernel_names[k], &result, dparameters, &worst);
	worst.rounding = rounding_of(s, dparameters);
	reference_free(&result);
	free(dx);
	free(dparameters);
	return worst;
}

struct bounds {
	double responses, losses;
	double gradients; /* 0: twenty times what rounding the parameters changes */
};
static const struct bounds ordinary = {1e-5, 1e-5, 1e-3};
static const struct bounds steep = {1e-5, 1e-5, 0};

static void rows_of(const char *name, const struct reference_sample *s, const struct reference_sample *wide,
	const struct bounds *b, const char *does)
{
	const struct errors e = compare(s, wide);

	row(name, compared("responses, the largest %.2g", e.largest), e.responses, b->responses, does);
	row("", "both losses", e.losses, b->losses, "");
	if (b->gradients > 0)
		row("", "gradients of all parameters", e.gradients, b->gradients, "");
	else
		row("",
			compared("gradients; rounding the parameters once to float32 changes them by %.1e",
				e.rounding),
			e.gradients, 20 * e.rounding, "");
}

static struct reference_options defaults(void)
{
	return reference_defaults(21, REFER_PCMI, REFER_DOT, REFER_CONTRAST_COSINE);
}

/* A case that is an option of the sample. */
static void option_case(
	const char *name, const struct reference_options *o, const struct bounds *b, const char *does)
{
	struct reference_sample s;

	reference_sample_init(&s, o);
	rows_of(name, &s, &s, b, does);
	reference_sample_free(&s);
}

/* 1,000 different Gaussians, each a thousand times: the softmax over a million is that over the thousand. */
static void million_case(void)
{
	enum { DIFFERENT = 1000, COPIES = 1000 };
	struct reference_options o = defaults();
	struct reference_sample s, wide;

	o.n = DIFFERENT;
	reference_sample_init(&s, &o);
	reference_sample_copy(&wide, &s);
	const size_t width = (size_t)o.feature_width;
	wide.x = realloc(wide.x, sizeof(double) * width * DIFFERENT * COPIES);
	wide.position = realloc(wide.position, sizeof(double) * 3 * DIFFERENT * COPIES);
	if (!wide.x || !wide.position)
		abort();
	for (size_t c = 1; c < COPIES; c++) {
		memcpy(wide.x + c * width * DIFFERENT, s.x, sizeof(double) * width * DIFFERENT);
		memcpy(wide.position + c * 3 * DIFFERENT, s.position, sizeof(double) * 3 * DIFFERENT);
	}
	wide.problem.n = (size_t)DIFFERENT * COPIES;
	wide.problem.x = wide.x;
	wide.problem.position = wide.position;
	rows_of("a million Gaussians in a word's softmax", &s, &wide, &ordinary, "learns");
	reference_sample_free(&wide);
	reference_sample_free(&s);
}

static void sentence_cases(void)
{
	struct reference_options o = defaults();
	struct reference_sample s;

	o.sentences = 1;
	option_case("one sentence: the contrast has no negative", &o, &ordinary, "learns; the contrast is 0");
	o = defaults();
	o.min_words = o.max_words = 4;
	reference_sample_init(&s, &o);
	const size_t numbers = 4 * (size_t)o.text_width;
	for (size_t r = 1; r < o.sentences; r++)
		memcpy(s.words + r * numbers, s.words, numbers * sizeof *s.words);
	rows_of("five equal sentences of two objects", &s, &s, &ordinary, "learns");
	reference_sample_free(&s);
}

static void mask_case(const char *name, int value)
{
	struct reference_options o = defaults();
	struct reference_sample s;

	reference_sample_init(&s, &o);
	memset(s.mask, value, o.pixels);
	rows_of(name, &s, &s, &ordinary, "learns");
	reference_sample_free(&s);
}

/* Features of zero, at the start and for good; the latter has no direction to be compared by. */
static void zero_cases(void)
{
	struct reference_options o = defaults();
	struct reference_sample s;

	o.x_scale = 0;
	option_case("features of zero, as at the start", &o, &ordinary, "learns");
	for (int similarity = 0; similarity < 2; similarity++) {
		o = reference_defaults(
			21, REFER_NONE, (enum refer_similarity)similarity, REFER_CONTRAST_COSINE);
		reference_sample_init(&s, &o);
		for (int t = FEATURE_2_WEIGHT; t <= FEATURE_2_BIAS; t++)
			memset(s.parameters + s.layout.tensors[t].offset, 0,
				sizeof(double) * (size_t)s.layout.tensors[t].rows *
					(size_t)s.layout.tensors[t].columns);
		rows_of(similarity ? "features collapsed to zero, cosine" : "features collapsed to zero", &s,
			&s, &ordinary, "norms are at least 1e-12: finite, and a step leaves it");
		reference_sample_free(&s);
	}
}

static void view_case(void)
{
	struct reference_options o = defaults();
	struct reference_sample s;

	reference_sample_init(&s, &o);
	memset(s.indptr, 0, (o.pixels + 1) * sizeof *s.indptr);
	rows_of("a view whose weights are all dropped", &s, &s, &ordinary, "learns from the contrast alone");
	reference_sample_free(&s);
	reference_sample_init(&s, &o);
	for (size_t i = 0; i < o.n * 3; i += 7)
		s.position[i] = (float)(s.position[i] * 1e4);
	rows_of("Gaussians 10,000 bounds away", &s, &s, &steep, "learns");
	reference_sample_free(&s);
}

/* log(1 + e^z) and its slope in long double, pixel by pixel. */
static void bce_case(void)
{
	enum { PIXELS = 20000 };
	float logits[PIXELS], slopes[PIXELS];
	uint8_t mask[PIXELS];
	long double sum = 0;
	double worst = 0;

	for (int i = 0; i < PIXELS; i++) {
		logits[i] = (float)((i * 7919 % 20001 - 10000) * (i % 3 ? 1.0 : 1e-3));
		mask[i] = i / 2 % 2;
	}
	const double loss = loss_bce(logits, mask, PIXELS, 1, slopes);
	for (int i = 0; i < PIXELS; i++) {
		const long double z = mask[i] ? -(long double)logits[i] : logits[i];
		const long double slope = 1 / (1 + expl(-z)) / PIXELS;
		sum += (z > 0 ? z : 0) + log1pl(expl(-fabsl(z)));
		keep(&worst, (double)fabsl((mask[i] ? -1 : 1) * slope - slopes[i]) * PIXELS);
	}
	sum /= PIXELS;
	row("responses of 1e4 in the cross-entropy", "the loss", (double)fabsl(loss - sum) / (double)sum,
		1e-6, "learns");
	row("", "its slopes", worst, 1e-6, "");
}

static void exp_case(void)
{
	enum { N = 1000000 };
	float *x = malloc(N * sizeof *x);
	long double sum = 0;

	if (!x)
		abort();
	for (size_t i = 0; i < N; i++)
		x[i] = (float)(1e4 - 1e-2 * (double)(i * 7919 % 2000));
	for (size_t i = 0; i < N; i++)
		sum += expl((long double)x[i] - 1e4L);
	row("a million numbers near 1e4 in a softmax", "the logarithm of their sum",
		(double)fabsl(loss_log_sum_exp(x, N) - (1e4L + logl(sum))) / 1e4, 1e-6,
		"takes the largest out");
	free(x);
}

void model_cases(int is_quick)
{
	struct reference_options o = defaults();

	bce_case();
	exp_case();
	option_case("an ordinary step", &o, &ordinary, "learns");
	o.gain = 6;
	option_case("large responses, softmax of large scores", &o, &steep, "learns");
	o.contrast = REFER_CONTRAST_DOT;
	o.temperature = 0.1;
	option_case("the same, raw products in the contrast", &o, &steep, "learns");
	if (!is_quick)
		million_case();
	sentence_cases();
	o = defaults();
	o.tau = 0.005;
	option_case("tau below one Gaussian", &o, &ordinary, "one Gaussian stands for the object");
	mask_case("a mask that is all", 1);
	mask_case("a mask that is nothing", 0);
	zero_cases();
	view_case();
}
