#include "ask/judge_words.h"

#include "ask/constants.h"
#include "lang/colours.h"
#include "lang/finish.h"
#include "places/relate.h"

#include <math.h>
#include <string.h>

/* The look that a word is of, where what Gaussians show of it counts; -1: none. */
static int look_of(const struct meaning *m, int word)
{
	return m->has_surfaces ? finish_of(m->sentence->parse->words[word].lemma) : -1;
}

/* What the Gaussians show of a look, where sentences do not say it. */
static void add_seen(const struct meaning *m, int word, double *match)
{
	const int finish = look_of(m, word);

	for (size_t o = 0; o < objects_of(m) && finish >= 0 && m->naming == 1; o++) {
		const double seen = surface_fits(&m->arrangement->objects[o].surface, finish);
		if (fabs(match[o]) < 1)
			match[o] = fmax(-1, fmin(1, match[o] + SURFACE_WORTH * seen));
	}
}

/* The same as a part of its own, where it is in doubt whose Gaussians they are. */
static void judge_surface(struct meaning *m, int phrase, int word)
{
	const int finish = look_of(m, word);

	if (finish < 0 || m->naming == 1)
		return;
	double *value = meaning_add_part(m, phrase, MEANING_SURFACE, word);
	for (size_t o = 0; o < objects_of(m); o++)
		value[o] = pow(SURFACE_UNLIKE,
			0.5 - 0.5 * surface_fits(&m->arrangement->objects[o].surface, finish));
	meaning_take_part(m);
}

void judge_attribute(struct meaning *m, int phrase, int word, double least)
{
	const size_t n = objects_of(m);

	if (colour_word(m->sentence->parse->words[word].lemma) >= 0) {
		judge_colour(m, phrase, word);
		return;
	}
	double *value = meaning_add_part(m, phrase, MEANING_ATTRIBUTE, word);
	vocabulary_attribute(m->vocabulary, m->sentence, word, value);
	add_seen(m, word, value);
	const double most = fmax(0, largest(value, n));
	m->unknown += most < 0.5;
	for (size_t o = 0; o < n; o++)
		value[o] = (value[o] < 0 ? least * (1 + (1 - OPPOSITE) * value[o])
					 : least + (1 - least) * value[o]) /
			   (least + (1 - least) * most);
	meaning_take_part(m);
	judge_surface(m, phrase, word);
}

/* A part that is, or fits, no object, but that training sentences may tell of: "with a handle". */
void judge_said(struct meaning *m, const struct parse_clause *c, double *said)
{
	const struct parse *p = m->sentence->parse;
	const size_t n = objects_of(m);
	double *match = m->scratch + n;

	memset(said, 0, n * sizeof *said);
	for (int k = 0; k < c->anchors.n; k++) {
		const int head = meaning_head_of(p, &p->phrases[c->anchors.item[k]]);
		if (head < 0)
			continue;
		vocabulary_has(m->vocabulary, m->sentence, head, c->relation, match);
		for (size_t o = 0; o < n; o++)
			said[o] = fmax(said[o], match[o]);
		if (c->relation != PARSE_NEAR)
			continue;
		vocabulary_at(m->vocabulary, m->sentence, head, match);
		for (size_t o = 0; o < n; o++)
			said[o] = fmax(said[o], SAID_WORTH * match[o]);
	}
}

/* What a thing does, is for, or has: any word of it may be said of an object. */
double judge_predicate(struct meaning *m, const struct parse_clause *c, double *value)
{
	const struct parse *p = m->sentence->parse;
	const size_t n = objects_of(m);
	double *match = m->scratch + n;
	int words = 0;

	for (size_t o = 0; o < n; o++)
		value[o] = 0;
	for (int k = 0; k < c->words.n + c->anchors.n; k++) {
		const int word = k < c->words.n
					 ? c->words.item[k]
					 : meaning_head_of(p, &p->phrases[c->anchors.item[k - c->words.n]]);
		if (word < 0)
			continue;
		vocabulary_attribute(m->vocabulary, m->sentence, word, match);
		add_seen(m, word, match);
		for (size_t o = 0; o < n; o++)
			value[o] += fmax(match[o], 0);
		words++;
	}
	const double most = fmax(0, largest(value, n));
	m->unknown += words && most < 0.5;
	for (size_t o = 0; o < n; o++) /* of what is denied nothing has to be so */
		value[o] = !words	? 1
			   : c->negated ? fmin(value[o], 1)
					: (PREDICATE_LEAST + value[o]) / (PREDICATE_LEAST + most);
	return most;
}

int judge_by_place(
	struct meaning *m, const struct parse_clause *c, int place, const double *fit, double *value)
{
	const struct parse *p = m->sentence->parse;
	const struct arrangement *a = m->arrangement;
	const int anchor = c->anchors.n == 1 ? c->anchors.item[0] : -1;
	const int head = anchor < 0 ? -1 : meaning_head_of(p, &p->phrases[anchor]);
	double *at = m->scratch + 6 * a->n, *key = m->scratch + 3 * a->n;

	if ((c->relation != PARSE_NEAR && c->relation != PARSE_FAR) || c->degree == PARSE_PLAIN || head < 0 ||
		m->known[anchor] >= 0.5 || p->phrases[anchor].viewer || meaning_is_scene(m, anchor))
		return 0;
	vocabulary_at(m->vocabulary, m->sentence, head, at);
	if (largest(at, a->n) < 0.5)
		return 0;
	for (size_t o = 0; o < a->n; o++) {
		double least = INFINITY;
		for (size_t k = 0; k < a->n; k++)
			if (at[k] >= 0.5 && a->objects[k].is_there)
				least = fmin(
					least, k == o ? 0 : pair_distance(&a->objects[o], &a->objects[k]));
		key[o] = (c->relation == PARSE_FAR ? -least : least) / (PLACE_SOFT * a->spacing);
	}
	relate_rank_by(a, key, place, fit, value);
	return 1;
}
