/* Where things are, as said from the reference viewpoint (synth_cameras_reference). A relation is judged in
 * three values, so that a sentence is only used where nobody could doubt what it means. */
#ifndef SYNTH_RELATIONS_H
#define SYNTH_RELATIONS_H

#include "synth/objects.h"
#include "synth/words.h"

enum synth_relation {
	/* of one other object */
	SYNTH_LEFT_OF,
	SYNTH_RIGHT_OF,
	SYNTH_IN_FRONT_OF,
	SYNTH_BEHIND,
	SYNTH_NEXT_TO,
	SYNTH_NEAREST_TO,
	SYNTH_FARTHEST_FROM,
	SYNTH_ON,
	SYNTH_UNDER,
	/* of two */
	SYNTH_BETWEEN,
	/* of the table */
	SYNTH_LEFT_SIDE,
	SYNTH_RIGHT_SIDE,
	SYNTH_FRONT_SIDE,
	SYNTH_BACK_SIDE,
	SYNTH_MIDDLE,
	SYNTH_ON_TABLE, /* and on no other object */
	SYNTH_LEFTMOST,
	SYNTH_RIGHTMOST,
	/* of whoever looks */
	SYNTH_NEAREST_US,
	SYNTH_FARTHEST_US,
	/* of the others that fit the noun phrase, and there must be such: "the left one of the two mugs" */
	SYNTH_LEFT_ONE,
	SYNTH_RIGHT_ONE,
	SYNTH_NEAR_ONE,
	SYNTH_FAR_ONE,
	SYNTH_MIDDLE_ONE, /* of three */
	SYNTH_LARGEST,
	SYNTH_SMALLEST,
	SYNTH_TALLEST,
	SYNTH_RELATIONS
};

/* The table as seen from the reference viewpoint: u to the right, v away. */
struct synth_layout {
	int n;
	const struct synth_object *objects;
	double u[SYNTH_MAX_OBJECTS], v[SYNTH_MAX_OBJECTS];
	double half_u, half_v; /* of the table */
};

void synth_layout_make(struct synth_layout *l, const struct synth_object *objects, int n,
	const struct synth_table *table, const double right[2], const double away[2]);

/* A relation with its other objects; a and b are -1 where it has none. */
struct synth_clause {
	enum synth_relation relation;
	int a, b;
};

/* 1: plainly true of object i; -1: plainly false; 0: could be argued. What compares (nearest, leftmost,
 * largest
 * ...) compares i with the other objects that fit `among`. */
int synth_clause_judge(
	const struct synth_layout *l, const struct synth_clause *c, int i, const struct synth_meaning *among);

/* 1 where object i stands on object a, or on what stands on it. */
int synth_layout_stands_on(const struct synth_layout *l, int i, int a);

#endif
