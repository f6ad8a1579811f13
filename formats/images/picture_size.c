/* The size of a PNG or JPEG as its header has it, without its pixels. */
#include "formats/images/png.h"

#include <string.h>

static unsigned big(const uint8_t *bytes, int n)
{
	unsigned x = 0;

	for (int i = 0; i < n; i++)
		x = x << 8 | bytes[i];
	return x;
}

/* Marker after marker, up to the one of a frame: length (2 bytes), the bits of a sample, height, width. */
static enum picture_kind jpeg_size(FILE *in, int *height, int *width)
{
	uint8_t head[7];
	int marker;

	while ((marker = getc(in)) != EOF) {
		if (marker == 0xff)
			continue; /* it begins with one or more of these */
		if (marker == 0xda || fread(head, 1, 2, in) != 2 || big(head, 2) < 2)
			return PICTURE_NONE;
		if (marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc) {
			if (fread(head + 2, 1, 5, in) != 5)
				return PICTURE_NONE;
			*height = (int)big(head + 3, 2);
			*width = (int)big(head + 5, 2);
			return PICTURE_JPEG;
		}
		for (unsigned left = big(head, 2) - 2; left; left--)
			if (getc(in) == EOF)
				return PICTURE_NONE;
	}
	return PICTURE_NONE;
}

enum picture_kind picture_size(FILE *in, int *height, int *width)
{
	uint8_t head[24];

	if (fread(head, 1, 2, in) != 2)
		return PICTURE_NONE;
	if (!memcmp(head, "\xff\xd8", 2))
		return jpeg_size(in, height, width);
	if (fread(head + 2, 1, 22, in) != 22 || memcmp(head, "\x89PNG\r\n\x1a\n", 8) ||
		big(head + 16, 4) > 65536 || big(head + 20, 4) > 65536)
		return PICTURE_NONE;
	*width = (int)big(head + 16, 4);
	*height = (int)big(head + 20, 4);
	return PICTURE_PNG;
}
