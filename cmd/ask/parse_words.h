/* A parse in its own words: a phrase, then its clauses with their anchors in brackets. */
#ifndef CMD_ASK_PARSE_WORDS_H
#define CMD_ASK_PARSE_WORDS_H

#include "lang/parse.h"

#include <stddef.h>

/* Text of a limited length; what has no room is left out, at a character's end. */
struct parse_words {
	char *to;
	size_t n, room;
};

void parse_words_bytes(struct parse_words *w, const char *from, size_t n);
void parse_words_add(struct parse_words *w, const char *text);

/* Of the sentence `text`: a phrase, one of its clauses, a phrase with all that hangs on it (depth 0 at
 * first), and its noun. */
void parse_words_phrase(struct parse_words *w, const struct parse *p, const char *text, int phrase);
void parse_words_clause(
	struct parse_words *w, const struct parse *p, const char *text, const struct parse_clause *c);
void parse_words_tree(struct parse_words *w, const struct parse *p, const char *text, int phrase, int depth);
void parse_words_noun(struct parse_words *w, const struct parse *p, int phrase);

#endif
