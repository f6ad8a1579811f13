/* Binary masks as COCO run lengths: columns first (Fortran order), runs alternate 0,1,0,... beginning with 0.
 * Positions are p = column * height + row. At most 2^32 - 1 pixels, so that a run fits. */
#pragma once

#include "base/err.h"

#include <stdint.h>

enum { RLE_MAX_SIDE = 65536 };

struct rle {
	int height, width;
	size_t n;
	uint32_t *runs; /* n lengths that sum to height*width; owned */
};

void rle_free(struct rle *r);

/* Sides in 1 to RLE_MAX_SIDE and at most 2^32 - 1 pixels: 0, else -1 with ERR_FORMAT and no file name. */
int rle_check_size(int64_t height, int64_t width, struct err *e);

/* mask (height,width) row-major, nonzero is foreground. */
int rle_encode(struct rle *r, const uint8_t *mask, int height, int width, struct err *e);
/* mask (height,width) row-major gets 0 or 1. */
void rle_decode(const struct rle *r, uint8_t *mask);

/* A copy of n given lengths (COCO's uncompressed list). Errors as rle_from_string. */
int rle_from_runs(struct rle *r, const uint32_t *runs, size_t n, int height, int width, struct err *e);

/* COCO's compressed string (byte-compatible with pycocotools). Parsing reports the offset of a bad character
 * or a sum of runs other than height*width, as ERR_FORMAT without a file name; rle_free after either. */
int rle_from_string(struct rle *r, const char *text, int height, int width, struct err *e);
/* free() the result; NULL with *e. */
char *rle_to_string(const struct rle *r, struct err *e);

size_t rle_area(const struct rle *r);
/* Whether runs that were read as COCO's look as if they went along rows: so taken, three times fewer pixels
 * differ from the next one across the runs. Of 16 pixels and more, two and more in a run. */
int rle_is_by_rows(const struct rle *r);
/* |a and b|; both must have the same size. */
size_t rle_intersection(const struct rle *a, const struct rle *b);
/* a or b, of the same size. `to` is neither of them. */
int rle_unite(struct rle *to, const struct rle *a, const struct rle *b, struct err *e);
/* a but not b, likewise. */
int rle_without(struct rle *to, const struct rle *a, const struct rle *b, struct err *e);
int rle_same_size(const struct rle *a, const struct rle *b);
/* Intersection over union; two empty masks give 1. */
double rle_iou(const struct rle *a, const struct rle *b);

/* Whether a mask or another map of h x w can be of a picture of height x width: sides that a resize rounds,
 * cuts or raises are less than one pixel of the smaller off, so |h width - w height| is at most the larger
 * sum of sides, or 0.5% of h width; the picture's own sides exchanged are another shape always. */
int rle_has_shape(int64_t h, int64_t w, int64_t height, int64_t width);

/* Returns 0 where it can, else -1 with ERR_FORMAT and no file name: "a mask of 3x4, but NAME is 4x3 ...". */
int rle_check_shape(const char *what, int64_t h, int64_t w, const char *name, int64_t height, int64_t width,
	struct err *e);

/* Another size: each new pixel's share of foreground by area, cut at one half (> 0.5 is foreground, exactly
 * 0.5 too). The shares are exact: whole numbers of 1/(H*W) of a new pixel. */
int rle_resize(struct rle *to, const struct rle *from, int height, int width, struct err *e);

/* rle_decode of rle_resize: mask (height,width). */
int rle_decode_at(const struct rle *r, int height, int width, uint8_t *mask, struct err *e);

/* A mask at the size of what it is held against: resized where it must be, once for all of one size. */
struct rle_fitted {
	const struct rle *own;
	const struct rle *now; /* own or resized; NULL before the first rle_fit */
	size_t area;	       /* of now */
	struct rle resized;
};

/* Brings f->now to that size. Of a struct zeroed but for own. Returns 0, or -1 with *e set; after either
 * rle_fitted_free is in order. */
int rle_fit(struct rle_fitted *f, const struct rle *like, struct err *e);
void rle_fitted_free(struct rle_fitted *f);
