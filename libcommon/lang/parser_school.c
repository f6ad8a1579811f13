#include "lang/parser_school.h"

#include "base/mem.h"

#include <stdlib.h>
#include <string.h>

/* Sentences in a step and the rates of both parts: first guesses, not searched. How many examples there are
 * for each reading, and the share of units dropped: of few tried values those that took the most of other
 * writers' marked sentences apart rightly. */
enum { SCHOOL_BATCH = 16, SHARE = 3 };
static const double examples_rate = 0.002, readings_rate = 0.001, dropout = 0.4;
/* passes of a round, and of the last */
enum { ROUND_EPOCHS = 4, LAST_EPOCHS = 6 };

static struct parser_course course_of(const struct parser_school *s, int epochs, double rate)
{
	return (struct parser_course){epochs, SCHOOL_BATCH, rate, dropout, s->progress, s->context};
}

/* Adds the marked sentences. Returns how many samples the set has then. */
static size_t add_marked(const struct parser_school *s, const struct parser_sample **set, size_t n)
{
	for (size_t i = 0; i < s->marked_count; i++)
		if (s->marked[i].n)
			set[n++] = &s->marked[i];
	return n;
}

int parser_school_examples(const struct parser_school *s, struct parser_weights *w, struct err *e)
{
	struct parser_course course = course_of(s, s->epochs, examples_rate);
	const struct parser_sample **set =
		mem_alloc(s->example_count + s->marked_count, sizeof *set, "samples", e);
	struct rng r;
	size_t n = 0;
	int bad;

	if (!set)
		return -1;
	rng_seed(&r, s->seed, 7);
	parser_weights_begin(w, &r);
	for (size_t i = 0; i < s->example_count; i++)
		if (s->examples[i].n)
			set[n++] = &s->examples[i];
	n = add_marked(s, set, n);
	bad = parser_learn(w, set, n, &course, &r, e);
	free(set);
	return bad;
}

/* What the readings say, in words, by the weights as they are. */
static int align(const struct parser_school *s, const struct parser_weights *w, struct err *e)
{
	struct parser_batch b;
	struct tokens *t = mem_alloc(1, sizeof *t, "words", e);
	struct analysis a;
	int bad = !t || parser_batch_make(&b, TOKENS_MOST, 1, w, e);

	for (size_t i = 0; i < s->read_count && !bad; i++) {
		struct parser_sample *x = &s->read[i];
		if (!x->n)
			continue;
		tokens_take(t, s->texts[i], s->pieces[i], NULL, 0);
		parser_batch_clear(&b);
		parser_batch_add(&b, x->features, x->vectors, x->n, w->width);
		parser_forward(w, &b);
		reading_align(s->readings[i], w, &b, 0, t, &a);
		memcpy(x->right, a.word, sizeof *x->right * (size_t)x->n);
	}
	if (!bad)
		parser_batch_free(&b);
	free(t);
	return bad ? -1 : 0;
}

int parser_school_readings(
	const struct parser_school *s, struct parser_weights *w, int without, struct err *e)
{
	const struct parser_sample **set =
		mem_alloc(s->example_count + s->read_count + s->marked_count, sizeof *set, "samples", e);
	struct rng r;
	int bad = !set;

	rng_seed(&r, s->seed, 8);
	for (int k = 0; k < s->rounds && s->read_count && !bad; k++) {
		struct parser_course course =
			course_of(s, k + 1 == s->rounds ? LAST_EPOCHS : ROUND_EPOCHS, readings_rate);
		size_t n = 0;
		bad = align(s, w, e);
		for (size_t i = 0; i < s->read_count; i++)
			if (s->read[i].n && s->fold[i] != without)
				set[n++] = &s->read[i];
		/* another part of the examples each round, SHARE for each reading: people who speak of
		 * rooms seldom deny or count, and speak otherwise than of what lies on a table */
		for (size_t i = 0; i < s->example_count && i < SHARE * s->read_count; i++) {
			const struct parser_sample *x =
				&s->examples[(i + (size_t)k * SHARE * s->read_count) % s->example_count];
			if (x->n)
				set[n++] = x;
		}
		n = add_marked(s, set, n);
		if (!bad)
			bad = parser_learn(w, set, n, &course, &r, e);
	}
	free(set);
	return bad ? -1 : 0;
}

void parser_school_blind(struct parser_school *s)
{
	for (size_t i = 0; i < s->example_count; i++)
		parser_features_blank(s->examples[i].features, s->examples[i].n);
	for (size_t i = 0; i < s->marked_count; i++)
		parser_features_blank(s->marked[i].features, s->marked[i].n);
	for (size_t i = 0; i < s->read_count; i++)
		parser_features_blank(s->read[i].features, s->read[i].n);
}

void parser_school_free(struct parser_school *s)
{
	for (size_t i = 0; s->examples && i < s->example_count; i++)
		parser_sample_free(&s->examples[i]);
	for (size_t i = 0; s->marked && i < s->marked_count; i++)
		parser_sample_free(&s->marked[i]);
	for (size_t i = 0; s->read && i < s->read_count; i++)
		parser_sample_free(&s->read[i]);
	free(s->examples);
	free(s->marked);
	free(s->read);
	free(s->readings);
	free(s->fold);
}
