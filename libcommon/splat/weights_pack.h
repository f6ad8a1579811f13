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

/* Memory for packing tiles, one thread's; zeroed before the first. */
struct weights_packer {
	size_t n;			     /* Gaussians of the tile */
	uint64_t *ids, *spare;		     /* (n) each and, in the low half, where its levels are */
	uint8_t (*levels)[VIEW_TILE_PIXELS]; /* (n) */
	int32_t *slot;			     /* (list) where each that may be in the tile is met, -1 */
	size_t room[4];			     /* of ids, spare, levels and slot */
};

void weights_packer_free(struct weights_packer *t);

/* A tile of VIEW_TILE x VIEW_TILE pixels, of some of the `list` Gaussians of a list. Returns 0, or -1 with *e
 * set. */
int weights_packer_start(struct weights_packer *t, size_t list, struct err *e);
/* The levels of the Gaussian at a place of the list, in 1/255, row by row: to be written where they are not
 * 0. */
uint8_t *weights_packer_levels(struct weights_packer *t, size_t place, uint32_t id);
/* Ends the tile, which goes on in a row of tiles that was zeroed before its first. The scene has so many
 * Gaussians. */
int weights_packer_end(struct weights_packer *t, size_t gaussians, struct weights_pack *row, struct err *e);

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
