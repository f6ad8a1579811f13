#include "ask/purposes.h"

#include "ask/constants.h"
#include "ask/meaning_private.h"
#include "lang/closed.h"
#include "lang/purpose.h"
#include "lang/tokens.h"

#include <string.h>

static const double not_there = -100; /* the score of what has no Gaussians */

/* "the shiny thing": what is said of a thing of no name. */
static int is_before_generic(const struct parse *p, int word)
{
	while (++word < p->word_count) {
		const int closed = closed_find(p->words[word].text);
		if (closed >= 0 && closed_words[closed].class == CLOSED_GENERIC)
			return 1;
		if (closed >= 0 && closed_words[closed].class != CLOSED_ATTRIBUTE &&
			closed_words[closed].class != CLOSED_SIZE)
			return 0;
	}
	return 0;
}

/* Whether a part holds whatever the sentence is about: a colour, a size, a place by something that is known.
 */
static int is_kept(const struct meaning *m, const struct meaning_part *part)
{
	const struct parse *p = m->sentence->parse;

	if (part->phrase || part->kind == MEANING_NOUN)
		return 0;
	if (part->kind == MEANING_ATTRIBUTE)
		return is_before_generic(p, part->index);
	if (part->kind != MEANING_CLAUSE)
		return 1;
	const struct parse_clause *c = &p->clauses[part->index];
	const int is_of_scene = c->relation <= PARSE_BEHIND || c->degree != PARSE_PLAIN ||
				(c->relation >= PARSE_CORNER && c->relation <= PARSE_FLOOR);
	if (c->relation >= PARSE_WITH || c->relation == PARSE_INSIDE || c->negated ||
		(!c->anchors.n && !is_of_scene))
		return 0;
	for (int k = 0; k < c->anchors.n; k++)
		if (m->known[c->anchors.item[k]] < 0.5 || !p->phrases[c->anchors.item[k]].noun.n)
			return 0;
	return 1;
}

/* Whether a word is of an anchor of a place. */
static int is_of_place(const struct meaning *m, int word)
{
	const struct parse *p = m->sentence->parse;

	for (size_t k = 0; k < m->part_count; k++) {
		const struct meaning_part *part = &m->parts[k];
		if (part->kind != MEANING_CLAUSE || !is_kept(m, part))
			continue;
		const struct parse_clause *c = &p->clauses[part->index];
		for (int j = 0; j < c->anchors.n; j++) {
			const struct parse_span *s = &p->phrases[c->anchors.item[j]].span;
			if (p->words[word].span.begin >= s->begin && p->words[word].span.end <= s->end)
				return 1;
		}
	}
	return 0;
}

/* Marks the words that tell of the use. */
static void mark_words(const struct meaning *m, char *counts)
{
	const struct parse *p = m->sentence->parse;

	for (int w = 0; w < p->word_count; w++)
		counts[w] =
			(char)(purpose_is_content(p, w) && !is_of_place(m, w) && !is_before_generic(p, w));
}

/* words (O): what the words that count give, summed; the less the more things here a word is of. Squares, as
 * half a match is mostly by a rare sense of the word. */
static void add_words(const struct meaning *m, const char *counts, double *words, double *match)
{
	const size_t n = objects_of(m);

	memset(words, 0, n * sizeof *words);
	for (int w = 0; w < m->sentence->parse->word_count; w++) {
		if (!counts[w])
			continue;
		vocabulary_use(m->vocabulary, m->sentence, w, match);
		double all = 0;
		for (size_t o = 0; o < n; o++)
			all += match[o] * match[o];
		for (size_t o = 0; o < n; o++)
			words[o] += match[o] * match[o] / sqrt(fmax(1, all));
	}
}

int purposes_says_more(const struct meaning *m)
{
	for (size_t k = 0; k < m->part_count; k++)
		if (is_kept(m, &m->parts[k]))
			return 1;
	return 0;
}

/* By its form, or as its noun is of nothing that one could point at: "where the countries are". */
static int is_purpose(const struct parse *p, int head)
{
	return purpose_is_said(p) || (head >= 0 && !uses_names_thing(p->words[head].lemma));
}

double purposes_judge(const struct meaning *m, double *score, double *scratch)
{
	const struct parse *p = m->sentence->parse;
	const size_t n = objects_of(m);
	double *about = scratch, *words = scratch + n;
	char counts[TOKENS_MOST];

	static const char *const there[] = {"there", "is", "'s", NULL};
	const int head = meaning_head_of(p, &p->phrases[0]);
	/* "is there a spoon?" asks for a spoon */
	const int is_named = head > 1 && closed_is(p->words[head - 1].text, CLOSED_DETERMINER) &&
			     parse_word_is(p, head - 2, there);
	if ((head >= 0 && (is_named || m->known[0] >= PURPOSE_NOUN)) || !is_purpose(p, head))
		return 0;
	mark_words(m, counts);
	add_words(m, counts, words, score);
	vocabulary_about(m->vocabulary, m->sentence, counts, about);
	for (size_t o = 0; o < n; o++)
		score[o] = m->arrangement->objects[o].is_there
				   ? PURPOSE_ABOUT * about[o] + PURPOSE_WORDS * words[o]
				   : not_there;
	for (size_t k = 0; k < m->part_count; k++) {
		if (!is_kept(m, &m->parts[k]))
			continue;
		for (size_t o = 0; o < n; o++)
			score[o] += PURPOSE_PARTS * log(fmax(m->parts[k].value[o], 1e-6));
	}
	const double best = largest(score, n);
	return 1 / (1 + exp(-(PURPOSE_THERE * best + PURPOSE_BASE)));
}
