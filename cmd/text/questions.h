/* Questions, one a line, from a pipe or a terminal. */
#pragma once

#include "base/err.h"

enum { QUESTION_MOST = 2000 /* bytes */ };

struct question {
	long line;    /* from 1 */
	int is_first; /* of a conversation: a blank line was before it */
	char text[QUESTION_MOST + 2];
	const char *fault; /* why it is none: "is not UTF-8"; NULL: it is one */
};

/* Lines of a pipe, a file or a terminal; zeroed but for fd before the first. */
struct questions {
	int fd;
	int is_at_end; /* of what there is to read */
	long line;     /* that was read last */
	size_t begin, end;
	char read[65536]; /* and not yet taken: from begin to end */
};

/* The next line that is not blank, without blanks at its ends; waits for it. 1, 0 at the end, -1 with *e.
 * After a fault the next call goes on behind that line. */
int question_next(struct question *q, struct questions *from, struct err *e);

/* Whether a question is there that question_next need not wait for. */
int question_waits(struct questions *from);

/* The same of a text. Returns 1 where it is a question, 0 where it is blank or faulty: q->fault says why. */
int question_take(struct question *q, const char *text);
