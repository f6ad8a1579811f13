/* The rasteriser's reference: every pixel against every Gaussian, with the textbook formulas of 3DGS in long
 * double. No tiles, no vectors, no factorisation. */
#ifndef RENDER_TWIN_H
#define RENDER_TWIN_H

#include "geom/camera.h"
#include "splat/splats.h"

#include <stddef.h>
#include <stdint.h>

struct twin_gaussian {
	double depth;
	int32_t index;
	long double x, y, conic[3], opacity; /* conic: xx, xy, yy */
};

struct twin {
	size_t n;
	struct twin_gaussian *items; /* front to back */
};

/* Aborts when memory is out. */
void twin_prepare(struct twin *t, const struct splats *s, const struct camera *c);
void twin_free(struct twin *t);

struct twin_pixel {
	size_t n;
	int32_t *index; /* (twin.n) room */
	double *weight; /* (twin.n) room */
	double transmittance;
	double margin; /* the least relative distance of any a from 1/255, or of any T (1-a) from 1e-4 */
};

void twin_blend(const struct twin *t, int column, int row, struct twin_pixel *out);

#endif
