/* What the parts of parse_build share. */
#pragma once

#include "lang/analysis.h"
#include "lang/closed.h"

#include <string.h>

struct build {
	struct parse *p;
	const struct analysis *a;
	const struct tokens *t;
	struct err *e;
	int phrase_of[TOKENS_MOST]; /* of a phrase's head: its phrase, else -1 */
	int noun;		    /* the target's main noun, or -1 */
	int from;		    /* the place word that an ordinal counts from, or -1 */
};

/* A closed word's value. */
static inline int build_value(const struct tokens *t, int i)
{
	return closed_words[t->word[i].closed].value;
}

/* The plural of a noun; "scissors" are one thing. */
static inline int build_is_plural(const struct tokens *t, int i)
{
	static const char pairs[] =
		"binoculars|clippers|earphones|forceps|glasses|goggles|headphones|jeans|pliers|scales|"
		"scissors|secateurs|shears|shorts|spectacles|sunglasses|tongs|trousers|tweezers";

	return strcmp(t->word[i].text, t->word[i].lemma) != 0 && !tokens_is(t, i, pairs);
}

/* A head that names no kind of thing is none. */
static inline int build_names_kind(const struct build *b, int i)
{
	return tokens_class(b->t, i) != CLOSED_GENERIC && tokens_class(b->t, i) != CLOSED_NUMBER &&
	       tokens_class(b->t, i) != CLOSED_RELATIVE && tokens_class(b->t, i) != CLOSED_DETERMINER;
}

/* The phrase that a head heads, or -1. */
static inline int build_phrase_under(const struct build *b, int head)
{
	return head == ROOT ? 0 : b->phrase_of[head];
}

/* The end that a word names: "left", "back"; PARSE_OTHER: none. */
static inline enum parse_relation build_end(const struct tokens *t, int i)
{
	enum parse_relation r = PARSE_OTHER;

	if (tokens_class(t, i) == CLOSED_PLACE)
		r = (enum parse_relation)closed_words[t->word[i].closed].relation;
	return r <= PARSE_BELOW ? r : PARSE_OTHER;
}

/* Whether a word tells which way one goes, and no place: either of "left to right". */
static inline int build_is_way(const struct tokens *t, int i)
{
	const int first = tokens_is(t, i + 1, "to") ? i : i - 2;

	return tokens_is(t, first + 1, "to") && build_end(t, first) != PARSE_OTHER &&
	       build_end(t, first + 2) != PARSE_OTHER;
}

/* How many things each phrase means, and of how many, where `groups` also by what comes later. */
void parse_counts(struct build *b, int groups);

/* "The second from the left". b->from gets the place word that it counts from. */
void parse_ordinals(struct build *b);
