/* What WordNet (Princeton's lexical database, 3.0) knows of nouns, through Debian's libwordnet. Where the
 * program was built without it, or the database is not installed, nothing is known and the program works on.
 *
 * libwordnet has one set of open files: call from one thread at a time. */
#pragma once

enum { WORDNET_SENSES = 8, WORDNET_UP = 96 };

/* The senses of a noun and what they are kinds of. */
struct wordnet_noun {
	int n;
	struct {
		long synset;
		short depth; /* 0: the noun's own sense; 1: what that is a kind of; ... */
		short sense; /* 0: the commonest */
	} up[WORDNET_UP];
	float chance[WORDNET_SENSES]; /* of each sense, where a thing is spoken of; their sum is at most 1 */
};

/* Whether there is a database. */
int wordnet_is_there(void);

/* Fills `to`, with n = 0 where the lemma is no noun that is known. Words are joined by '_'. */
void wordnet_find(struct wordnet_noun *to, const char *lemma);

/* The same of what a thing is called: a plate that is called a dish is no food. */
void wordnet_find_thing(struct wordnet_noun *to, const char *lemma);

/* Whether the lemma is a noun that is known: wordnet_find without what it is a kind of. */
int wordnet_is_noun(const char *lemma);

/* The chance that a thing called `known` may be called `word`, in [0,1]: over the senses of `known`, that a
 * sense of `word` is the same or what it is a kind of ("vessel" for a mug). That counts the less the more
 * steps away, and the rarer that sense of `word`. What is only a kind of it ("hardback"
 * for a book) does not name it. */
double wordnet_fits(const struct wordnet_noun *word, const struct wordnet_noun *known);

/* Whether some sense of a noun is what a sense of the other is a kind of. */
int wordnet_is_above(const struct wordnet_noun *above, const struct wordnet_noun *word);

/* Whether the lemma is an adjective, or a verb, that is known. */
int wordnet_is_adjective(const char *lemma);
int wordnet_is_verb(const char *lemma);
