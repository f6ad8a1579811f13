/* Everyday words of how a surface looks, where WordNet's adjectives are not near one another, or where the one
 * is a noun: rings, "banded" and "striped". English. */
#ifndef LANG_FINISH_H
#define LANG_FINISH_H

/* 1 where two lemmas are of one look, -1 where what is the one is hardly the other ("plain", "striped"), 0
 * where nothing is known. */
int finish_fits(const char *a, const char *b);

#endif
