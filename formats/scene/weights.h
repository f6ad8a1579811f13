/* weights/VIEW.safetensors (refer.weights): a view's blend weights, CSR over pixels
 * (formats/scene/weights.md). */
#pragma once

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
	const struct view_tiles *tiles;	 /* of weights_open_in, in the room; else NULL */
	enum precision precision;	 /* of the weights in the file */
	const struct weights_pack *pack; /* for weights_write: packed weights, in place of indptr, index and
					    weight; else NULL */
};

/* Weights below half of 1/255 round to 0 as u8: render_weights_within leaves them out as dropped. */
#define WEIGHTS_U8_LEAST (0.5 / 255)

/* Maps and checks DIR/VIEW.safetensors: indptr rises from 0 to nnz, ids in [0,gaussians), weights finite in
 * [0,1]. VIEW is a view of the scene; weights of another scene, or of another camera, are an error. */
int weights_open(struct weights *w, const char *dir, const struct scene *scene, size_t view, struct err *e);
/* The same for one view after the other: what packed weights become is in *room, zeroed before the first, and
 * lasts until the next. To ask the system for so much memory with each view costs more than to fill it.
 * weights_room_free (splat/weights_pack.h) at last. As tiles, packed weights have w->tiles, and indptr, index
 * and weight are NULL; w->tiles is NULL where weights are not packed. */
enum weights_form { WEIGHTS_ROWS, WEIGHTS_TILES };
int weights_open_in(struct weights *w, struct weights_room *room, enum weights_form form, const char *dir,
	const struct scene *scene, size_t view, struct err *e);
/* weights_open by its path and of any scene; "-" is stdin. */
int weights_open_file(struct weights *w, const char *path, struct err *e);
void weights_close(struct weights *w);

/* there (cameras->n): 1 for the training views that have weights. *missing gets the number of those without.
 * -1 with *e where there is no other. */
int weights_mark(const char *dir, const struct cameras *cameras, char *there, size_t *missing, struct err *e);

/* What the library blends with; referred to. */
struct view_weights weights_view(const struct weights *w);
/* The same as rows or, of WEIGHTS_TILES, as tiles. */
struct view_matrix weights_matrix(const struct weights *w);

/* Writes DIR/VIEW.safetensors, with the weights in w's precision (u8: whole numbers of 1/255) or packed. */
int weights_write(
	const struct weights *w, const char *dir, const char *view, const char *options, struct err *e);
