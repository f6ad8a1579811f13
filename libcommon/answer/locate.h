/* A model's answers in space: what each is made of, where it is, and how sure it is. */
#pragma once

#include "answer/responses.h"
#include "base/err.h"
#include "lift/extent.h"
#include "splat/splats.h"

struct located {
	struct extent extent;
	double sure; /* in [0,1]: mean of sigmoid(response - lift) over its Gaussians, 0 for none */
};

/* all (a->answers), zeroed, gets each answer; extent_free each, also after a failure. 0, or -1 with *e. */
int locate_all(struct located *all, const struct responses *a, const struct splats *s, const double up[3],
	struct err *e);

/* What is shown of the Gaussians of an answer. */
enum locate_show { LOCATE_COLOURED, LOCATE_ISOLATED, LOCATE_REMOVED };

/* of (N) gets 1 for the Gaussians of things of a lifted model (extents (O)), else 0: those that are mostly in
 * a thing's masks, more than in another's, and those inside it (lift/inside.h). Strays are among them, as
 * reflections lie far behind what shows them, but not to show the thing isolated. most (N):
 * splat/visibility.h. Both return 0, or -1 with *e set. */
int locate_things(char *of, const struct lifted *l, const struct extent *extents, const size_t *things,
	size_t count, enum locate_show show, const struct splats *s, const float *most, struct err *e);
/* The same of an answer by any model, whose things are not known; x: its extent. */
int locate_answer(char *of, const struct responses *a, size_t answer, const struct extent *x,
	enum locate_show show, const struct splats *s, const float *most, struct err *e);

/* to: the scene with the Gaussians of (N) painted, them alone, or the scene without them. splats_free it.
 * Returns 0, or -1 with *e set and *to zeroed. */
int locate_show(
	struct splats *to, const struct splats *s, const char *of, enum locate_show show, struct err *e);
