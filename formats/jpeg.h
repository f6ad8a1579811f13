/* JPEG images through libjpeg, read only: formats/jpeg.md. formats/png.h has the function that tells PNG from
 * JPEG. */
#ifndef FORMATS_JPEG_H
#define FORMATS_JPEG_H

#include "base/err.h"

#include <stdint.h>
#include <stdio.h>

/* Grey, YCbCr or RGB as RGB, (height,width,3). free() it. `name` is the file's name in messages. */
int jpeg_read_rgb(const char *name, FILE *in, uint8_t **rgb, int *height, int *width, struct err *e);

#endif
