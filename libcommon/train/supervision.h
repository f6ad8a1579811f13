/* Supervision: which mask teaches which sentence in which view. */
#ifndef TRAIN_SUPERVISION_H
#define TRAIN_SUPERVISION_H

#include "base/err.h"
#include "mask/rle.h"
#include "train/train.h"

#include <stddef.h>
#include <stdint.h>

struct supervision_mask {
	size_t view;
	char *ref, *object; /* NULL where the record had none */
	uint8_t *bits;	    /* of the view's weights' pixels, mask/bits.h */
	size_t bytes;
	int is_shared; /* the bits are those of an earlier mask of the view, which is equal */
	uint64_t name_hash, bits_hash;
};

struct supervision {
	size_t n, capacity;
	struct supervision_mask *masks;
	/* Two hash tables of mask numbers + 1, 0 where free: all masks by view and name, those with bits of
	 * their own by view and bits. */
	size_t slots, *by_name, *by_bits;
};

/* Takes a copy of a mask, at the size of the view's weights: another size is reduced by area and cut at one
 * half. ERR_FORMAT (without a file name) where the view already has a mask of that ref, or of that object
 * without ref. */
int supervision_add(struct supervision *s, size_t view, int width, int height, const char *ref,
	const char *object, const struct rle *mask, struct err *e);
void supervision_free(struct supervision *s);

/* Fills count, sentences and masks of every view: a sentence is taught by the mask of its ref, else by that
 * of its object without ref. The views' weights are left alone. Free with supervision_unlink. */
int supervision_link(const struct supervision *s, const char *const *refs, const char *const *objects,
	size_t sentences, struct train_view *views, size_t view_count, struct err *e);
void supervision_unlink(struct train_view *views, size_t view_count);

#endif
