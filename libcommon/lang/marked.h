/* Sentences with marks behind their words that say what each is: people's sentences to learn a parser from.
 * formats/records/marked.md.
 *
 *   "the small/P1:smaller mug/T on/P2:on the plate/A2" */
#pragma once

#include "lang/analysis.h"

enum { MARKED_LENGTH = 1024, MARKED_MOST = 128 };

/* What a mark names: a noun, by its role, its number and, of the anchors of one predicate, its place. */
struct mark_name {
	enum word_role role;
	int number, place;
};

struct mark {
	struct parse_span span; /* of the marked word in the text */
	enum word_role role;
	struct mark_name name; /* of a noun; a predicate's has its number */
	struct mark_name of;   /* what a predicate or a word of looks is said of */
	enum parse_relation relation;
	int negated;
};

struct marked {
	char text[MARKED_LENGTH]; /* without the marks, with one blank between words */
	int n;
	struct mark mark[MARKED_MOST];
};

/* Of one line. Returns 0, or -1 with *e: what is wrong with it. */
int marked_take(struct marked *m, const char *line, struct err *e);

/* What the marks say of the words that tokens_take made of m->text; -1 with *e: a circle. */
int marked_analyse(const struct marked *m, const struct tokens *t, struct analysis *a, struct err *e);
