/* What the files of places/motions.h share. */
#pragma once

#include "base/logistic.h"
#include "geom/vector.h"
#include "places/motions.h"

/* A motion of this part of the size is as likely meant as not; and how soft that is. */
static const double motions_least = 0.3, motions_soft = 0.06;

/* How a number changes with time. */
struct signal {
	const double *axis; /* along this; NULL: minus the distance to */
	double sign;
	const struct track *other; /* this */
};

static inline double soft(double x, double half, double width)
{
	return logistic((x - half) / width);
}

static inline double distance(const double a[3], const double b[3])
{
	const double d[3] = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};

	return vector_length(d);
}

/* How far what goes somewhere goes there, and straight: the longest rise of a signal within *in, which
 * becomes its time. */
double motions_way(const struct signal *s, const struct track *k, double cosine, struct motions_span *in);

/* Its moves within a span together, which *in becomes: all, or by kind those after or before a rest. */
double motions_moves(
	const struct tracks *t, const struct track *k, enum motion_kind kind, struct motions_span *in);

/* The part of a move that is within a span. */
struct motions_span motions_within(const struct track_move *m, const struct motions_span *in);

/* motions_judge of motion about another object. */
double motions_about(
	const struct motions *m, enum motion_kind kind, size_t o, long about, struct motions_span *in);
