/* What a word is in a sentence and what it hangs on: the common ground of the parser and the sentences that
 * it learns from. parse_build makes a parse of it.
 *
 *   "the small mug on the plate": small: predicate (smaller) of the target; mug: target; on: predicate of the
 *   target; plate: anchor of "on". */
#pragma once

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

/* Makes every head one that its role may have, without a circle; what then hangs on nothing hangs on ROOT. */
void analysis_repair(struct analysis *a);

/* The rules of lang/rules.def that are of an analysis, but those that are left out. */
void analysis_apply_rules(struct analysis *a, const struct tokens *t, unsigned without);

/* The rule `from`, which parse_build applies, as no marks tell it. */
void analysis_take_from(struct analysis *a, const struct tokens *t);

/* Whether there is such a word and it is a predicate. */
int analysis_is_predicate(const struct analysis *a, int i);
/* Whether a word is the predicate of an anchor. */
int analysis_has_anchor(const struct analysis *a, int predicate);

/* The parse that an analysis stands for; -1 only where memory is out. Degrees, counts, ordinals, groups and
 * views are told from the words themselves. without: the rules of lang/rules.h that do not count. */
int parse_build(
	struct parse *p, const struct analysis *a, const struct tokens *t, unsigned without, struct err *e);

/* The rules that are of a built parse. Likewise. */
int parse_apply_rules(struct parse *p, unsigned without, struct err *e);

/* Two of these: "the tray and what is on it" are two; so "two boxes, the red one and the one by the door". */
int parse_companion(struct parse *p, struct err *e);
int parse_members(struct parse *p, struct err *e);
int parse_shared(struct parse *p, struct err *e);

/* Room for two phrases and a clause more; pointers to those before are then stale. */
int parse_make_room(struct parse *p, struct err *e);
