/* What the parse of a sentence means among the objects of a scene, seen from one place. Every judgement has
 * three values, so that sentences that could be argued about are not used: 1 plainly true, -1 plainly false,
 * 0 arguable. */
#ifndef SYNTH_UNSEEN_JUDGE_H
#define SYNTH_UNSEEN_JUDGE_H

#include "synth/unseen.h"

/* The scene as somebody sees it: u to the right, v away, in world units from the table's middle. */
struct synth_stand {
	int n;
	const struct synth_object *objects;
	double u[SYNTH_MAX_OBJECTS], v[SYNTH_MAX_OBJECTS];
	double bearing[SYNTH_MAX_OBJECTS]; /* to the right of the line of sight, radians */
	double range[SYNTH_MAX_OBJECTS];   /* from who looks, along the table */
	double half_u, half_v;		   /* of the table */
	uint64_t visible;		   /* objects that are plainly to be seen */
};

/* As seen by a camera; `all` 1: everything counts as visible. */
void synth_stand_camera(struct synth_stand *s, const struct synth_object *objects, int n,
	const struct synth_table *table, const double centre[3], const double right[2], const double away[2]);

/* The objects that phrase p of the sentence means: 0, or -1 where that could be argued. The number of objects
 * is what the phrase's count says; `may_be_none` 1: none is fine too. */
int synth_unseen_resolve(
	const struct synth_stand *s, const struct synth_unseen *x, int p, int may_be_none, uint64_t *objects);

/* The verdict of a clause alone about object i; for superlatives among the objects of `among`. */
int synth_unseen_judge(
	const struct synth_stand *s, const struct synth_unseen *x, int clause, int i, const int *among);

#endif
