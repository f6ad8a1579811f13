/* Words that compare how things look: "darkest", "shinier", "most colourful". English. Sizes and places are
 * closed words (lang/closed.h), and none of these. */
#pragma once

#include "lang/tokens.h"

enum compared_look {
	COMPARED_DARK,
	COMPARED_BRIGHT,
	COMPARED_COLOURFUL,
	COMPARED_COLOUR, /* "reddest": colour_word of the base */
	COMPARED_FINISH, /* finish_of the base (lang/finish.h) */
	COMPARED_NONE	 /* no look that can be measured: "softest" */
};

enum { COMPARED_LENGTH = 32 };

/* The degree of a word that ends with -er or -est and whose base (COMPARED_LENGTH) is how things look or, of
 * -est, any adjective that WordNet knows; PARSE_PLAIN where it is none. */
enum parse_degree compared_of(const char *word, char *base);

/* The degree of word i as such, or as a look after "most" or "more". */
enum parse_degree compared_at(const struct tokens *t, int i);

/* What an adjective says of looks. */
enum compared_look compared_look(const char *adjective);
