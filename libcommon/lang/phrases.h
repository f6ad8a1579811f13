/* The phrases that say where a thing is, and words that say nothing of it. */
#ifndef LANG_PHRASES_H
#define LANG_PHRASES_H

#include "lang/sentence.h"

/* What follows a phrase, or comes before it. */
enum lang_form {
	LANG_AFTER,	  /* an anchor, or several with "and" */
	LANG_PAIR,	  /* two anchors */
	LANG_PAIR_BEFORE, /* two anchors came after "with" */
	LANG_AGAIN,	  /* the anchors of the clause before: "on its left" */
	LANG_PLACE,	  /* nothing, or the name of a surface */
	LANG_ADJECTIVE,	  /* nothing; it may stand within a noun phrase */
	LANG_SIDE_WORD,	  /* the same, but only as in "the left one", "the left-hand mug" */
	LANG_OUTERMOST,	  /* the same, but only before "to the left of" or "to the right of" */
};

struct lang_match {
	enum lang_relation relation;
	enum lang_form form;
	int length; /* words */
};

/* The longest phrase that begins at word `at`: 1, or 0 where none does. */
int lang_match(const struct lang_sentence *s, int at, struct lang_match *m);

/* Whether a word is in a list of words with spaces between. */
int lang_is_one_of(const char *word, const char *list);

extern const char lang_determiners[]; /* the a an its ... */
extern const char lang_viewers[];     /* us camera viewer ... */
extern const char lang_surfaces[];    /* table desk picture ...: what is no anchor */
extern const char lang_enders[];      /* that which with standing ...: end an anchor */
extern const char lang_links[];	      /* and, directly, ...: no part of an anchor that they end */

/* Whether a word says something of a thing. */
int lang_says_something(const char *word);

#endif
