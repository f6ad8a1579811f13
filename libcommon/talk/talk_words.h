/* What words of a question point back to: "it", "the other one", "those", "the left one". */
#pragma once

#include "lang/tokens.h"
#include "talk/talk.h"

/* What words of a question may point to; "" where there is no such thing. */
struct referents {
	char name[TALK_TEXT], other[TALK_TEXT], things[TALK_TEXT];
	char noun[TALK_TEXT], kind[TALK_TEXT]; /* of "the left one", and of "the red one" */
};

/* What words pointed to, as bits. */
enum { TO_THINGS = 1, TO_NOUN = 2 };

/* The question with what its words point back to in their place. Returns what they point to. */
unsigned talk_put_pointed(const struct referents *r, const char *question, char understood[QUESTION_TEXT]);

/* The question with the rest of what was spoken of in place of words for that: "the others", "how many
 * don't?". Returns whether it has such words. */
int talk_put_rest(const struct meaning_set *rest, const char *question, char to[QUESTION_TEXT]);

/* Whether a word says a look: of "the red one" another thing of the kind is meant. */
int talk_says_look(const struct tokens *t, int i);

/* "s" or "es". */
const char *talk_plural_end(const char *noun);
