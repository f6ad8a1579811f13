/* Blending with fixed weights: geometry is frozen, so the image of a view is a sparse product M = W m (design
 * section 4). W is CSR over pixels, as gs-weigh writes it. */
#ifndef SPLAT_VIEW_WEIGHTS_H
#define SPLAT_VIEW_WEIGHTS_H

#include <stddef.h>
#include <stdint.h>

struct view_weights {
	size_t pixels;	       /* P */
	size_t gaussians;      /* N, the range of index */
	const int64_t *indptr; /* (P+1) */
	const int32_t *index;  /* (nnz) */
	const float *weight;   /* (nnz) */
};

/* image (P) = W m (N). */
void view_blend(const struct view_weights *w, const float *m, float *image);

/* dm (N) = W^T dimage (P). scratch holds VIEW_SLABS * N floats: the pixels are cut into so many slabs, summed
 * apart and added in order, whatever the number of threads. */
enum { VIEW_SLABS = 8 };
void view_blend_back(const struct view_weights *w, const float *dimage, float *dm, float *scratch);

#endif
