/* How far two things are apart: questions such as "how far is the mug from the plate?". */
#ifndef CMD_ASK_DISTANCE_H
#define CMD_ASK_DISTANCE_H

#include "base/err.h"
#include "base/report.h"
#include "cmd/ask/asking.h"

enum { DISTANCE_SPLITS = 8, DISTANCE_TEXT = 2048 };

/* The two things that a distance may be asked between, as the question has them. */
struct distance_ends {
	char text[2][DISTANCE_TEXT]; /* the second is empty where the first means both: "the two mugs" */
};

/* The ways to read a question as one about a distance: "how far is A from B", "distance between A and B",
 * "how far apart are A and B"; several, where A or B has such a word too. Returns how many, 0 where it is
 * none. */
int distance_take(const char *question, struct distance_ends ends[DISTANCE_SPLITS]);

struct distance {
	int is_asked;	     /* the question is one about a distance */
	double gap, centres; /* between the boxes, 0 where they touch, and between their centres */
	double probability;  /* that these are the two things */
};

/* Answers a question about a distance: of the ways to read it the one in which both things are likeliest. The
 * things of the answer are the two, in the question's order, or none, and then its reason says what was not
 * found. Of another question *d is zeroed, and nothing else done. Returns 0, or -1 with *e set;
 * asking_answer_free after success where d->is_asked. */
int distance_ask(struct asking *a, const char *question, struct asking_answer *answer, struct distance *d,
	const struct report *to, struct err *e);

#endif
