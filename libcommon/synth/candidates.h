/* Candidate masks as a text-prompted detector and segmenter gives them: ragged, partial, joined with a
 * neighbour, missing, and for some sentences an object that was never meant, with confidence. */
#ifndef SYNTH_CANDIDATES_H
#define SYNTH_CANDIDATES_H

#include "base/err.h"
#include "mask/rle.h"
#include "synth/noise.h"
#include "synth/objects.h"
#include "synth/sentences.h"

#include <stddef.h>
#include <stdint.h>

/* A sentence's habit, the same in every view. */
enum synth_habit {
	SYNTH_HABIT_GOOD,
	SYNTH_HABIT_CONFUSED, /* in most views another object, and sure of it */
	SYNTH_HABIT_GUESSING, /* the same, but not sure */
	SYNTH_HABIT_PART,     /* often a part only */
	SYNTH_HABIT_UNION,    /* often with a neighbour */
	SYNTH_HABITS
};

struct synth_detector {
	uint64_t seed;
	int n; /* objects */
	const struct synth_object *objects;
	enum synth_habit habits[SYNTH_MAX_OBJECTS][SYNTH_TRAIN_SENTENCES];
	int confusers[SYNTH_MAX_OBJECTS];  /* what a confused sentence finds: alike in colour or shape */
	int neighbours[SYNTH_MAX_OBJECTS]; /* the nearest on the table */
	struct synth_noise noise;
};

void synth_detector_make(struct synth_detector *d, const struct synth_object *objects, int n, uint64_t seed);

struct synth_candidate {
	int object, sentence; /* sentence 0 to SYNTH_TRAIN_SENTENCES-1 of that object */
	double score;	      /* 0.2 to 0.95, three decimals */
	struct rle mask;      /* owned */
};

struct synth_candidates {
	size_t n, capacity;
	struct synth_candidate *items;
};

/* Appends what the detector finds in view number `view` for every training sentence. `truth` (n,height,width)
 * is what the objects show there. Depends on the seed and the view alone, not on the order of calls. */
int synth_detect(struct synth_candidates *out, const struct synth_detector *d, int view, const uint8_t *truth,
	int height, int width, struct err *e);
void synth_candidates_free(struct synth_candidates *c);

#endif
