/* What parse-train learns from: the generator's example sentences, and people's with marks
 * (formats/records/marked.md). */
#ifndef CMD_TRAIN_PARSER_LESSONS_H
#define CMD_TRAIN_PARSER_LESSONS_H

#include "base/err.h"
#include "formats/scene/text.h"
#include "lang/parser_school.h"

/* Writes n example sentences (JSON Lines), of the wordings for training or for testing. Returns 0, or -1 with
 * *e set; so do the next. */
int parser_examples_write(const char *path, long long n, int is_test, long long seed, struct err *e);

/* Writes the sentences of a file of marked ones (JSON Lines), or the parses that their marks stand for
 * (formats/records/parses.md), whose words are spelt as where they were encoded (NULL: as without an
 * encoder). */
int parser_marked_write(
	const char *path, const char *encoded, int is_parses, const char *output, struct err *e);

/* Samples of the examples that were encoded as the text, which is the file `path`. */
int parser_examples_take(
	struct parser_school *c, const struct text *text, const char *path, long long seed, struct err *e);

/* The same of the marked sentences of the file `path`, of which the text is the file `encoded`. */
int parser_marked_take(struct parser_school *c, const char *path, const struct text *text,
	const char *encoded, struct err *e);

/* The vectors of a sentence of a text, *count of them. */
const float *lesson_vectors(const struct text *t, size_t sentence, int *count);

#endif
