/* A mask drawn over a picture, so that a person sees at once whether it is right. */
#pragma once

#include <stdint.h>

/* Draws mask (height,width) of 0 and 1 over rgb (height,width,3) in place: outside pale, inside tinted, and
 * an outline as wide as the picture asks. */
void overlay_draw(uint8_t *rgb, const uint8_t *mask, int height, int width);

/* Words under a picture, in a small font of ASCII. */

enum { CAPTION_GLYPHS = 95, CAPTION_WIDTH = 6, CAPTION_HEIGHT = 10 };
extern const uint8_t caption_font[CAPTION_GLYPHS][CAPTION_HEIGHT];

/* Pixels that a line of words is high in a picture of that width: a letter is a hundredth of it wide. */
int caption_height(int width);

/* Draws a line of words, UTF-8, white on black over rows top to top + caption_height - 1 of rgb
 * (...,width,3). Characters that the font lacks become '?'; what has no room ends in dots. */
void caption_draw(uint8_t *rgb, int width, int top, const char *text);
