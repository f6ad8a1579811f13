/* A model's answers in space: what each is made of, where it is, and how sure it is. */
#ifndef ANSWER_LOCATE_H
#define ANSWER_LOCATE_H

#include "answer/responses.h"
#include "base/err.h"
#include "lift/extent.h"
#include "splat/splats.h"

struct located {
	struct extent extent;
	double sure; /* in [0,1]: mean of sigmoid(response - lift) over its Gaussians, 0 for none */
};

/* all (a->answers), zeroed, gets each answer; extent_free each, also after a failure. Returns 0, or -1 with
 * *e set. */
int locate_all(struct located *all, const struct responses *a, const struct splats *s, const double up[3],
	struct err *e);

/* Which Gaussians a viewer shows of an answer, and in which colour. */
enum locate_show { LOCATE_COLOURED, LOCATE_ISOLATED, LOCATE_REMOVED };

/* to: the scene with the answer's Gaussians painted, them alone, or the scene without them. splats_free it.
 * Returns 0, or -1 with *e set and *to zeroed. */
int locate_show(struct splats *to, const struct splats *s, const struct extent *x, enum locate_show show,
	struct err *e);

#endif
