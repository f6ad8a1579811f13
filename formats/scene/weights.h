/* weights/VIEW.safetensors (refer.weights): a view's blend weights, CSR over pixels.
 * formats/scene/weights.md. */
#ifndef FORMATS_WEIGHTS_H
#define FORMATS_WEIGHTS_H

#include "base/err.h"
#include "formats/arrays/fingerprint.h"
#include "formats/arrays/precision.h"
#include "formats/arrays/safetensors.h"
#include "formats/scene/scene.h"
#include "splat/view_matrix.h"

#include <stdint.h>

struct weights_pack;
struct weights_room;

struct weights {
	int width, height;     /* of the rendered size: P = width*height pixels, row-major */
	int64_t gaussians;     /* N of the scene it belongs to */
	const int64_t *indptr; /* (P+1) */
	const int32_t *index;  /* (nnz) Gaussian ids, front to back within a pixel; packed: rising */
	const float *weight;   /* (nnz) a_i prod_{k<i} (1-a_k); from f32 in place, else converted */
	const float *dropped;  /* (P) weight left out by --tolerance */
	struct fingerprint scene, camera; /* of what it was made from; camera: at the rendered size */
	struct safetensors file;	  /* keeps the map alive */
	float *owned;			  /* the converted copy of f16 and u8 weights, else NULL */
	int is_packed;			  /* in the file: u8, and in few bytes */
	struct weights_room *room;	  /* of what packed weights become; NULL: they are not packed */
	int is_lent;			  /* the room is somebody else's */
	float *owned_dropped;
	const struct view_tiles *tiles;	 /* of weights_open_tiles, in the room; else NULL */
	enum precision precision;	 /* of the weights in the file */
	const struct weights_pack *pack; /* for weights_write: packed weights, in place of indptr, index and
					    weight; else NULL */
};

/* Weights below half of 1/255 round to 0 as u8: prune_weights leaves them out, so that they count as dropped.
 */
#define WEIGHTS_U8_LEAST (0.5 / 255)

/* Maps and checks DIR/VIEW.safetensors: indptr rises from 0 to nnz, ids in [0,gaussians), weights finite in
 * [0,1]. VIEW is a view of the scene; weights of another scene, or of another camera, are an error. */
int weights_open(struct weights *w, const char *dir, const struct scene *scene, size_t view, struct err *e);
/* The same for one view after the other: what packed weights become is in *room, zeroed before the first, and
 * lasts until the next. To ask the system for so much memory with each view costs more than to fill it.
 * weights_room_free (formats/scene/weights_pack.h) at last. */
int weights_open_in(struct weights *w, struct weights_room *room, const char *dir, const struct scene *scene,
	size_t view, struct err *e);
/* The same, but that packed weights become tiles, and indptr, index and weight are NULL; w->tiles is NULL
 * where weights are not packed. */
int weights_open_tiles(struct weights *w, struct weights_room *room, const char *dir,
	const struct scene *scene, size_t view, struct err *e);
/* weights_open by its path and of any scene; "-" is stdin. */
int weights_open_file(struct weights *w, const char *path, struct err *e);
/* 1 where DIR/VIEW.safetensors is there, 0 where it is not, -1 with *e. */
int weights_exist(const char *dir, const char *view, struct err *e);
void weights_close(struct weights *w);

/* there (cameras->n): 1 for the training views that have weights. *missing gets the number of those without.
 * -1 with *e where there is no other. */
int weights_mark(const char *dir, const struct cameras *cameras, char *there, size_t *missing, struct err *e);
/* Visits the training views that have weights, in the order of the cameras, each open only meanwhile, and
 * where `needs` is given and gives 0 not at all: w is NULL then. A visit that does not give 0 ends it.
 * *missing gets the number of training views without. -1 with *e, also where there is no other. */
int weights_each(const char *dir, const struct scene *scene, int (*needs)(const void *context, size_t view),
	int (*visit)(void *context, size_t view, const struct weights *w, struct err *e), void *context,
	size_t *missing, struct err *e);

/* What the library blends with; referred to. */
struct view_weights weights_view(const struct weights *w);
/* The same as rows or, after weights_open_tiles, as tiles. */
struct view_matrix weights_matrix(const struct weights *w);

/* Writes DIR/VIEW.safetensors, with the weights in w's precision; u8 has whole numbers of 1/255; or as
 * they are packed. */
int weights_write(
	const struct weights *w, const char *dir, const char *view, const char *options, struct err *e);

#endif
