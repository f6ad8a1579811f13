/* Splats of any format, cut and moved: gs-transform. */
#pragma once

#include "base/err.h"
#include "splat/move.h"
#include "splat/splats.h"

struct transforming {
	const char *crop; /* X0,Y0,Z0,X1,Y1,Z1; NULL: everything */
	int drop_strays;
	const char *rotate;    /* W,X,Y,Z or X,Y,Z:DEGREES; NULL: not */
	const char *translate; /* X,Y,Z; NULL: not */
	double scale;
	const char *known;   /* X0,Y0,Z0,X1,Y1,Z1=LENGTH in place of scale: two points and how far they are
				apart;   NULL: scale */
	const char *up_from; /* cameras, a file or folder (formats/cameras/camerafile.h): what is up for them
				becomes -y; NULL: not */
};

struct transforming_count {
	size_t outside, strays; /* left out */
	double up[3];		/* where up_from is given: what was up */
	double scale;		/* how much larger everything is */
};

/* What can be wrong with the options: ERR_USAGE. Returns 0, or -1 with *e set. */
int transforming_check(const struct transforming *o, struct err *e);

/* In this order: crop, strays, scale, up, rotate, translate. World coordinates are means + offset. Returns 0,
 * or -1 with *e set; *s is the caller's to free in any case. */
int transforming_do(struct splats *s, double offset[3], const struct transforming *o,
	struct transforming_count *left_out, struct err *e);
