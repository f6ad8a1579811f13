/* What things rest on, where that has no name: a shelf, a ledge, a stack of paper. It is told from the things
 * themselves: most stand at one height, and what stands higher, on none of the others, rests on something. */
#ifndef PLACES_RESTING_H
#define PLACES_RESTING_H

#include "places/arrangement.h"
#include "lang/parse.h"

/* Sets `raised` of all objects from their boxes. */
void resting_find(struct arrangement *a);

/* Whether a noun is of what holds things up off the ground: "shelf", "windowsill". */
int resting_holds(const char *lemma);

/* out (a->n) in [0,1]: how true it is that each stands on, or below, such a thing, where it is no object
 * here; a half for other relations, and where nothing is raised. */
void resting_relate(const struct arrangement *a, enum parse_relation kind, double *out);

#endif
