#include "mask/caption.h"

#include "base/utf8.h"

#include <string.h>

const uint8_t caption_font[CAPTION_GLYPHS][CAPTION_HEIGHT] = {
#include "mask/caption_font.def"
};

/* Pixels of the picture for one of the font. */
static int scale_of(int width)
{
	return width / (100 * CAPTION_WIDTH) > 1 ? width / (100 * CAPTION_WIDTH) : 1;
}

int caption_height(int width)
{
	return (CAPTION_HEIGHT + 2) * scale_of(width);
}

static void draw_glyph(uint8_t *rgb, int width, int top, int left, uint32_t c)
{
	const int scale = scale_of(width), is_known = c >= 32 && c < 32 + CAPTION_GLYPHS;
	const uint8_t *rows = caption_font[(is_known ? c : '?') - 32];

	for (int y = 0; y < CAPTION_HEIGHT * scale; y++)
		for (int x = 0; x < CAPTION_WIDTH * scale; x++)
			if (rows[y / scale] >> (CAPTION_WIDTH - 1 - x / scale) & 1)
				memset(rgb + 3 * ((size_t)(top + y) * (size_t)width + (size_t)(left + x)),
					255, 3);
}

static int count_characters(const char *text, size_t length)
{
	int n = 0;

	for (size_t at = 0; at < length; n++)
		utf8_next(text, length, &at);
	return n;
}

void caption_draw(uint8_t *rgb, int width, int top, const char *text)
{
	const int scale = scale_of(width), step = CAPTION_WIDTH * scale, room = width / step - 1;
	const size_t length = strlen(text);
	const int is_cut = count_characters(text, length) > room;
	size_t at = 0;

	memset(rgb + 3 * (size_t)top * (size_t)width, 0, 3 * (size_t)width * (size_t)caption_height(width));
	for (int n = 0; at < length && n < room; n++) {
		const uint32_t c = utf8_next(text, length, &at);
		draw_glyph(rgb, width, top + scale, step / 2 + n * step, is_cut && n >= room - 2 ? '.' : c);
	}
}
