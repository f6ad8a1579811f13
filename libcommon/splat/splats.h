/* A trained scene of 3D Gaussians, activations already applied (3DGS, Kerbl et al. 2023). */
#pragma once

#include "base/err.h"

#define SPLATS_NEAR 0.2 /* world units: the near plane of 3DGS */

struct splats {
	size_t n;
	int sh_coefficients; /* K = (degree+1)^2: 1, 4, 9 or 16 */
	double near;	     /* world units: no view shows Gaussians whose camera z is at most this */
	float *means;	     /* (n,3) world units, recentred on import */
	float *scales;	     /* (n,3) standard deviations, >= 0 */
	float *quats;	     /* (n,4) w,x,y,z; of any length but 0 */
	float *opacities;    /* (n) in [0,1] */
	float *sh;	     /* (n,K,3) spherical harmonics, colour channel last */
};

/* Allocates every array (not initialised); near is SPLATS_NEAR. 0, or -1 with *e and *s zeroed. */
int splats_alloc(struct splats *s, size_t n, int sh_coefficients, struct err *e);
/* to: those of `from` where kept (n) is not 0, in their order. 0, or -1 with *e and *to zeroed. */
int splats_keep(struct splats *to, const struct splats *from, const char *kept, struct err *e);
/* Frees all that they have but n and the means, where no more is needed. */
void splats_keep_means(struct splats *s);
void splats_free(struct splats *s);
