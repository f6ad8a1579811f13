/* What vocabulary.c makes and vocabulary_match.c and vocabulary_uses.c ask. */
#pragma once

#include "ask/vocabulary.h"

/* out (width) of length 1: the mean direction of a word's pieces, less the scene's mean. */
void vocabulary_word_vector(
	struct vocabulary *v, const struct parse_word *w, const float *vectors, float *out);

/* out (width) of length 1: the mean of pieces, less one of v's means. */
void vocabulary_sentence_vector(
	struct vocabulary *v, const float *vectors, size_t pieces, const double *less, float *out);

/* out (width) of length 1: the mean of the pieces of the words that count, less one of v's means; NULL: of
 * none. */
void vocabulary_words_vector(struct vocabulary *v, const struct vocabulary_sentence *s, const char *counts,
	const double *less, float *out);

/* Finds the lines of lang/things.h that each object is, after all else is known of it. */
int vocabulary_find_lines(struct vocabulary *v, const struct parser *parser, struct err *e);

static inline char vocabulary_lower(char c)
{
	return c >= 'A' && c <= 'Z' ? (char)(c - 'A' + 'a') : c;
}

/* Whether a word is a word of a name: 2 its last (no number) or all without gaps, 1 another. */
int vocabulary_in_name(const char *word, const char *name);
