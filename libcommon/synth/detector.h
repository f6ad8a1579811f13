/* Candidate masks as a text-prompted detector and segmenter gives them: ragged, partial, joined with a
 * neighbour, missing, and for some sentences an object that was never meant, with confidence. */
#pragma once

#include "base/err.h"
#include "mask/mask.h"
#include "synth/noise.h"
#include "synth/presets.h"
#include "synth/sentence.h"

#include <stdint.h>

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
 * its own, and those that fit its noun phrase, for what it means. Each test sentence gets what one of its
 * object's training sentences gets. */
void synth_errors_make(struct synth_errors *h, const struct synth_object *objects, int n,
	const struct synth_sentence *sentences, enum synth_severity severity, struct rng *r,
	struct rng *r_test);

struct synth_detector {
	uint64_t seed;
	enum synth_severity severity;
	int n; /* objects */
	const struct synth_object *objects;
	const struct synth_sentence *sentences;
	struct synth_errors errors;
	struct synth_noise noise;
};

/* sentences: (n objects, SYNTH_SENTENCES). Both are the caller's and must outlive the detector. */
void synth_detector_make(struct synth_detector *d, const struct synth_object *objects, int n,
	const struct synth_sentence *sentences, enum synth_severity severity, uint64_t seed);

/* Appends what the detector finds in view number `number` for the first `count` sentences of every object
 * (SYNTH_TRAIN_SENTENCES or SYNTH_SENTENCES), with scores of 0.2 to 0.95, of three decimals. `truth`
 * (n,height,width) is what the objects show there. Depends on the seed and the view alone. */
int synth_detect(struct masks *out, const struct synth_detector *d, int number, const char *view, int count,
	const uint8_t *truth, int height, int width, struct err *e);
