/* A view's weights in few bytes: formats/scene/weights.md, "Packed". Used by formats/scene/weights.c. */
#pragma once

#include "base/err.h"
#include "splat/view_tiles.h"

#include <stdint.h>

enum { WEIGHTS_STREAMS = 3 };
extern const char *const weights_stream_name[WEIGHTS_STREAMS];

/* Streams of bytes, compressed by zstd: the Gaussians of each tile, its pixels, how much. */
struct weights_pack {
	size_t bytes[WEIGHTS_STREAMS], packed[WEIGHTS_STREAMS], room[WEIGHTS_STREAMS]; /* before and after */
	uint8_t *data[WEIGHTS_STREAMS];
};

/* Weights of 0 to 1, CSR over the pixels of a picture or of a part of it. They are rounded to 1/255; those of
 * 0 are left out, and of two of one Gaussian in a pixel the later one. */
struct weights_picture {
	int width, height;
	const int64_t *indptr; /* (P+1) */
	const int32_t *index;
	const float *weight;
};

/* Memory for packing a scene's weights, one thread's. */
struct weights_packer {
	size_t gaussians, n;		     /* of the scene, and of a tile */
	int32_t *ids, *spare;		     /* (n), as they are met or rising; and room for as many */
	uint8_t (*levels)[VIEW_TILE_PIXELS]; /* (n) as they are met */
	int32_t *slot;			     /* (gaussians) where each is met, -1 */
	size_t room[3];			     /* of ids, spare and levels */
};

/* Returns 0, or -1 with *e set; free after either. */
int weights_packer_make(struct weights_packer *t, size_t gaussians, struct err *e);
void weights_packer_free(struct weights_packer *t);

/* Packs the next part of some rows of tiles, which go on in rows (height/8, rounded up), zeroed before the
 * first. Parts are whole tiles but at the picture's edge. Returns 0, or -1 with *e set. */
int weights_pack_part(
	struct weights_pack *rows, struct weights_packer *t, const struct weights_picture *v, struct err *e);

/* All rows of tiles, compressed. They are empty after it, and have room for the next picture's; *p, zeroed
 * before the first, may be used again too. Returns 0, or -1 with *e set. */
int weights_pack_join(struct weights_pack *p, struct weights_pack *rows, int count, struct err *e);
void weights_pack_free(struct weights_pack *p);

/* What a view's weights are unpacked to, and memory for it: zeroed before the first view, and used again with
 * each that follows. */
struct weights_room {
	struct view_tiles tiles;
	/* rows of pixels */
	int64_t *indptr; /* (P+1) */
	int32_t *index;
	float *weight;

	uint8_t *ids; /* the stream of the tiles' Gaussians */
	size_t indptr_room, index_room, weight_room, ids_room;
	size_t begin_room, gaussians_room, maps_room, level_begin_room, levels_room; /* of the tiles */
};
void weights_room_free(struct weights_room *r);

/* The other way: the tiles. ERR_FORMAT, after `path`, where the streams are no such weights of a scene of so
 * many Gaussians; the room is then as it may be used again or freed. */
int weights_unpack_tiles(const struct weights_pack *p, int width, int height, int64_t gaussians,
	const char *path, struct weights_room *to, struct err *e);

/* The tiles and the rows; weights are level / 255, in the order of the Gaussians within a pixel. */
int weights_unpack(const struct weights_pack *p, int width, int height, int64_t gaussians, const char *path,
	struct weights_room *to, struct err *e);
