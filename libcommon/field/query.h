/* What a trained field is asked in place of a sentence's words, where it goes by parses. The paper's field
 * adds up its answers to all words, so that the landmark of a relation is marked as readily as the thing
 * itself. A query has a row for each word piece of the things that are meant, and of what they are said to
 * have
 * ("with"), and one for each clause, so that the field can learn "left of the plate" apart from "plate":
 *
 *   [vector of the piece; mean of the anchors' pieces; flags]
 *
 * A clause is known by the flag of its relation, whatever words say it; one of no place ("that you type on")
 * by the mean of its predicate's pieces. A sentence of which nothing is left has its words as rows, with the
 * flag QUERY_RAW. */
#pragma once

#include "base/err.h"
#include "lang/parser.h"

#include <stddef.h>
#include <stdint.h>

/* Flags, after those of enum parse_relation. A row has 0 or one number for all in each. */
enum query_flag {
	QUERY_TARGET = PARSE_RELATIONS, /* a piece of what is meant */
	QUERY_HAS,			/* of what it has */
	QUERY_CLAUSE,
	QUERY_RAW,
	QUERY_NEGATED, /* it does not hold; what is left out */
	QUERY_NESTED,  /* said of an anchor */
	QUERY_MORE,    /* degrees */
	QUERY_MOST,
	QUERY_ORDINAL, /* first to fourth, and last */
	QUERY_FLAGS = QUERY_ORDINAL + 5
};

/* Sentences as text.safetensors has them (formats/scene/text.h). */
struct query_text {
	size_t n;
	int width;
	const int64_t *offsets;
	const float *words, *middle;
	char *const *texts, *const *pieces;
};

struct query {
	int64_t *offsets; /* (n+1) of the sentences' rows */
	float *words;	  /* (offsets[n], query_width) */
};

/* Columns of a row, for words of `width`. */
int query_width(int width);

/* Of all sentences; the same for any number of threads. Those without words have no rows. 0, or -1 with *e
 * (memory); query_free after either. */
int query_make(struct query *q, const struct query_text *t, const struct parser *parser, struct err *e);
void query_free(struct query *q);
