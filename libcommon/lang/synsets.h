/* Reading WordNet's synsets (sets of words with one meaning, known by their offset) through libwordnet, for
 * lang/wordnet.c. Only where the program is built with it. */
#pragma once

#ifdef HAVE_WORDNET
#include <wn.h>

/* The synsets of a lemma as a part of speech, the commonest first: how many, at most `most`. None where there
 * is no database. */
int synsets_of(const char *lemma, int pos, long *synsets, int most);

/* counts (n): how often each of the first n synsets was meant in the texts that were tagged. */
void synsets_counts(const char *lemma, int pos, int *counts, int n);

/* One synset, NULL where it cannot be read; free_synset it. */
SynsetPtr synsets_read(int pos, long synset);

/* Steps through what a synset is a kind of, *at being 0 before the first: 1 and *up, or 0 at the end. */
int synsets_next_up(const Synset *s, int pos, int *at, long *up);
#endif
