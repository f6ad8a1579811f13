/* How well each object fits a relation to others, as people mean it from a viewpoint. Every judgement is a
 * number in [0,1] that changes smoothly with where things are, so that what holds by a hair weighs little. */
#pragma once

#include "places/pairs.h"

/* A phrase that a relation is to: how likely each object, and last the viewer, is to be it. */
struct relate_anchor {
	const double *p; /* (a->n + 1) in [0,1] */
	int is_scene;	 /* the place as a whole; p means nothing */
	int is_every;	 /* all that fit ("taller than the cups"), not one of them */
	int is_other;	 /* the thing itself is one of those that fit: "than the other cups" */
};

struct relation {
	enum parse_relation kind;
	enum parse_degree degree;
	enum relate_width width;
	int place; /* with PARSE_MOST: 2 for "second nearest to"; 0 as 1 */
	int count;
	const struct relate_anchor *anchors; /* (count) */
};

/* out (a->n). fit (n) in [0,1]: how well each object fits what else is said of the target, for what compares
 * (nearest, leftmost, largest ...) compares with those that fit. key (3n) is scratch. An object is not its
 * own anchor. A plain size with an anchor is "as large as". */
void relate(
	const struct arrangement *a, const struct relation *r, const double *fit, double *key, double *out);

/* out (n): that an object is the k-th from an end (k > 0; from the other end: k < 0) among those that fit, by
 * a relation that orders them: PARSE_LEFT counts from the left. key (n) is scratch. */
void relate_rank(const struct arrangement *a, enum parse_relation from, int k, const double *fit, double *key,
	double *out);

/* The same by a key of the caller's, in units of what is told apart: the smallest is the first. */
void relate_rank_by(const struct arrangement *a, const double *key, int k, const double *fit, double *out);
