/* Names of things, of their properties and of what one does with them, for the unseen split only. */
#ifndef SYNTH_UNSEEN_WORDS_H
#define SYNTH_UNSEEN_WORDS_H

#include "base/rng.h"
#include "synth/objects.h"

struct synth_unseen_noun {
	unsigned shapes, maybe; /* that it names; that it may be thought to name */
	const char *one, *many;
};

/* A random noun for the shape. */
const struct synth_unseen_noun *synth_unseen_noun(enum synth_shape s, struct rng *rng);
/* One of nothing in the scenes. */
const struct synth_unseen_noun *synth_unseen_foreign(struct rng *rng);

/* Words of a property, and the bits of what they say; NULL for a plain finish and a medium size. */
const char *synth_unseen_hue(enum synth_colour c, struct rng *rng);
unsigned synth_unseen_near_hues(enum synth_colour c); /* colours that some would call the same */
const char *synth_unseen_finish(enum synth_finish f, struct rng *rng);
const char *synth_unseen_size(enum synth_size s, struct rng *rng);

struct synth_unseen_use {
	unsigned shapes, maybe;
	const char *text, *words[2]; /* "drink coffee from"; drink, coffee */
};
const struct synth_unseen_use *synth_unseen_use(enum synth_shape s, struct rng *rng);

#endif
