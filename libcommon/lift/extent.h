/* Where an object is: boxes around its Gaussians that a few wrong ones do not blow up.
 *
 * A Gaussian counts w = min(r / median of r, 1)^4, r its response: what is partly of something else, as halos
 * and contacts are, counts little. Gaussians farther from the rest than they are from each other are strays:
 * only the heaviest cluster stays, and those at least EXTENT_PART as heavy. Along a direction the box begins
 * where between EXTENT_TRIM and EXTENT_TAIL of the weight W is passed, and ends likewise, with Gaussians
 * EXTENT_SIGMAS standard deviations long: where W inside / length^EXTENT_THIN is largest, as what makes the
 * box much longer for little weight is of something else (formats/records/boxes.md: why these). */
#pragma once

#include "base/err.h"
#include "geom/box.h"
#include "splat/splats.h"

#include <stdint.h>

#define EXTENT_PART 0.1
#define EXTENT_TRIM 0.01
#define EXTENT_TAIL 0.1
#define EXTENT_THIN 0.1
#define EXTENT_SIGMAS 1.0
/* Cells in which clusters are looked for, over the mean distance of Gaussians on a surface of this extent. */
#define EXTENT_SPACING 1.5
/* A box is turned only where that saves so much of its foot: round things would be turned by chance. */
#define EXTENT_GAIN 0.08

struct extent {
	size_t n;
	int32_t *ids;	    /* (n) the Gaussians that are no strays, in the order in which they were given */
	double *weight;	    /* (n) w: how far each is the object's alone, 0 to 1 */
	struct box aligned; /* along the axes of the means; zeroed where n is 0 */
	struct box turned;  /* its third axis is up, its foot the smallest rectangle (see EXTENT_GAIN) */
};

/* The object whose Gaussians are ids (n), with responses (n) above 0. Returns 0, or -1 with *e set and
 * nothing to free. */
int extent_find(struct extent *x, const struct splats *s, const int32_t *ids, const float *responses,
	size_t n, const double up[3], struct err *e);
void extent_free(struct extent *x);

/* How much of an object a Gaussian makes up: what it covers, seen from anywhere. */
double extent_part(const struct splats *s, size_t gaussian);
