/* Answers of refer-ask for a person or a program to read. */
#ifndef CMD_ASK_ANSWER_WORDS_H
#define CMD_ASK_ANSWER_WORDS_H

#include "base/err.h"
#include "cmd/ask/answer_picture.h"
#include "cmd/ask/asking.h"
#include "cmd/ask/calling.h"
#include "cmd/ask/distance.h"

#include <stdio.h>

struct answer_told {
	const struct asking *asking;
	const char *question; /* or the place in a view where a thing was picked */
	const struct asking_answer *answer;
	int is_picked;
	struct calling calling;	   /* of what was picked */
	struct distance distance;  /* where one was asked */
	const char *picture;	   /* that was made of it; NULL: none */
	struct answer_drawn drawn; /* what is in the picture */
};

/* A line for each thing, or for a distance, or one that says why there is none; after the explanation, where
 * there is one. */
int answer_put_words(const struct answer_told *t, FILE *out, struct err *e);

/* A JSON object on one line. refer-ask(1) lists its keys. Both return 0, or -1 with *e. */
int answer_put_json(const struct answer_told *t, FILE *out, struct err *e);

/* The shortest answer, for a caption: "kettle 97%, bottle 92%", or "nothing here". Cut to fit. */
void answer_caption(const struct answer_told *t, char *to, size_t room);

#endif
