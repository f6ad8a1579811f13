/* What refer-render draws for a person to look at: a picture for each view and sentence.
 * formats/images/pictures.md. */
#pragma once

#include "base/err.h"

#include <stdint.h>

/* The folders to write to; NULL: not this kind. */
struct pictures {
	const char *masks, *responses, *overlays;
	int is_npy; /* responses as numbers, else as 16-bit PNG */
};

/* One answer of a model: an image M (height,width), its mask of 0 and 1, and, for an overlay, the view's
 * colours (height,width,3), which stay as they are. */
struct picture {
	const char *view, *ref;
	int height, width;
	const float *image;
	const uint8_t *mask;
	const float *rgb;     /* in [0,1] */
	const char *words[2]; /* that stand under an overlay, a line each */
};

/* Writes DIR/VIEW/REF.png (.npy) of each kind, each appearing whole; makes the folders. */
int pictures_put(const struct pictures *p, const struct picture *one, struct err *e);

/* An overlay alone: the colours with the mask over them, and its words below. 0, or -1 with *e. */
int picture_overlay(const char *path, const struct picture *one, struct err *e);
