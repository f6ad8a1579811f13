/* How two things stand to one another, by their boxes: each judgement in [0,1], or a distance. */
#pragma once

#include "lang/parse.h"
#include "places/arrangement.h"

/* How much of the plane is left of, behind ... a thing: what lies near that direction; more of it, where two
 * such relations together tell; and however far away, a quarter ("everything behind the plate") or half of it
 * ("everything left of the plate"). */
enum relate_width { RELATE_NARROW, RELATE_WIDE, RELATE_CONE, RELATE_HALF_PLANE };

/* How far p is in a relation of places to q: left of it, on it, near it. 0.5 for relations that are none. */
double pair_fits(const struct arrangement *a, enum parse_relation relation, enum relate_width width,
	const struct arranged *p, const struct arranged *q);

/* o is between p and q. */
double pair_between(const struct arrangement *a, const struct arranged *o, const struct arranged *p,
	const struct arranged *q);

/* p stands on q, in [0,1]. */
double pair_stands_on(const struct arrangement *a, const struct arranged *p, const struct arranged *q);

/* Between their boxes: 0 where they touch. */
double pair_gap(const struct arranged *p, const struct arranged *q);

/* Between their centres, on the ground. */
double pair_distance(const struct arranged *p, const struct arranged *q);

/* out (O): how far each is on the table itself, rather than on a thing that is on it, or on a shelf above it.
 */
void pairs_on_scene(const struct arrangement *a, double *out);
