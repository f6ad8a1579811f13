/* What sentences are made of: frames, wordings of relations, and words for what objects are. They are data:
 * sentences.tsv for training and test sentences, unseen.tsv for those that test parsers; moves.tsv and
 * moves-kept-back.tsv for what moves. No author of a parser should read unseen.tsv and moves-kept-back.tsv.
 */
#pragma once

#include "base/err.h"
#include "base/rng.h"
#include "lang/parse.h"
#include "synth/objects.h"

/* The list that a row belongs to. Frames first, by what they are built on. Slots of a frame:
 *   %S %F %M %C  the size, finish, material and colour of the target
 *   %N %Q %G     its noun, the same in the plural, a noun for several shapes
 *   %T %P        all these in order, the same in the plural
 *   %R %W        the target's next clause, all of them
 *   %Z           the next clause as an adjective ("biggest")
 *   %V %L        the first clause as a predicate ("is left of the cup"), without its verb ("left of the cup")
 *   %A           the first clause's first anchor, which the clause then calls "it"
 *   %X %Y        phrases that are left out or meant too
 *   %K %O %E %U  how many, "second", "left", what one does with it
 *   %I           a finished sentence */
enum synth_list {
	SYNTH_TRAIN,
	SYNTH_TEST,
	SYNTH_PLAINLY,	/* a phrase and its clauses, written down */
	SYNTH_CHATTY,	/* the same, spoken */
	SYNTH_NOT,	/* a negated clause */
	SYNTH_OTHER,	/* one is left out, the other is meant */
	SYNTH_NOTHING,	/* nothing stands on it */
	SYNTH_NEITHER,	/* two are left out */
	SYNTH_ORDINAL,	/* second from the left */
	SYNTH_EXTREME,	/* leftmost */
	SYNTH_OF_GROUP, /* the left one of the two */
	SYNTH_MOST,	/* biggest */
	SYNTH_PAIR,	/* the bigger of the two */
	SYNTH_THAN,	/* bigger than something */
	SYNTH_ALL,	/* all of a kind */
	SYNTH_COUNT,	/* the three */
	SYNTH_ALSO,	/* this one and that one */
	SYNTH_EXCEPT,	/* all but one */
	SYNTH_FUNCTION, /* by what one does with it */
	SYNTH_VIEW,	/* around a sentence that is said of a picture */
	SYNTH_FRAMES,
	SYNTH_KINDS = SYNTH_FRAMES, /* a kind of unseen sentence, and frames for it */
	SYNTH_RELATIONS,	    /* a relation, and how often it is used; form R or Z: its slot */
	SYNTH_SAID,		    /* a wording of one, with %A and %B for the anchors */
	SYNTH_SAID_TEST,
	SYNTH_SIZES_SAID, /* words, and what they say of an object */
	SYNTH_FINISHES_SAID,
	SYNTH_MATERIALS,
	SYNTH_COLOURS_SAID,
	SYNTH_NOUNS,
	SYNTH_GROUPS,
	SYNTH_FOREIGN, /* nouns of what is in no scene */
	SYNTH_USES,    /* what one does with an object */
	/* What moves how (synth/moves.h). Forms: 's' means one thing or none, 'p' several, 'e' tells of an
	 * event. Slots: %T %P the thing, the things; %A another, with its article; %Y an event. */
	SYNTH_MOTIONS,
	SYNTH_PLAIN_THING = SYNTH_MOTIONS, /* whatever it does */
	SYNTH_ANY_MOVE,
	SYNTH_MOVES_NOT,
	SYNTH_STARTS,
	SYNTH_STOPS,
	SYNTH_PAUSES,
	SYNTH_RAISED,
	SYNTH_PUT_DOWN,
	SYNTH_FALLS_DOWN,
	SYNTH_ROLLS_OFF,
	SYNTH_SLIDES_OFF,
	SYNTH_LEFTWARDS,
	SYNTH_RIGHTWARDS,
	SYNTH_NEARER,
	SYNTH_FARTHER,
	SYNTH_TOWARDS, /* another; so are the next four */
	SYNTH_AWAY,
	SYNTH_PASSES_BEHIND,
	SYNTH_PASSES_FRONT,
	SYNTH_CHANGES_PLACES,
	SYNTH_FASTEST,
	SYNTH_SLOWEST,
	SYNTH_MOVES_MOST,
	SYNTH_MOVES_FIRST,
	SYNTH_MOVES_LAST,
	SYNTH_WHILE,
	SYNTH_BEFORE,
	SYNTH_AFTER,
	SYNTH_LISTS
};

/* A table of rows. */
enum synth_table_of {
	SYNTH_TABLE_SENTENCES,
	SYNTH_TABLE_UNSEEN,
	SYNTH_TABLE_MOVES,
	SYNTH_TABLE_MOVES_KEPT,
	SYNTH_TABLES
};

/* What words say of an object: for each property the values that they surely mean, and those that they may be
 * thought to mean, a bit each. */
struct synth_sense {
	unsigned surely[SYNTH_PROPERTIES], maybe[SYNTH_PROPERTIES];
};

struct synth_row {
	enum synth_list list;
	const char *text, *more; /* more: the plural; the words of a use that a parse has */
	int weight;
	enum synth_list frames; /* of KINDS */
	/* Of RELATIONS and SAID. anchors -1: whoever looks, named in the text. Forms of a wording: 'p' goes
	 * after "is" ("left of %A"), 'h' is a predicate of its own ("has %A on its right"), 'w' only goes
	 * after a noun ("with %A on its right"), 'c' is an adjective ("biggest"). */
	enum parse_relation relation;
	enum parse_degree degree;
	int anchors;
	char form;
	/* Of words. */
	enum synth_property property;
	unsigned surely, maybe;
};

struct synth_wordings {
	int n;
	struct synth_row *rows; /* owned */
	char *text;		/* owned; rows point into it */
};

/* "motion-falls"; NULL where none of motion. */
const char *synth_motion_name(enum synth_list motion);

/* Returns 0, or -1 with *e set (memory). */
int synth_wordings_load(struct synth_wordings *w, enum synth_table_of table, struct err *e);
void synth_wordings_free(struct synth_wordings *w);

/* Which rows: of the list, and as far as it is given surely true of the object, with the text, of that
 * relation, degree and number of anchors, of a form among `forms`. */
struct synth_query {
	enum synth_list list;
	const struct synth_object *of;
	const char *text, *forms;
	const struct synth_row *like;
	int is_stepwise; /* drawn by one random number a row that fits, instead of one for all of them */
};

/* A random one of the rows, by their weights; NULL where there is none. */
const struct synth_row *synth_draw(
	const struct synth_wordings *w, const struct synth_query *q, struct rng *r);

/* Narrows *s to what the word says too. */
void synth_sense_add(struct synth_sense *s, const struct synth_row *word);

/* 1: surely means the object, -1: surely does not, 0: may be thought to. */
int synth_sense_judge(const struct synth_sense *s, const struct synth_object *o);

extern const struct synth_sense synth_anything;
