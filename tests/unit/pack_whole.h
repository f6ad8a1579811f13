/* Packs the weights of a whole picture, a row of tiles at a time. */
#ifndef PACK_WHOLE_H
#define PACK_WHOLE_H

#include "formats/scene/weights_pack.h"

/* CSR over the pixels, of Gaussians below `gaussians`. Returns 0, or -1 with *e set; weights_pack_free after
 * either. */
int pack_whole(struct weights_pack *p, int width, int height, size_t gaussians, const int64_t *indptr,
	const int32_t *index, const float *weight, struct err *e);

#endif
