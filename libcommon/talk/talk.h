/* What was spoken of in a conversation, and the words that point back to it: "it", "the other one", "and the
 * kettle?", "the rest". They are put right in a question's text, so that everything else reads it as if it
 * had been said in full. English. */
#pragma once

#include "ask/meaning.h"
#include "lang/question_kinds.h"

#include <stddef.h>

#define TALK_NONE ((size_t)-1)

enum { TALK_TEXT = 256 /* bytes of what a thing is called */ };

/* What a conversation was about last. */
struct talk {
	size_t thing, other;	      /* the thing that was answered, and "the other one"; TALK_NONE */
	int is_unsure;		      /* it was asked which of the two is meant */
	char things[TALK_TEXT];	      /* "the mug and the cup": the two that were spoken of; "": it was one */
	struct meaning_set set;	      /* "them": the last answer of several */
	int is_several;		      /* it was the last one */
	struct meaning_set of;	      /* which the last questions were about some of: "the red one" */
	struct meaning_set rest;      /* the others of the kind that was answered */
	char question[QUESTION_TEXT]; /* that was asked last, as it was understood; "": none */
};
#define TALK_NEW                                                                                             \
	{                                                                                                    \
		.thing = TALK_NONE, .other = TALK_NONE                                                       \
	}

/* What was answered to a question: things among all that have names. */
struct talk_answer {
	char *const *names; /* (objects) */
	size_t objects;
	const struct question_asked *asked;
	const char *understood;
	const size_t *things; /* (count), likeliest first */
	size_t count, runner_up;
	int is_unsure; /* it is the first or runner_up */
};

/* A question with the things that its words point back to put in their place. names (objects). Returns the
 * things one of which is meant by their noun in it, or NULL: any. talk may be NULL: nothing was spoken of. */
const struct meaning_set *talk_understand(const struct talk *talk, char *const *names, size_t objects,
	const char *question, char understood[QUESTION_TEXT]);

/* Whether words of a text point back to what has to be known from before. */
int talk_points(const char *text);

/* Whether the last question told its things by their looks alone: "which mugs are brown?" */
int talk_is_of_looks(const struct talk *talk);

/* What is spoken of after an answer, which with is_within was of some of those before. */
void talk_take(struct talk *talk, const struct talk_answer *a, int is_within);

/* The words of a name but for numbers; with is_noun the last of them alone. */
void talk_name_words(const char *name, int is_noun, char words[TALK_TEXT]);
