/* The loss of an image beside its photograph: 0.8 L1 + 0.2 (1 - SSIM), as 3DGS has it, each a mean over
 * pixels and channels. SSIM (Wang et al. 2004) has a Gaussian window of 11x11 pixels, sigma 1.5, with zeros
 * beyond the edge. */
#pragma once

#include "base/err.h"

#include <stdint.h>

struct photo_loss {
	double l1, ssim, squares; /* means; squares: of the difference, both limited to [0,1] */
	double total;
};

/* Room that is kept from image to image. Zeroed is empty. */
struct photo_loss_room {
	float *planes;
	double *rows;
	size_t plane_room, row_room;
};
void photo_loss_free(struct photo_loss_room *r);

/* image (3,P) against the bytes of a photograph (P,3). gradient (3,P) gets dL/dimage; NULL: the loss
 * alone. Returns 0, or -1 with *e set. */
int photo_loss(struct photo_loss *l, const float *image, const uint8_t *photograph, int height, int width,
	float *gradient, struct photo_loss_room *room, struct err *e);
