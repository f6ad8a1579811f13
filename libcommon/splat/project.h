/* Projection of Gaussians to a view: EWA as in 3DGS (Zwicker et al. 2001; Kerbl et al. 2023), in double. */
#pragma once

#include "geom/camera.h"
#include "splat/splats.h"

#include <stdint.h>

#define PROJECT_LOW_PASS 0.3 /* px^2, a variance that every projection gets */

/* A Gaussian that may touch a pixel, a cache line of it. At (x, y), with dx = x - x_mean and dy = y - y_mean,
 *	u = l11 dx + l21 dy,  v = l22 dy,  a = 2^(log_opacity - u^2 - v^2):
 * a Cholesky factor of the inverse covariance, times log2(e)/2. u^2 + v^2 has no cancellation. */
struct projected {
	double x, y;	      /* mean, pixels */
	double l11, l21, l22; /* 1/pixels */
	double depth;	      /* camera z */
	float slope[3];	      /* l11, l21, l22 rounded: how u and v change between near pixels */
	float log_opacity;    /* log2 o */
};

/* For the kernels: what a camera contributes to every Gaussian. */
struct project_lens {
	double world_to_camera[3][4];
	double fx, fy, cx, cy;
	double width, height;	/* pixels */
	double normal[3][3];	/* row k: the cross product of the rotation's other two rows */
	double low[2], high[2]; /* limits of x/z and y/z in the Jacobian */
	double near;		/* of the splats */
};

void project_lens_make(struct project_lens *lens, const struct camera *c, double near);

enum { PROJECT_LANES = 64 }; /* enough that a lane is in memory when its vector is read */

/* Gaussians side by side; opacities are at least 1/255. Not seen are those with z <= near, those whose
 * ellipse holds no pixel centre, and those whose covariance exceeds double. */
struct project_batch {
	float mean[3][PROJECT_LANES], scale[3][PROJECT_LANES], quat[4][PROJECT_LANES];
	float opacity[PROJECT_LANES];
	double x[PROJECT_LANES], y[PROJECT_LANES], z[PROJECT_LANES];	   /* mean in pixels, and camera z */
	double l11[PROJECT_LANES], l21[PROJECT_LANES], l22[PROJECT_LANES]; /* as struct projected */
	double log_opacity[PROJECT_LANES];
	double radius[PROJECT_LANES]; /* u^2 + v^2 <= radius^2 where a >= 1/255, and, for rounding, a little
					 beyond */
	int32_t seen[PROJECT_LANES];  /* 0: not seen, and the rest means nothing */
	/* first and last of the pixels whose centres the ellipse's bounding box holds */
	int32_t columns[2][PROJECT_LANES], rows[2][PROJECT_LANES];
};

/* Gaussian i as lane `lane`. Returns 0, and leaves the lane, where it is too faint for any pixel. */
int project_take(struct project_batch *b, const struct splats *s, size_t i, int lane);
