/* How much of each object a camera sees past the others, quickly and about right: points of the surfaces in a
 * coarse depth buffer. Accurate to a few percent; what counts is told by the rasteriser (synth/truth.h). */
#pragma once

#include "base/err.h"
#include "geom/camera.h"
#include "synth/objects.h"

enum {
	SYNTH_OCCLUSION_POINTS = 1500, /* an object */
	SYNTH_OCCLUSION_COLUMNS = 96,  /* cells across the longer side of the image */
};

struct synth_occlusion {
	int n;		  /* objects */
	float *points;	  /* (n,SYNTH_OCCLUSION_POINTS,3) */
	float *depth;	  /* (SYNTH_OCCLUSION_COLUMNS^2) of what is seen in a cell */
	int *seen, *last; /* (SYNTH_OCCLUSION_COLUMNS^2) the object seen there, and the last one that lies
			     there */
};

/* Returns 0, or -1 with *e; synth_occlusion_free after either. */
int synth_occlusion_make(struct synth_occlusion *s, const struct synth_object *objects, int n, struct err *e);
void synth_occlusion_free(struct synth_occlusion *s);

/* whole (n) gets the cells in which an object lies, visible (n) those where nothing else is nearer. */
void synth_occlusion_look(struct synth_occlusion *s, const struct camera *c, int *visible, int *whole);
