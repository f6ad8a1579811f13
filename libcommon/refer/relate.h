/* How well each object fits a relation to others, as people mean it from the reference viewpoint. Every
 * judgement is a number in [0,1] that changes smoothly with where things are, so that a relation that holds
 * by a hair weighs little. */
#ifndef REFER_RELATE_H
#define REFER_RELATE_H

#include "lang/sentence.h"
#include "refer/arrangement.h"

/* out (a->n). anchors (count,n): for each anchor of the relation how likely each object is to be it, summing
 * to 1; an object is not its own anchor. fit (n) in [0,1]: how well each object fits the target's own words,
 * for what compares (nearest, leftmost, largest ...) compares with those that fit. key (n) is scratch. */
void relate(const struct arrangement *a, enum lang_relation relation, const double *anchors, int count,
	const double *fit, double *key, double *out);

#endif
