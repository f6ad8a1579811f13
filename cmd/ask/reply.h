/* The reply to a question, to a question about a distance, or to a place in a view: refer-ask. */
#ifndef CMD_ASK_REPLY_H
#define CMD_ASK_REPLY_H

#include "base/err.h"
#include "base/report.h"
#include "cmd/ask/answer_words.h"
#include "cmd/ask/asking.h"

struct reply_options {
	const char *point, *box; /* places in views that are asked about in place of a question; NULL */
	const char *picture;	 /* file to draw to; NULL: none */
};

/* *told becomes the reply to what is asked, with found as its answer, and is drawn where anything is found.
 * Returns 0, or -1 with *e set (ERR_USAGE: a place is at fault); asking_answer_free(found) after success. */
int reply_make(struct answer_told *told, struct asking_answer *found, struct asking *a, const char *question,
	const struct reply_options *o, const struct report *to, struct err *e);

#endif
