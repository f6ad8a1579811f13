/* A view's weights in few bytes: formats/weights.md, "Packed". Used by formats/weights.c. */
#ifndef FORMATS_WEIGHTS_PACK_H
#define FORMATS_WEIGHTS_PACK_H

#include "base/err.h"
#include "splat/view_tiles.h"

#include <stddef.h>
#include <stdint.h>

enum { WEIGHTS_STREAMS = 3 };

/* Streams of bytes, deflated: the Gaussians of each tile, which of its pixels each is in, and by how much. */
struct weights_pack {
	size_t bytes[WEIGHTS_STREAMS], packed[WEIGHTS_STREAMS], room[WEIGHTS_STREAMS]; /* before and after */
	uint8_t *data[WEIGHTS_STREAMS];
};

/* Packs weights of 0 to 255 (of 1/255), CSR over the pixels of a picture. Entries of level 0 are left out,
 * and of two of one Gaussian in a pixel the later one. Free after either. */
int weights_pack(struct weights_pack *p, int width, int height, const int64_t *indptr, const int32_t *index,
	const uint8_t *level, struct err *e);
void weights_pack_free(struct weights_pack *p);

/* The other way: indptr (P+1) is the caller's; *index and *weight, which are level / 255, are allocated, in
 * the order of the Gaussians within a pixel. ERR_FORMAT, after `path`, where the streams are no such weights
 * of a scene of so many Gaussians. */
int weights_unpack(const struct weights_pack *p, int width, int height, int64_t gaussians, const char *path,
	int64_t *indptr, int32_t **index, float **weight, struct err *e);

/* They as tiles; view_tiles_free. ERR_FORMAT as above, and then there is nothing to free. */
int weights_unpack_tiles(const struct weights_pack *p, int width, int height, int64_t gaussians,
	const char *path, struct view_tiles *to, struct err *e);

#endif
