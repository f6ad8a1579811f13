/* What .sog files number their values by: a codebook of single numbers, a palette of rows of them. Both are
 * found without chance, so that the same scene makes the same file. formats/splats/sog.md. */
#pragma once

#include "base/err.h"

#include <stdint.h>

enum { PALETTE_CODES = 256 };

/* Numbers that stand for values (n): codes get PALETTE_CODES of them, rising. Where there are not more
 * different values, they are these; else each is the mean of the values that are nearest to it, and the
 * squared error is about the least. Returns 0, or -1 with *e set. */
int palette_codebook(double codes[PALETTE_CODES], const float *values, size_t n, struct err *e);

/* The nearest of the codes. */
int palette_code(const double codes[PALETTE_CODES], double value);

/* Rows that stand for rows (n, width): centres (k, width), k at most `most`, and for each row its centre.
 * The set with the largest squared error is cut in two, at the mean of the column with the largest variance,
 * until there are `most` sets or none has an error. Returns 0, or -1 with *e set. */
int palette_rows(float *centres, size_t *k, uint16_t *labels, const float *rows, size_t n, size_t width,
	size_t most, struct err *e);
