/* What everyday things usually are made of and have, by lang/things.h: a laptop has a battery. */
#pragma once

enum { PARTS_STEMS = 160 };

/* Stems of words, hashed. */
struct parts {
	int n;
	unsigned stem[PARTS_STEMS];
};

/* Fills `to` with the words of what a thing called so usually is made of, and has. */
void parts_usual(struct parts *to, const char *lemma);

/* Fills `to` with the word alone, or what is of a kind that the word is for ("electronics"). */
void parts_of_word(struct parts *to, const char *lemma);

/* Whether a thing has what a word says. */
int parts_share(const struct parts *thing, const struct parts *word);
