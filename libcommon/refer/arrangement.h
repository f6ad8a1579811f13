/* Where lifted objects are and what they look like, as seen from the reference viewpoint: the mean of the
 * training cameras' centres, looking level along the mean of their viewing directions. What people say of
 * left, right, front and back is meant from there. */
#ifndef REFER_ARRANGEMENT_H
#define REFER_ARRANGEMENT_H

#include "base/err.h"
#include "geom/camera.h"
#include "refer/lifted.h"
#include "splat/splats.h"

struct arranged {
	int is_there; /* 0: it has no Gaussians, and nothing below means anything */
	/* Axes: 0 to the right, 1 away from the viewer, 2 up; scene units, the origin at the middle of the
	 * objects. */
	double low[3],
		high[3];  /* box: the middle 80% of its weight along each axis, a tenth longer each way */
	double centre[3]; /* of the box */
	double lab[3];	  /* mean colour, CIE L*a*b* (D65) */
	/* Its Gaussians' colours (colours,3) and how much of the object each makes up: they sum to 1. */
	size_t colours;
	float *palette, *part;
};

struct arrangement {
	size_t n;
	struct arranged *objects; /* (n) */
	double eye[3];		  /* the viewpoint, in the same axes */
	double spacing;		  /* median distance between two objects on the ground; > 0 */
};

/* Of the objects of l in the scene that splats and cameras are of. Where no camera is for training all are
 * looked from. Returns 0, or -1 with *e set and nothing to free. */
int arrangement_make(struct arrangement *a, const struct lifted *l, const struct splats *splats,
	const struct cameras *cameras, struct err *e);
void arrangement_free(struct arrangement *a);

/* Whether two objects are the same to look at, but for where they are: 0 where they are, and less the more
 * they differ in mean colour (by 8 of L*a*b*) and in size (by 15%): -1/2 of the sum of the squares. */
double arrangement_alike(const struct arrangement *a, size_t i, size_t k);

#endif
