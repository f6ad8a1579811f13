/* Projection of Gaussians to a view: EWA as in 3DGS (Zwicker et al. 2001; Kerbl et al. 2023, section 4), in
 * double. */
#ifndef SPLAT_PROJECT_H
#define SPLAT_PROJECT_H

#include "base/cpu.h"
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
	float half_width;  /* pixels: where u^2 + v^2 <= radius^2, |dx| <= half_width */
	float half_height; /* and |dy| <= half_height */
	float log_opacity; /* log2 o */
	int32_t index;	   /* of the Gaussian in its scene */
};

/* The visible Gaussians front to back (by camera z, ties by index). Left out are those with z <= 0.2 or o <
 * 1/255, those whose ellipse holds no pixel centre, and those whose covariance exceeds double (a standard
 * deviation above 1e75 px). The caller frees *out. Returns 0, or -1 with *e set. */
int project_splats(const struct splats *s, const struct camera *c, enum cpu_level level,
	struct projected **out, size_t *count, struct err *e);

/* For the kernels: what a camera contributes to every Gaussian. */
struct project_lens {
	double world_to_camera[3][4];
	double fx, fy, cx, cy;
	double normal[3][3];	/* row k: the cross product of the rotation's other two rows */
	double low[2], high[2]; /* limits of x/z and y/z in the Jacobian */
};

enum { PROJECT_LANES = 8 };

/* Gaussians side by side, so that the compiler can take them at once. */
struct project_batch {
	double mean[3][PROJECT_LANES], scale[3][PROJECT_LANES], quat[4][PROJECT_LANES];
	double x[PROJECT_LANES], y[PROJECT_LANES], z[PROJECT_LANES];	/* mean in pixels, and camera z */
	double xx[PROJECT_LANES], xy[PROJECT_LANES], yy[PROJECT_LANES]; /* covariance, pixels^2 */
	double det[PROJECT_LANES];					/* and its determinant */
};

#endif
