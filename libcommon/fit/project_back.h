/* The backward pass of projection, and of colours: from a view's sums over pixels to gradients of parameters.
 */
#pragma once

#include "fit/parameters.h"
#include "geom/camera.h"
#include "splat/render.h"

#include <stdint.h>

/* seen[i] (N) gets 1 for the Gaussians that the view has, else 0: what follows goes by index, as memory is
 * fast then. */
void fit_seen(const struct render_view *v, uint8_t *seen);

/* colors (N,3) of those seen, as sh_color has them, from harmonics up to `degree`. */
void fit_colors(const struct fit_gaussians *g, const uint8_t *seen, const struct camera *c, int degree,
	float *colors);

/* From sums (N,BACK_SUMS) of fit/back.h the gradient slab, for harmonics up to `degree`; 0 for a Gaussian
 * that is not seen. colors are those of fit_colors: a channel at 0 has no gradient. */
void fit_project_back(struct fit_gaussians *g, const struct render_view *v, const uint8_t *seen,
	const struct camera *c, int degree, const float *colors, const float *sums);
