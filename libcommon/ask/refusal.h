/* Why a sentence means nothing among a scene's objects, and the words of its parts. */
#pragma once

#include "ask/meaning.h"
#include "lang/parse.h"

#include <stddef.h>

/* A parse in its own words: a phrase, then its clauses with their anchors in brackets. */

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

enum { EXPLAIN_REASON = 256, EXPLAIN_MOST = 6 /* candidates that are shown */ };

/* A sentence that was judged. m->sentence is not looked at: it may be gone when a watch of choose() is
 * called. */
struct explained {
	const struct meaning *meaning;
	const struct parse *parse;
	const char *text;
};

/* The words of a part of its meaning. */
void explain_add_part(struct parse_words *w, const struct explained *x, const struct meaning_part *part);

/* Why a sentence means nothing here, in words that end a sentence. Cut where it is too long. */
void explain_refusal(const struct explained *x, char reason[EXPLAIN_REASON]);
