/* How each photograph was exposed: what it shows is gain times the scene plus an offset, for each channel, so
 * that a camera's automatic exposure is not learned as fog. The mean over photographs of the gains is 1, and
 * that of the offsets 0: else the scene could be of any brightness. */
#pragma once

#include "base/err.h"
#include "fit/parameters.h"
#include "fit/photograph.h"

enum { EXPOSURE_WIDTH = 6 }; /* gain and offset of red, of green, of blue */

struct exposures {
	size_t n;
	float *values, *moment1, *moment2; /* (n,EXPOSURE_WIDTH), one slab from values on */
};

/* Gains 1 and offsets 0. Returns 0, or -1 with *e set. */
int exposures_alloc(struct exposures *x, size_t n, struct err *e);
void exposures_free(struct exposures *x);

/* From the colours of the Gaussians that training begins with, which are means over photographs, and the
 * pixels on which their centres fall. Returns how far the photographs' gains are apart: the standard
 * deviation of their logarithms. */
double exposures_guess(struct exposures *x, const struct fit_gaussians *g, const struct photograph *p);

/* What the photograph shows where the scene shows image; planes (3,P). */
void exposure_apply(const float *exposure, const float *image, float *shown, size_t pixels);

/* A step of Adam, the photograph's step-th, by the gradient of what it shows, which becomes that of the
 * image. */
void exposures_step(struct exposures *x, size_t which, const float *image, float *gradient, size_t pixels,
	double rate, long step);

/* The exposure with which the image is nearest, in squares, to a photograph (P,3) that was not learned from.
 */
void exposure_nearest(float *exposure, const float *image, const uint8_t *photograph, size_t pixels);
