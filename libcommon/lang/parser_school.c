#include "lang/parser_school.h"

#include "base/mem.h"

#include <stdlib.h>
#include <string.h>

/* Sentences in a step and the rates of both parts: first guesses, not searched. How many examples there are
 * for each reading, and the share of units dropped: of few tried values those that took the most of other
 * writers' marked sentences apart rightly. */
enum { SCHOOL_BATCH = 16, SHARE = 3 };
static const double examples_rate = 0.002, readings_rate = 0.001, dropout = 0.33, dropout_state = 0.2;
/* passes of a round, and of the last */
enum { ROUND_EPOCHS = 4, LAST_EPOCHS = 6 };

/* One network among those that learn. */
struct pupil {
	const struct parser_school *school;
	struct parser_weights *weights;
	int member, without;
	struct rng rng;
	struct parser_sample *read; /* as the school's, with `right` as this network finds it */
};

static struct parser_course course_of(const struct pupil *p, int epochs, double rate)
{
	const struct parser_school *s = p->school;

	return (struct parser_course){
		epochs, SCHOOL_BATCH, rate, dropout, dropout_state, p->member, s->progress, s->context};
}

static unsigned long long seed_of(const struct pupil *p)
{
	return p->school->seed + (unsigned long long)p->member * 1000;
}

/* Adds the marked sentences. Returns how many samples the set has then. */
static size_t add_marked(const struct parser_school *s, const struct parser_sample **set, size_t n)
{
	for (size_t i = 0; i < s->marked_count; i++)
		if (s->marked[i].n)
			set[n++] = &s->marked[i];
	return n;
}

static int learn_examples(struct pupil *p, struct err *e)
{
	const struct parser_school *s = p->school;
	struct parser_course course = course_of(p, s->epochs, examples_rate);
	const struct parser_sample **set =
		mem_alloc(s->example_count + s->marked_count, sizeof *set, "samples", e);
	size_t n = 0;
	int bad;

	if (!set)
		return -1;
	rng_seed(&p->rng, seed_of(p), 7);
	parser_weights_begin(p->weights, &p->rng);
	for (size_t i = 0; i < s->example_count; i++)
		if (s->examples[i].n)
			set[n++] = &s->examples[i];
	n = add_marked(s, set, n);
	bad = parser_learn(p->weights, set, n, &course, &p->rng, e);
	free(set);
	return bad;
}

/* What the readings say, in words, by the weights as they are. */
static int align(struct pupil *p, struct err *e)
{
	const struct parser_school *s = p->school;
	struct parser_batch b;
	struct tokens *t = mem_alloc(1, sizeof *t, "words", e);
	struct analysis a;
	int bad = !t || parser_batch_make(&b, TOKENS_MOST, 1, p->weights, e);

	for (size_t i = 0; i < s->read_count && !bad; i++) {
		struct parser_sample *x = &p->read[i];
		if (!x->n)
			continue;
		tokens_take(t, s->texts[i], s->pieces[i], NULL, 0);
		parser_batch_clear(&b);
		parser_batch_add(&b, x->features, x->vectors, x->n, p->weights->width);
		parser_forward(p->weights, &b);
		reading_align(s->readings[i], p->weights, &b, 0, t, &a);
		memcpy(x->right, a.word, sizeof *x->right * (size_t)x->n);
	}
	if (!bad)
		parser_batch_free(&b);
	free(t);
	return bad ? -1 : 0;
}

/* p->read, of which only `right` is its own. */
static int copy_read(struct pupil *p, struct err *e)
{
	const struct parser_school *s = p->school;

	p->read = mem_zalloc(s->read_count, sizeof *p->read, "samples", e);
	if (!p->read)
		return -1;
	for (size_t i = 0; i < s->read_count; i++) {
		p->read[i] = s->read[i];
		p->read[i].right = mem_zalloc((size_t)s->read[i].n, sizeof *s->read[i].right, "samples", e);
		if (!p->read[i].right)
			return -1;
	}
	return 0;
}

static void free_read(struct pupil *p)
{
	for (size_t i = 0; p->read && i < p->school->read_count; i++)
		free(p->read[i].right);
	free(p->read);
	p->read = NULL;
}

static int learn_readings(struct pupil *p, struct err *e)
{
	const struct parser_school *s = p->school;
	const struct parser_sample **set =
		mem_alloc(s->example_count + s->read_count + s->marked_count, sizeof *set, "samples", e);
	int bad = !set || copy_read(p, e);

	rng_seed(&p->rng, seed_of(p), 8);
	for (int k = 0; k < s->rounds && s->read_count && !bad; k++) {
		struct parser_course course =
			course_of(p, k + 1 == s->rounds ? LAST_EPOCHS : ROUND_EPOCHS, readings_rate);
		size_t n = 0;
/* one at a time: WordNet, which words are looked up in, has buffers of its own */
#pragma omp critical(school_align)
		bad = align(p, e);
		for (size_t i = 0; i < s->read_count; i++)
			if (p->read[i].n && s->fold[i] != p->without)
				set[n++] = &p->read[i];
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
			bad = parser_learn(p->weights, set, n, &course, &p->rng, e);
	}
	free(set);
	free_read(p);
	return bad ? -1 : 0;
}

/* Each member does so by itself, so that the number of threads changes nothing. */
static int each_member(const struct parser_school *s, struct parser_weights *w, int without,
	int (*learn)(struct pupil *p, struct err *e), struct err *e)
{
	struct pupil pupils[PARSER_MEMBERS];
	struct err errors[PARSER_MEMBERS] = {{0}};
	int n = 0, bad = 0;

	for (struct parser_weights *next; w && n < PARSER_MEMBERS; w = next, n++) {
		next = w->next;
		pupils[n] = (struct pupil){.school = s, .weights = w, .member = n, .without = without};
		w->next = NULL; /* learns alone */
	}
#pragma omp parallel for schedule(dynamic) reduction(| : bad)
	for (int k = 0; k < n; k++)
		bad |= learn(&pupils[k], &errors[k]) != 0;
	for (int k = 0; k < n; k++)
		pupils[k].weights->next = k + 1 < n ? pupils[k + 1].weights : NULL;
	for (int k = n; k-- > 0;)
		if (errors[k].message[0])
			*e = errors[k];
	return bad ? -1 : 0;
}

int parser_school_examples(const struct parser_school *s, struct parser_weights *w, struct err *e)
{
	return each_member(s, w, -1, learn_examples, e);
}

int parser_school_readings(
	const struct parser_school *s, struct parser_weights *w, int without, struct err *e)
{
	return s->read_count ? each_member(s, w, without, learn_readings, e) : 0;
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
