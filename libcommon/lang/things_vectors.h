/* What everyday things are for (lang/things.h), as directions in the space of a language encoder: of each
 * line of the table the mean of its uses' directions, so that a sentence that tells of a use is near to the
 * things that are for it, in whatever words. It is a part of the program: lang/things.vectors, the line
 * "refer.things 1 ENCODER LINES WIDTH HASH" (things_hash of the table) and LINES x WIDTH signed bytes, each
 * line of any length; made by `make -f pipelines/parse.mk things`. */
#pragma once

#include "base/err.h"

#include <stdint.h>

struct things_vectors {
	int lines, width;
	const int8_t *of; /* (lines,width) */
	float *length;	  /* (lines); owned */
	uint32_t hash;	  /* of the table that it was made of */
};

/* lines is 0 where the encoder (its fingerprint, or NULL) or the width of its words is another. Returns 0, or
 * -1 with *e set and nothing to free. */
int things_vectors_open(struct things_vectors *t, const char *encoder, int width, struct err *e);
void things_vectors_free(struct things_vectors *t);

/* The best cosine of a line of one with a line of the other: how far they are for the same; -1 without. */
double things_vectors_between(
	const struct things_vectors *t, const int *a, size_t a_n, const int *b, size_t b_n);

/* cosine (lines) of a direction (width) of length 1 with each. */
void things_vectors_cosines(const struct things_vectors *t, const float *direction, float *cosine);
