#include "refer/choose.h"

#include "base/mem.h"
#include "refer/relate.h"
#include "refer/vocabulary.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double words_weight = 3.5, relations_weight = 1.3, sentence_weight = 5, learned = 10;
static const double fit_sharpness = 5, anchor_sharpness = 12;
static const double colour_weight = 0.6, colour_least = 0.05;
static const double known_word = 0.5, known_soft = 0.05, relation_least = 0.02;
static const double absent_match = 0.5, absent_colour = 0.2, absent_relation = 0.3;

int choose_without(const char *list, unsigned *parts, struct list_name *unknown)
{
	static const char *const names[CHOOSE_PARTS] = {
		"words", "names", "alike", "colours", "relations", "sentence"};

	*parts = CHOOSE_ALL;
	while (list_next(&list, unknown)) {
		int p = 0;
		while (p < CHOOSE_PARTS && !list_name_is(unknown, names[p]))
			p++;
		if (p == CHOOSE_PARTS)
			return -1;
		*parts &= ~(1U << p);
	}
	return 0;
}

/* What all sentences of a call share, and scratch of (O). */
struct chooser {
	const struct lifted *l;
	unsigned parts;
	struct vocabulary vocabulary;
	struct arrangement arrangement;
	double *match, *colour; /* (O) of one word */
	double *anchors;	/* (LANG_ANCHORS,O) */
	double *fit, *judged, *key, *attributes, *relations, *whole;
};

static int has(const struct chooser *c, enum choose_part p)
{
	return c->parts >> p & 1;
}

static double largest(const double *x, size_t n)
{
	double most = -INFINITY;

	for (size_t i = 0; i < n; i++)
		most = fmax(most, x[i]);
	return most;
}

/* log of the sum of exp. */
static double log_sum(const double *x, size_t n)
{
	const double most = largest(x, n);
	double sum = 0;

	if (!isfinite(most))
		return most;
	for (size_t i = 0; i < n; i++)
		sum += exp(x[i] - most);
	return most + log(sum);
}

/* x becomes exp(sharpness (x - max x)). */
static void sharpen(double *x, size_t n, double sharpness)
{
	const double most = largest(x, n);

	for (size_t i = 0; i < n; i++)
		x[i] = exp(sharpness * (x[i] - most));
}

/* attributes (O): A of a phrase's words. Returns how much better a thing would match that is not there. */
static double match_phrase(struct chooser *c, const struct lang_sentence *s, const struct lang_phrase *p,
	const float *vectors, double *attributes)
{
	const size_t objects = c->l->objects;
	double absent = 0;

	memset(attributes, 0, objects * sizeof *attributes);
	for (int i = 0; i < p->n; i++) {
		const struct lang_word *w = &s->words[p->words[i]];
		if (has(c, CHOOSE_WORDS) || has(c, CHOOSE_NAMES)) {
			vocabulary_match(&c->vocabulary, w, vectors, has(c, CHOOSE_WORDS),
				has(c, CHOOSE_NAMES), has(c, CHOOSE_ALIKE) ? &c->arrangement : NULL,
				c->match);
			double best = largest(c->match, objects);
			for (size_t o = 0; o < objects; o++)
				attributes[o] += c->match[o] - best;
			absent += absent_match - best;
		}
		if (has(c, CHOOSE_COLOURS) && vocabulary_colour(&c->arrangement, w, c->colour)) {
			double best = log(colour_least + largest(c->colour, objects));
			for (size_t o = 0; o < objects; o++)
				attributes[o] += colour_weight * (log(colour_least + c->colour[o]) - best);
			absent += colour_weight * (log(colour_least + absent_colour) - best);
		}
	}
	return absent;
}

/* anchors (O): how likely each object is to be meant by an anchor. Returns whether it is known at all. */
static double find_anchor(struct chooser *c, const struct lang_sentence *s, const struct lang_phrase *p,
	const float *vectors, double *anchors)
{
	const size_t objects = c->l->objects;
	double sum = 0, known = 1;

	match_phrase(c, s, p, vectors, anchors);
	if (has(c, CHOOSE_WORDS) || has(c, CHOOSE_NAMES)) {
		vocabulary_match(&c->vocabulary, &s->words[p->words[p->n - 1]], vectors, has(c, CHOOSE_WORDS),
			has(c, CHOOSE_NAMES), NULL, c->match);
		known = 1 / (1 + exp(-(largest(c->match, objects) - known_word) / known_soft));
	}
	sharpen(anchors, objects, anchor_sharpness);
	for (size_t o = 0; o < objects; o++)
		sum += anchors[o];
	for (size_t o = 0; o < objects; o++)
		anchors[o] /= sum;
	return known;
}

/* relations (O): R. fit (O) is how well the objects fit the target's words. */
static void relate_all(struct chooser *c, const struct lang_sentence *s, const float *vectors)
{
	const size_t objects = c->l->objects;

	memset(c->relations, 0, objects * sizeof *c->relations);
	for (int i = 0; i < s->clause_count; i++) {
		const struct lang_clause *clause = &s->clauses[i];
		double known = 1;
		for (int k = 0; k < clause->anchor_count; k++)
			known *= find_anchor(
				c, s, &clause->anchors[k], vectors, c->anchors + (size_t)k * objects);
		relate(&c->arrangement, clause->relation, c->anchors, clause->anchor_count, c->fit, c->key,
			c->judged);
		for (size_t o = 0; o < objects; o++)
			c->relations[o] += log(known * c->judged[o] + (1 - known) / 2 + relation_least);
	}
}

/* score (O) of a sentence, and *absent that of its meaning none of them. */
static void score(struct chooser *c, const struct choose_sentence *from, double *score, double *absent)
{
	const size_t objects = c->l->objects;
	struct lang_sentence s;
	double share = 1;

	memset(score, 0, objects * sizeof *score);
	*absent = -INFINITY;
	if (from->pieces) {
		lang_sentence_read(&s, from->pieces);
		share = s.all.n ? (double)s.target.n / s.all.n : 0;
		*absent = words_weight * match_phrase(c, &s, &s.target, from->vectors, c->attributes);
		memcpy(c->fit, c->attributes, objects * sizeof *c->fit);
		sharpen(c->fit, objects, fit_sharpness);
		for (size_t o = 0; o < objects; o++)
			score[o] = words_weight * c->attributes[o];
		if (has(c, CHOOSE_RELATIONS)) {
			relate_all(c, &s, from->vectors);
			for (size_t o = 0; o < objects; o++)
				score[o] += relations_weight * c->relations[o];
			*absent += relations_weight * s.clause_count * log(absent_relation + relation_least);
		}
		*absent -= log_sum(score, objects);
	}
	if (has(c, CHOOSE_SENTENCE)) {
		size_t same = vocabulary_sentence(
			&c->vocabulary, from->pieces, from->vectors, from->words, c->whole);
		for (size_t o = 0; o < objects; o++)
			score[o] += sentence_weight * share * c->whole[o] + learned * (same == o);
		if (same < objects)
			*absent = -INFINITY;
	}
}

static int chooser_init(struct chooser *c, const struct choose_scene *s, unsigned parts, struct err *e)
{
	const size_t objects = s->lifted->objects;

	*c = (struct chooser){.l = s->lifted, .parts = parts};
	if (arrangement_make(&c->arrangement, s->lifted, s->splats, s->cameras, e) ||
		vocabulary_make(&c->vocabulary, s->lifted, e))
		return -1;
	double *scratch = mem_alloc(objects, (8 + LANG_ANCHORS) * sizeof *scratch, "choice", e);
	if (!scratch)
		return -1;
	double **const parts_of[] = {&c->match, &c->colour, &c->fit, &c->judged, &c->key, &c->attributes,
		&c->relations, &c->whole, &c->anchors};
	for (size_t i = 0; i < sizeof parts_of / sizeof *parts_of; i++)
		*parts_of[i] = scratch + i * objects;
	return 0;
}

static void chooser_free(struct chooser *c)
{
	arrangement_free(&c->arrangement);
	vocabulary_free(&c->vocabulary);
	free(c->match);
}

int choose(const struct choose_scene *s, const struct choose_sentence *sentences, size_t n, unsigned parts,
	float *probability, struct err *e)
{
	const size_t objects = s->lifted->objects;
	double *scores = mem_alloc(objects, sizeof *scores, "choice", e), absent;
	struct chooser c = {0};

	if (!scores || chooser_init(&c, s, parts, e)) {
		chooser_free(&c);
		free(scores);
		return -1;
	}
	for (size_t i = 0; i < n; i++) {
		float *row = probability + i * objects;
		memset(row, 0, objects * sizeof *row);
		if (!sentences[i].words || !objects)
			continue;
		score(&c, &sentences[i], scores, &absent);
		const double total = log_sum(scores, objects), there = 1 / (1 + exp(absent));
		for (size_t o = 0; o < objects; o++)
			row[o] = (float)(there * exp(scores[o] - total));
	}
	chooser_free(&c);
	free(scores);
	return 0;
}
