/* The whole course of a parser: first examples and marked sentences, whose analyses are known, then readings
 * whose words are found by the weights learnt so far. */
#ifndef LANG_PARSER_SCHOOL_H
#define LANG_PARSER_SCHOOL_H

#include "lang/parser_learn.h"
#include "lang/reading_align.h"

struct parser_school {
	struct parser_sample *examples; /* (example_count) */
	size_t example_count;
	struct parser_sample *marked; /* (marked_count): people's sentences with marks */
	size_t marked_count;
	struct parser_sample *read; /* (read_count): sentences with readings; without `right` */
	const struct reading **readings;
	char **texts, **pieces; /* (read_count) of these */
	int *fold;		/* (read_count): which part they are left out with */
	size_t read_count;
	int epochs, rounds;
	unsigned long long seed;
	/* of parser_course; may be NULL; of several members at once, one at a time */
	void (*progress)(void *context, int member, int epoch, double loss);
	void *context;
};

/* All members of w learn, each by itself from its own start; on several threads at once. */
int parser_school_examples(const struct parser_school *s, struct parser_weights *w, struct err *e);
/* Goes on from there with the readings but those of fold `without` (-1: with all), the marked sentences, and
 * some of the examples. */
int parser_school_readings(
	const struct parser_school *s, struct parser_weights *w, int without, struct err *e);
/* Takes away what the grammar says of every sentence. */
void parser_school_blind(struct parser_school *s);
void parser_school_free(struct parser_school *s); /* samples, readings' list and folds */

#endif
