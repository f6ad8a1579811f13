/* Everyday nouns by which people call things of one kind or one shape, which WordNet, a hierarchy of senses,
 * does not have near one another: a block, a cube and a box; a drum and a cylinder. English. */
#ifndef LANG_KINDS_H
#define LANG_KINDS_H

#include <stddef.h>

enum { KINDS_LENGTH = 32 }; /* of the longest noun with its 0 */

/* The nouns of a group with a space around each; NULL past the last group. */
const char *kinds_group(size_t group);

/* Whether a lemma is in any group. */
int kinds_have(const char *lemma);

/* Whether things called so hold others: a jar of tea is a jar, and an eraser box has an eraser. */
int kinds_hold(const char *lemma);

/* Whether two lemmas are in one group. */
double kinds_share(const char *a, const char *b);

#endif
