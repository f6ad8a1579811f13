/* Questions, one a line, from a pipe or a terminal. */
#ifndef CMD_JOBS_QUESTIONS_H
#define CMD_JOBS_QUESTIONS_H

#include "base/err.h"

#include <stdio.h>

enum { QUESTION_MOST = 2000 /* bytes */ };

struct question {
	long line; /* from 1 */
	char text[QUESTION_MOST + 2];
	const char *fault; /* why it is none: "is not UTF-8"; NULL: it is one */
};

/* The next line that is not blank, without blanks at its ends; *q is zeroed before the first. 1, 0 at the
 * end, -1 with *e. After a fault the next call goes on behind that line. */
int question_next(struct question *q, FILE *in, struct err *e);

/* The same of a text. Returns 1 where it is a question, 0 where it is blank or faulty: q->fault says why. */
int question_take(struct question *q, const char *text);

#endif
