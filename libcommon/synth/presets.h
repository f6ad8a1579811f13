/* The scenes that gs-synth can make: the things, the room, and how it is photographed. */
#pragma once

#include "synth/objects.h"

#include <stddef.h>
#include <stdint.h>

/* The detector. MILD: of every object some sentence is understood. SEVERE: as Grounded-SAM does on Ref-LERF;
 * of many objects most sentences are taken to mean one other thing. */
enum synth_severity { SYNTH_MILD, SYNTH_SEVERE, SYNTH_SEVERITIES };

struct synth_preset {
	const char *name;
	/* Where nobody asks for others. */
	int objects, views, width, height;
	size_t gaussians;
	int test_views;		  /* of that many views; of others in proportion */
	int shapes[SYNTH_SHAPES]; /* lots of each shape; at least three shapes have some */
	int sizes[SYNTH_SIZES];	  /* lots of each size */
	int is_stacked;		  /* one object in six stands on another */
	enum synth_severity severity;
	double aspect;		/* the table's width over its depth */
	double filled;		/* the share of the table that is covered, at most about 0.5 */
	double hidden;		/* the share of (test view, object) pairs that are less than half visible */
	double distance;	/* of the cameras, in half widths of the table */
	double elevations[2];	/* of the training cameras, out and back, degrees */
	double room;		/* the wall's radius over the same */
	double wood[3], boards; /* the table's colour, and how wide its boards are */
	double wall[3], carpet[3]; /* colours of the room */
};

enum { SYNTH_PRESETS = 5 };

/* What is asked for. */
struct synth_options {
	const struct synth_preset *preset;
	uint64_t seed; /* synth_preset_seed */
	int objects, views, width, height;
	size_t gaussians;
	int is_wording_seen; /* test sentences are in wordings of training ones */
	int times;	     /* of a scene that moves, or that has room for it (1); 0: none */
};

/* Number 0 is the plain table. NULL where there is no such number. */
const struct synth_preset *synth_preset(int number);

/* A seed for everything in the scene: the same `seed` gives every scene other numbers. `attempt` 0, 1, 2 ...
 * gives others again. Of scene 0 and attempt 0 it is the seed itself. */
uint64_t synth_preset_seed(int number, uint64_t seed, int attempt);

/* Chooses n objects (SYNTH_MIN_OBJECTS to SYNTH_MAX_OBJECTS) and puts them on a table of fitting size.
 *
 * Of four objects or more half are in groups of two or three of one shape and colour, and mostly of one
 * finish; of the sizes of a group all are the same. No other two are alike in shape and colour. Where the
 * preset stacks, one object in six stands on a book, box or plate, within its flat top; one thing carries at
 * most one other, and none that carries stands on another. Otherwise none touches another. */
void synth_arrange(struct synth_object *objects, int n, struct synth_table *table,
	const struct synth_preset *preset, uint64_t seed);
