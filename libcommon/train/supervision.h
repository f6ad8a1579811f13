/* Supervision: which mask teaches which sentence in which view. */
#pragma once

#include "base/err.h"
#include "mask/mask_index.h"
#include "train/train.h"

#include <stdint.h>

/* What a mask covers at the size of its view's weights. */
struct supervision_bits {
	size_t view;
	uint8_t *bits; /* mask/bits.h */
	size_t bytes;
	int is_shared; /* they are those of an earlier mask of the view, which is equal */
	uint64_t hash;
};

struct supervision {
	struct masks masks; /* without their runs */
	size_t capacity;
	struct supervision_bits *bits; /* (masks.n) */
	struct mask_index index;       /* of supervision_index */
	/* A hash table of mask numbers + 1, 0 where free: those with bits of their own by view and bits. */
	size_t slots, *by_bits;
};

/* Takes a mask over, at the size of its view's weights: another size is reduced by area and cut at one half.
 * Returns 0, or -1 with *e set; the mask is taken over also then. */
int supervision_add(
	struct supervision *s, size_t view, int width, int height, struct mask *mask, struct err *e);

/* After all were added. ERR_FORMAT (without a file name) and *later where mask number *later has the view and
 * ref, or without ref the view and object, of an earlier one. */
int supervision_index(struct supervision *s, size_t *later, struct err *e);
void supervision_free(struct supervision *s);

/* Fills count, sentences and masks of every view, after supervision_index: a sentence is taught by the mask
 * of its ref, else by that of its object without ref. The views' weights are left alone. Free with
 * supervision_unlink. */
int supervision_link(const struct supervision *s, const char *const *refs, const char *const *objects,
	size_t sentences, struct train_view *views, size_t view_count, struct err *e);
void supervision_unlink(struct train_view *views, size_t view_count);
