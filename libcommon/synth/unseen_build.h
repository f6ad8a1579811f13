/* Makes random parses of each build, to be judged and put into words by synth/unseen.c. */
#ifndef SYNTH_UNSEEN_BUILD_H
#define SYNTH_UNSEEN_BUILD_H

#include "synth/unseen_frames.h"
#include "synth/unseen_judge.h"
#include "synth/unseen_text.h"
#include "synth/unseen_words.h"

struct synth_unseen_draft {
	const struct synth_stand *stand;
	struct rng *rng;
	struct synth_unseen x;
	struct synth_unseen_fill fill;
};

/* A random parse of the build, about `object`, and a frame for it; -1 where one does not fit the other.
 * Whether it means one thing, or that one, is not said. two_hop: an anchor has a clause. */
int synth_unseen_build(struct synth_unseen_draft *d, enum synth_unseen_build b, int object, int two_hop);

/* The same of something that is not there. */
int synth_unseen_build_absent(struct synth_unseen_draft *d, int object);

#endif
