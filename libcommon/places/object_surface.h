/* What the Gaussians of an object show of its surface: one colour, stripes or spots, and whether it shines.
 * Light and shade are no pattern: they change a colour's brightness alone, and slowly. */
#pragma once

#include "base/err.h"

#include <stddef.h>

/* A Gaussian: where it is in the scene, its colour (CIE L*a*b*), and how much it counts. */
struct surface_point {
	double at[3], lab[3], weight;
};

struct surface {
	double stripes, spots;	/* P that the surface is so; what is left is of one colour. 0.25 where nothing
				   is known */
	double view_dependence; /* of its Gaussians' colours, sRGB: root mean square of the first degree of
				   their spherical harmonics; 0 where they have none */
	double gloss; /* that beside the scene's other objects, in [-1,1]: dull to shiny; 0: nothing known */
};

/* Sets stripes and spots by n points of one object; up is of length 1. Two colours are found by 2-means. They
 * are a pattern where they change from near to near, or where they are of different hue and neither is a
 * part of the object, as a cap is. Stripes are what is told by the place along one axis, and changes at
 * least four times on the way. Returns 0, or -1 with *e set. */
int surface_find(
	struct surface *s, const struct surface_point *points, size_t n, const double up[3], struct err *e);

/* Sets the gloss, where the scene's objects have a view_dependence from low to high: 1 is a factor of 2. */
void surface_set_gloss(struct surface *s, double low, double high);

/* How far a surface has a look (finish_of, lang/finish.h), in [-1,1]; below 0: it has not. */
double surface_fits(const struct surface *s, int finish);
