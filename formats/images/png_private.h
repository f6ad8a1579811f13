/* What reading (png.c) and writing (png_write.c) of formats/images/png.h share. formats/images/png.md. */
#pragma once

#include "formats/images/png.h"

#include <png.h>

enum { PNG_SIDE_MAX = 65536 };

/* What libpng reports, and what must be released when it jumps out. */
struct png_job {
	const char *path;
	struct err *e;
	png_structp png;
	png_infop info;
	uint8_t *raw;
	png_bytep *rows;
	size_t row_bytes;
	int height, width, channels, depth;
	int is_rgb;    /* of 16 bit samples the high byte, without alpha */
	int is_labels; /* a palette's numbers are kept, and colours are an error */
	uint8_t palette_alpha[256];
	int grey_clear; /* the grey level that is transparent, or -1 */
};

/* libpng's error and warning functions: the first jumps to the place that png_jmpbuf has. */
_Noreturn void png_job_error(png_structp png, png_const_charp message);
void png_job_warning(png_structp png, png_const_charp message);
