/* Gaussians from files of any layout: a reader gives rows of numbers in one order, and what every reader does
 * is done here: activations, leaving out what no scene may have, the offset (formats/splats/ply.md). */
#pragma once

#include "base/err.h"
#include "splat/splats.h"

/* The values of a row, as 3DGS's .ply has them: logarithms of the standard deviations, logit of the opacity,
 * quaternion w x y z; then the harmonics from degree 1 on, all of red, then green, then blue. */
enum {
	ROW_MEAN = 0,
	ROW_DC = 3,
	ROW_OPACITY = 6,
	ROW_SCALE = 7,
	ROW_ROT = 10,
	ROW_REST = 14,
	ROW_REST_MAX = 45,
	ROW_MAX = ROW_REST + ROW_REST_MAX
};

/* What was left out on reading, and why. */
struct rows_report {
	size_t read;		      /* Gaussians in the file */
	size_t not_finite, zero_quat; /* left out */
	size_t *dropped;	      /* (not_finite + zero_quat) indices, rising; owned by the caller */
};

/* Where rows come from. next fills values (ROW_REST + rest) of row `row`; called for 0 to n - 1 in order.
 * Where it returns 1 it has filled the mean and the rotation alone: the rest is that of Gaussian `row` of
 * `like`. */
struct gaussian_rows {
	const char *path; /* as messages name the file */
	size_t n;	  /* the file has so many: check that before this is used */
	int rest;	  /* 3 (K-1): 0, 9, 24 or 45 */
	int (*next)(void *reader, size_t row, double *values, struct err *e);
	void *reader;
	const struct splats *like; /* of n Gaussians; NULL: next returns 0 or -1 */
};

/* Reads all rows. Returns 0, or -1 with *e. The report is complete, and its list and *s are the
 * caller's, after either. */
int gaussian_rows_read(struct splats *s, double offset[3], struct rows_report *report,
	const struct gaussian_rows *from, struct err *e);

/* The offset of means (n,3), by the rule of ply.md. Returns 0, or -1 with *e set. */
int gaussian_offset(double offset[3], const double *means, size_t n, struct err *e);

/* The row of Gaussian i, without an offset; the number of its values. */
int gaussian_row_of(const struct splats *s, size_t i, double *values);

/* The inverse of the sigmoid. 0 and 1 have none: what is given gives them back in single precision. */
double gaussian_logit(double opacity);

/* The harmonics from degree 1 on where the y and z axes, or x and y, are turned round: each one's sign. */
enum { FLIP_X = 1, FLIP_Y = 2, FLIP_Z = 4 };
int gaussian_flip_sign(int coefficient, int axes);
