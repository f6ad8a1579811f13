/* Images of responses in one view, their loss against masks, and the gradient of the responses. */
#pragma once

#include "base/err.h"
#include "splat/view_weights.h"

#include <stdint.h>

/* Buffers for views of at most so many pixels and rows, and for so many responses at a time. */
struct image_loss {
	size_t pixels, rows;
	int threads;
	float *image, *dimage; /* (group,pixels) */
	float *m, *dm;	       /* (rows,group), where several go together */
	float *slabs;	       /* (VIEW_SLABS,rows,group) */
};

int image_loss_init(struct image_loss *s, size_t pixels, size_t rows, int most, int threads, struct err *e);
void image_loss_free(struct image_loss *s);

/* The mean over `count` responses of the binary cross-entropy of their images against masks (bits, one for
 * each response), and dm, its gradient. m and dm are panels of `count` channels (field/block.h). Passes over
 * the view's weights serve VIEW_GROUP responses each. */
double image_loss_run(struct image_loss *s, const struct view_weights *view, const float *m, int count,
	const uint8_t *const *masks, float *dm);
