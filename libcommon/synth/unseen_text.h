/* Puts the parse of an unseen sentence into words. */
#ifndef SYNTH_UNSEEN_TEXT_H
#define SYNTH_UNSEEN_TEXT_H

#include "synth/unseen_frames.h"

struct synth_unseen_fill {
	const char *frame;
	const char *use;   /* for %F */
	int left_out[2];   /* phrases for %X and %Y; -1 */
	const char *inner; /* a finished sentence for %Z */
};

/* Writes x->text by the frame; -1 where the frame has no use for these clauses, or the text is too long. */
int synth_unseen_write(struct synth_unseen *x, const struct synth_unseen_fill *f, struct rng *rng);

/* How it is typed: a capital and a full stop or neither, now and then without an apostrophe or with a slip.
 */
void synth_unseen_type(char *text, struct rng *rng);

#endif
