/* JPEG images through libjpeg: formats/images/jpeg.md. formats/images/png.h tells PNG from JPEG. */
#pragma once

#include "base/err.h"

#include <stdint.h>
#include <stdio.h>

/* Grey, YCbCr or RGB as RGB, (height,width,3). free() it. `name` is the file's name in messages. */
int jpeg_read_rgb(const char *name, FILE *in, uint8_t **rgb, int *height, int *width, struct err *e);

/* A picture rgb (height,width,3) as the bytes of a baseline JPEG of this quality, 1 to 100: free() them.
 * Returns 0, or -1 with *e set; `name` is the picture's name in messages. */
int jpeg_encode(const char *name, const uint8_t *rgb, int height, int width, int quality, uint8_t **bytes,
	size_t *count, struct err *e);
