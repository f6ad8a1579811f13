#include "splat/backproject.h"

enum { BLOCK = 1024 }; /* pixels that one thread renders at a time */

void backproject_weight(const struct view_weights *w, double *weight)
{
	for (int64_t k = 0, end = w->indptr[w->pixels]; k < end; k++)
		weight[w->index[k]] += (double)w->weight[k];
}

/* The channels of the last group may be fewer. */
static int group_size(size_t channels, size_t group)
{
	const size_t left = channels - group * VIEW_GROUP;

	return left < VIEW_GROUP ? (int)left : VIEW_GROUP;
}

static int is_set(const float *image, size_t stride, int count, size_t p)
{
	for (int k = 0; k < count; k++)
		if (image[(size_t)k * stride + p] != 0)
			return 1;
	return 0;
}

/* A group belongs to one thread, which adds its pixels in their order. Those of masks come in runs. */
void backproject_add(const struct view_weights *w, const float *image, size_t channels, float *sum)
{
#pragma omp parallel for schedule(dynamic)
	for (size_t g = 0; g < backproject_groups(channels); g++) {
		const int count = group_size(channels, g);
		const float *from = image + g * VIEW_GROUP * w->pixels;
		float *to = sum + g * VIEW_GROUP * w->gaussians;
		for (size_t begin = 0, end; begin < w->pixels; begin = end) {
			end = begin + 1;
			if (!is_set(from, w->pixels, count, begin))
				continue;
			while (end < w->pixels && is_set(from, w->pixels, count, end))
				end++;
			view_blend_back_group(w, from, w->pixels, count, begin, end, to);
		}
	}
}

void backproject_render(const struct view_weights *w, const float *field, size_t channels, float *image)
{
	const size_t groups = backproject_groups(channels), blocks = (w->pixels + BLOCK - 1) / BLOCK;

#pragma omp parallel for collapse(2) schedule(dynamic)
	for (size_t g = 0; g < groups; g++)
		for (size_t b = 0; b < blocks; b++) {
			const size_t from = b * BLOCK, left = w->pixels - from;
			view_blend_group(w, field + g * VIEW_GROUP * w->gaussians, group_size(channels, g),
				from, from + (left < BLOCK ? left : BLOCK),
				image + g * VIEW_GROUP * w->pixels, w->pixels);
		}
}
