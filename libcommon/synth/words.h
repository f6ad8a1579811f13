/* Words for what an object is, and what each word says: sets of shapes, colours, sizes and finishes, as bit
 * masks. */
#ifndef SYNTH_WORDS_H
#define SYNTH_WORDS_H

#include "base/rng.h"
#include "synth/objects.h"

enum synth_word_kind {
	SYNTH_NOUN = 'N',     /* mug, cup */
	SYNTH_GROUP = 'G',    /* container: several shapes */
	SYNTH_MATERIAL = 'M', /* ceramic: by shape */
	SYNTH_HUE = 'C',      /* crimson */
	SYNTH_EXTENT = 'S',   /* little */
	SYNTH_SURFACE = 'F',  /* glossy */
};

struct synth_word {
	enum synth_word_kind kind;
	unsigned mask; /* of the property that the kind speaks of: 1 << value */
	const char *text;
};

/* What a noun phrase says: an object fits where each of its properties is in the set. */
struct synth_meaning {
	unsigned shapes, colours, sizes, finishes;
};

struct synth_meaning synth_meaning_any(void);
void synth_meaning_add(struct synth_meaning *m, const struct synth_word *w);
int synth_meaning_fits(const struct synth_meaning *m, const struct synth_object *o);

/* A random word of that kind that is true of the object; NULL where there is none. */
const struct synth_word *synth_word_choose(
	enum synth_word_kind kind, const struct synth_object *o, struct rng *r);

#endif
