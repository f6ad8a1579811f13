/* Groups of everyday nouns (kinds.tsv): by which people call things of one shape, such as a block, a cube and
 * a box, or of one look and use, such as a jug and a kettle. WordNet, a hierarchy of senses, does not have
 * them near one another. English. */
#pragma once

#include <stddef.h>
#include <stdint.h>

enum { KINDS_LENGTH = 32 /* of the longest noun with its 0 */, KINDS_LINES = 192 /* at most */ };

/* Steps through all nouns: *at is 0 before the first. 0 after the last. */
int kinds_next(long *at, char noun[KINDS_LENGTH]);

/* Whether a lemma is in any group. */
int kinds_have(const char *lemma);

/* Whether a lemma is in the line of this name: "holder", "gathering" (bouquet), "vague", "shape". */
int kinds_listed(const char *list, const char *lemma);

/* What things of a kind that a lemma is for have, of which any will do: "battery screen" of "electronics";
 * *length bytes. NULL: it is for no such kind. */
const char *kinds_has(const char *lemma, size_t *length);

enum { KINDS_FIELDS = 3 };

/* The lines that have a word, bit l of line l: in any field, in the first, and in the second. */
struct kinds_lines {
	uint64_t bits[KINDS_FIELDS][KINDS_LINES / 64];
};

void kinds_find(struct kinds_lines *to, const char *lemma);

/* The chance that what is called `known` is called by the word, as a group of `known` has it; 0 where none
 * has. */
double kinds_share(const struct kinds_lines *word, const struct kinds_lines *known);

/* Whether what is called `known` is of the sort that the word names: "clothes" of a jacket. */
int kinds_are_of(const struct kinds_lines *word, const struct kinds_lines *known);
