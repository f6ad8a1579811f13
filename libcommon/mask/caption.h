/* Words under a picture, in a small font of ASCII. */
#pragma once

#include <stddef.h>
#include <stdint.h>

enum { CAPTION_GLYPHS = 95, CAPTION_WIDTH = 6, CAPTION_HEIGHT = 10 };
extern const uint8_t caption_font[CAPTION_GLYPHS][CAPTION_HEIGHT];

/* Pixels that a line of words is high in a picture of that width: a letter is about a hundredth of it wide.
 */
int caption_height(int width);

/* Draws a line of words, UTF-8, white on black over rows top to top + caption_height - 1 of rgb
 * (...,width,3). Characters that the font lacks become '?'; what has no room ends in dots. */
void caption_draw(uint8_t *rgb, int width, int top, const char *text);
