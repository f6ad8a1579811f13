/* Blending with fixed weights: geometry is frozen, so the image of a view is a sparse product M = W m (design
 * section 4). W is CSR over pixels, as gs-weigh writes it. */
#pragma once

#include <stddef.h>
#include <stdint.h>

struct view_weights {
	size_t pixels;	       /* P */
	size_t gaussians;      /* N, the range of index */
	const int64_t *indptr; /* (P+1) */
	const int32_t *index;  /* (nnz) */
	const float *weight;   /* (nnz) */
};

/* image[from,to) of W m (N), by one thread. */
void view_blend(const struct view_weights *w, const float *m, size_t from, size_t to, float *image);

/* dm (N) += W^T dimage over the pixels [from,to), by one thread. */
void view_blend_back(const struct view_weights *w, const float *dimage, size_t from, size_t to, float *dm);

/* The same for `count` responses at once, at most VIEW_GROUP: m (N,VIEW_GROUP), image[k * stride + p] of
 * response k, and back. */
enum { VIEW_GROUP = 4 };
void view_blend_group(const struct view_weights *w, const float *m, int count, size_t from, size_t to,
	float *image, size_t stride);
void view_blend_back_group(const struct view_weights *w, const float *dimage, size_t stride, int count,
	size_t from, size_t to, float *dm);

/* For a backward pass by many threads: the pixels are cut into VIEW_SLABS parts, each with a dm of its own in
 * slabs (VIEW_SLABS,N), and these are added in order, whatever the number of threads. */
enum { VIEW_SLABS = 8 };
void view_join(const float *slabs, size_t gaussians, float *dm);
