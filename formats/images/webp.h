/* Lossless WebP: what SOG keeps its numbers in. formats/splats/sog.md. */
#pragma once

#include "base/err.h"

struct webp {
	int width, height;
	unsigned char *rgba; /* (height, width, 4) */
};

/* Decodes `len` bytes, where they are an image of at most `pixels`; messages name the archive and the file in
 * it. Returns 0, or -1 with *e set. */
int webp_decode(struct webp *to, const char *data, size_t len, size_t pixels, const char *name,
	const char *file, struct err *e);
void webp_free(struct webp *w);

/* The longest side of an image. */
enum { WEBP_SIDE_MOST = 16383 };

/* Encodes rgba (height, width, 4) without loss, colours under transparent pixels too: webp_release(*bytes).
 * `name` is for messages. Returns 0, or -1 with *e set. */
int webp_encode(unsigned char **bytes, size_t *length, const unsigned char *rgba, int width, int height,
	const char *name, struct err *e);
void webp_release(unsigned char *bytes);
