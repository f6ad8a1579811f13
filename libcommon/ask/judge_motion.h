/* How the things of a scene that moves do what a sentence says (places/motions.h), as parts of its meaning.
 */
#pragma once

#include "ask/meaning.h"
#include "places/motions.h"

/* Of the sentence that is judged next, or was last. */
struct motion_meaning {
	struct motions moving;
	struct motion_said said;
	enum motion_kind gone;	   /* what tells the time; MOTION_NONE: nothing does */
	double *happens;	   /* (O) and how far that happens for each object */
	struct motions_span *when; /* (O) when the target's motion may be; then when it is */
	struct motions_span *own;  /* (2 O) scratch */
	double *fits;		   /* (2 O) scratch */
};

int motion_meaning_make(struct motion_meaning *m, const struct tracks *t, struct err *e);
void motion_meaning_free(struct motion_meaning *m);

/* Nothing is said of motion, which may be at any time. */
void motion_meaning_begin(struct motion_meaning *m);

/* What is said of a phrase's motion, which its fit takes in. The phrases that it is about are judged. */
void judge_motion(struct meaning *m, int phrase);
