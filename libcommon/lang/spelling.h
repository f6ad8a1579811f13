/* Slips of spelling: one letter too many, too few or wrong, or two neighbours the wrong way round. */
#pragma once

enum { SPELLING_LENGTH = 32 }; /* bytes of a word with its 0; longer ones are left as they are */

/* 1 where one insertion, deletion, replacement or exchange of neighbours makes a into b. */
int spelling_near(const char *a, const char *b);

/* right (SPELLING_LENGTH) gets what a word of lower case is a slip of: one of `known` (a scene's vocabulary,
 * singular; may be NULL) or its plural, a closed-class word, a colour, an everyday noun (lang/kinds.h). Of an
 * exchange any word of three letters or more is told; of another slip, one of six letters with the same first
 * letter, or of five where WordNet does not know the word as it is. Returns 0 where it is one of these, or a
 * slip of none. */
int spelling_repair(const char *word, const char *const *known, int known_count, char *right);
