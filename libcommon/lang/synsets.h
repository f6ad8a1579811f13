/* Reading WordNet's synsets (sets of words with one meaning, known by their offset) through libwordnet, for
 * lang/wordnet.c. Only where the program is built with it. */
#pragma once

#ifdef HAVE_WORDNET
#include <wn.h>

/* The synsets of a lemma as a part of speech, the commonest first: how many, at most `most`. */
int synsets_of(const char *lemma, int pos, long *synsets, int most);

/* counts (n): how often each of the first n synsets was meant in the texts that were tagged. */
void synsets_counts(const char *lemma, int pos, int *counts, int n);

enum { SYNSETS_UP = 8 }; /* WordNet 3.0 has 5 at most */

/* What a noun's synset is a kind of; how many. */
int synsets_up(long synset, long up[SYNSETS_UP]);
#endif
