/* PNG images through libpng (formats/images/png.md), JPEG through libjpeg (formats/images/jpeg.md). */
#pragma once

#include "base/err.h"

#include <stdint.h>
#include <stdio.h>

/* A picture of more pixels is refused before memory is taken for it: 2^28, those of 16384 x 16384. */
enum { PICTURE_PIXELS_MAX = 1 << 28 };

/* 0 where the size is within that limit, else -1 with *e (ERR_FORMAT); `kind` is PNG or JPEG. */
int picture_check_size(const char *path, const char *kind, size_t width, size_t height, struct err *e);

/* 0 where a picture that takes at least so many bytes can be in the file: what is read from a pipe can. Else
 * -1 with *e (ERR_FORMAT). */
int picture_check_bytes(const char *path, const char *kind, size_t width, size_t height, uint64_t least,
	FILE *in, struct err *e);

/* What is transparent: less than half as opaque as the most opaque pixel, also by a palette or a colour that
 * is. A PNG as a mask: pixels (height,width) get 1 where any colour channel is nonzero and it is not
 * transparent. free() it. */
int png_read_mask(const char *path, uint8_t **pixels, int *height, int *width, struct err *e);

/* The same of a stream; `path` is for messages. */
int png_take_mask(const char *path, FILE *in, uint8_t **pixels, int *height, int *width, struct err *e);

/* A PNG of numbers: grey levels of up to 16 bits as they are in the file, or the places in a palette, -1
 * where it is transparent; other colours are an error. labels (height,width); free() it. */
int png_read_labels(const char *path, int32_t **labels, int *height, int *width, struct err *e);

/* A painted PNG: paint (height,width) is 0xrrggbb, a grey or number as png_paint_number has it, or
 * PNG_PAINT_NONE, where it is transparent or a colour of 16 bits that none of 8 bits is. Greys of 16 bits are
 * numbers, but where all are 8 bits said twice. free() it. */
enum { PNG_PAINT_NUMBER = 1 << 24, PNG_PAINT_NONE = 1 << 25 };
int png_read_paint(const char *path, uint32_t **paint, int *height, int *width, struct err *e);
/* Up to 255 the grey 0xrrggbb, else PNG_PAINT_NUMBER and the number. */
uint32_t png_paint_number(uint32_t number);

/* Refuses paint (height,width), or labels (-1 is none), that was scaled with mixing or saved as a JPEG: of
 * its edges more than a tenth are of values between those on either side, which are labels of other things.
 * counts (height,width) has 0 where a value means nothing; NULL: all do. 0, or -1 with *e. */
int png_check_edges(const char *path, const uint32_t *values, const uint8_t *counts, int height, int width,
	int is_number, struct err *e);

/* What a stream begins with: PICTURE_PNG or PICTURE_JPEG, whose size it says, or PICTURE_NONE. */
enum picture_kind { PICTURE_NONE, PICTURE_PNG, PICTURE_JPEG };
enum picture_kind picture_size(FILE *in, int *height, int *width);

/* A PNG or JPEG (by content) as RGB, (height,width,3). free() it. */
int image_read_rgb(const char *path, uint8_t **rgb, int *height, int *width, struct err *e);

/* All appear whole. channels 1 or 3, row-major. The 16-bit one is grey, native-endian values in memory. */
int png_write(const char *path, const uint8_t *pixels, int height, int width, int channels, struct err *e);
int png_write16(const char *path, const uint16_t *grey, int height, int width, struct err *e);
