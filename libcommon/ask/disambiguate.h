/* Which lifted object is which: a detector that cannot tell two things that look the same gives each the
 * other's masks as readily as its own, but the training sentences say where each is. */
#pragma once

#include "base/err.h"
#include "geom/camera.h"
#include "lang/parser.h"
#include "lift/lifted_model.h"
#include "splat/splats.h"

/* Gives each object the Gaussians that its training sentences mean: of all ways to share them out, the one
 * with the largest sum over sentences of log(p + 0.003), p of ask/choose.h without its part `sentence`, at
 * most one lot of Gaussians to an object; again, as anchors move with their objects, until nothing changes,
 * four times at most. An object's own words fit its own Gaussians best, so that only things that look the
 * same change places: what is seen of a look that a sentence tells ("striped", places/object_surface.h)
 * counts, other words hardly.
 *
 * Only the first `named` objects are. The others, which have the name "" and no sentences, are regions that a
 * detector took for no object, or for one that has another: lots that an object may have in place of its own,
 * whereupon the one that nobody has is theirs. What is known of a lot besides, that its masks agree, counts
 * with 0.25 log(confidence + 0.02) for the object that has it; this says which are left over, and nothing
 * where none are.
 *
 * An object that is_fixed (objects, 0 or 1; spare ones too) keeps its Gaussians, whatever sentences say, and
 * nobody else gets them: a person named them. The others change places only where that is clearly better.
 *
 * to (named) gets what came of each. Returns 0, or -1 with *e set and the model as it was. */
struct disambiguated {
	int is_moved;
	size_t sentences, against; /* of a fixed one: its sentences, and those that plainly mean another */
	/* What tells most against what it was, where it moved or `against` is not 0: a sentence, the object
	 * that it means, as this was before, and how probably it means its own and that. */
	size_t sentence, other;
	float own_p, other_p;
};
int disambiguate(struct lifted *l, size_t named, const char *is_fixed, const struct splats *splats,
	const struct cameras *cameras, const struct parser *parser, struct disambiguated *to, struct err *e);
