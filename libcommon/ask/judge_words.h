/* What the words of a phrase say of each object. */
#pragma once

#include "ask/meaning.h"

/* The noun of a phrase, or the noun that it leaves out: a part, and how far it is known. */
void judge_noun(struct meaning *m, int phrase);

/* How far objects are of the colour of a word, and of those right after it that are colours too: "salmon
 * pink" and "black and white" are either. Nothing where the word before it has done so. */
void judge_colour(struct meaning *m, int phrase, int word);

/* An attribute, which leaves at least so much to an object of which it is not said. */
void judge_attribute(struct meaning *m, int phrase, int word, double least);

/* said (O): a clause's anchor that is, or fits, no object, but that training sentences may tell of: "with a
 * handle", "on the shelf". */
void judge_said(struct meaning *m, const struct parse_clause *c, double *said);

/* value (O) takes in the colours of parts that are no objects: "with a black cap". */
void judge_part_colours(struct meaning *m, int phrase, const struct parse_clause *c, double *value);

/* What a thing does, is for, or has: any word of it may be said of an object. Returns how far something is
 * known to be so. */
double judge_predicate(struct meaning *m, const struct parse_clause *c, double *value);

/* "The chair nearest to the sink", and a sink is no object: it is where the things are that are said to be at
 * it. value (O): how far each is the place-th nearest, or farthest, of those that fit. Returns whether it is
 * told so. */
int judge_by_place(
	struct meaning *m, const struct parse_clause *c, int place, const double *fit, double *value);
