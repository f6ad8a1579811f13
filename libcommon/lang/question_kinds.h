/* What kind of answer a question wants, and of what: "how tall is the mug?" wants a size of "the mug". The
 * table is libcommon/lang/question_kinds.tsv. English. */
#pragma once

#include "lang/parse.h"
#include "lang/tokens.h"

enum question_kind {
	QUESTION_WHICH,	   /* the thing itself, and where it is: whatever is none of the others */
	QUESTION_LIST,	   /* all that is there */
	QUESTION_NUMBER,   /* how many */
	QUESTION_COLOUR,   /* what colour it has */
	QUESTION_LOOK,	   /* what else is said of it */
	QUESTION_DISTANCE, /* from one thing to another, or between two of a kind */
	QUESTION_HEIGHT,   /* how tall */
	QUESTION_WIDTH,	   /* how wide, how long */
	QUESTION_SIZE,	   /* how large */
	QUESTION_COMPARE,  /* which of two is larger, higher, farther left */
	QUESTION_MORE,	   /* whether the first of two is the larger, the higher */
	QUESTION_EITHER,   /* which of the second and the third the first thing is: "black or white" */
	QUESTION_THERE,	   /* whether it is there */
	QUESTION_WHETHER,  /* whether the first, which is there, is the second */
	QUESTION_SET,	   /* what stands in a relation: one thing, or where that is in doubt all that do */
	QUESTION_TALLY,	   /* whether there are more of the first than of the second */
	QUESTION_EVEN,	   /* whether there are as many of the first as of the second */
	QUESTION_MAJORITY, /* of which of two there are more */
	QUESTION_SURPLUS,  /* how many more there are of the first than of the second */
	QUESTION_SAME,	   /* whether things are alike in a size or, with no relation, in colour */
	QUESTION_WHEN,	   /* when a thing moves */
	QUESTION_THEN,	   /* where it is at the end, or was at the start */
	QUESTION_UNTOLD,   /* what no scene tells: how fast it is, who owns it, why it is there */
	QUESTION_KINDS
};

enum { QUESTION_TEXT = 2048, QUESTION_WAYS = 8 /* that are worth trying */ };

struct question_asked {
	enum question_kind kind;
	int relation;  /* enum parse_relation of the word of size or place that asks ("tall"), or that a place
			  begins with ("on the tray"); -1 where there is none */
	int least;     /* of QUESTION_NUMBER: 1 where kinds of things are counted; of QUESTION_THERE: how many
			  have to be there, 0: any; of QUESTION_WHETHER: 1 where nothing else is the second; of
			  QUESTION_TALLY: by how many there have to be more; of QUESTION_MAJORITY: -1 where it
			  asks for fewer */
	int most;      /* of QUESTION_THERE: how many there may be, and of QUESTION_SET and QUESTION_COMPARE 1
			  where but one is meant; 0: any number */
	int is_denied; /* of QUESTION_THERE: yes where none is */
	char text[3][QUESTION_TEXT]; /* what to ask for; "" nothing. The second of QUESTION_COLOUR: the whole,
				      * where the first is a part. The third: what two are compared by */
	struct parse_span about;     /* of the question: the thing that it asks about; empty: not known */
};

/* The name of a kind, as the table has it. */
const char *question_name(enum question_kind kind);

/* The way-th way to read a question, from 0: 1, or 0 where there is no such way. Way 0 of a text that is of
 * no other kind is QUESTION_WHICH with the text itself. */
int question_read(struct question_asked *q, const char *text, int way);

/* The noun of a phrase: "mug" of "the red mug on the tray"; "": it has none. */
void question_noun(const char *phrase, char noun[TOKEN_LENGTH]);

/* Whether a phrase means any of its kind: "anything", "a mug", "one of them". */
int question_is_any(const char *phrase);

/* Whether a text asks for whatever there is, "what can I drink from?", "the ones to read", and not for one.
 */
int question_is_open(const char *text);

/* Whether a text asks for yes or no: "does the mug fall?" */
int question_is_yes_or_no(const char *text);
/* The same of something that is known to be there: "is the mug full?" */
int question_is_of_thing(const char *text);

/* Whether a text asks for a whole side of the scene: "on the left side". */
int question_is_half(const char *text);
