/* What a text-prompted detector gets wrong of a scene in every view alike: which sentences it misunderstands,
 * and what it takes for their object. */
#ifndef SYNTH_DETECTOR_ERRORS_H
#define SYNTH_DETECTOR_ERRORS_H

#include "base/rng.h"
#include "synth/objects.h"
#include "synth/presets.h"
#include "synth/synth_sentences.h"

/* What goes wrong with a sentence, the same in every view. */
enum synth_error {
	SYNTH_ERROR_NONE,
	SYNTH_ERROR_CONFUSED, /* in most views another object, and sure of it */
	SYNTH_ERROR_GUESSING, /* the same, but not sure */
	SYNTH_ERROR_PART,     /* often a part only */
	SYNTH_ERROR_UNION,    /* often with a neighbour */
	SYNTH_ERROR_GROUP,    /* often all that are alike */
	SYNTH_ERRORS
};

struct synth_errors {
	enum synth_error of[SYNTH_MAX_OBJECTS][SYNTH_SENTENCES];
	int mistaken[SYNTH_MAX_OBJECTS][SYNTH_SENTENCES]; /* what a confused sentence finds */
	int neighbours[SYNTH_MAX_OBJECTS]; /* what it stands on or carries, else the nearest on the table */
};

/* sentences (n objects, SYNTH_SENTENCES). A severe detector takes the objects that a sentence names beside
 * its own, and those that fit its noun phrase, for what it means. Only the training sentences get one. */
void synth_errors_make(struct synth_errors *h, const struct synth_object *objects, int n,
	const struct synth_sentence *sentences, enum synth_severity severity, struct rng *r);

/* Each test sentence gets that of one of its object's training sentences, and what that one is mistaken
 * for.
 */
void synth_errors_test(struct synth_errors *h, int n, struct rng *r);

/* 1 where b has a's shape and colour. */
int synth_look_alike(const struct synth_object *a, const struct synth_object *b);

#endif
