/* How a thing could be called: the shortest description by which the scene's own choice finds it again. */
#ifndef CMD_ASK_CALLING_H
#define CMD_ASK_CALLING_H

#include "base/err.h"
#include "base/report.h"
#include "cmd/ask/asking.h"

enum { CALLING_TEXT = 256 };

struct calling {
	char text[CALLING_TEXT]; /* "the red mug to the left of the plate"; "": none is found again */
	double probability;	 /* that it means the thing */
};

/* Tries, and asks each as a question: the noun; the name; with a colour or a size; superlatives; the position
 * beside a neighbour whose name no other thing has; both. Of the first of these kinds with a description that
 * means this object alone, at least as likely as not, the likeliest. centres (objects), which may be NULL,
 * gets where all objects are as seen from the viewpoint. Returns 0, or -1 with *e set. */
int calling_find(struct asking *a, size_t object, struct calling *to, double (*centres)[3],
	const struct report *report, struct err *e);

#endif
