/* What a sentence says of motion: which of its things moves how, "the box behind the cup that falls", and
 * when, "while the ball rolls". It is read off a parse, which is left as if the sentence did not say it: "the
 * box behind the cup". The words are in libcommon/lang/motion_words.tsv. English. */
#pragma once

#include "lang/parse.h"

enum motion_kind {
	MOTION_MOVES,
	MOTION_STILL,
	MOTION_STARTS, /* it rested before */
	MOTION_STOPS,  /* it rests then */
	MOTION_PAUSES, /* it rests between two moves */
	MOTION_FALLS,
	MOTION_RAISED,
	MOTION_LOWERED, /* put down */
	MOTION_ROLLS,
	MOTION_SLIDES,
	MOTION_TURNS, /* about its upright axis */
	MOTION_TIPS,
	MOTION_LEFT,
	MOTION_RIGHT,
	MOTION_UP,
	MOTION_DOWN,
	MOTION_TOWARDS,
	MOTION_AWAY,
	MOTION_PASSES,
	MOTION_BEHIND, /* another, as who looks sees it, from one side to the other */
	MOTION_FRONT,  /* likewise */
	MOTION_SWAPS,  /* places */
	MOTION_FOLLOWS,
	MOTION_FASTEST, /* from here on: among the things that the rest fits */
	MOTION_SLOWEST,
	MOTION_FARTHEST,
	MOTION_LEAST,
	MOTION_FIRST,
	MOTION_LAST,
	MOTION_WHILE, /* when */
	MOTION_BEFORE,
	MOTION_AFTER,
	MOTION_TIME, /* "all the time": nothing else */
	MOTION_KINDS,
	MOTION_NONE = MOTION_KINDS
};

enum { MOTION_EVENTS = 8 };

/* "Rolls past the cup". */
struct motion_event {
	enum motion_kind kind;
	int negated;
	int phrase; /* what moves */
	int about;  /* the phrase of the cup; -1: none, or who looks */
};

struct motion_said {
	int n;
	struct motion_event events[MOTION_EVENTS]; /* those that compare last */
};

/* Takes what a parse says of motion out of it. Returns how many events there are. */
int motion_said_take(struct motion_said *m, struct parse *p);

/* A sentence within a sentence, and what is left of it: words from begin to end - 1. */
struct motion_cut {
	int begin, end;		    /* without "does", "when does" in front */
	enum motion_kind when;	    /* MOTION_WHILE, MOTION_BEFORE, MOTION_AFTER; MOTION_NONE: no other, */
	int other_begin, other_end; /* of these */
};

/* Returns 1 where anything is to cut. text: of the parse. */
int motion_said_cut(struct motion_cut *c, const struct parse *p, const char *text);

/* "falls": for the reason of a refusal. */
const char *motion_kind_name(enum motion_kind kind);
