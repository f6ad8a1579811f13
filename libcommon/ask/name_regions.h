/* Which region of a scene each thing is that sentences tell of, where no mask says so: all sentences of all
 * things together.
 *
 * The value of region k for thing o is the sum over its sentences of log(fit_k / max fit + 0.03), fit of
 * ask/choose.h, where nouns of the thing itself do not count and anchors are the things that have a region;
 * of how likely the region is anything at all; and of how far a detector found it to be what sentences call
 * the thing. The thing whose best region is clearest gets it first, and is an anchor for the others; then
 * things change their regions, the largest gain first, until nothing is better. At last each gets the
 * likeliest thing of the regions in its own and around it. Nearly the same regions are of one thing. */
#pragma once

#include "base/err.h"
#include "geom/camera.h"
#include "lang/parser.h"
#include "lift/lifted_model.h"
#include "splat/splats.h"

#define REGION_NONE SIZE_MAX

/* What is known of the regions, which are the objects of a model from `named` on. */
struct region_facts {
	size_t count;
	const float *score; /* (count) how likely each is a thing */
	const float *agree; /* (count,count) intersection over union */
	size_t class_count;
	char *const *classes; /* (class_count) a detector's words */
	const float *votes;   /* (count,class_count) how far it finds each region to be that, in [0,1] */
};

/* The first `named` objects of l have names and sentences and no Gaussians. region (named) gets the one of
 * each or REGION_NONE, probability (named) how likely it, or one nearly the same, is right. Returns 0, or -1
 * with *e set. */
int name_regions(const struct lifted *l, size_t named, const struct region_facts *facts,
	const struct splats *splats, const struct cameras *cameras, const struct parser *parser,
	size_t *region, double *probability, struct err *e);
