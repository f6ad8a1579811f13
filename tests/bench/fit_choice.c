/* The constants of the choice (libcommon/ask/constants.def) by likelihood.
 *
 *	fit_choice [--rounds N] [--held-out N] DIR...
 *
 * Each DIR is a cell of pipelines/ablation.mk, with scene, lifted/full.safetensors, text/unseen.safetensors
 *and data/unseen.jsonl. Every constant in turn is moved up and down, in ever smaller steps, and keeps what
 *makes the sentences' true answers likelier, less a penalty for leaving the value that it had. Prints the
 *constants that moved, and for the sentences fitted and held out what was gained and how far probabilities
 *can be believed. It is compiled with the room ask, whose constants then vary. */
#include "answer/responses.h"
#include "ask/choose.h"
#include "base/mem.h"
#include "cli/cli.h"
#include "formats/scene/lifted.h"
#include "formats/encoders/parser_weights.h"
#include "formats/scene/scene.h"
#include "formats/records/sentences.h"
#include "formats/scene/text.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define CONSTANT(name, value) double name = value;
#include "ask/constants.def"
#undef CONSTANT

static struct constant {
	const char *name;
	double *value, first;
} constants[] = {
#define CONSTANT(name, value) {#name, &name, value},
#include "ask/constants.def"
#undef CONSTANT
};

enum { CONSTANTS = sizeof constants / sizeof *constants, BINS = 10, CELLS_MOST = 256 };

/* A parse that is misread makes any answer unlikely; so much is left to that. */
#define MISREAD 0.03
/* What a constant loses in log likelihood by going to e times its first value. */
#define STAYING 0.5

struct cell {
	const char *dir;
	struct scene scene;
	struct lifted model;
	struct text text;
	struct origin origin;
	struct sentences truth;
	struct parse *parses; /* (text.n) */
	struct choose_sentence *sentences;
	struct choose_scene about;
	struct chooser *chooser;
	struct choice *choices;
	float *probability;	 /* (n,O) */
	char *chosen, *is_meant; /* (n,O) */
	int is_held_out;
};

/* What a set of cells gives. */
struct tally {
	double likelihood;
	size_t n, right, in_bin[BINS], right_in_bin[BINS];
	double sum_in_bin[BINS];
};

static char *path_in(const char *dir, const char *name)
{
	static char path[4096];

	snprintf(path, sizeof path, "%s/%s", dir, name);
	return path;
}

static void mark_meant(struct cell *c, size_t i)
{
	const struct sentence *s = &c->truth.items[i];
	const size_t n = s->has_objects ? s->object_count : 1;

	for (size_t k = 0; k < n; k++)
		for (size_t o = 0; o < c->model.objects; o++)
			if (!strcmp(c->model.names[o], s->has_objects ? s->objects[k] : s->object))
				c->is_meant[i * c->model.objects + o] = 1;
}

static struct viewpoint viewpoint_of(const struct cell *c, size_t i)
{
	struct viewpoint from = {.kind = VIEWPOINT_USUAL};

	if (c->truth.items[i].view)
		viewpoint_read(&from, c->truth.items[i].view, &c->scene.cameras, c->scene.offset);
	return from;
}

static int read_cell(struct cell *c, const struct parser *parser, struct err *e)
{
	if (scene_read(&c->scene, path_in(c->dir, "scene"), e) ||
		lifted_read(&c->model, &c->origin, path_in(c->dir, "lifted/full.safetensors"), e) ||
		text_read(&c->text, path_in(c->dir, "text/unseen.safetensors"), e) ||
		sentences_read(&c->truth, path_in(c->dir, "data/unseen.jsonl"), e))
		return -1;
	if (c->truth.n != c->text.n)
		return err_set(e, ERR_FORMAT, "%s: text and sentences are not of one file", c->dir);
	const size_t n = c->text.n, cells = n * c->model.objects;
	c->parses = mem_zalloc(n, sizeof *c->parses, "parses", e);
	c->sentences = mem_zalloc(n, sizeof *c->sentences, "sentences", e);
	c->choices = mem_zalloc(n, sizeof *c->choices, "choices", e);
	c->probability = mem_zalloc(cells, sizeof *c->probability, "probabilities", e);
	c->chosen = mem_zalloc(cells, 2, "choices", e);
	if (!c->parses || !c->sentences || !c->choices || !c->probability || !c->chosen)
		return -1;
	c->is_meant = c->chosen + cells;
	c->about = (struct choose_scene){&c->model, &c->scene.splats, &c->scene.cameras, parser, 1, NULL};
	c->chooser = chooser_make(&c->about, CHOOSE_ALL, e);
	if (!c->chooser)
		return -1;
	for (size_t i = 0; i < n; i++) {
		const struct text *t = &c->text;
		const float *vectors = t->words + (size_t)t->offsets[i] * (size_t)t->width;
		const int words = (int)(t->offsets[i + 1] - t->offsets[i]);
		const struct parser_vectors v = {t->pieces[i], text_middle(t, i), words, t->width};
		if (parse_sentence(&c->parses[i], parser, t->texts[i], &v, e))
			return -1;
		c->sentences[i] = (struct choose_sentence){t->texts[i], t->pieces[i], vectors, NULL,
			(size_t)words, viewpoint_of(c, i), &c->parses[i], 0};
		mark_meant(c, i);
	}
	return 0;
}

/* The likelihood of sentence i's true answer. */
static double likelihood(const struct cell *c, size_t i)
{
	const size_t objects = c->model.objects;
	const float *p = c->probability + i * objects;
	const char *meant = c->is_meant + i * objects;
	const double there = c->choices[i].there;
	double of_one = 0, of_set = 1;
	size_t n = 0;

	for (size_t o = 0; o < objects; o++) {
		n += (size_t)meant[o];
		of_one += meant[o] ? (double)p[o] : 0;
		of_set *= meant[o] ? (double)p[o] : 1 - (double)p[o];
	}
	return !n ? 1 - there : there * (n == 1 && !c->choices[i].is_several ? of_one : of_set);
}

/* The probability that the answer is right, as the program has it. */
static double believed(const struct cell *c, size_t i, int is_refused)
{
	const size_t objects = c->model.objects;
	const double there = c->choices[i].there;
	double sum = 0, n = 0;

	for (size_t o = 0; o < objects; o++)
		if (c->chosen[i * objects + o]) {
			sum += (double)c->probability[i * objects + o];
			n++;
		}
	return is_refused ? 1 - there : there * sum / fmax(n, 1);
}

static void count(const struct cell *c, size_t i, struct tally *t)
{
	const size_t objects = c->model.objects;
	const char *chosen = c->chosen + i * objects, *meant = c->is_meant + i * objects;
	const int is_refused = c->choices[i].there < RESPONSES_LEAST;
	const double p = believed(c, i, is_refused);
	const size_t bin = (size_t)fmin(p * BINS, BINS - 1);
	int right = 1;

	for (size_t o = 0; o < objects; o++)
		right &= (chosen[o] && !is_refused) == meant[o];
	t->n++;
	t->right += (size_t)right;
	t->in_bin[bin]++;
	t->right_in_bin[bin] += (size_t)right;
	t->sum_in_bin[bin] += p;
	t->likelihood += log(MISREAD + (1 - MISREAD) * likelihood(c, i));
}

static int evaluate(struct cell *cells, size_t n, int held_out, struct tally *t, struct err *e)
{
	*t = (struct tally){0};
	for (size_t k = 0; k < n; k++) {
		struct cell *c = &cells[k];
		if (c->is_held_out != held_out)
			continue;
		if (choose_with(c->chooser, c->sentences, c->text.n, c->choices, c->probability, c->chosen,
			    NULL, e))
			return -1;
		for (size_t i = 0; i < c->text.n; i++)
			count(c, i, t);
	}
	return 0;
}

static double penalty(void)
{
	double sum = 0;

	for (int k = 0; k < CONSTANTS; k++) {
		const double x = log(*constants[k].value / constants[k].first);
		sum += STAYING * x * x;
	}
	return sum;
}

/* Up or down by a factor; what is a share stays below 1. */
static double moved(const struct constant *c, double factor)
{
	const double x = *c->value;

	return c->first < 1 ? x * factor / (1 - x + x * factor) : x * factor;
}

static int fit(struct cell *cells, size_t n, int rounds, struct err *e)
{
	struct tally t;
	double best;

	if (evaluate(cells, n, 0, &t, e))
		return -1;
	best = t.likelihood - penalty();
	for (int r = 0; r < rounds; r++) {
		const double step = r == 0 ? 1.6 : r == 1 ? 1.3 : 1.15;
		for (int k = 0; k < CONSTANTS; k++)
			for (int way = 0; way < 2; way++) {
				const double was = *constants[k].value;
				*constants[k].value = moved(&constants[k], way ? step : 1 / step);
				if (evaluate(cells, n, 0, &t, e))
					return -1;
				if (t.likelihood - penalty() > best + 0.1) {
					best = t.likelihood - penalty();
					way--; /* and on */
				} else {
					*constants[k].value = was;
				}
			}
		fprintf(stderr, "round %d: log likelihood %.1f\n", r + 1, best);
	}
	return 0;
}

static int report(struct cell *cells, size_t n, int held_out, const char *title, struct err *e)
{
	struct tally t;
	double error = 0;

	if (evaluate(cells, n, held_out, &t, e))
		return -1;
	if (!t.n)
		return 0;
	printf("%s: %zu sentences, right %.1f%%, log likelihood of a sentence %.4f\n", title, t.n,
		100.0 * (double)t.right / (double)t.n, t.likelihood / (double)t.n);
	printf("  believed  answers  mean of belief  right\n");
	for (int b = 0; b < BINS; b++) {
		if (!t.in_bin[b])
			continue;
		const double m = (double)t.in_bin[b], p = t.sum_in_bin[b] / m,
			     r = (double)t.right_in_bin[b] / m;
		printf("  %.1f-%.1f   %7zu  %14.1f  %5.1f\n", (double)b / BINS, (b + 1.0) / BINS, t.in_bin[b],
			100 * p, 100 * r);
		error += m / (double)t.n * fabs(p - r);
	}
	printf("  expected calibration error %.1f%%\n", 100 * error);
	return 0;
}

static int report_all(struct cell *cells, size_t n, const char *when, struct err *e)
{
	char title[64];

	snprintf(title, sizeof title, "fitted, %s", when);
	if (report(cells, n, 0, title, e))
		return -1;
	snprintf(title, sizeof title, "held out, %s", when);
	return report(cells, n, 1, title, e);
}

static int run(struct cell *cells, size_t n, int rounds, struct err *e)
{
	struct parser_weights w = {0};
	struct parser parser = {.weights = &w};

	if (parser_weights_default(&w, e))
		return -1;
	for (size_t k = 0; k < n; k++)
		if (read_cell(&cells[k], &parser, e))
			return -1;
	if (report_all(cells, n, "before", e) || fit(cells, n, rounds, e))
		return -1;
	for (int k = 0; k < CONSTANTS; k++)
		if (*constants[k].value != constants[k].first)
			printf("CONSTANT(%s, %.3g) was %.3g\n", constants[k].name, *constants[k].value,
				constants[k].first);
	return rounds ? report_all(cells, n, "after", e) : 0;
}

int main(int argc, char **argv)
{
	static struct cell cells[CELLS_MOST];
	int rounds = 3, held_out = 0;
	const struct cli_option options[] = {
		{"rounds", 0, CLI_INT, &rounds, "N",
			"times through all constants; 0: only says how good they are", 0, 100},
		{"held-out", 0, CLI_INT, &held_out, "N", "so many of the last folders are not fitted to", 0,
			CELLS_MOST},
		{0},
	};
	const struct cli_tool tool = {.name = "fit_choice",
		.operands = "DIR...",
		.summary = "Fit the constants of the choice to sentences whose answers are known.",
		.options = options,
		.min_operands = 1,
		.max_operands = CELLS_MOST};
	struct err e = {0};
	struct cli c;

	cli_parse(&c, &tool, argc, argv);
	for (int k = 0; k < c.operand_count; k++)
		cells[k] =
			(struct cell){.dir = c.operands[k], .is_held_out = k >= c.operand_count - held_out};
	return run(cells, (size_t)c.operand_count, rounds, &e) ? cli_fail(&c, &e) : cli_done(&c);
}
