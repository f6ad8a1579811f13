/* Photographs of a scene, with their cameras, at the sizes in which they are learned from. */
#pragma once

#include "base/err.h"
#include "geom/camera.h"
#include "splat/splats.h"

#include <stdint.h>

/* Each level is half as wide and high as that before it. */
enum { FIT_LEVELS = 3 };

struct photograph {
	struct camera camera[FIT_LEVELS]; /* name and image belong to the camera it was made with */
	double scale;			  /* of camera[0], as a share of the whole view */
	uint8_t *rgb[FIT_LEVELS];	  /* (height,width,3) of that camera */
	uint8_t *ignored[FIT_LEVELS];	  /* (height,width) 1 for a pixel that does not count; NULL: all do */
};

/* The view c at `scale` of its size, from a picture of it in any size; where that is smaller, no larger than
 * it. Returns 0, or -1 with *e; photograph_free after either. */
int photograph_make(struct photograph *p, const struct camera *c, double scale, const uint8_t *rgb,
	int height, int width, struct err *e);
void photograph_free(struct photograph *p);

/* Pixels that hold a part of a mask (height,width) of the whole view do not count. Returns 0, or -1 with *e
 * set. */
int photograph_ignore(struct photograph *p, const uint8_t *mask, int height, int width, struct err *e);

/* What was learned from photographs (n) shows in whole views what it shows in theirs: the rasteriser's low
 * pass is as many pixels wide in either, so that in larger views Gaussians are thinner than they were learned
 * and let through what is behind. Each is widened, alike in all directions, by what its low pass has less, as
 * wide as that is where the nearest of the photographs has its mean: sigma^2 += 0.3 (1 - scale^2) (z / f)^2,
 * as Mip-Splatting (Yu et al. 2024) bounds Gaussians by the nearest sampling, f and z of the photograph. */
void photographs_widen(struct splats *s, const struct photograph *p, size_t n);
