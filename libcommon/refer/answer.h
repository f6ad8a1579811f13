/* A trained model's answers in one view: for each sentence the image of its responses, its mask and its
 * score.
 */
#ifndef REFER_ANSWER_H
#define REFER_ANSWER_H

#include "base/err.h"
#include "geom/camera.h"
#include "splat/splats.h"

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* What is asked, the same for every view. */
struct answer_question {
	const struct splats *splats;
	const float *responses; /* (sentences,N) as render_pack has them */
	const double *lifts;	/* (sentences) what calibration added to them */
	size_t sentences;
	int wants_rgb;
};

/* The answer to one sentence, row-major; good until the callback returns. */
struct answer {
	const struct camera *camera;
	size_t sentence;
	const float *image;  /* (P) M */
	const uint8_t *mask; /* (P) M > 0 */
	const float *rgb;    /* (P,3) the scene's colours on black, where they are wanted */
	double score;	     /* of respond_mask */
};

struct answer_calls {
	void *data;
	/* One answer; what it puts into `records` is that view's text. Called by several threads at once, but
	 * for a view by one, sentence after sentence. Returns 0, or -1 with *e set. */
	int (*each)(void *data, const struct answer *a, FILE *records, struct err *e);
	/* A view is done: called for one after the other, in order. */
	void (*done)(void *data, size_t view, const char *records);
};

/* Answers in n views. Each is rendered by a thread of its own, where there is memory for as many, as threads
 * in one view have less to share. Returns 0, or -1 with *e set by what went wrong in the first view where
 * anything did. */
int answer_all(const struct answer_question *q, const struct camera *cameras, size_t n,
	const struct answer_calls *calls, struct err *e);

#endif
