/* What a thing may be called: the chance that a noun names a thing which is called by another one. The
 * evidence is WordNet with how often each sense is meant (lang/wordnet.h), in one direction: what a thing is
 * a kind of names it, a sister and a kind of it do not; the names of one line of the table of things
 * (lang/things.h); and the groups of nouns for things that look alike (lang/kinds.h). */
#pragma once

#include "lang/kinds.h"
#include "lang/things.h"
#include "lang/wordnet.h"

struct naming {
	const char *lemma; /* the caller's; words joined by one space */
	struct wordnet_noun noun;
	struct things_rows things;
	struct kinds_lines kinds;
};

/* What is known of a word that asks for a thing, and of a word that a
 * thing is called by: a plate that is called a dish is no food. */
void naming_of_word(struct naming *to, const char *lemma);
void naming_of_thing(struct naming *to, const char *lemma);

/* Whether a noun of two words is known as one: a tea bag is no bag of some sort. */
int naming_is_known(const struct naming *n);

/* The chance that a thing called `known` is also called `word`, in [0,1]. Of a general noun ("pot" of a
 * kettle) only what WordNet has counts: lines and groups are of other things that are called so. */
double naming_fits(const struct naming *word, const struct naming *known, int is_general);
