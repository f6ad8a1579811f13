/* What a word is in a sentence and what it hangs on: the common ground of the grammar, the learnt parser and
 * the sentences that it learns from. parse_build makes a parse of it.
 *
 *   "the small mug on the plate": small: predicate (smaller) of the target; mug: target; on: predicate of the
 *   target; plate: anchor of "on". */
#ifndef LANG_ANALYSIS_H
#define LANG_ANALYSIS_H

#include "lang/parse.h"
#include "lang/tokens.h"

enum word_role {
	ROLE_NONE,	/* says nothing: articles, requests, the rest of a predicate */
	ROLE_TARGET,	/* the target's noun, or what stands for it ("one", "thing"); hangs on ROOT */
	ROLE_ANCHOR,	/* a noun, hangs on its predicate */
	ROLE_ALSO,	/* the noun of a further target; ROOT */
	ROLE_EXCEPT,	/* the noun of what is left out; ROOT or the phrase that it is left out of */
	ROLE_VIEW,	/* the noun of what is faced or stood at; ROOT */
	ROLE_MEMBER,	/* the noun of one of those that the target is chosen from; ROOT */
	ROLE_NAME,	/* a part of a noun of several words ("trash" can); hangs on the noun */
	ROLE_ATTRIBUTE, /* hangs on a noun, or on ROOT for the target */
	ROLE_PREDICATE, /* the main word of a relation; hangs on its figure: a noun, or ROOT for the target */
	ROLES
};

enum { ROOT = -1 };

struct analysis_word {
	enum word_role role;
	int head;		      /* a word or ROOT */
	enum parse_relation relation; /* of predicates, as the next */
	int negated;
};

struct analysis {
	int n;
	struct analysis_word word[TOKENS_MOST];
};

/* 1 for the roles of nouns that head a phrase. */
int role_is_phrase(enum word_role r);

/* The word says nothing. */
void analysis_give_up(struct analysis_word *w);

/* By closed-class words and the order of words alone. */
void grammar_analyse(struct analysis *a, const struct tokens *t);

/* Makes every head one that its role may have, without a circle; what then hangs on nothing hangs on ROOT. */
void analysis_repair(struct analysis *a);

/* What closed-class words settle whatever was made of them: what is denied of looks, what a look is said of,
 * and places. grammar: what grammar_analyse made. */
void analysis_mend(struct analysis *a, const struct analysis *grammar, const struct tokens *t);

/* A part of analysis_mend: what is denied. */
void analysis_denied(struct analysis *a, const struct tokens *t);

/* Another: who looks, corners, places that are said twice. */
void analysis_places(struct analysis *a, const struct analysis *grammar, const struct tokens *t);

/* Another: what "it" is, what stands by itself, "a book behind it". */
void analysis_it(struct analysis *a, const struct tokens *t);

/* Another: where a thing shall be put. */
void analysis_command(struct analysis *a, const struct tokens *t);

/* Whether there is such a word and it is a predicate. */
int analysis_is_predicate(const struct analysis *a, int i);
/* Whether a word is the predicate of an anchor. */
int analysis_has_anchor(const struct analysis *a, int predicate);

/* The parse that an analysis stands for; -1 only where memory is out. Degrees, counts, ordinals, groups and
 * views are told from the words themselves. */
int parse_build(struct parse *p, const struct analysis *a, const struct tokens *t, struct err *e);

/* What the words of a built parse tell besides: "the taller of those three vases" is a vase. -1 only where
 * memory is out. */
int parse_settle(struct parse *p, struct err *e);

/* A part of parse_settle: "the tray and what is on it" are two. Likewise. */
int parse_carried(struct parse *p, struct err *e);

/* A part of parse_settle: the jar on one side and the tin on the other. Likewise. */
int parse_between(struct parse *p, struct err *e);

/* A part of parse_settle: "two boxes, the red one and the one by the door". Likewise. */
int parse_members(struct parse *p, struct err *e);

#endif
