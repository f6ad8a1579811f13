/* Words under a picture. */
#include "mask/overlay.h"
#include "unit.h"

#include <string.h>

enum { WIDTH = 120, HEIGHT = 20, BYTES = 3 * WIDTH * HEIGHT };

/* The letter that was drawn in a column of letters, or -1 where it is none of the font's. */
static int read_letter(const uint8_t *rgb, int width, int top, int column)
{
	for (int g = 0; g < CAPTION_GLYPHS; g++) {
		int wrong = 0;
		for (int y = 0; y < CAPTION_HEIGHT; y++)
			for (int x = 0; x < CAPTION_WIDTH; x++) {
				const int at = (top + 1 + y) * width + CAPTION_WIDTH / 2 +
					       column * CAPTION_WIDTH + x;
				const int on = caption_font[g][y] >> (CAPTION_WIDTH - 1 - x) & 1;
				wrong |= rgb[3 * at] != (on ? 255 : 0);
			}
		if (!wrong)
			return g + 32;
	}
	return -1;
}

static void read_line(const uint8_t *rgb, int top, char out[WIDTH / CAPTION_WIDTH])
{
	for (int k = 0; k < WIDTH / CAPTION_WIDTH - 1; k++)
		out[k] = (char)read_letter(rgb, WIDTH, top, k);
	out[WIDTH / CAPTION_WIDTH - 1] = 0;
}

static void letters(void)
{
	static uint8_t rgb[BYTES];
	char line[WIDTH / CAPTION_WIDTH];
	const struct {
		const char *text, *shown;
	} cases[] = {{"where is it?", "where is it?       "}, {"", "                   "},
		{"\xc3\xa9t\xc3\xa9 \xe2\x98\x83!", "?t? ?!             "},
		{"a sentence that has no room", "a sentence that h.."},
		{"as long as the line", "as long as the line"}};

	for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
		memset(rgb, 7, sizeof rgb);
		caption_draw(rgb, WIDTH, 4, cases[i].text);
		read_line(rgb, 4, line);
		CHECK(!strcmp(line, cases[i].shown), "'%s' is '%s'", cases[i].text, line);
		size_t touched = 0;
		for (int k = 0; k < BYTES; k++)
			touched += rgb[k] != 7 &&
				   (k < 3 * WIDTH * 4 || k >= 3 * WIDTH * (4 + caption_height(WIDTH)));
		CHECK(!touched, "'%s': %zu bytes beside the line", cases[i].text, touched);
	}
}

/* Every width has its line: nothing is written past it (the sanitizers look). */
static void widths(void)
{
	for (int width = 1; width < 2000; width += width < 20 ? 1 : 97) {
		const int height = caption_height(width);
		uint8_t *rgb = malloc(3 * (size_t)width * (size_t)height);
		caption_draw(rgb, width, 0, "where is the kettle, and is there anything left in it?");
		size_t other = 0;
		for (size_t i = 0; i < 3 * (size_t)width * (size_t)height; i++)
			other += rgb[i] != 0 && rgb[i] != 255;
		CHECK(!other, "width %d: %zu bytes are neither black nor white", width, other);
		free(rgb);
	}
	CHECK(caption_height(1906) == 3 * (CAPTION_HEIGHT + 2), "large pictures have large letters");
}

int main(void)
{
	letters();
	widths();
	return unit_end();
}
