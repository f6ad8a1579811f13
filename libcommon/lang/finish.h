/* Everyday words of how a surface looks, where WordNet's adjectives are not near one another, or where the
 * one is a noun: rings, "banded" and "striped". English. */
#pragma once

enum finish { FINISH_STRIPES, FINISH_SPOTS, FINISH_PLAIN, FINISH_SHINY, FINISH_DULL, FINISHES };

/* The look that a lemma is a word of; -1: none. */
int finish_of(const char *lemma);

/* 1 where two looks are one, -1 where what is the one is hardly the other ("plain", "striped"), 0 where
 * nothing is known. */
int finish_fits(int a, int b);
