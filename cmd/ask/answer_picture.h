/* A picture of an answer: the scene in the view that shows it best, the things tinted and outlined, and words
 * below. */
#ifndef CMD_ASK_ANSWER_PICTURE_H
#define CMD_ASK_ANSWER_PICTURE_H

#include "base/err.h"
#include "cmd/ask/asking.h"

/* The things, at least one, as one answer: where the response of any of them is above 0. Returns 0, or -1
 * with *e set; responses_free after either. */
int answer_responses(
	struct responses *to, const struct lifted *l, const size_t *things, size_t count, struct err *e);

struct answer_drawn {
	const struct camera *view; /* which to draw; NULL: it is found */
	int low[2], high[2]; /* column and row: the rectangle around the things, where high > low; high is
				outside */
};

/* Writes a PNG that appears whole, with two lines of words. The view that is found is the one in which the
 * things cover most, where things that the picture's edge cuts count half. Returns 0, or -1 with *e set. */
int answer_picture(const struct asking *a, const struct asking_answer *answer, const char *const words[2],
	const char *path, struct answer_drawn *drawn, struct err *e);

#endif
