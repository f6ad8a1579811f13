/* What the parts of cmd/masks/painting.h share: painting_colours.c has pictures of colours, painting.c the
 * rest. */
#ifndef CMD_MASKS_PAINTING_PRIVATE_H
#define CMD_MASKS_PAINTING_PRIVATE_H

#include "cmd/masks/painting.h"
#include "formats/records/annotations.h"
#include "formats/records/masks.h"

/* The record of a mask, which is freed. Where it goes: the lens's photograph to the view. */
int painting_put(struct mask *mask, struct warping *w, const char *path, FILE *out, struct err *e);

/* A mask record for each colour of a picture that has a name. */
int painting_put_colours(struct painting_names *names, const char *path, struct warping *w, FILE *out,
	const struct report *to, struct err *e);

/* Takes the pixels of outlines that lie on larger ones away from these. */
int painting_layers(struct annotations *a, struct err *e);

/* ERR_FORMAT where pictures that are called the same in different folders are of one view. */
int painting_check_shared(const char *const *pictures, size_t count, struct err *e);

/* That error, of two files; always -1. */
int painting_two_pictures(const char *earlier, const char *later, const char *view, struct err *e);

#endif
