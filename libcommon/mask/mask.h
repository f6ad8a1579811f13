/* A mask of an object in a view: what detectors find, what is selected, what teaches and is lifted, what is
 * predicted, and the truth. */
#pragma once

#include "base/err.h"
#include "mask/mask_place.h"
#include "mask/rle.h"

/* Who makes one says whether its strings, runs and place are its own; those of `struct masks` are. */
struct mask {
	const char *view;
	const char *ref;    /* of the sentence; NULL where the mask is of the object whatever the sentence */
	const char *object; /* may be NULL where there is a ref */
	struct rle rle;
	double score;	/* confidence; NaN where nothing is known */
	double visible; /* of the outline of a whole object, the share in [0,1] that is in sight; NaN where
			   nothing is known */
	struct mask_place *place; /* NULL where nothing is known */
};

/* The score, or 1 where there is none. */
double mask_confidence(const struct mask *m);

/* What a mask goes by where there is one of each object: its object, else its ref. */
const char *mask_object(const struct mask *m);

/* 0 where a mask of a view can be of a picture of that size: rle_check_shape; `of` is what the picture is. */
int mask_check_shape(
	const char *view, const struct rle *rle, const char *of, int height, int width, struct err *e);

/* By what masks go by, then by sentence and pixels: an order that is not that in which they came. 0 where all
 * of that is the same. */
int mask_order(const struct mask *a, const struct mask *b);

/* A copy with its own strings and runs, of this ref and object (either may be NULL); its score alone comes
 * along. Returns 0, or -1 with *e set and nothing to free. */
int mask_copy(struct mask *to, const struct mask *from, const char *ref, const char *object, struct err *e);

/* Of a mask that owns its strings, runs and place. */
void mask_free(struct mask *m);

struct masks {
	size_t n, capacity;
	struct mask *items; /* owned, with their strings, runs and places */
};

/* Appends a mask, which is the list's from then on, also where it fails: then it is freed. Returns 0, or -1
 * with *e set. */
int masks_add(struct masks *to, struct mask *m, struct err *e);
void masks_free(struct masks *masks);
