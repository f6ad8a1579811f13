/* The one place for closed-class words: what grammar is made of, and the words of place and size. */
#pragma once

#include "lang/parse.h"

enum closed_class {
	CLOSED_DETERMINER,  /* the, a, my, this */
	CLOSED_NUMBER,	    /* two, 3, both, all, every */
	CLOSED_ORDINAL,	    /* first, 2nd, last */
	CLOSED_PRONOUN,	    /* it, them, you, us */
	CLOSED_GENERIC,	    /* one, thing, something: a head that names no kind */
	CLOSED_BE,	    /* is, 's, are */
	CLOSED_HAVE,	    /* has, got */
	CLOSED_WITH,	    /* with */
	CLOSED_NEGATION,    /* not, n't, no, without */
	CLOSED_EXCEPT,	    /* except, but */
	CLOSED_PREPOSITION, /* of, to, from: none that places by itself */
	CLOSED_AUXILIARY,   /* do, can, would */
	CLOSED_RELATIVE,    /* that, which, who */
	CLOSED_CONJUNCTION, /* and, plus */
	CLOSED_ADVERB,	    /* just, very, directly */
	CLOSED_REQUEST,	    /* please, pass, find */
	CLOSED_VIEW,	    /* facing, looking, when, if, entering */
	CLOSED_POSE,	    /* sitting, standing, located, hanging */
	CLOSED_PLACE,	    /* left, behind, on: has a relation */
	CLOSED_SIZE,	    /* big, taller: has a relation */
	CLOSED_ATTRIBUTE,   /* an adjective that is never a noun here */
	CLOSED_CLASSES
};

struct closed_word {
	const char *text;
	enum closed_class class;
	int relation; /* enum parse_relation of a place or size, -1 */
	int value;    /* a number's, an ordinal's (-1 for last), enum parse_degree of a place or size */
};

extern const struct closed_word closed_words[];
extern const int closed_count; /* at most CLOSED_MOST */
enum { CLOSED_MOST = 576 };

/* Its index or -1. */
int closed_find(const char *text);
/* Whether it is a word of the class. */
int closed_is(const char *text, enum closed_class class);

/* The class of a parse's word, CLOSED_CLASSES of one of the open classes, -1 where there is no such word. */
int closed_class_of(const struct parse *p, int word);

/* The relation the other way round: left for right, supports for on. */
enum parse_relation closed_inverse(enum parse_relation r);
