/* Images of responses in one view, their loss against masks, and the gradient of the responses. */
#ifndef REFER_IMAGES_H
#define REFER_IMAGES_H

#include "base/err.h"
#include "splat/view_weights.h"

#include <stddef.h>
#include <stdint.h>

/* Buffers for views of at most so many pixels and rows, and for so many responses at a time. */
struct images {
	size_t pixels, rows;
	int threads;
	float *image, *dimage; /* (group,pixels) */
	float *m, *dm;	       /* (rows,group), where several go together */
	float *slabs;	       /* (VIEW_SLABS,rows,group) */
};

int images_init(struct images *s, size_t pixels, size_t rows, int most, int threads, struct err *e);
void images_free(struct images *s);

/* The mean over `count` responses of the binary cross-entropy of their images against masks (bits, one for
 * each response), and dm, its gradient. m and dm are panels of `count` channels (refer/block.h). Passes over
 * the view's weights serve VIEW_GROUP responses each. */
double images_loss(struct images *s, const struct view_weights *view, const float *m, int count,
	const uint8_t *const *masks, float *dm);

#endif
