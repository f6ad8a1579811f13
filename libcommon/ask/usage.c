#include "ask/usage.h"

#include "ask/constants.h"
#include "base/logistic.h"
#include "lang/closed.h"
#include "lang/purpose.h"
#include "lang/tokens.h"

#include <string.h>

static const double not_there = -100; /* the score of what has no Gaussians */

/* "the shiny thing": what is said of a thing of no name. */
static int is_before_generic(const struct parse *p, int word)
{
	while (++word < p->word_count) {
		const int class = closed_class_of(p, word);
		if (class == CLOSED_GENERIC)
			return 1;
		if (class != CLOSED_ATTRIBUTE && class != CLOSED_SIZE && class != CLOSED_CLASSES)
			return 0;
	}
	return 0;
}

/* Whether a part holds whatever the sentence is about: a colour, a size, a place by something known. */
static int is_kept(const struct meaning *m, const struct meaning_part *part)
{
	const struct parse *p = m->sentence->parse;

	if (part->phrase || part->kind == MEANING_NOUN)
		return 0;
	if (part->kind == MEANING_ATTRIBUTE) /* "everything shiny" */
		return is_before_generic(p, part->index) ||
		       (parse_word_is(p, part->index - 1, "everything") && part->index + 1 == p->word_count);
	if (part->kind != MEANING_CLAUSE)
		return 1;
	const struct parse_clause *c = &p->clauses[part->index];
	const int is_of_scene = c->relation <= PARSE_BEHIND || c->degree != PARSE_PLAIN ||
				(c->relation >= PARSE_CORNER && c->relation <= PARSE_FLOOR);
	const int is_place = c->relation < PARSE_WITH && c->relation != PARSE_INSIDE;
	if (!is_place || c->negated || (!c->anchors.n && !is_of_scene))
		return 0;
	int known = !c->anchors.n;
	for (int k = 0; k < c->anchors.n; k++)
		known |= m->known[c->anchors.item[k]] >= 0.5 && p->phrases[c->anchors.item[k]].noun.n;
	return known;
}

/* use_words marks the words that tell of the use, as a sentence; counts, of these, those not of grammar. */
static void mark_words(const struct meaning *m, char *use_words, char *counts)
{
	const struct parse *p = m->sentence->parse;

	for (int w = 0; w < p->word_count; w++) {
		use_words[w] = (char)!is_before_generic(p, w);
		counts[w] = (char)(use_words[w] && purpose_is_content(p, w));
	}
}

int usage_says_more(const struct meaning *m)
{
	for (size_t k = 0; k < m->part_count; k++)
		if (is_kept(m, &m->parts[k]))
			return 1;
	return 0;
}

/* parts (O): the logarithms of what the sentence says besides. */
static void add_parts(const struct meaning *m, double *parts)
{
	const size_t n = objects_of(m);

	memset(parts, 0, n * sizeof *parts);
	for (size_t k = 0; k < m->part_count; k++)
		for (size_t o = 0; o < n && is_kept(m, &m->parts[k]); o++)
			parts[o] += PURPOSE_PARTS * log(fmax(m->parts[k].value[o], 1e-6));
}

/* Whether a thing is asked for by its name: one that is here, or "is there a spoon?", "how many spoons",
 * "which spoons are there?" */
static int is_by_name(const struct meaning *m, int head)
{
	const struct parse *p = m->sentence->parse;
	const int before = head >= 0 ? p->phrases[0].noun.item[0] - 1 : -1;

	return head >= 0 && (m->known[0] >= PURPOSE_NOUN || parse_word_is(p, before, "many|any") ||
				    (parse_word_is(p, before, "what|which") && !p->phrases[0].clauses.n) ||
				    (head > 1 && closed_is(p->words[head - 1].text, CLOSED_DETERMINER) &&
					    parse_word_is(p, head - 2, "there|is|'s")));
}

/* Whether a word is of what the target is said to be near, under ...; with no noun of its own, of the place
 * as a whole: "what is on the table?" */
static int is_of_anchor(const struct meaning *m, int word)
{
	const struct parse *p = m->sentence->parse;
	const struct parse_list *clauses = &p->phrases[0].clauses;

	for (int k = 0; k < clauses->n; k++) {
		const struct parse_clause *c = &p->clauses[clauses->item[k]];
		for (int j = 0; c->relation < PARSE_SUPPORTS && j < c->anchors.n; j++) {
			const struct parse_phrase *f = &p->phrases[c->anchors.item[j]];
			if ((p->phrases[0].noun.n || meaning_is_scene(m, c->anchors.item[j])) &&
				(parse_list_has(&f->noun, word) || parse_list_has(&f->attributes, word)))
				return 1;
		}
	}
	return 0;
}

/* Whether the words that count say more than a name and a place: "where is the teddy bear?" does not. */
static int says_more_than_name(const struct meaning *m, const char *counts)
{
	const struct parse *p = m->sentence->parse;
	const struct parse_list *noun = &p->phrases[0].noun;

	for (int w = 0; w < p->word_count; w++)
		if (counts[w] && !parse_list_has(noun, w) && !is_of_anchor(m, w))
			return 1;
	return 0;
}

double usage_judge(const struct meaning *m, double *score, double *scratch)
{
	const struct parse *p = m->sentence->parse;
	const size_t n = objects_of(m);
	double *about = scratch, *use = scratch + n, *parts = scratch + 2 * n, any;
	char use_words[TOKENS_MOST], counts[TOKENS_MOST];

	if (is_by_name(m, meaning_head_of(p, &p->phrases[0])))
		return 0;
	mark_words(m, use_words, counts);
	vocabulary_about(m->vocabulary, m->sentence, counts, about);
	add_parts(m, parts);
	const int is_said = purpose_is_said(p);
	if (!vocabulary_for(m->vocabulary, m->sentence, use_words, about, use, &any) ||
		!memchr(counts, 1, (size_t)p->word_count) || (!is_said && !says_more_than_name(m, counts)))
		return 0;
	for (size_t o = 0; o < n; o++)
		score[o] = m->arrangement->objects[o].is_there
				   ? PURPOSE_USE * use[o] + PURPOSE_NAME * about[o] + parts[o]
				   : not_there;
	const size_t o = best_of(score, n);
	const double sure = PURPOSE_SURE * (use[o] - any) + PURPOSE_SURE_NAME * about[o] +
			    PURPOSE_SURE_PARTS * parts[o] + (is_said ? PURPOSE_SAID : PURPOSE_UNSAID);
	return sure < 0 && !is_said ? 0 : logistic(sure);
}
