/* Masks propagated from the view where each begins to all others, through the scene. The paper compares its
 * choice of pseudo masks with "the first frame's mask, propagated to the others by SAM2" (section 4,
 * ablations); here the scene itself does what the video tracker does there.
 *
 * A mask is lifted onto the Gaussians that its view sees: a_i = sum of w_pi over the mask's pixels / sum of
 * w_pi over all pixels. Gaussians without weight there are unknown: nothing says that they are not of the
 * object. Another view has the mask at the pixels where sum w_pi a_i > 1/2 sum w_pi, both sums over known
 * Gaussians, and where these make at least half of the pixel's weight. */
#pragma once

#include "base/err.h"
#include "geom/camera.h"
#include "mask/pool.h"
#include "splat/view_weights.h"

/* Where an object begins. */
struct propagate_start {
	size_t view;		 /* of the scene */
	const struct mask *mask; /* the winner there */
	double vote;
};

/* The masks that begin in one view, lifted. */
struct propagate_source {
	size_t view;
	size_t begin, count; /* in order[] */
	/* Channels of splat/backproject.h, so that both sums are one and are compared with 0: channel 0 has
	 * 1/2 for a known Gaussian and -1/2 for another; channel 1+k, of the k-th mask, a_i - 1/2 and 0. */
	float *field; /* NULL until propagate_lift */
};

struct propagation {
	size_t count;
	struct propagate_start
		*starts; /* (count) one of each object, in the order in which the objects came */
	size_t *order;	 /* (count) starts by view */
	size_t source_count;
	struct propagate_source *sources; /* by view */
};

/* An object begins in the first training view, in the order of the cameras, where it has a winner in the
 * pool. views (pool's n) has the camera of each candidate. Masks are referred to. */
int propagate_init(struct propagation *c, const struct pool *p, const size_t *views,
	const struct cameras *cameras, struct err *e);
void propagate_free(struct propagation *c);

/* Lifts the masks of a source, whose view has these weights and that size; masks of another size are reduced
 * by area, as rle_resize does. All sources must be lifted before propagate_render. */
int propagate_lift(struct propagation *c, size_t source, const struct view_weights *w, int height, int width,
	struct err *e);

/* masks (count) in a view, at the size of its weights; rle_free each. Those that begin there are themselves,
 * at that size. On failure there are none. */
int propagate_render(const struct propagation *c, size_t view, const struct view_weights *w, int height,
	int width, struct rle *masks, struct err *e);
