/* Learns the weights of text-parse: from the project's own example sentences, and readings of others if
 * given. */
#include "base/file.h"
#include "base/mem.h"
#include "cli/cli.h"
#include "formats/jsonl.h"
#include "formats/parser_weights.h"
#include "formats/parses.h"
#include "formats/readings.h"
#include "formats/text.h"
#include "lang/examples.h"
#include "lang/parser.h"
#include "lang/parser_school.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct options {
	long long write, epochs, rounds, folds;
	const char *readings, *readings_text, *source;
	int test, no_grammar;
};

struct training {
	const struct cli *c;
	const struct options *o;
	struct text examples, others;
	struct reading_set readings;
	struct parser_school school;
};

static int write_examples(const struct cli *c, long long n, int test, struct err *e)
{
	struct file_out out = {0};
	struct rng r;
	int bad = file_out_open(&out, c->output, e);
	static struct example x;

	rng_seed(&r, (uint64_t)c->seed, (uint64_t)test);
	for (long long i = 0; i < n && !bad; i++) {
		example_make(&x, test ? EXAMPLES_TEST : EXAMPLES_TRAIN, NULL, &r);
		fprintf(out.stream, "{\"ref\":\"e%lld\",\"object\":\"example\"", i);
		bad = jsonl_put_string(out.stream, ",\"text\":", x.text, e);
		fprintf(out.stream, ",\"split\":\"%s\"}\n", test ? "test" : "train");
	}
	if (bad)
		file_out_abort(&out);
	return bad ? -1 : file_out_commit(&out, e);
}

/* The vectors of sentence r. */
static const float *vectors_of(const struct text *t, size_t r, int *count)
{
	*count = (int)(t->offsets[r + 1] - t->offsets[r]);
	return t->words + (size_t)t->offsets[r] * (size_t)t->width;
}

/* Makes the examples again, to have their analyses. */
static int take_examples(struct training *s, const char *path, struct err *e)
{
	static struct example x;
	struct rng r;

	rng_seed(&r, (uint64_t)s->c->seed, 0);
	s->school.examples = mem_zalloc(s->examples.n, sizeof *s->school.examples, "samples", e);
	if (!s->school.examples)
		return -1;
	s->school.example_count = s->examples.n;
	for (size_t i = 0; i < s->examples.n; i++) {
		int count;
		const float *v = vectors_of(&s->examples, i, &count);
		example_make(&x, EXAMPLES_TRAIN, s->examples.pieces ? s->examples.pieces[i] : NULL, &r);
		if (!s->examples.pieces || strcmp(x.text, s->examples.texts[i]) != 0)
			return err_set(e, ERR_FORMAT,
				"%s: ref '%s': not what parse-train --write makes with --seed %lld", path,
				s->examples.refs[i], s->c->seed);
		if (parser_sample_make(
			    &s->school.examples[i], &x.tokens, &x.analysis, v, count, s->examples.width, e))
			return -1;
	}
	return 0;
}

static int take_readings(struct training *s, struct err *e)
{
	static struct tokens t;
	struct parser_school *c = &s->school;
	size_t n = s->others.n;

	c->read = mem_zalloc(n, sizeof *c->read, "samples", e);
	c->readings = mem_zalloc(n, sizeof *c->readings, "samples", e);
	c->fold = mem_zalloc(n, sizeof *c->fold, "samples", e);
	if (!c->read || !c->readings || !c->fold)
		return -1;
	if (!s->others.pieces || s->others.width != s->examples.width)
		return err_set(e, ERR_FORMAT, "%s: not encoded as the examples are", s->o->readings_text);
	c->read_count = n;
	c->texts = s->others.texts;
	c->pieces = s->others.pieces;
	for (size_t i = 0; i < n; i++) {
		const struct reading_record *r = readings_find(&s->readings, s->others.refs[i]);
		int count;
		const float *v = vectors_of(&s->others, i, &count);
		if (!r)
			return err_set(e, ERR_FORMAT, "%s: no reading of ref '%s'", s->o->readings,
				s->others.refs[i]);
		c->readings[i] = &r->reading;
		c->fold[i] = readings_fold(r, s->o->folds);
		tokens_take(&t, c->texts[i], c->pieces[i], NULL, 0);
		if (parser_sample_make(&c->read[i], &t, NULL, v, count, s->others.width, e))
			return -1;
	}
	return 0;
}

static void say(void *context, int epoch, double loss)
{
	cli_note(context, 1, "epoch %d: loss %.4f", epoch + 1, loss);
}

static int put_parses(
	const struct training *s, const struct parser_weights *w, int fold, FILE *out, struct err *e)
{
	const struct parser parser = {.weights = w, .is_blind = s->o->no_grammar};

	for (size_t i = 0; i < s->others.n; i++) {
		struct parse p;
		struct parser_vectors v = {.pieces = s->others.pieces[i], .width = s->others.width};
		if (s->school.fold[i] != fold)
			continue;
		v.vectors = vectors_of(&s->others, i, &v.count);
		if (parse_sentence(&p, &parser, s->others.texts[i], &v, e))
			return -1;
		int bad = parses_put(out, s->others.refs[i], s->others.texts[i], &p, e);
		parse_free(&p);
		if (bad)
			return -1;
	}
	return 0;
}

static int cross_validate(struct training *s, struct parser_weights *w, struct err *e)
{
	struct file_out out = {0};
	struct parser_weights begun = {0};
	int bad = file_out_open(&out, s->c->output, e);

	if (!bad)
		bad = parser_school_examples(&s->school, w, e) || parser_weights_make(&begun, w->width, e);
	for (int fold = 0; fold < s->o->folds && !bad; fold++) {
		if (fold)
			memcpy(w->slab, begun.slab, sizeof(float) * w->count);
		else
			memcpy(begun.slab, w->slab, sizeof(float) * w->count);
		bad = parser_school_readings(&s->school, w, fold, e) || put_parses(s, w, fold, out.stream, e);
	}
	parser_weights_free(&begun);
	if (bad)
		file_out_abort(&out);
	return bad ? -1 : file_out_commit(&out, e);
}

static void training_free(struct training *s)
{
	parser_school_free(&s->school);
	text_free(&s->examples);
	text_free(&s->others);
	readings_free(&s->readings);
}

static int run(const struct cli *c, const struct options *o, struct err *e)
{
	struct training s = {.c = c,
		.o = o,
		.school = {.epochs = (int)o->epochs,
			.rounds = (int)o->rounds,
			.seed = (unsigned long long)c->seed,
			.progress = say,
			.context = (void *)c}};
	struct parser_weights w = {0};
	const char *path = c->operand_count ? c->operands[0] : "-";
	int bad;

	bad = text_read(&s.examples, path, e) || take_examples(&s, path, e);
	if (!bad && o->readings)
		bad = readings_read(&s.readings, o->readings, e) ||
		      text_read(&s.others, o->readings_text, e) || take_readings(&s, e);
	if (!bad && o->no_grammar)
		parser_school_blind(&s.school);
	if (!bad)
		bad = parser_weights_make(&w, s.examples.width, e);
	if (!bad)
		bad = o->folds ? cross_validate(&s, &w, e)
			       : parser_school_examples(&s.school, &w, e) ||
					 parser_school_readings(&s.school, &w, -1, e) ||
					 parser_weights_write(&w, c->output, o->readings ? "--readings" : "",
						 c->seed, o->source, e);
	training_free(&s);
	parser_weights_free(&w);
	return bad;
}

int main(int argc, char **argv)
{
	struct options o = {.epochs = 5, .rounds = 2, .source = "the example sentences of refersplat"};
	const struct cli_option options[] = {
		{"write", 0, CLI_INT, &o.write, "N",
			"write N example sentences (JSON Lines) instead of learning", 0, 1e6},
		{"test", 0, CLI_FLAG, &o.test, NULL,
			"with --write: sentences in the wordings kept for testing", 0, 0},
		{"readings", 0, CLI_STRING, &o.readings, "READINGS",
			"learn from these readings too (JSON Lines)", 0, 0},
		{"readings-text", 0, CLI_STRING, &o.readings_text, "TEXT", "their encoded sentences", 0, 0},
		{"epochs", 0, CLI_INT, &o.epochs, "N", "passes over the examples (default 5)", 1, 1000},
		{"rounds", 0, CLI_INT, &o.rounds, "N", "rounds with the readings (default 2)", 0, 100},
		{"folds", 0, CLI_INT, &o.folds, "N",
			"cross-validate: write parses of the readings' sentences, each by weights that saw no sentence of its room",
			0, 100},
		{"no-grammar", 0, CLI_FLAG, &o.no_grammar, NULL,
			"with --folds: the network is not told what the grammar says, for comparison", 0, 0},
		{"source", 0, CLI_STRING, &o.source, "TEXT",
			"what the weights say that they were learnt from", 0, 0},
		{0},
	};
	const struct cli_tool tool = {
		.name = "parse-train",
		.operands = "[TEXT]",
		.summary = "Learn the weights of text-parse from encoded example sentences.",
		.options = options,
		.common = CLI_VERBOSE | CLI_QUIET | CLI_OUTPUT | CLI_SEED | CLI_THREADS,
		.max_operands = 1,
	};
	struct err e = {0};
	struct cli c;
	int bad;

	cli_parse(&c, &tool, argc, argv);
	if (!o.readings != !o.readings_text)
		cli_usage(&c, "--readings and --readings-text go together");
	if (o.folds && !o.readings)
		cli_usage(&c, "--folds needs --readings");
	if (o.no_grammar && !o.folds)
		cli_usage(&c, "--no-grammar needs --folds");
	if (!o.write && !o.folds)
		cli_refuse_terminal(&c);
	bad = o.write ? write_examples(&c, o.write, o.test, &e) : run(&c, &o, &e);
	return bad ? cli_fail(&c, &e) : cli_done(&c);
}
