/* The near plane of a scene. That of 3DGS is 0.2 whatever the scene's unit is. Gaussians nearer to a camera
 * than that were not in its pictures in training, and may hide all that it shows. In a scene of another unit
 * 0.2 leaves out too much or too little.
 *
 * d is the depth that NEAR_FIRST of the Gaussians do not reach, over all views whose picture holds their
 * centre. The plane is at NEAR_SHARE d, or, up to NEAR_MOST d, at the last Gaussian that by itself covers
 * NEAR_COVERS of a picture. It is 0.2 where nothing that a view shows lies between that and 0.2; up to
 * NEAR_MOST d so little may lie there that it covers NEAR_SAME of the pictures. So a scene keeps its pictures
 * in any unit. */
#pragma once

#include "base/err.h"
#include "geom/camera.h"
#include "splat/splats.h"

/* Sets s->near. Returns 0, or -1 with *e set. */
int near_find(struct splats *s, const struct cameras *cameras, struct err *e);
