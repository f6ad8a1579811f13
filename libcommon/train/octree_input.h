/* How much detail the training views can teach of each Gaussian: what the octree of shared features is built
 * from. */
#pragma once

#include "base/err.h"
#include "field/octree.h"
#include "geom/camera.h"
#include "train/view_source.h"

/* footprint (n): the size of a pixel at each of the points means (n,3), in the scene's units, in the view
 * that sees it largest; INFINITY where no view has it within its image. */
void octree_input_footprints(
	const float *means, size_t n, const struct camera *cameras, size_t count, float *footprint);

/* signature (scene_gaussians, OCTREE_SIGNATURE): the weighted mean over a Gaussian's pixels of the sum of the
 * masks there, every object with a random direction of length 1 (a mask counts by its share of the object's
 * masks in the view). weight (scene_gaussians): over all views. Returns 0, or -1 with *e set. */
int octree_input_signatures(const struct view_source *views, const int *objects, size_t scene_gaussians,
	const double *weight, float *signature, struct err *e);
