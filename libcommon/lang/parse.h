/* A referring sentence taken apart: noun phrases, and the clauses that say how they stand to one another.
 * "the small mug on the plate that is left of the red book" is the target phrase "small mug" with a clause
 * on, whose anchor is the phrase "plate" with a clause left, whose anchor is the phrase "red book". English.
 *
 * A parse is flat: phrases and clauses are arrays, and refer to one another by index. Phrase 0 is the target;
 * every other phrase is reached from it. formats/records/parses.md shows the same as JSON. */
#pragma once

#include "base/err.h"

#include <stddef.h>

enum parse_relation {
	PARSE_LEFT,
	PARSE_RIGHT,
	PARSE_FRONT,
	PARSE_BEHIND,
	PARSE_ABOVE, /* higher up, or over without contact; "the highest" is this with PARSE_MOST */
	PARSE_BELOW,
	PARSE_ON,     /* rests on its anchor */
	PARSE_INSIDE, /* is in its anchor */
	PARSE_NEAR,   /* "nearest to X" is this with PARSE_MOST */
	PARSE_FAR,
	PARSE_BETWEEN, /* several anchors, or one that is plural */
	PARSE_MIDDLE,  /* of its anchor, of the scene, or of the things that the target's words fit */
	PARSE_LARGER,
	PARSE_SMALLER,
	PARSE_TALLER,
	PARSE_SHORTER,
	PARSE_LONGER,
	PARSE_WIDER,
	PARSE_CORNER,
	PARSE_WALL,
	PARSE_FLOOR,
	PARSE_FACING,
	PARSE_ACROSS,
	PARSE_SUPPORTS, /* carries or holds its anchor: "with a ball on it", "that the mug stands on"; negated
			   with an anchor of no noun: "with nothing on it" */
	PARSE_WITH,	/* has its anchor as a part or beside it: "with a handle", "wearing a scarf" */
	PARSE_OTHER,	/* a predicate of no place: what a thing does or is for ("that you type on") */
	PARSE_RELATIONS
};

enum parse_degree { PARSE_PLAIN, PARSE_MORE, PARSE_MOST }; /* "large", "larger than", "largest" */

/* How many things a phrase means. A number above 1: exactly so many. */
enum { PARSE_ONE = 1, PARSE_SEVERAL = -1, PARSE_ALL = -2 };

struct parse_span {
	int begin, end; /* bytes of the text; begin == end: nothing */
};

struct parse_list {
	int n, *item;
};

struct parse_word {
	struct parse_span span;
	int piece, pieces; /* its word pieces in the encoder's order: piece .. piece+pieces-1; 0 pieces where
			      the parse was made without an encoder */
	char *text;	   /* lower case, spelling repaired */
	char *lemma;
};

struct parse_phrase {
	struct parse_span span; /* from its first word to its last, without its clauses */
	struct parse_list noun; /* words of the noun, the head last ("trash can"); none: "the other one" */
	struct parse_list attributes; /* other words that say something of it: "red", "wooden", "shiny" */
	struct parse_list clauses;    /* clauses that it is the figure of */
	struct parse_list
		among; /* phrases one of which it is: "of the jar, the tin and the box the tallest" */
	struct parse_list except; /* phrases that are left out: "but not the red one", "except the mug" */
	struct parse_list also;	  /* phrases meant too: "the red mug and the bowl"; of the target only */
	int count;		  /* PARSE_ONE, PARSE_ALL, PARSE_SEVERAL or a number */
	int group;   /* "the left one of the two cups": 2; "which of the cups": PARSE_SEVERAL; 0: no
			group is spoken of */
	int ordinal; /* 2 for "second", -1 for "last", -2 for "last but one"; 0: none */
	enum parse_relation from; /* of an ordinal: the end it counts from ("from the left": PARSE_LEFT;
				     PARSE_OTHER: not said) */
	int viewer;		  /* 1: who looks or the camera: "us", "me", "the camera" */
	int scene;		  /* 1: the place as a whole: "the picture", "the room", "the table" as in
				     "the left side of the table" */
};

struct parse_clause {
	struct parse_span span; /* of the predicate's words */
	enum parse_relation relation;
	enum parse_degree degree;
	int negated;
	struct parse_list
		anchors;	 /* phrases; none: of the whole scene, or of the things that the words fit */
	struct parse_list words; /* words of the predicate that say something: "type" for PARSE_OTHER */
};

enum parse_view { PARSE_VIEW_NONE, PARSE_VIEW_FACING, PARSE_VIEW_FROM };

struct parse {
	int word_count, phrase_count, clause_count;
	struct parse_word *words;
	struct parse_phrase *phrases; /* phrases[0] is the target, always there */
	struct parse_clause *clauses;
	enum parse_view view;	       /* "when facing the window", "from the door" */
	int view_phrase;	       /* the phrase of the window or door; -1 */
	double confidence;	       /* of the parse, in [0,1] */
	struct parse_list unexplained; /* words that say something and found no place */
};

/* A zeroed one may be freed. */
void parse_free(struct parse *p);

/* "left" ... "other": as in parses.jsonl. */
const char *parse_relation_name(enum parse_relation r);
/* The relation of that name or -1. */
int parse_relation_find(const char *name);

/* Appends to a list; -1 only where memory is out. */
int parse_list_add(struct parse_list *list, int item, struct err *e);

/* Appends a list's items to another; likewise. */
int parse_list_join(struct parse_list *to, const struct parse_list *from, struct err *e);

/* Whether an item is in a list. */
int parse_list_has(const struct parse_list *list, int item);

/* Only the items below `end` stay. */
void parse_list_cut(struct parse_list *list, int end);

/* Whether there is such a word and its text is one of "this|that". */
int parse_word_is(const struct parse *p, int word, const char *words);
