#include "mask/overlay.h"

#include "base/utf8.h"

#include <string.h>

/* Whether the pixels within `reach` of (row,column) along both axes all have its value. */
static int is_inner(const uint8_t *mask, int height, int width, int row, int column, int reach)
{
	const uint8_t own = mask[(size_t)row * (size_t)width + (size_t)column];

	for (int d = -reach; d <= reach; d++) {
		int r = row + d, c = column + d;
		if (r >= 0 && r < height && mask[(size_t)r * (size_t)width + (size_t)column] != own)
			return 0;
		if (c >= 0 && c < width && mask[(size_t)row * (size_t)width + (size_t)c] != own)
			return 0;
	}
	return 1;
}

void overlay_draw(uint8_t *rgb, const uint8_t *mask, int height, int width)
{
	static const int tint[3] = {255, 64, 32}, line[3] = {255, 235, 0};
	const int reach = (height > width ? height : width) / 600 + 1;

#pragma omp parallel for schedule(static)
	for (int row = 0; row < height; row++)
		for (int column = 0; column < width; column++) {
			const size_t at = (size_t)row * (size_t)width + (size_t)column;
			const int is_edge = mask[at] && !is_inner(mask, height, width, row, column, reach);
			for (int c = 0; c < 3; c++) {
				uint8_t *p = &rgb[3 * at + (size_t)c];
				if (is_edge)
					*p = (uint8_t)line[c];
				else if (mask[at])
					*p = (uint8_t)((*p * 6 + tint[c] * 4) / 10);
				else
					*p = (uint8_t)((*p * 7 + 255 * 2) / 9);
			}
		}
}

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
