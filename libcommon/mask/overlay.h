/* A mask drawn over a picture, so that a person sees at once whether it is right. */
#pragma once

#include <stdint.h>

/* Draws mask (height,width) of 0 and 1 over rgb (height,width,3) in place: outside pale, inside tinted, and
 * an outline as wide as the picture asks. */
void overlay_draw(uint8_t *rgb, const uint8_t *mask, int height, int width);
