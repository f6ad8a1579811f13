/* Makes random phrases and clauses of each build, to be judged and put into words by synth/unseen.c. */
#ifndef SYNTH_UNSEEN_BUILD_H
#define SYNTH_UNSEEN_BUILD_H

#include "synth/sentence.h"

struct synth_draft {
	const struct synth_wordings *w;
	const struct synth_viewpoint *v;
	struct rng *rng;
	struct synth_sentence s;
	const char *frame;
};

/* A random sentence of the build, about `object`, and a frame for it; -1 where one does not fit the other.
 * Whether it means one thing, or that one, is not said. two_hop: an anchor has a clause. */
int synth_unseen_build(struct synth_draft *d, enum synth_list build, int object, int two_hop);

/* The same of something that is not there. */
int synth_unseen_build_absent(struct synth_draft *d, enum synth_list build, int object);

#endif
