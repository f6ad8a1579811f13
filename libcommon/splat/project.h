/* Projection of Gaussians to a view: EWA as in 3DGS (Zwicker et al. 2001; Kerbl et al. 2023, section 4), in
 * double. */
#ifndef SPLAT_PROJECT_H
#define SPLAT_PROJECT_H

#include "base/err.h"
#include "geom/camera.h"
#include "splat/splats.h"

#include <stdint.h>

/* A Gaussian that may touch a pixel. At (x, y), with dx = x - x_mean and dy = y - y_mean,
 *	u = l11 dx + l21 dy,  v = l22 dy,  a = 2^(log_opacity - u^2 - v^2):
 * a Cholesky factor of the inverse covariance, times log2(e)/2. Unlike the conic it has no cancellation in
 *u^2 + v^2. */
struct projected {
	double x, y;	      /* mean, pixels */
	double l11, l21, l22; /* 1/pixels */
	double radius;	   /* u^2 + v^2 <= radius^2 where a >= 1/255 (and, for rounding, a little beyond) */
	double depth;	   /* camera z */
	float log_opacity; /* log2 o */
	int32_t index;	   /* of the Gaussian in its scene */
};

/* The ellipse u^2 + v^2 <= radius^2 lies within x +- projected_width, y +- projected_height. */
double projected_width(const struct projected *p);
double projected_height(const struct projected *p);

/* The visible Gaussians front to back (by camera z, ties by index). Left out are those with z <= 0.2 or o <
 * 1/255, those whose ellipse holds no pixel centre, and those whose covariance exceeds double (a standard
 * deviation above 1e75 px). The caller frees *out. Returns 0, or -1 with *e set. */
int project_splats(
	const struct splats *s, const struct camera *c, struct projected **out, size_t *count, struct err *e);

#endif
