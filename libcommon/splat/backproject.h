/* Between the images of a view and the Gaussians, by blend weight: images are lifted (a Gaussian's value is
 * the weighted mean of the pixels that it takes part in, W^T image / W^T 1, over one view or many) and a
 * field of values rendered (W field). All of it is the same to the bit for any number of threads.
 *
 * A field of `channels` values for each of N Gaussians is (backproject_groups(channels), N, VIEW_GROUP): see
 * backproject_index. Images are (channels,P). */
#pragma once

#include "splat/view_weights.h"

/* Groups of VIEW_GROUP channels: a field has backproject_groups(channels) * N * VIEW_GROUP floats. */
static inline size_t backproject_groups(size_t channels)
{
	return channels / VIEW_GROUP + (channels % VIEW_GROUP != 0);
}

/* Where a field has a Gaussian's channel. */
static inline size_t backproject_index(size_t gaussians, size_t channel, size_t gaussian)
{
	return (channel / VIEW_GROUP * gaussians + gaussian) * VIEW_GROUP + channel % VIEW_GROUP;
}

/* weight (N) += W^T 1: each Gaussian's weight in the view. */
void backproject_weight(const struct view_weights *w, double *weight);

/* sum (a field) += W^T image. Pixels where the channels of a group are 0 cost nothing. */
void backproject_add(const struct view_weights *w, const float *image, size_t channels, float *sum);

/* image = W field. */
void backproject_render(const struct view_weights *w, const float *field, size_t channels, float *image);
