/* Where lifted objects are and what they look like, as seen from a viewpoint. What people say of left, right,
 * front and back is meant from there. */
#pragma once

#include "places/object_surface.h"
#include "places/viewpoint.h"
#include "base/err.h"
#include "base/quantile.h"
#include "geom/camera.h"
#include "lang/colours.h"
#include "lift/lifted_model.h"
#include "splat/splats.h"

struct arranged {
	int is_there; /* 0: it has no Gaussians, and nothing below means anything */
	int in_sight; /* 0: the viewpoint is a picture, and the centre is outside of it */
	/* Axes: 0 to the right, 1 away from the viewer, 2 up; scene units, from the objects' middle. */
	double low[3], high[3]; /* box: places/object_span.h along each axis */
	double centre[3];	/* of the box */
	double side;		/* how far right it looks: centre[0], or, in a picture, in perspective */
	double lab[3];		/* mean colour, CIE L*a*b* (D65) */
	double colours[COLOUR_WORDS]; /* part of it that people would call so (lang/colours.h) */
	struct surface surface;
	size_t begin, count; /* its points */
};

/* A Gaussian of an object: where it is in the scene, and how much it counts. */
struct arranged_point {
	double at[3], weight;
};

struct arrangement {
	size_t n;
	struct arranged *objects; /* (n) */
	struct arranged viewer;	  /* a point: where the viewer stands, in the same axes */
	double spacing;		  /* median distance between two objects on the ground; > 0 */

	const struct cameras *cameras;
	size_t point_count;
	struct arranged_point *points; /* (point_count) */
	struct quantile_item *along;   /* scratch */
};

/* Of the objects of l in the scene that splats and cameras are of, which must outlive it, seen from the usual
 * viewpoint. Only Gaussians that hang together count (lift/extent.h), and none for much more than its fellows
 * do, so that strays and large ones do not decide where an object is. Returns 0, or -1 with *e set and
 * nothing to free. */
int arrangement_make(struct arrangement *a, const struct lifted *l, const struct splats *splats,
	const struct cameras *cameras, struct err *e);

/* The same seen from elsewhere. */
void arrangement_look(struct arrangement *a, const struct viewpoint *from);

/* Where an object is in the scene, whatever it is seen from: the mean of its points. 0: it has none. */
int arrangement_where(const struct arrangement *a, size_t object, double at[3]);

/* Two objects change places, with all that is seen of them; the viewpoint stays. */
void arrangement_swap(struct arrangement *a, size_t i, size_t k);
void arrangement_free(struct arrangement *a);

/* The logarithm of a length, which may be 0, and the mean of those of a box. */
double arranged_length(const struct arrangement *a, double length);
double arranged_bulk(const struct arrangement *a, const struct arranged *o);
