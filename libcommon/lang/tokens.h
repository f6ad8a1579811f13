/* The one tokeniser of sentences: words with their place in the text, their lemma and the pause before them.
 *
 * Clitics are words of their own ("isn't" is "is" and "n't", "penguin's" is "penguin" and "'s"), also where
 * the apostrophe is left out ("isnt", "wheres"); hyphens part words; bytes that are not ASCII do not. */
#pragma once

#include "lang/parse.h"

enum {
	TOKENS_MOST = 256, /* words of a sentence; what comes after them is not looked at */
	TOKEN_LENGTH = 32, /* bytes of a word with its 0; longer ones are cut */
};

enum token_pause { PAUSE_NONE, PAUSE_COMMA, PAUSE_STOP }; /* "," ":" "-" and brackets; "." "?" "!" ";" */

struct token {
	struct parse_span span;
	char text[TOKEN_LENGTH];  /* lower case, spelling repaired */
	char lemma[TOKEN_LENGTH]; /* singular */
	enum token_pause before;
	int closed; /* its closed_word, or -1 */
	int piece, pieces;
};

struct tokens {
	int n;
	struct token word[TOKENS_MOST];
};

/* Takes a text apart. `pieces` are the encoder's word pieces of it with a space between, as text.safetensors
 * has them (continuations begin with "##"), or NULL. A word that is one piece is spelt right, as are the
 * closed words and those of `known` (known_count, may be NULL: a scene's vocabulary); others are repaired
 * (lang/spelling.h). */
void tokens_take(
	struct tokens *t, const char *text, const char *pieces, const char *const *known, int known_count);

/* The enum closed_class of a word, -1 where it has none or is none (i out of range); whether it is one of
 * "this|that". */
int tokens_class(const struct tokens *t, int i);
int tokens_is(const struct tokens *t, int i, const char *words);

/* Whether a word ends so, after at least `stem` bytes. */
int token_ends(const char *word, const char *tail, size_t stem);

/* Singular of a noun ("boxes", "shelves", "mice"); others as they are. out holds TOKEN_LENGTH bytes. */
void token_lemma(const char *word, char *out);
