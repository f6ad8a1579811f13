#include "cmd/train/parser_training.h"

#include "base/file.h"
#include "base/mem.h"
#include "cmd/train/parser_lessons.h"
#include "formats/encoders/parser_weights.h"
#include "formats/records/parses.h"
#include "formats/records/readings.h"
#include "formats/scene/text.h"
#include "lang/parser.h"
#include "lang/parser_school.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct parser_training {
	const struct parser_training_options *options;
	struct text examples, marked, others;
	struct reading_set readings;
	struct parser_school school;
};

static int check_encoding(
	const struct parser_training *s, const struct text *t, const char *path, struct err *e)
{
	if (!t->middle)
		return err_set(e, ERR_FORMAT, "%s: tensor 'middle' is missing", path);
	if (t->pieces && t->width == s->examples.width)
		return 0;
	return err_set(e, ERR_FORMAT, "%s: not encoded as the examples are", path);
}

static int take_readings(struct parser_training *s, struct err *e)
{
	static struct tokens t;
	struct parser_school *c = &s->school;
	size_t n = s->others.n;

	c->read = mem_zalloc(n, sizeof *c->read, "samples", e);
	c->readings = mem_zalloc(n, sizeof *c->readings, "samples", e);
	c->fold = mem_zalloc(n, sizeof *c->fold, "samples", e);
	if (!c->read || !c->readings || !c->fold)
		return -1;
	c->read_count = n;
	c->texts = s->others.texts;
	c->pieces = s->others.pieces;
	for (size_t i = 0; i < n; i++) {
		const struct reading_record *r = readings_find(&s->readings, s->others.refs[i]);
		int count;
		const float *v = lesson_vectors(&s->others, i, &count);
		if (!r)
			return err_set(e, ERR_FORMAT, "%s: no reading of ref '%s'", s->options->readings,
				s->others.refs[i]);
		c->readings[i] = &r->reading;
		c->fold[i] = readings_fold(r, s->options->folds);
		tokens_take(&t, c->texts[i], c->pieces[i], NULL, 0);
		if (parser_sample_make(&c->read[i], &t, NULL, v, count, s->others.width, e))
			return -1;
	}
	return 0;
}

static void say(void *context, int member, int epoch, double loss)
{
#pragma omp critical
	report_note(context, 1, "network %d, epoch %d: loss %.4f", member + 1, epoch + 1, loss);
}

static int put_parses(
	const struct parser_training *s, const struct parser_weights *w, int fold, FILE *out, struct err *e)
{
	const struct parser parser = {
		.weights = w, .is_blind = s->options->is_blind, .encoder = s->others.encoder.hex};

	for (size_t i = 0; i < s->others.n; i++) {
		struct parse p;
		struct parser_vectors v = {.pieces = s->others.pieces[i], .width = s->others.width};
		if (s->school.fold[i] != fold)
			continue;
		v.vectors = lesson_vectors(&s->others, i, &v.count);
		if (parse_sentence(&p, &parser, s->others.texts[i], &v, e))
			return -1;
		int bad = parses_put(out, s->others.refs[i], s->others.texts[i], &p, e);
		parse_free(&p);
		if (bad)
			return -1;
	}
	return 0;
}

/* Networks of zeros, as many as are asked for. */
static int make_members(struct parser_weights *w, int width, long long members, struct err *e)
{
	if (parser_weights_make(w, width, e))
		return -1;
	for (long long k = 1; k < members; k++, w = w->next) {
		w->next = mem_zalloc(1, sizeof *w->next, "parser's weights", e);
		if (!w->next || parser_weights_make(w->next, width, e))
			return -1;
	}
	return 0;
}

static void copy_members(struct parser_weights *to, const struct parser_weights *from)
{
	for (; to && from; to = to->next, from = from->next)
		memcpy(to->slab, from->slab, sizeof(float) * to->count);
}

/* w: learnt from the examples. */
static int cross_validate(struct parser_training *s, struct parser_weights *w, struct err *e)
{
	struct file_out out = {0};
	struct parser_weights begun = {0};
	int bad = file_out_open(&out, s->options->output, e) ||
		  make_members(&begun, w->width, s->options->members, e);

	if (!bad)
		copy_members(&begun, w);
	for (int fold = 0; fold < s->options->folds && !bad; fold++) {
		copy_members(w, &begun);
		bad = parser_school_readings(&s->school, w, fold, e) || put_parses(s, w, fold, out.stream, e);
	}
	parser_weights_free(&begun);
	return file_out_end(&out, bad, e);
}

static int learn_weights(struct parser_training *s, struct err *e)
{
	const struct parser_training_options *o = s->options;
	struct parser_weights w = {0};
	int bad = make_members(&w, s->examples.width, o->members, e) ||
		  parser_school_examples(&s->school, &w, e);

	if (!bad) {
		memcpy(w.encoder, s->examples.encoder.hex, sizeof w.encoder);
		bad = o->folds ? cross_validate(s, &w, e)
			       : parser_school_readings(&s->school, &w, -1, e) ||
					 parser_weights_write(&w, o->output, o->readings ? "--readings" : "",
						 o->seed, o->source, e);
	}
	parser_weights_free(&w);
	return bad ? -1 : 0;
}

int parser_train(const struct parser_training_options *o, const struct report *to, struct err *e)
{
	struct parser_training s = {.options = o,
		.school = {.epochs = (int)o->epochs,
			.rounds = (int)o->rounds,
			.seed = (unsigned long long)o->seed,
			.progress = say,
			.context = (void *)to}};
	int bad = text_read(&s.examples, o->examples, e) || check_encoding(&s, &s.examples, o->examples, e) ||
		  parser_examples_take(&s.school, &s.examples, o->examples, o->seed, e);

	if (!bad && o->marked)
		bad = text_read(&s.marked, o->marked_text, e) ||
		      check_encoding(&s, &s.marked, o->marked_text, e) ||
		      parser_marked_take(&s.school, o->marked, &s.marked, o->marked_text, e);
	if (!bad && o->readings)
		bad = readings_read(&s.readings, o->readings, e) ||
		      text_read(&s.others, o->readings_text, e) ||
		      check_encoding(&s, &s.others, o->readings_text, e) || take_readings(&s, e);
	if (!bad && o->is_blind)
		parser_school_blind(&s.school);
	bad = bad || learn_weights(&s, e);
	parser_school_free(&s.school);
	text_free(&s.examples);
	text_free(&s.marked);
	text_free(&s.others);
	readings_free(&s.readings);
	return bad ? -1 : 0;
}
