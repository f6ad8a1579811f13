/* What is shared by the files that say a question again (lang/question_forms.h). */
#pragma once

#include "lang/closed.h"
#include "lang/question_match.h"

enum { ITEMS = 8 }; /* of a list that is chosen from */

/* From one token up to another. */
struct part {
	int begin, end;
};

/* A question, and what it is said again as: `n` of `size` bytes so far. */
struct asked {
	const struct tokens *t;
	const char *text;
	char *to;
	size_t size, n;
};

static inline int is_class(const struct tokens *t, int i, enum closed_class class)
{
	return tokens_class(t, i) == (int)class;
}

/* Whether a token is a noun; whether one of a part may name a thing. */
int asked_is_content(const struct tokens *t, int i);
int asked_has_content(const struct tokens *t, struct part p);

void asked_put(struct asked *q, const char *words);
void asked_put_part(struct asked *q, struct part p);
/* "the mug, the jug and the tray"; last: " and " */
void asked_put_list(struct asked *q, const struct part *items, int n, const char *last);

/* The longest list of things in the question; returns how many they are. */
int asked_list(const struct asked *q, struct part items[ITEMS]);

/* Where the part of a sentence ends that begins at a token, and where the one begins that has a token. */
int asked_end_of(const struct asked *q, int begin);
int asked_begin_of(const struct asked *q, int i);

/* Says a choice from a list again: "mug, jug, tin: the smallest?" Returns 0 where it is none. */
int asked_say_choice(struct asked *q);
