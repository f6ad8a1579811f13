/* The speed of a training step on made inputs, phase by phase. bench_step --help lists what can be varied.
 *
 * PCMI, contrast by cosine; text 384 wide. The Gaussians of near pixels are near each other in the array, as
 * in a scene. The time is the process's own where one thread runs, so that a busy machine disturbs it little
 * (unless --wall), and the clock's where more do. Figures are medians over the repeats; the table's are the
 * least. */
#include "base/mem.h"
#include "base/rng.h"
#include "cli/cli.h"
#include "mask/bits.h"
#include "peak.h"
#include "train/step.h"
#include "train/train.h"

#include <omp.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
	TEXT = 384,
	FEATURE = 16,
	PATCH = 8,
	NEAR = 400,
	PER_OBJECT = 4,
	ADAM = STEP_PHASES,
	STEP,
	TIMES,
	LIST = 32
};

static const char *const names[TIMES] = {"words", "fold", "hidden", "respond", "images", "top", "gather",
	"scores_back", "hidden_back", "adam", "step"};

static struct {
	const char *gaussians, *threads;
	long long words, sentences, negatives, batch, weights, repeats;
	int size[2], similarity, is_wall;
} options = {.gaussians = "68270",
	.words = 14,
	.sentences = 44,
	.batch = 1,
	.weights = 56,
	.repeats = 10,
	.size = {318, 178}};

static const struct cli_option table[] = {{"gaussians", 0, CLI_STRING, &options.gaussians, "N,...",
						  "Gaussians that learn (default 68270)", 0, 0},
	{"words", 0, CLI_INT, &options.words, "N", "of a sentence (default 14)", 1, 500},
	{"sentences", 0, CLI_INT, &options.sentences, "R", "of the scene (default 44)", 1, 100000},
	{"negatives", 0, CLI_INT, &options.negatives, "K",
		"sentences of the contrast besides the step's own (default 0: all)", 0, 100000},
	{"batch", 0, CLI_INT, &options.batch, "S", "sentences in a step (default 1)", 1, 64},
	{"size", 0, CLI_SIZE, options.size, "WxH", "of the view in pixels (default 318x178)", 1, 10000},
	{"weights", 0, CLI_INT, &options.weights, "N", "of a pixel, on average (default 56)", 1, 10000},
	{"similarity", 0, CLI_CHOICE, &options.similarity, REFER_SIMILARITY_CHOICES,
		"how features answer words (default dot)", 0, 0},
	{"repeats", 0, CLI_INT, &options.repeats, "K", "timed steps (default 10)", 1, 100000},
	{"threads", 0, CLI_STRING, &options.threads, "T,...", "numbers of threads (default: 1, 2, 4 to all)",
		0, 0},
	{"wall", 0, CLI_FLAG, &options.is_wall, NULL, "the clock's time with one thread too", 0, 0}, {0}};

static const struct cli_tool tool = {.name = "bench_step",
	.operands = "",
	.summary = "Time a training step.",
	.options = table,
	.common = CLI_JSON};

/* A scene, its sentences and one view, all made. */
struct problem {
	size_t gaussians;
	struct refer_layout layout;
	struct train_state state;
	float *position, *text;
	int64_t *offsets;
	int *objects;
	struct view_weights view;
	uint8_t *mask;
	size_t *others; /* sentences in the order in which the contrast takes them */
};

/* Seconds of every repeat, phase by phase. */
struct result {
	int threads;
	double *times[TIMES]; /* (repeats), sorted */
};

struct watch {
	clockid_t clock;
	double last, spent[STEP_PHASES];
};

static void ended(void *data, enum step_phase phase)
{
	struct watch *w = data;
	const double time = clock_seconds(w->clock);

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
static struct view_weights make_view(
	struct rng *r, size_t gaussians, size_t width, size_t height, size_t mean)
{
	const size_t pixels = width * height, across = (width + PATCH - 1) / PATCH,
		     down = (height + PATCH - 1) / PATCH;
	int64_t *indptr = need(pixels + 1, sizeof *indptr);
	int32_t *index = need(pixels * 2 * mean, sizeof *index), *base = need(across * down, sizeof *base);
	float *weight = need(pixels * 2 * mean, sizeof *weight);
	const uint32_t near = gaussians < NEAR ? (uint32_t)gaussians : NEAR;

	for (size_t i = 0; i < across * down; i++)
		base[i] = (int32_t)rng_below(r, (uint32_t)gaussians - near + 1);
	for (size_t p = 0; p < pixels; p++) {
		const int32_t from = base[p / width / PATCH * across + p % width / PATCH];
		const int64_t count = 1 + rng_below(r, 2 * (uint32_t)mean - 1);
		for (int64_t k = 0; k < count; k++) {
			index[indptr[p] + k] = from + (int32_t)rng_below(r, near);
			weight[indptr[p] + k] = (float)(rng_uniform(r) / (double)count);
		}
		indptr[p + 1] = indptr[p] + count;
	}
	free(base);
	return (struct view_weights){pixels, gaussians, indptr, index, weight};
}

static void problem_make(struct problem *p, size_t gaussians)
{
	const size_t sentences = (size_t)options.sentences, words = (size_t)options.words,
		     width = (size_t)options.size[0];
	struct rng r;
	struct err e;

	rng_seed(&r, 1, 1);
	p->gaussians = gaussians;
	refer_layout_init(&p->layout, REFER_PCMI, TEXT, FEATURE);
	if (train_state_init(&p->state, &p->layout, gaussians, 1, &e)) {
		fprintf(stderr, "bench_step: %s\n", e.message);
		exit(4);
	}
	float *x = uniform(&r, gaussians * FEATURE, 1);
	panels_pack(x, gaussians, FEATURE, train_state_x(&p->state));
	free(x);
	p->offsets = need(sentences + 1, sizeof *p->offsets);
	p->objects = need(sentences, sizeof *p->objects);
	for (size_t i = 0; i < sentences; i++) {
		p->offsets[i + 1] = (int64_t)((i + 1) * words);
		p->objects[i] = (int)i / PER_OBJECT;
	}
	p->position = uniform(&r, gaussians * 3, 1);
	p->text = uniform(&r, sentences * words * TEXT, 0.1f);
	p->view = make_view(&r, gaussians, width, (size_t)options.size[1], (size_t)options.weights);
	p->mask = need(bits_bytes(p->view.pixels), 1);
	for (size_t i = 0; i < p->view.pixels; i++)
		p->mask[i / 8] |= (uint8_t)((i % width < width / 5) << i % 8);
	p->others = need(sentences, sizeof *p->others);
	for (size_t i = 0; i < sentences; i++)
		p->others[i] = sentences - 1 - i;
}

static void problem_free(struct problem *p)
{
	train_state_free(&p->state);
	free((void *)p->view.indptr);
	free((void *)p->view.index);
	free((void *)p->view.weight);
	free(p->position);
	free(p->text);
	free(p->offsets);
	free(p->objects);
	free(p->mask);
	free(p->others);
}

/* Multiplications with an addition that the mathematics asks for, folded. */
static double work(const struct problem *p, enum step_phase phase)
{
	const double n = (double)p->gaussians, batch = (double)options.batch, own = (double)options.words;
	const double others = (double)options.negatives, chosen = (double)options.sentences;
	const double all = own * (others > 0 ? fmin(others + PER_OBJECT, chosen) : chosen),
		     nnz = (double)p->view.indptr[p->view.pixels];
	const double g = BLOCK_G, z = g + own, scores = batch * own * g, feature = FEATURE * 32 + 32 * 64,
		     position = 3 * 16 + 16 * 64, text0 = 512.0 * TEXT, text1 = 512.0 * 256;
	const int is_cosine = options.similarity == REFER_COSINE;

	switch (phase) {
	case STEP_WORDS:
		return all * (2 * text0 + 3 * text1);
	case STEP_HIDDEN:
		return n * (feature + position + 2 * scores);
	case STEP_RESPOND:
		return n * (2 * scores + batch * (is_cosine ? z * (z + 1) / 2 + z : z));
	case STEP_IMAGES:
		return 2 * batch * nnz;
	case STEP_SCORES_BACK:
		return n * (2 * scores + batch * (is_cosine ? z * z + z * (z + 1) / 2 + 3 * z : z + 2 * own));
	case STEP_HIDDEN_BACK:
		return n * (6 * scores + FEATURE * 32 + 2 * feature + 2 * 16 * 64 + 2 * 3 * 16 +
				   (is_cosine ? 0 : 2 * batch * g));
	default:
		return 0;
	}
}

static int ascending(const void *a, const void *b)
{
	const double x = *(const double *)a, y = *(const double *)b;

	return (x > y) - (x < y);
}

static struct result measure(struct problem *p, int threads)
{
	const int repeats = (int)options.repeats, batch = (int)options.batch;
	const struct step_setup setup = {.layout = &p->layout,
		.similarity = (enum refer_similarity)options.similarity,
		.contrast = REFER_CONTRAST_COSINE,
		.temperature = 0.1,
		.lambda = 0.02,
		.gaussians = p->gaussians,
		.position = p->position,
		.sentences = (size_t)options.sentences,
		.offsets = p->offsets,
		.words = p->text,
		.objects = p->objects,
		.pixels = p->view.pixels,
		.batch = batch};
	struct watch w = {
		.clock = threads == 1 && !options.is_wall ? CLOCK_PROCESS_CPUTIME_ID : CLOCK_MONOTONIC};
	struct result r = {.threads = threads};
	struct step_target targets[64];
	struct err e;

	omp_set_num_threads(threads);
	struct step *s = step_new(&setup, &e);
	if (!s) {
		fprintf(stderr, "bench_step: %s\n", e.message);
		exit(4);
	}
	const int is_sampled = options.negatives > 0 && options.negatives < options.sentences;
	const struct step_others others = {p->others, (size_t)options.negatives};
	step_watch(s, ended, &w);
	for (int t = 0; t < TIMES; t++)
		r.times[t] = need((size_t)repeats, sizeof(double));
	for (int i = -1; i < repeats; i++) { /* the first warms up */
		for (int k = 0; k < batch; k++)
			targets[k] = (struct step_target){
				(size_t)((i + 1) * batch + k) % (size_t)options.sentences, p->mask};
		memset(w.spent, 0, sizeof w.spent);
		const double start = w.last = clock_seconds(w.clock);
		step_run(s, p->state.values, train_state_x(&p->state), &p->view, targets, batch,
			contrast_top_count(0, p->gaussians), is_sampled ? &others : NULL, p->state.gradient,
			p->state.gradient + p->state.parameters);
		const double middle = clock_seconds(w.clock);
		train_adam(&p->state, &(struct train_rates){2.5e-3, 1e-4});
		const double end = clock_seconds(w.clock);
		if (i < 0)
			continue;
		for (int t = 0; t < STEP_PHASES; t++)
			r.times[t][i] = w.spent[t];
		r.times[ADAM][i] = end - middle;
		r.times[STEP][i] = end - start;
	}
	for (int t = 0; t < TIMES; t++)
		qsort(r.times[t], (size_t)repeats, sizeof(double), ascending);
	step_free(s);
	return r;
}

static double median(const double *sorted)
{
	const long long n = options.repeats;

	return (sorted[(n - 1) / 2] + sorted[n / 2]) / 2;
}

static double whole_work(const struct problem *p)
{
	double all = 0;

	for (enum step_phase phase = 0; phase < STEP_PHASES; phase++)
		all += work(p, phase);
	return all;
}

static void print_table(const struct problem *p, const struct result *r, double peak)
{
	printf("\n%zu Gaussians, %lld words, %d of %lld sentences, %d x %d pixels, %lld weights, %s, %d thread%s "
	       "(%s, %.0f GFLOP/s each)\n",
		p->gaussians, options.words, (int)options.batch, options.sentences, options.size[0],
		options.size[1], (long long)p->view.indptr[p->view.pixels],
		refer_similarity_name((enum refer_similarity)options.similarity), r->threads,
		r->threads == 1 ? "" : "s", block_select(NULL)->name, 2e-9 * peak);
	for (int t = 0; t < TIMES; t++) {
		const double seconds = r->times[t][0];
		const double madds = t == STEP ? whole_work(p) : t < ADAM ? work(p, (enum step_phase)t) : 0;
		printf("%-14s %8.2f ms", names[t], 1e3 * seconds);
		if (madds > 0)
			printf(" %8.1f GFLOP/s %5.0f %%", 2e-9 * madds / seconds,
				100 * madds / seconds / peak / r->threads);
		printf("\n");
	}
}

static void print_json(const struct problem *p, const struct result *r, double peak)
{
	const double seconds = median(r->times[STEP]), rate = 2e-9 * whole_work(p) / seconds,
		     top = 2e-9 * peak * r->threads;

	printf("{\"bench\":\"step\",\"gaussians\":%zu,\"words\":%lld,\"sentences\":%lld,\"negatives\":%lld,\"batch\":%lld,"
	       "\"pixels\":%zu,\"weights\":%lld,\"threads\":%d,\"similarity\":\"%s\",\"kernels\":\"%s\","
	       "\"repeats\":%lld,\"ms\":%.4f,\"min_ms\":%.4f,\"phases\":{",
		p->gaussians, options.words, options.sentences, options.negatives, options.batch,
		p->view.pixels, (long long)p->view.indptr[p->view.pixels], r->threads,
		refer_similarity_name((enum refer_similarity)options.similarity), block_select(NULL)->name,
		options.repeats, 1e3 * seconds, 1e3 * r->times[STEP][0]);
	for (int t = 0; t < STEP; t++)
		printf("%s\"%s\":%.4f", t ? "," : "", names[t], 1e3 * median(r->times[t]));
	printf("},\"gflops\":%.2f,\"peak_gflops\":%.2f,\"share_of_peak\":%.4f}\n", rate, top, rate / top);
	fflush(stdout);
}

/* "N,N,..." into out (LIST). Returns how many. */
static int numbers(const struct cli *c, const char *option, const char *text, long long most, long long *out)
{
	int count = 0;

	for (const char *at = text; *at || at == text;) {
		char *end;
		const long long value = strtoll(at, &end, 10);
		if (end == at || (*end && *end != ',') || value < 1 || value > most || count == LIST)
			cli_usage(c, "--%s wants at most %d numbers from 1 to %lld, not '%s'", option, LIST,
				most, text);
		out[count++] = value;
		at = end + (*end == ',');
	}
	return count;
}

int main(int argc, char **argv)
{
	long long sizes[LIST], threads[LIST];
	int thread_count = 0;
	struct cli c;

	cli_parse(&c, &tool, argc, argv);
	if (options.batch * options.words > BLOCK_WORDS)
		cli_usage(&c, "a step takes at most %d words", BLOCK_WORDS);
	const int size_count = numbers(&c, "gaussians", options.gaussians, 1 << 26, sizes);
	if (options.threads)
		thread_count = numbers(&c, "threads", options.threads, 1024, threads);
	else
		for (int t = 1; t <= omp_get_max_threads(); t *= 2)
			threads[thread_count++] = t;
	const double peak = measure_peak();
	for (int i = 0; i < size_count; i++) {
		struct problem p;
		problem_make(&p, (size_t)sizes[i]);
		for (int t = 0; t < thread_count; t++) {
			struct result r = measure(&p, (int)threads[t]);
			(c.json ? print_json : print_table)(&p, &r, peak);
			for (int k = 0; k < TIMES; k++)
				free(r.times[k]);
		}
		problem_free(&p);
	}
	return 0;
}
