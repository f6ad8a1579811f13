/* The speed of a training step on made inputs, phase by phase, for one thread and for all.
 *
 *	bench_step [gaussians [words [width height [steps]]]]
 *
 * PCMI, cosine similarity and cosine contrast; 44 sentences of `words` words, 384 wide. A view has 56 weights
 *a pixel on average, of Gaussians that are near each other in the array for near pixels, as in a scene. Each
 *figure is the least of all steps, in the process's own time where one thread runs, so that a busy machine
 *disturbs it little. */
#include "base/mem.h"
#include "base/rng.h"
#include "mask/bits.h"
#include "refer/step.h"
#include "refer/train.h"

#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#if defined __x86_64__
#include <immintrin.h>
#endif

enum { SENTENCES = 44, TEXT = 384, WEIGHTS = 56, PATCH = 8, NEAR = 400 };

struct watch {
	clockid_t clock;
	double last, spent[STEP_PHASES];
};

static double now(clockid_t clock)
{
	struct timespec t;

	clock_gettime(clock, &t);
	return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void ended(void *data, enum step_phase phase)
{
	struct watch *w = data;
	double time = now(w->clock);

	w->spent[phase] += time - w->last;
	w->last = time;
}

static void *need(size_t count, size_t size)
{
	struct err e;
	void *p = mem_zalloc(count, size, "benchmark", &e);

	if (!p) {
		fprintf(stderr, "bench_step: %s\n", e.message);
		exit(4);
	}
	return p;
}

static float *uniform(struct rng *r, size_t count, float size)
{
	float *x = need(count, sizeof *x);

	for (size_t i = 0; i < count; i++)
		x[i] = (float)rng_range(r, -(double)size, (double)size);
	return x;
}

/* All the Gaussians of a patch of pixels come from NEAR neighbours in the array. */
static struct view_weights make_view(struct rng *r, size_t gaussians, size_t width, size_t height)
{
	const size_t pixels = width * height, across = (width + PATCH - 1) / PATCH,
		     down = (height + PATCH - 1) / PATCH;
	int64_t *indptr = need(pixels + 1, sizeof *indptr);
	int32_t *index = need(pixels * 2 * WEIGHTS, sizeof *index), *base = need(across * down, sizeof *base);
	float *weight = need(pixels * 2 * WEIGHTS, sizeof *weight);
	const uint32_t near = gaussians < NEAR ? (uint32_t)gaussians : NEAR;

	for (size_t i = 0; i < across * down; i++)
		base[i] = (int32_t)rng_below(r, (uint32_t)gaussians - near + 1);
	for (size_t p = 0; p < pixels; p++) {
		const int32_t from = base[p / width / PATCH * across + p % width / PATCH];
		const int64_t count = 1 + rng_below(r, 2 * WEIGHTS - 1);
		for (int64_t k = 0; k < count; k++) {
			index[indptr[p] + k] = from + (int32_t)rng_below(r, near);
			weight[indptr[p] + k] = (float)(rng_uniform(r) / (double)count);
		}
		indptr[p + 1] = indptr[p] + count;
	}
	free(base);
	return (struct view_weights){pixels, gaussians, indptr, index, weight};
}

/* Multiplications with an addition that the mathematics asks for, folded: for a Gaussian, and for a word of
 * MLP_t. */
static double work(enum step_phase phase, double gaussians, double n, double words)
{
	const double g = BLOCK_G, z = g + n, feature = 16 * 32 + 32 * 64, position = 3 * 16 + 16 * 64;
	const double text = 512.0 * 256, text0 = 512.0 * TEXT;

	switch (phase) {
	case STEP_WORDS:
		return words * (2 * text0 + 3 * text);
	case STEP_HIDDEN:
		return gaussians * (feature + position + 2 * n * g);
	case STEP_RESPOND:
		return gaussians * (2 * n * g + z * (z + 1) / 2 + z);
	case STEP_SCORES_BACK:
		return gaussians * (2 * n * g + z * z + z * (z + 1) / 2 + 3 * z);
	case STEP_HIDDEN_BACK:
		return gaussians * (6 * n * g + 16 * 32 + 2 * feature + 2 * 16 * 64 + 2 * 3 * 16);
	default:
		return 0;
	}
}

/* Independent chains of multiply-adds, as wide as the processor has them: how many it did, each. */
enum { CHAINS = 12, ROUNDS = 1000000 };

#if defined __x86_64__
__attribute__((target("avx512f"))) static double chains_avx512(void)
{
	__m512 sums[CHAINS], x = _mm512_set1_ps(0.5f);

	for (int c = 0; c < CHAINS; c++)
		sums[c] = _mm512_set1_ps((float)c);
	for (long i = 0; i < ROUNDS; i++)
		for (int c = 0; c < CHAINS; c++)
			sums[c] = _mm512_fmadd_ps(sums[c], x, x);
	for (int c = 1; c < CHAINS; c++)
		sums[0] = _mm512_add_ps(sums[0], sums[c]);
	volatile float sink = _mm512_cvtss_f32(sums[0]);
	(void)sink;
	return 16.0 * CHAINS * ROUNDS;
}

__attribute__((target("avx2,fma"))) static double chains_avx2(void)
{
	__m256 sums[CHAINS], x = _mm256_set1_ps(0.5f);

	for (int c = 0; c < CHAINS; c++)
		sums[c] = _mm256_set1_ps((float)c);
	for (long i = 0; i < ROUNDS; i++)
		for (int c = 0; c < CHAINS; c++)
			sums[c] = _mm256_fmadd_ps(sums[c], x, x);
	for (int c = 1; c < CHAINS; c++)
		sums[0] = _mm256_add_ps(sums[0], sums[c]);
	volatile float sink = _mm256_cvtss_f32(sums[0]);
	(void)sink;
	return 8.0 * CHAINS * ROUNDS;
}
#endif

static double chains_plain(void)
{
	float __attribute__((vector_size(16))) sums[CHAINS] = {{0}}, x = {0.5f, 0.5f, 0.5f, 0.5f};

	for (long i = 0; i < ROUNDS; i++)
		for (int c = 0; c < CHAINS; c++)
			sums[c] = sums[c] * x + x;
	for (int c = 1; c < CHAINS; c++)
		sums[0] += sums[c];
	volatile float sink = sums[0][0];
	(void)sink;
	return 4.0 * CHAINS * ROUNDS;
}

/* The processor's peak for one thread, in multiply-adds a second. */
static double measure_peak(void)
{
	double (*chains)(void) = chains_plain;
	double best = 0;

#if defined __x86_64__
	if (__builtin_cpu_supports("avx512f"))
		chains = chains_avx512;
	else if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
		chains = chains_avx2;
#endif
	for (int i = 0; i < 5; i++) {
		double start = now(CLOCK_THREAD_CPUTIME_ID), done = chains();
		double rate = done / (now(CLOCK_THREAD_CPUTIME_ID) - start);
		best = rate > best ? rate : best;
	}
	return best;
}

static void print_row(const char *name, double seconds, double madds, double peak)
{
	printf("%-14s %8.2f ms", name, 1e3 * seconds);
	if (madds > 0)
		printf(" %8.1f GFLOP/s %5.0f %%", 2e-9 * madds / seconds, 100 * madds / seconds / peak);
	printf("\n");
}

static void measure(const struct step_setup *setup, struct train_state *t, const struct view_weights *view,
	const uint8_t *mask, int steps, int threads, double peak)
{
	static const char *const names[STEP_PHASES] = {"words", "fold", "hidden", "respond", "images", "top",
		"gather", "scores_back", "hidden_back"};
	struct watch w = {.clock = threads == 1 ? CLOCK_PROCESS_CPUTIME_ID : CLOCK_MONOTONIC};
	double least[STEP_PHASES + 2], all = 0;
	struct err e;

	omp_set_num_threads(threads);
	struct step *s = step_new(setup, &e);
	if (!s) {
		fprintf(stderr, "bench_step: %s\n", e.message);
		exit(4);
	}
	step_watch(s, ended, &w);
	for (int p = 0; p < STEP_PHASES + 2; p++)
		least[p] = 1e9;
	const double n = (double)setup->offsets[1], words = (double)setup->offsets[setup->sentences];
	const double size = (double)setup->gaussians;
	for (int i = 0; i < steps; i++) {
		const struct step_target target = {(size_t)i % SENTENCES, mask};
		memset(w.spent, 0, sizeof w.spent);
		const double start = w.last = now(w.clock);
		step_run(s, t->values, train_state_x(t), view, &target, 1,
			contrast_top_count(i, setup->gaussians), NULL, t->gradient, t->gradient + t->parameters);
		const double middle = now(w.clock);
		train_adam(t, &(struct train_rates){1e-4, 1e-3});
		const double end = now(w.clock);
		for (int p = 0; p < STEP_PHASES; p++)
			least[p] = w.spent[p] < least[p] ? w.spent[p] : least[p];
		least[STEP_PHASES] = end - middle < least[STEP_PHASES] ? end - middle : least[STEP_PHASES];
		least[STEP_PHASES + 1] =
			end - start < least[STEP_PHASES + 1] ? end - start : least[STEP_PHASES + 1];
	}
	printf("\n%d thread%s\n", threads, threads == 1 ? "" : "s");
	for (enum step_phase p = 0; p < STEP_PHASES; p++) {
		double madds = work(p, size, n, words);
		all += madds;
		print_row(names[p], least[p], madds, peak * threads);
	}
	print_row("adam", least[STEP_PHASES], 0, peak);
	print_row("step", least[STEP_PHASES + 1], all, peak * threads);
	step_free(s);
}

int main(int argc, char **argv)
{
	const size_t gaussians = argc > 1 ? strtoul(argv[1], NULL, 10) : 68270,
		     words = argc > 2 ? strtoul(argv[2], NULL, 10) : 14;
	const size_t width = argc > 4 ? strtoul(argv[3], NULL, 10) : 318,
		     height = argc > 4 ? strtoul(argv[4], NULL, 10) : 178;
	const int steps = argc > 5 ? atoi(argv[5]) : 10, most = omp_get_max_threads();
	int64_t offsets[SENTENCES + 1];
	int objects[SENTENCES];
	struct refer_layout layout;
	struct train_state t;
	struct rng r;
	struct err e;

	if (!gaussians || gaussians > 1 << 26 || !words || words > 500 || !width || width > 10000 ||
		!height || height > 10000) {
		fprintf(stderr, "usage: bench_step [gaussians [words [width height [steps]]]]\n");
		return 2;
	}
	rng_seed(&r, 1, 1);
	refer_layout_init(&layout, REFER_PCMI, TEXT);
	if (train_state_init(&t, &layout, gaussians, 1, &e)) {
		fprintf(stderr, "bench_step: %s\n", e.message);
		return 4;
	}
	float *x = uniform(&r, gaussians * REFER_X, 1);
	step_pack(x, gaussians, train_state_x(&t));
	for (int i = 0; i <= SENTENCES; i++)
		offsets[i] = i * (int64_t)words;
	for (int i = 0; i < SENTENCES; i++)
		objects[i] = i / 4;
	float *position = uniform(&r, gaussians * 3, 1), *text = uniform(&r, SENTENCES * words * TEXT, 0.1f);
	struct view_weights view = make_view(&r, gaussians, width, height);
	uint8_t *mask = need(bits_bytes(view.pixels), 1);
	for (size_t p = 0; p < view.pixels; p++)
		mask[p / 8] |= (uint8_t)((p % width < width / 5) << p % 8);
	const struct step_setup setup = {.layout = &layout,
		.similarity = REFER_COSINE,
		.contrast = REFER_CONTRAST_COSINE,
		.temperature = 0.1,
		.lambda = 0.1,
		.gaussians = gaussians,
		.position = position,
		.sentences = SENTENCES,
		.offsets = offsets,
		.words = text,
		.objects = objects,
		.pixels = view.pixels,
		.batch = 1};
	const double peak = measure_peak();
	printf("%zu Gaussians, %zu words, %zu x %zu pixels, %lld weights, %s; peak %.0f GFLOP/s a thread\n",
		gaussians, words, width, height, (long long)view.indptr[view.pixels],
		block_select(NULL)->name, 2e-9 * peak);
	for (int threads = 1; threads <= most; threads *= 2)
		measure(&setup, &t, &view, mask, steps, threads, peak);
	train_state_free(&t);
	free((void *)view.indptr);
	free((void *)view.index);
	free((void *)view.weight);
	free(x);
	free(position);
	free(text);
	free(mask);
	return 0;
}
