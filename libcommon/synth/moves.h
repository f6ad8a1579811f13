/* What moves in a synthetic scene, how and when: things are pushed, rolled, lifted, put down, dropped or
 * exchanged, and some stay where they are. A move lasts from one stored time to another; times are counted
 * from 0. formats/scene/synth.md. */
#pragma once

#include "synth/sentence.h"
#include "synth/synth_scene.h"

enum { SYNTH_MAX_TIMES = 1000, SYNTH_WAY = 3 };

enum synth_move_kind { SYNTH_SLIDES, SYNTH_ROLLS, SYNTH_RISES, SYNTH_CARRIED, SYNTH_LOWERED, SYNTH_FALLS };

struct synth_move {
	enum synth_move_kind kind;
	int first, last; /* it rests until the first, and from the last on */
	double by[3];	 /* where it gets from where it was */
	double aside;	 /* to the right of a straight line at half way */
};

/* In the order of their beginnings; the parts of one that has no rest inside overlap. */
struct synth_way {
	int n;
	struct synth_move moves[SYNTH_WAY];
	int partner; /* the object that it changes places with; -1 */
};

struct synth_moves {
	int times;
	struct synth_scene *scene; /* its objects stand as they do at the first time */
	struct splats first;	   /* its splats then */
	struct synth_way ways[SYNTH_MAX_OBJECTS];
};

/* Draws a way for each object, in which nothing touches anything else at any time. Two objects in seven, and
 * what stands on another or carries one, have none. Returns 0, or -1 with *e set; after either
 * synth_moves_free. */
int synth_moves_draw(
	struct synth_moves *m, struct synth_scene *scene, int times, uint64_t seed, struct err *e);
void synth_moves_free(struct synth_moves *m);

/* When that is: from 0 to 1. */
double synth_moves_time(int times, int time);

/* How far object i is from where it was first, at a time (between stored ones too); *rolled: how far it has
 * rolled. */
void synth_moves_at(const struct synth_moves *m, int i, double time, double by[3], double *rolled);

/* Moves the scene's splats to a stored time. */
void synth_moves_set(const struct synth_moves *m, int time);

/* A sentence of motion: what it means, and from when to when. */
struct synth_moving_sentence {
	enum synth_list kind;
	int is_several, first, last; /* several and none have no time */
	uint64_t objects;
	char text[SYNTH_TEXT];
};

struct synth_moving_sentences {
	size_t n, capacity;
	struct synth_moving_sentence *items; /* owned */
};

/* Sentences in the wordings of moves.tsv, or (is_kept_back) of moves-kept-back.tsv. Returns 0, or -1 with *e.
 */
int synth_moving_make(struct synth_moving_sentences *list, const struct synth_moves *m, int is_kept_back,
	uint64_t seed, struct err *e);
