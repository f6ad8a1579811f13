/* Whether a question is said as a row of lang/question_kinds.tsv has it. */
#pragma once

#include "lang/tokens.h"

/* The words that a capture holds: from one token up to another. */
struct capture {
	int begin, end;
};

enum { CAPTURE_A, CAPTURE_B, CAPTURE_C, CAPTURE_WORD, CAPTURES };

struct matching {
	const char *text;
	const struct tokens *tokens;
	struct capture of[CAPTURES];
	int skip;		     /* ways that are passed over */
	int idle_before, idle_after; /* up to which word all are idle, and from which on */
};

/* Whether a sentence or a part of one ends before a word. */
int question_is_break(const struct tokens *t, const char *text, int at);

/* Whether a word says nothing more of what is asked for, before it or behind it. */
int question_is_idle(const struct tokens *t, int i);

/* Whether a question that is of no row wants yes or no: "might something pink be behind it?", "mum, did you
 * spot a spoon?", but not "could you show me the spoon?" */
int question_wants_yes(const struct tokens *t, const char *text);

/* The rest of a row from token `at` on. */
int question_match(struct matching *m, const char *said, int at);
