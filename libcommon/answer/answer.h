/* A model's answers in a view: for each answer to a sentence (answer/responses.h) the image of its
 * responses, its mask and its score; or, amodally, the outline of the whole object as if nothing hid it. */
#pragma once

#include "answer/responses.h"
#include "base/err.h"
#include "geom/camera.h"
#include "splat/splats.h"

#include <stdint.h>

/* What is drawn, the same for every view. */
struct answer_question {
	const struct splats *splats;
	const struct responses *responses;
	const struct splats *wholes; /* (answers) of responses_wholes, for outlines; NULL: what is in sight */
	int wants_rgb;
	int wants_images; /* as they are, not only where they are above 0 */
};

/* One answer, row-major; good until the callback returns. */
struct answer {
	const struct camera *camera;
	size_t view, answer;
	/* (P) M, where images are wanted, else it or 0 where it is not above 0; of an outline how much of the
	 * whole object's opacity is above ANSWER_OUTLINE */
	const float *image;
	const uint8_t *mask; /* (P) image > 0 */
	const float *rgb;    /* (P,3) the scene's colours on black, where they are wanted */
	double score;	     /* of respond_mask, for what is in sight */
	double visible;	     /* share of the outline's pixels that are in sight; NaN without an outline */
};

/* A whole object covers a pixel where its Gaussians alone have more than this opacity. */
#define ANSWER_OUTLINE 0.5f

struct answer_calls {
	void *data;
	/* One answer. Called by several threads at once, but for a view by one, answer after answer. */
	int (*each)(void *data, const struct answer *a, struct err *e);
	/* All of a view's answers were given: called for one view after the other, in order. May be NULL. */
	int (*done)(void *data, size_t view, struct err *e);
}; /* both return 0, or -1 with *e set */

/* Answers in n views. Each is rendered by a thread of its own, where there is memory for as many, as threads
 * in one view have less to share. 0, or -1 with *e of the first view where anything went wrong. */
int answer_all(const struct answer_question *q, const struct camera *cameras, size_t n,
	const struct answer_calls *calls, struct err *e);
