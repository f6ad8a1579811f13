/* What the noun of a phrase says of each object, or the noun that it leaves out. */
#include "ask/constants.h"
#include "ask/judge_words.h"
#include "lang/closed.h"
#include "lang/colours.h"
#include "lang/kinds.h"
#include "lang/tokens.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* "the red one", "the other two": a thing of the kind that was spoken of. */
static int is_elliptic(const struct parse *p, const struct parse_phrase *f)
{
	static const char again[] = "one|ones|other|others|another|two|three|those";

	for (int w = 1; w < p->word_count && !f->noun.n; w++) /* "the striped one" */
		if (p->words[w - 1].span.end == f->span.end && meaning_word_is(&p->words[w], again))
			return 1;
	return !f->noun.n && (f->span.begin == f->span.end || meaning_has_word(p, f, again));
}

/* Whether a phrase, or a word like "one" where the phrase has no words, comes after some words. */
static int is_after(const struct parse *p, const struct parse_phrase *f, struct parse_span words)
{
	for (int w = 0; w < p->word_count && f->span.begin == f->span.end; w++)
		if (p->words[w].span.begin >= words.end &&
			meaning_word_is(&p->words[w], "one|ones|other|others|another"))
			return 1;
	return words.begin < f->span.begin;
}

/* "Not the orange plate, the other one": the word of the kind that was spoken of before, or -1. */
static int kind_before(const struct parse *p, const struct parse_phrase *target)
{
	for (int k = 0; k < target->except.n; k++) {
		const struct parse_phrase *f = &p->phrases[target->except.item[k]];
		if (is_after(p, target, f->span))
			return meaning_head_of(p, f);
	}
	return -1;
}

/* Whether a word that nothing is called by is said of something: "neither purple nor striped". */
static int is_said_of_something(struct meaning *m, int word, double *match)
{
	if (!wordnet_is_adjective(m->sentence->parse->words[word].lemma))
		return 0;
	vocabulary_attribute(m->vocabulary, m->sentence, word, match);
	return largest(match, objects_of(m)) > ATTRIBUTE_SAID;
}

/* "That are not light", "not made of glass": no lamp, but a word that is said of things. */
static int is_denied_look(const struct parse *p, const struct parse_phrase *f, int head)
{
	if (f->noun.n != 1 || f->attributes.n)
		return 0;
	return (parse_word_is(p, head - 1, "of|from") && parse_word_is(p, head - 2, "made|built|cut")) ||
	       (wordnet_is_adjective(p->words[head].lemma) &&
		       closed_class_of(p, head - 1) == CLOSED_NEGATION &&
		       !parse_word_is(p, head - 1, "no|without"));
}

/* "The white gadget": a thing whose name is not said, and few things called so are called so here. */
static int is_vague(const struct parse_word *w)
{
	return kinds_listed("vague", w->text) || kinds_listed("vague", w->lemma);
}

/* "The white pebble" is a case: a shape in place of a name, where nothing here is called so. "A power strip",
 * "a sheet of paper" and "the sheets" are names. */
static int is_shape(const struct parse *p, const struct parse_phrase *f, int head)
{
	return f->noun.n == 1 && (f->count == PARSE_ONE || f->attributes.n || f->clauses.n) &&
	       kinds_listed("shape", p->words[head].lemma) && !parse_word_is(p, head + 1, "of");
}

/* "Something orange" is any thing of that colour; "the orange" is a fruit. */
static int is_colour(const struct parse *p, int head)
{
	struct things_rows rows;
	char two[2 * TOKEN_LENGTH];

	if (colour_word(p->words[head].lemma) < 0)
		return 0;
	snprintf(two, sizeof two, "%s %s", head ? p->words[head - 1].lemma : "", p->words[head].lemma);
	things_find(&rows, two); /* "ice cream" */
	if (rows.n)
		return 0;
	things_find(&rows, p->words[head].lemma);
	return !rows.n || !parse_word_is(p, head - 1, "a|an|any|my|the|your");
}

/* "Mug 2" is the one of that name, where there is one, and "mug 1" the one whose name has no number. */
static void judge_number(const struct meaning *m, int head, double *match)
{
	const struct parse *p = m->sentence->parse;
	const char *number = head + 1 < p->word_count ? p->words[head + 1].text : "";
	const double best = largest(match, objects_of(m));
	int is_there = 0;

	if (!*number || number[strspn(number, "0123456789")])
		return;
	for (int turn = 0; turn < 2; turn++)
		for (size_t o = 0; o < objects_of(m); o++) {
			const char *name = m->vocabulary->lifted->names[o], *end = strrchr(name, ' ');
			const int is_plain = !end || end[1 + strspn(end + 1, "0123456789")];
			const int is = is_plain ? !strcmp(number, "1") : !strcmp(end + 1, number);
			if (!turn)
				is_there |= is && match[o] >= 0.5 * best;
			else if (is_there && !is)
				match[o] *= NUMBER_ELSE;
		}
}

/* "The screen with a film on it": where nothing is called so, what has it. match (O) in and out. */
static void judge_part(struct meaning *m, int head, double *match)
{
	const size_t n = objects_of(m);
	double *has = m->scratch + 8 * n;

	if (largest(match, n) >= 0.5)
		return;
	vocabulary_has(m->vocabulary, m->sentence, head, PARSE_OTHER, has);
	for (size_t o = 0; o < n; o++)
		match[o] = fmax(match[o], PART_NOUN * has[o] * m->arrangement->objects[o].is_there);
}

void judge_noun(struct meaning *m, int phrase)
{
	const struct parse *p = m->sentence->parse;
	const struct parse_phrase *f = &p->phrases[phrase];
	const size_t n = objects_of(m);
	int head = meaning_head_of(p, f);
	double *value, *there = there_of(m, phrase), *match = m->scratch + n;

	if (head < 0 && !phrase && is_elliptic(p, f))
		head = kind_before(p, f);
	for (size_t o = 0; o < n; o++)
		there[o] = GENERIC_THERE;
	m->known[phrase] = GENERIC_THERE;
	if (head < 0)
		return;
	m->vocabulary->of_several = f->count != PARSE_ONE;
	vocabulary_noun(m->vocabulary, m->sentence, head, match);
	m->vocabulary->of_several = 0;
	judge_number(m, head, match);
	for (size_t o = 0; o < n && m->naming != 1; o++) /* those that are not found yet are no anchors */
		match[o] *= m->arrangement->objects[o].is_there;
	const int is_any = is_vague(&p->words[head]) || (is_shape(p, f, head) && largest(match, n) < 0.5);
	if (!phrase && !is_any && (f->attributes.n || f->clauses.n))
		judge_part(m, head, match);
	for (size_t o = 0; o < n && is_any; o++)
		match[o] = fmax(match[o], VAGUE_LEAST);
	if (phrase && is_denied_look(p, f, head)) {
		judge_attribute(m, phrase, head, ATTRIBUTE_SEVERAL);
		return;
	}
	if (is_colour(p, head) && largest(match, n) < 0.5) {
		judge_colour(m, phrase, head);
		return;
	}
	if (largest(match, n) < 0.5 && is_said_of_something(m, head, m->scratch + 8 * n)) {
		judge_attribute(m, phrase, head, f->count == PARSE_ONE ? ATTRIBUTE_LEAST : ATTRIBUTE_SEVERAL);
		return;
	}
	value = meaning_add_part(m, phrase, MEANING_NOUN, head);
	const double best = fmax(0, largest(match, n));
	/* of several things each has to be called so as well as another is, or be of that kind */
	const int is_one = f->count == PARSE_ONE || is_any;
	m->known[phrase] = best;
	for (size_t o = 0; o < n; o++) {
		const int is_kind = is_one || vocabulary_is_above(m->vocabulary, p->words[head].lemma, o);
		const double x = match[o] * pow(match[o] / fmax(best, 1e-9), is_kind ? 0 : NOUN_SEVERAL);
		value[o] = NOUN_LEAST + (1 - NOUN_LEAST) * x * x / fmax(best, 1e-9);
		/* another thing that is called so speaks against it */
		there[o] = match[o] * match[o] / fmax(best, 1e-9);
	}
	meaning_take_part(m);
}
