#include "ask/choose.h"

#include "base/mem.h"
#include "ask/relate.h"
#include "ask/vocabulary.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double words_weight = 3.5, relations_weight = 1.6, sentence_weight = 1, learned = 10;
static const double fit_sharpness = 3, anchor_sharpness = 12;
static const double colour_weight = 0.6, colour_least = 0.05, size_weight = 0.6;
static const double known_word = 0.5, known_soft = 0.05, relation_least = 0.02;
/* How well a sentence fits: weights of the match of its head noun, the mean best match of its words, its
 * colours, its relations and how plainly it means one object, by logistic regression on present and absent
 * sentences. */
static const double head_known = 3.2, words_known = 8.9, colours_known = 1, relations_known = 0.9,
		    plainly_known = 1.7;
static const double usual_colour = 0.2, usual_relation = 0.3;
/* Of sentences about what is not there, p is distributed as p^(shape-1); of five sentences, four are about
 * what is. */
static const double absent_shape = 0.25, present_odds = 4;

int choose_without(const char *list, unsigned *parts, struct list_name *unknown)
{
	static const char *const names[CHOOSE_PARTS] = {
		"words", "names", "alike", "colours", "sizes", "relations", "sentence"};

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
	double naming;
	struct vocabulary vocabulary;
	struct arrangement arrangement;
	double *match, *colour; /* (O) of one word */
	double *anchors;	/* (LANG_ANCHORS,O) */
	double *fit, *judged, *key, *attributes, *relations, *whole;
	double *known; /* (R) rising: how well each training sentence fits its object by the others alone */
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

/* attributes (O): A of a phrase's words. */
static void match_phrase(struct chooser *c, const struct lang_sentence *s, const struct lang_phrase *p,
	const float *vectors, double naming, double *attributes)
{
	const size_t objects = c->l->objects;
	memset(attributes, 0, objects * sizeof *attributes);
	for (int i = 0; i < p->n; i++) {
		const struct lang_word *w = &s->words[p->words[i]];
		if (has(c, CHOOSE_WORDS) || has(c, CHOOSE_NAMES)) {
			vocabulary_match(&c->vocabulary, w, vectors, has(c, CHOOSE_WORDS),
				has(c, CHOOSE_NAMES), has(c, CHOOSE_ALIKE) ? &c->arrangement : NULL,
				c->match);
			double best = largest(c->match, objects);
			for (size_t o = 0; o < objects; o++)
				attributes[o] += naming * (c->match[o] - best);
		}
		if (has(c, CHOOSE_COLOURS) && vocabulary_colour(&c->arrangement, w, c->colour)) {
			double best = log(colour_least + largest(c->colour, objects));
			for (size_t o = 0; o < objects; o++)
				attributes[o] += colour_weight * (log(colour_least + c->colour[o]) - best);
		}
		if (has(c, CHOOSE_SIZES) && vocabulary_size(&c->arrangement, w, c->colour)) {
			const double best = largest(c->colour, objects);
			for (size_t o = 0; o < objects; o++)
				attributes[o] += size_weight * (c->colour[o] - best);
		}
	}
}

/* anchors (O): how likely each object is to be meant by an anchor. Returns whether it is known at all. */
static double find_anchor(struct chooser *c, const struct lang_sentence *s, const struct lang_phrase *p,
	const float *vectors, double *anchors)
{
	const size_t objects = c->l->objects;
	double sum = 0, known = 1;

	match_phrase(c, s, p, vectors, 1, anchors);
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

/* Adds to relations (O): R. fit (O) is how well the objects fit the target's words. */
static void relate_all(struct chooser *c, const struct lang_sentence *s, const float *vectors)
{
	const size_t objects = c->l->objects;

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

/* score (O) of a sentence whose pieces are known, by all parts but `sentence`. */
static void score_parts(struct chooser *c, const struct lang_sentence *s, const float *vectors, double *score)
{
	const size_t objects = c->l->objects;

	match_phrase(c, s, &s->target, vectors, c->naming, c->attributes);
	memcpy(c->fit, c->attributes, objects * sizeof *c->fit);
	sharpen(c->fit, objects, fit_sharpness);
	memset(c->relations, 0, objects * sizeof *c->relations);
	if (has(c, CHOOSE_RELATIONS))
		relate_all(c, s, vectors);
	for (size_t o = 0; o < objects; o++)
		score[o] = words_weight * c->attributes[o] + relations_weight * c->relations[o];
}

static size_t best_of(const double *score, size_t n)
{
	size_t best = 0;

	for (size_t o = 1; o < n; o++)
		best = score[o] > score[best] ? o : best;
	return best;
}

/* How well a sentence fits its best object, after score_parts. */
static double fitness(
	struct chooser *c, const struct lang_sentence *s, const float *vectors, const double *score)
{
	const size_t objects = c->l->objects, o = best_of(score, objects);
	double fit = plainly_known * (score[o] - log_sum(score, objects));

	for (int i = 0; i < s->target.n; i++) {
		const struct lang_word *w = &s->words[s->target.words[i]];
		vocabulary_match(&c->vocabulary, w, vectors, has(c, CHOOSE_WORDS), has(c, CHOOSE_NAMES),
			has(c, CHOOSE_ALIKE) ? &c->arrangement : NULL, c->match);
		fit += words_known * largest(c->match, objects) / s->target.n;
		if (s->target.words[i] == s->head)
			fit += head_known * c->match[o];
		if (has(c, CHOOSE_COLOURS) && vocabulary_colour(&c->arrangement, w, c->colour))
			fit += colours_known *
			       log((colour_least + c->colour[o]) / (colour_least + usual_colour));
	}
	if (has(c, CHOOSE_RELATIONS))
		fit += relations_known *
		       (c->relations[o] - s->clause_count * log(usual_relation + relation_least));
	return fit;
}

/* The probability that a sentence of this fitness means anything that was lifted. */
static double presence(const struct chooser *c, double fit)
{
	const size_t n = c->l->sentences;
	size_t below = 0;

	while (below < n && c->known[below] <= fit)
		below++;
	const double p = (double)(below + 1) / (double)(n + 1);
	return present_odds / (present_odds + absent_shape * pow(p, absent_shape - 1));
}

/* score (O) of a sentence. Returns the probability that it means any of them. */
static double score(struct chooser *c, const struct choose_sentence *from, double *score)
{
	const size_t objects = c->l->objects;
	struct lang_sentence s;
	double share = 1, there = 1;

	memset(score, 0, objects * sizeof *score);
	if (from->pieces) {
		lang_sentence_read(&s, from->pieces);
		share = s.all.n ? (double)s.target.n / s.all.n : 0;
		score_parts(c, &s, from->vectors, score);
		if (s.target.n)
			there = presence(c, fitness(c, &s, from->vectors, score));
	}
	if (has(c, CHOOSE_SENTENCE)) {
		size_t same = vocabulary_sentence(
			&c->vocabulary, from->pieces, from->vectors, from->words, c->whole);
		for (size_t o = 0; o < objects; o++)
			score[o] += sentence_weight * share * c->whole[o] + learned * (same == o);
		there = same < objects ? 1 : there;
	}
	return there;
}

static int by_value(const void *a, const void *b)
{
	const double x = *(const double *)a, y = *(const double *)b;

	return (x > y) - (x < y);
}

/* What a right sentence looks like in this scene: each training sentence, as if it had not been there. */
static void learn_fitness(struct chooser *c, double *score)
{
	const struct lifted *l = c->l;
	struct lang_sentence s;

	for (size_t r = 0; r < l->sentences; r++) {
		const float *vectors = l->words + (size_t)l->offsets[r] * (size_t)l->width;
		lang_sentence_read(&s, l->pieces[r]);
		c->vocabulary.without = r;
		score_parts(c, &s, vectors, score);
		c->known[r] = fitness(c, &s, vectors, score);
	}
	c->vocabulary.without = l->sentences;
	if (l->sentences)
		qsort(c->known, l->sentences, sizeof *c->known, by_value);
}

static int chooser_init(struct chooser *c, const struct choose_scene *s, unsigned parts, struct err *e)
{
	const size_t objects = s->lifted->objects;

	*c = (struct chooser){.l = s->lifted, .parts = parts, .naming = s->naming};
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
	c->known = mem_alloc(s->lifted->sentences, sizeof *c->known, "choice", e);
	if (c->known && objects)
		learn_fitness(c, c->judged);
	return c->known ? 0 : -1;
}

static void chooser_free(struct chooser *c)
{
	arrangement_free(&c->arrangement);
	vocabulary_free(&c->vocabulary);
	free(c->match);
	free(c->known);
}

int choose(const struct choose_scene *s, const struct choose_sentence *sentences, size_t n, unsigned parts,
	float *probability, struct err *e)
{
	const size_t objects = s->lifted->objects;
	double *scores = mem_alloc(objects, sizeof *scores, "choice", e);
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
		const double there = score(&c, &sentences[i], scores), total = log_sum(scores, objects);
		for (size_t o = 0; o < objects; o++)
			row[o] = (float)(there * exp(scores[o] - total));
	}
	chooser_free(&c);
	free(scores);
	return 0;
}
