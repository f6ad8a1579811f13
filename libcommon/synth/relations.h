/* Where things are, as somebody sees them. A relation is judged in three values, so that a sentence is only
 * used where nobody could doubt what it means: 1 plainly true, -1 plainly false, 0 arguable. */
#pragma once

#include "geom/camera.h"
#include "lang/parse.h"
#include "synth/objects.h"

#include <stdint.h>

/* The scene as seen from a place: u to the right, v away, in world units from the table's middle. */
struct synth_viewpoint {
	int n;
	const struct synth_object *objects;
	double u[SYNTH_MAX_OBJECTS], v[SYNTH_MAX_OBJECTS];
	double bearing[SYNTH_MAX_OBJECTS]; /* to the right of the line of sight, radians */
	double range[SYNTH_MAX_OBJECTS];   /* from who looks, along the table */
	double half_u, half_v;		   /* of the table */
	uint64_t visible; /* objects that are plainly to be seen: all, unless somebody says */
	/* 1: by wider margins, and so that who measures a direction by bearing, or from who looks, finds the
	 * same. relations.c has the margins. */
	int is_strict;
};

/* From `centre`, looking at the table; right and away are unit directions in its plane. */
void synth_viewpoint_make(struct synth_viewpoint *s, const struct synth_object *objects, int n,
	const struct synth_table *table, const double centre[3], const double right[2], const double away[2],
	int is_strict);

/* From the reference viewpoint (synth_cameras_reference). */
void synth_viewpoint_reference(struct synth_viewpoint *s, const struct synth_object *objects, int n,
	const struct synth_table *table, const struct cameras *cameras, int is_strict);

/* A relation to objects a and b; -1 where it has none. Degrees: PLAIN "left of a", "on the left"; MOST "the
 * leftmost"; MORE "the left one", of those that are spoken of; a size with an object "larger than a". */
struct synth_relation {
	enum parse_relation relation;
	enum parse_degree degree;
	int a, b;
};

/* Of object i. What ranks (nearest, leftmost, largest ...) compares i with the others of `among` (n),
 * verdicts on what is spoken of; NULL: with everything. */
int synth_relation_judge(
	const struct synth_viewpoint *s, const struct synth_relation *r, int i, const int *among);

/* 1 where i lies plainly farther in the direction (PARSE_LEFT to PARSE_BEHIND) than j, -1 where less far. */
int synth_relation_compare(const struct synth_viewpoint *s, enum parse_relation direction, int i, int j);

int synth_relation_is_size(enum parse_relation r);
